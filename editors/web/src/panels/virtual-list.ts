// A list of rows of equal height of which only those near the visible ones are in the page.

/** So many rows beyond both edges are in the page. */
const BEYOND = 6;

export class VirtualList {
  private readonly rows = new Map<number, HTMLElement>();
  private count = 0;
  /** The height of a row in pixels. */
  private height = 0;
  /** The height of the list before it was resized, in pixels. */
  private heightBefore = 0;
  /** The row that stays in the page wherever the list is scrolled, because it may have the focus; -1 for none. */
  private kept = -1;

  /**
   * `place` lies in `scroller`, which has the height of a row as its custom property `--row`. `make` makes a row. `shown` is called after
   * rows came or went.
   */
  constructor(private readonly scroller: HTMLElement, private readonly place: HTMLElement, private readonly make: (at: number) => HTMLElement, private readonly shown: () => void) {
    scroller.addEventListener("scroll", () => this.render(), { passive: true });
    new ResizeObserver(() => this.resize()).observe(scroller);
  }

  /** The rows that are in the page, by their index. */
  get visible(): ReadonlyMap<number, HTMLElement> {
    return this.rows;
  }

  /** How many rows a page up or down skips. */
  get page(): number {
    return Math.max(Math.floor(this.scroller.clientHeight / this.height) - 1, 1);
  }

  /** Shows `count` rows, one of which is kept. Those of which `isSame` is true stay as they are. */
  set(count: number, kept: number, isSame: (at: number) => boolean): void {
    this.count = count;
    this.kept = kept;
    for (const [at, row] of this.rows) {
      if (at < count && isSame(at)) continue;
      row.remove();
      this.rows.delete(at);
    }
    this.measure();
    this.render();
  }

  /** Keeps another row. */
  keep(at: number): void {
    this.kept = at;
    this.render();
  }

  /** Scrolls just as far that a row is visible. */
  reveal(at: number): void {
    const { clientHeight, scrollTop } = this.scroller;
    const top = this.place.offsetTop + at * this.height;
    if (top < scrollTop) this.scroller.scrollTop = top;
    else if (top + this.height > scrollTop + clientHeight) this.scroller.scrollTop = top + this.height - clientHeight;
    this.render();
  }

  /** A kept row that was in sight stays in sight. */
  private resize(): void {
    const top = this.place.offsetTop + this.kept * this.height - this.scroller.scrollTop;
    const wasInSight = this.kept >= 0 && top >= 0 && top + this.height <= this.heightBefore;
    this.heightBefore = this.scroller.clientHeight;
    this.measure();
    if (wasInSight) this.reveal(this.kept);
    else this.render();
  }

  private measure(): void {
    const height = parseFloat(getComputedStyle(this.scroller).getPropertyValue("--row")) || 26;
    if (height !== this.height) {
      this.height = height;
      for (const [at, row] of this.rows) this.put(row, at);
    }
    this.place.style.height = `${this.count * height}px`;
  }

  private put(row: HTMLElement, at: number): void {
    row.style.transform = `translateY(${at * this.height}px)`;
  }

  private render(): void {
    const { clientHeight, scrollTop } = this.scroller;
    const top = scrollTop - this.place.offsetTop;
    const first = Math.max(Math.floor(top / this.height) - BEYOND, 0);
    const last = Math.min(Math.ceil((top + clientHeight) / this.height) + BEYOND, this.count);
    const isWanted = (at: number): boolean => (at >= first && at < last) || at === this.kept;
    let changed = false;
    for (const [at, row] of this.rows) {
      if (isWanted(at)) continue;
      row.remove();
      this.rows.delete(at);
      changed = true;
    }
    const missing: number[] = [];
    for (let at = first; at < last; at++) if (!this.rows.has(at)) missing.push(at);
    if (this.kept >= 0 && this.kept < this.count && !this.rows.has(this.kept) && !missing.includes(this.kept)) missing.push(this.kept);
    if (missing.length > 0) {
      // In the order of the rows, for screen readers. Rows that are there do not move: moved elements lose the focus.
      const there = [...this.rows.keys()].sort((a, b) => a - b);
      for (const at of missing) {
        const row = this.make(at);
        this.put(row, at);
        this.place.insertBefore(row, this.rows.get(there.find((other) => other > at) ?? -1) ?? null);
        this.rows.set(at, row);
        there.push(at);
        there.sort((a, b) => a - b);
      }
      changed = true;
    }
    if (changed) this.shown();
  }
}
