// How a clip's drawings lie in time, and which frames of its source they stand for.

import type { ClipFacts } from "../protocol";

/** A drawing. It is shown from one of the clip's frames on, and stands for a stretch of the source's frames. */
export interface Run {
  /** The source's frame that is shown. */
  readonly source: number;
  readonly start: number;
  readonly frames: number;
  /** The source's frames that it stands for, from one up to another. */
  readonly from: number;
  readonly to: number;
}

/** A frame's time read from a file lies a little beside the true one: its times are kept in single precision. */
const NEAR = 0.01;

export class Exposure {
  readonly runs: readonly Run[];
  /** Frames of the clip as it is shown, and of its source. */
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
    // The last of thinned entries may stand for fewer frames than the others.
    this.sources = Math.max(named, facts.ssdStep === 1 ? seen : Math.min(seen, Math.max(this.frames, seen - facts.ssdStep + 1)), seen === 0 ? this.frames : 1);
    // Where no frame was omitted, the clip's frames are the source's. Else a drawing stands for the frames up to the next one,
    // without those that were omitted.
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

  /** Which drawing is shown in a frame, from 0; -1 if the clip is not limited. */
  drawingIn(frame: number): number {
    return lastWhere(this.runs, ({ start }) => start <= frame);
  }

  /** Which drawing stands for a frame of the source, from 0; -1 if none does. */
  drawingFor(source: number): number {
    if (this.omitted.has(source)) return -1;
    const at = lastWhere(this.runs, ({ from }) => from <= source);
    return at >= 0 && source < this.runs[at]!.to ? at : -1;
  }

  /** The source's frame at a time, as the drawing goes through the frames that it stands for. */
  sourceAt(time: number): number {
    const frame = this.frameAt(time);
    const run = this.runs[this.drawingIn(frame)];
    return run ? Math.min(run.from + frame - run.start, run.to - 1) : Math.min(frame, this.sources - 1);
  }

  /** When a frame of the source is shown, or what stands in its place. */
  timeOf(source: number): number {
    const run = this.runs[Math.max(lastWhere(this.runs, ({ from }) => from <= source), 0)];
    const frame = run ? run.start + Math.min(Math.max(source - run.from, 0), run.frames - 1) : source;
    return (Math.min(frame, this.frames - 1) + NEAR) / this.fps;
  }

  /** The movement in a frame of the source, or null where it is not known. */
  ssd(source: number): number | null {
    return this.facts.ssd[Math.floor(source / this.facts.ssdStep)] ?? null;
  }
}

/** The largest entry of each of at most `most` stretches of equal length, so that no peak is lost. */
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

/** The facts of a clip in a few words. */
export function inWords({ runs, frames, facts }: Exposure): string {
  const words = [`${frames} ${frames === 1 ? "frame" : "frames"}`];
  if (!facts.limited) return `${words[0]}, as in the motion file`;
  const drawings = facts.drawings || runs.length;
  words.push(`${drawings} ${drawings === 1 ? "drawing" : "drawings"}`);
  if (facts.omitted.length > 0) words.push(`${facts.omitted.length} in-${facts.omitted.length === 1 ? "between" : "betweens"} omitted`);
  if (facts.held > 0) words.push(`${facts.held} held`);
  return words.join(", ");
}

/** The last place in a list that begins with those that are so; -1 if none is. */
function lastWhere<One>(list: readonly One[], isSo: (one: One) => boolean): number {
  let low = 0;
  let high = list.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (isSo(list[middle]!)) low = middle + 1;
    else high = middle;
  }
  return low - 1;
}
