// Models come one after the other, sometimes faster than they can be read. One is read at a time; of those that came meanwhile,
// only the newest is read next.

export class Newest<Key, Value> {
  private wanted: { readonly key: Key } | null = null;
  private busy = false;

  /** `read` makes a value, `take` gets each in turn, `fail` hears why there is none. */
  constructor(
    private readonly read: (key: Key) => Promise<Value>,
    private readonly take: (value: Value, key: Key) => void,
    private readonly fail: (error: unknown, key: Key) => void,
  ) {}

  want(key: Key): void {
    this.wanted = { key };
    if (!this.busy) void this.work();
  }

  private async work(): Promise<void> {
    this.busy = true;
    try {
      while (this.wanted) {
        const { key } = this.wanted;
        this.wanted = null;
        let value: Value;
        try {
          value = await this.read(key);
        } catch (error) {
          this.fail(error, key);
          continue;
        }
        this.take(value, key);
      }
    } finally {
      this.busy = false;
    }
  }
}
