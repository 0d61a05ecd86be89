// The parts of a drawing, as a hierarchy.

import type { Part } from "./protocol";

export class Parts {
  private readonly byName = new Map<string, Part>();
  private readonly byElement = new Map<string, Part>();
  private readonly below = new Map<string | null, Part[]>();
  /** Parts that are not in the model: legends, and shapes that are not used. */
  readonly aside: readonly Part[];
  /** The number of parts and landscapes in the model, and of the other shapes that belong to them. */
  readonly main: number;
  readonly shapes: number;

  constructor(readonly all: readonly Part[]) {
    // The first of several parts with the same name counts; the others are reported as a finding.
    for (const part of all) {
      if (!this.byName.has(part.name)) this.byName.set(part.name, part);
      if (!this.byElement.has(part.element)) this.byElement.set(part.element, part);
    }
    this.aside = all.filter(isAside);
    this.main = all.filter(({ kind }) => ["main", "terrain", "region"].includes(kind)).length;
    this.shapes = all.filter(({ kind }) => kind === "sub").length;
    for (const part of all) {
      if (isAside(part)) continue;
      const parent = part.parent !== null && this.isInModel(part.parent) && !this.hangsOnItself(part) ? part.parent : null;
      const siblings = this.below.get(parent);
      if (siblings) siblings.push(part);
      else this.below.set(parent, [part]);
    }
    for (const siblings of this.below.values()) siblings.sort((a, b) => Number(a.kind === "sub") - Number(b.kind === "sub"));
  }

  get(name: string | null): Part | undefined {
    return name === null ? undefined : this.byName.get(name);
  }

  at(element: string): Part | undefined {
    return this.byElement.get(element);
  }

  /** The children of a part, or of the root: parts first, then the shapes that belong to it. */
  children(name: string | null): readonly Part[] {
    return this.below.get(name) ?? [];
  }

  /** The names of a part and of all parts below it. */
  family(name: string): ReadonlySet<string> {
    const names = new Set([name]);
    // A set also goes through what is added meanwhile.
    for (const above of names) for (const { name } of this.children(above)) names.add(name);
    return names;
  }

  /** The names of a part's ancestors, the nearest first. */
  above(name: string): string[] {
    const names: string[] = [];
    for (let part = this.get(name); part && part.parent !== null && !names.includes(part.parent); part = this.get(part.parent)) names.push(part.parent);
    return names;
  }

  /** The part whose node shows this one: itself, or for a shape that belongs to a part, that part. */
  carrier(name: string): Part | undefined {
    let part = this.get(name);
    for (let steps = 0; part?.kind === "sub" && steps < this.all.length; steps++) part = this.get(part.parent);
    return part && !isAside(part) ? part : undefined;
  }

  private isInModel(name: string): boolean {
    const part = this.byName.get(name);
    return part !== undefined && !isAside(part);
  }

  private hangsOnItself(part: Part): boolean {
    return this.above(part.name).includes(part.name);
  }
}

export const isAside = (part: Part): boolean => part.kind === "legend" || part.kind === "unused";

/** How deep a part lies, in words; null for a part without a node. */
export function depthOf({ depth }: Part): string | null {
  if (depth === null) return null;
  const length = Number(Math.abs(depth).toFixed(2));
  if (length === 0) return "in the drawing plane";
  return `${length} ${depth > 0 ? "in front of" : "behind"} the drawing plane`;
}

/** Why it lies there, in words. */
export function depthReasonOf(part: Part): string {
  return part.depthWhy ?? (part.parent === null ? "nothing moves it" : `in the plane of ${part.parent}`);
}

/** What is said of a part, and what undoes it in a string, if anything does. */
export const withUndo = (said: string, undo: string | null): string => (undo === null ? said : `${said} (\`${undo}\` undoes that)`);

/** Whether okoshi generated the part's name, because no string gives one. */
export const isAutomatic = (part: Part): boolean => part.namedBy === "automatic";
