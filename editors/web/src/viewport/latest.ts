// Processes the latest of a series of requests: one at a time, and requests that are replaced meanwhile are skipped.

export class Latest<Key, Value> {
  private wanted: { readonly key: Key } | null = null;
  private busy = false;

  /** `read` produces a value, `take` receives each in turn, `fail` receives errors. */
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
