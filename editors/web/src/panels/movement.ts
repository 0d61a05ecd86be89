// A movement that is recorded while limbs are dragged or a clip plays.

import type { Moment, Turn } from "../editing/messages";

/** Moments a second: as many as frames of a clip. */
const RATE = 24;
/** A smaller turn is none, in degrees. */
const STILL = 0.05;

export class Movement {
  private readonly moments = new Map<number, ReadonlyMap<string, number>>();
  /** The parts that were turned by hand. */
  private readonly turned = new Set<string>();

  private readonly began = performance.now();

  get isEmpty(): boolean {
    return this.turned.size === 0;
  }

  /** Notes how all parts are turned, in degrees from how they are drawn, and which are by hand. */
  note(turns: ReadonlyMap<string, number>, byHand: Iterable<string>): void {
    this.moments.set(Math.round(((performance.now() - this.began) / 1e3) * RATE), turns);
    for (const part of byHand) this.turned.add(part);
  }

  /** What was recorded, of the figures of which a part was turned by hand. A moment has the parts that are turned otherwise than in the one before. */
  of(figure: (part: string) => string): Moment[] {
    const figures = new Set([...this.turned].map(figure));
    const last = new Map<string, number>();
    return [...this.moments].map(([frame, turns]) => {
      const changed: Turn[] = [];
      for (const [part, degrees] of turns) {
        if (Math.abs(degrees - (last.get(part) ?? 0)) <= STILL || !figures.has(figure(part))) continue;
        last.set(part, degrees);
        changed.push({ part, degrees });
      }
      return { seconds: Math.round((frame / RATE) * 1e3) / 1e3, turns: changed };
    });
  }
}
