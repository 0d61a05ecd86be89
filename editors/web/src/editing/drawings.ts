// What is changed about the drawings of a clip, and the list of `Held` that says it. Frames count from 0 here, from 1 in the list.

/** A drawing in the sheet: a source frame, and the frames of the clip in which it stands. */
export interface Drawn {
  readonly source: number;
  readonly start: number;
  readonly frames: number;
}

/** The drawings of a clip, and those that are chosen by hand: for how many frames each stands, by source frame. */
export interface Sheet {
  readonly drawings: readonly Drawn[];
  readonly held: ReadonlyMap<number, number>;
}

/** The list as it is written; null if it is empty. */
export function heldWords(held: Sheet["held"]): string | null {
  const sorted = [...held].sort(([a], [b]) => a - b);
  return sorted.length > 0 ? sorted.map(([source, frames]) => `${source + 1} ${frames}`).join(" ") : null;
}

export function readHeld(words: string | null): Map<number, number> {
  const numbers = words?.match(/\d+/g)?.map(Number) ?? [];
  const held = new Map<number, number>();
  for (let at = 0; at + 1 < numbers.length; at += 2) held.set(numbers[at]! - 1, numbers[at + 1]!);
  return held;
}

/** For how many frames a drawing can stand at most: until the end. The last one always does. */
export function most({ drawings }: Sheet, at: number): number {
  const last = drawings.at(-1);
  const drawing = drawings[at];
  return drawing && last ? last.start + last.frames - drawing.start : 0;
}

/** A drawing stands for so many frames: those behind are covered, or the next begins sooner. With 0 it is left out. Null if that cannot be. */
export function standing(sheet: Sheet, at: number, frames: number): Sheet | null {
  const { drawings } = sheet;
  const drawing = drawings[at];
  if (!drawing || frames === drawing.frames || at + 1 === drawings.length && frames > 0) return null;
  if (frames <= 0) return leftOut(sheet, at);
  const end = drawing.start + Math.min(frames, most(sheet, at));
  const held = new Map(sheet.held).set(drawing.source, end - drawing.start);
  const behind = drawings.slice(at + 1);
  const next = behind.findIndex((one) => one.start + one.frames > end);
  const covered = next < 0 ? behind : behind.slice(0, next);
  // What is covered is no longer chosen; what is left of the next one ends where it did.
  for (const one of covered) held.delete(one.source);
  const rest = next < 0 ? [] : behind.slice(next);
  const [first, ...others] = rest;
  if (!first) return { drawings: [...drawings.slice(0, at), { ...drawing, frames: end - drawing.start }], held };
  const shifted = { ...first, start: end, frames: first.start + first.frames - end };
  if (held.has(first.source)) held.set(first.source, shifted.frames);
  return { drawings: [...drawings.slice(0, at), { ...drawing, frames: end - drawing.start }, shifted, ...others], held };
}

function leftOut({ drawings, held: before }: Sheet, at: number): Sheet | null {
  const drawing = drawings[at]!;
  const previous = drawings[at - 1];
  // The first one is what the clip begins with.
  if (!previous) return null;
  const longer = { ...previous, frames: previous.frames + drawing.frames };
  const held = new Map(before).set(drawing.source, 0);
  if (held.has(previous.source)) held.set(previous.source, longer.frames);
  return { drawings: [...drawings.slice(0, at - 1), longer, ...drawings.slice(at + 1)], held };
}

/** The drawing that is not shown, and would come back behind one: the last that was left out by hand, or else the last that is not shown; null if there is none, or no frame for it. */
function missing({ drawings, held }: Sheet, at: number, sources: number): number | null {
  const drawing = drawings[at];
  const next = drawings[at + 1];
  if (!drawing || drawing.frames < 2) return null;
  const between = Array.from({ length: Math.max((next?.source ?? sources) - drawing.source - 1, 0) }, (_, index) => drawing.source + 1 + index);
  return between.findLast((source) => held.get(source) === 0) ?? between.at(-1) ?? null;
}

/** Brings a drawing back behind one, in the last frame of that; null if none is left out there. */
export function broughtBack(sheet: Sheet, at: number, sources: number): Sheet | null {
  const source = missing(sheet, at, sources);
  if (source === null) return null;
  const { drawings } = sheet;
  const drawing = drawings[at]!;
  const shorter = { ...drawing, frames: drawing.frames - 1 };
  const back = { source, start: drawing.start + shorter.frames, frames: 1 };
  const held = new Map(sheet.held).set(source, 1);
  if (held.has(drawing.source)) held.set(drawing.source, shorter.frames);
  return { drawings: [...drawings.slice(0, at), shorter, back, ...drawings.slice(at + 1)], held };
}

/** The drawing whose end is nearest to a frame of the clip; frames between have fractions. The last one has no end that moves. */
export function nearestEnd({ drawings }: Sheet, frame: number): { readonly at: number; readonly away: number } | null {
  let best: { at: number; away: number } | null = null;
  drawings.slice(0, -1).forEach(({ start, frames }, at) => {
    const away = Math.abs(start + frames - frame);
    if (!best || away < best.away) best = { at, away };
  });
  return best;
}
