// The exposure sheet of a clip: when its drawings are shown, and which frames of its source they replace.

import type { ClipFacts } from "../protocol";

/** A drawing. It is shown from frame `start` of the clip on, and replaces some frames of the source. */
export interface ExposureRun {
  /** The source frame that is shown. */
  readonly source: number;
  readonly start: number;
  readonly frames: number;
  /** The source frames that it replaces, `to` excluded. */
  readonly from: number;
  readonly to: number;
}

/** Tolerance in frames: times in a file have single precision. */
const NEAR = 0.01;

export class ExposureSheet {
  readonly runs: readonly ExposureRun[];
  /** The number of frames of the clip as shown, and of its source. */
  readonly frames: number;
  readonly sources: number;
  readonly fps: number;
  readonly omitted: ReadonlySet<number>;

  constructor(readonly facts: ClipFacts) {
    this.omitted = new Set(facts.omitted);
    this.fps = facts.fps > 0 ? facts.fps : 24;
    const runs: { source: number; start: number; frames: number }[] = [];
    let frames = 0;
    for (const [source, stands] of facts.limited ? facts.exposure : []) {
      if (stands === 0) continue;
      const last = runs.at(-1);
      if (last?.source === source) last.frames += stands;
      else runs.push({ source, start: frames, frames: stands });
      frames += stands;
    }
    this.frames = Math.max(frames, runs.length > 0 ? 0 : facts.frames, 1);
    const seen = facts.ssd.length * facts.ssdStep;
    const named = runs.reduce((most, { source }) => Math.max(most, source + 1), facts.omitted.reduce((most, source) => Math.max(most, source + 1), 0));
    // If the values are thinned, the last one may stand for fewer frames than the others.
    this.sources = Math.max(named, facts.ssdStep === 1 ? seen : Math.min(seen, Math.max(this.frames, seen - facts.ssdStep + 1)), seen === 0 ? this.frames : 1);
    // If no frame was omitted, the clip's frames are the source's. Otherwise a drawing replaces the frames up to the next drawing,
    // except omitted ones.
    const begins = facts.omitted.length === 0 ? runs.map(({ start }) => start) : runs.map(({ source }) => source);
    this.runs = runs.map((run, at) => {
      const from = begins[at]!;
      let to = begins[at + 1] ?? this.sources;
      while (to - 1 > from && this.omitted.has(to - 1)) to--;
      return { ...run, from, to: Math.max(to, from + 1) };
    });
  }

  /** The clip's frame at a time, from 0. */
  frameAt(time: number): number {
    return Math.min(Math.max(Math.floor(time * this.fps + NEAR), 0), this.frames - 1);
  }

  /** The time at which a frame of the clip begins. */
  timeOfFrame(frame: number): number {
    return (Math.min(frame, this.frames - 1) + NEAR) / this.fps;
  }

  /** The drawing that is shown in a frame, from 0; -1 if the clip is not limited. */
  drawingIn(frame: number): number {
    return lastIndexWhere(this.runs, ({ start }) => start <= frame);
  }

  /** The source frame at a time. */
  sourceAt(time: number): number {
    const frame = this.frameAt(time);
    const run = this.runs[this.drawingIn(frame)];
    return run ? Math.min(run.from + frame - run.start, run.to - 1) : Math.min(frame, this.sources - 1);
  }

  /** The time at which a source frame is shown, or the drawing that replaces it. */
  timeOf(source: number): number {
    const run = this.runs[Math.max(lastIndexWhere(this.runs, ({ from }) => from <= source), 0)];
    const frame = run ? run.start + Math.min(Math.max(source - run.from, 0), run.frames - 1) : source;
    return this.timeOfFrame(frame);
  }

  /** The movement in a source frame, or null if unknown. */
  ssd(source: number): number | null {
    return this.facts.ssd[Math.floor(source / this.facts.ssdStep)] ?? null;
  }
}

/** The maxima of at most `most` stretches of equal length, so that no peak is lost. */
export function peaks(values: readonly number[], most: number): { readonly step: number; readonly values: readonly number[] } {
  const step = Math.max(Math.ceil(values.length / Math.max(most, 1)), 1);
  if (step === 1) return { step, values };
  const kept: number[] = [];
  for (let at = 0; at < values.length; at += step) {
    let top = values[at]!;
    for (let next = at + 1; next < Math.min(at + step, values.length); next++) top = Math.max(top, values[next]!);
    kept.push(top);
  }
  return { step, values: kept };
}

/** A short description of a clip. */
export function describeExposure({ runs, frames, facts }: ExposureSheet): string {
  const words = [`${frames} ${frames === 1 ? "frame" : "frames"}`];
  if (!facts.limited) return `${words[0]}, as ${facts.performance?.timed ? "performed" : "in the motion file"}`;
  const drawings = facts.drawings || runs.length;
  words.push(`${drawings} ${drawings === 1 ? "drawing" : "drawings"}`);
  if (facts.omitted.length > 0) words.push(`${facts.omitted.length} in-${facts.omitted.length === 1 ? "between" : "betweens"} omitted`);
  if (facts.held.length > 0) words.push(`${facts.held.length} held`);
  return words.join(", ");
}

/** The index of the last item for which a condition holds, in a list that begins with all those items; -1 if there is none. */
function lastIndexWhere<One>(list: readonly One[], isSo: (one: One) => boolean): number {
  let low = 0;
  let high = list.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (isSo(list[middle]!)) low = middle + 1;
    else high = middle;
  }
  return low - 1;
}
