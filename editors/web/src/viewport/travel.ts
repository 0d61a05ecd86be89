// Keeps a figure that travels in the picture.

import { Vector3, type AnimationClip } from "three";
import type { Model } from "./model";

/** How far a clip has carried the model over the ground. */
export class Travel {
  /** Whether the view goes along. */
  wanted = false;
  private readonly last = new Vector3();
  private isKnown = false;

  /** The clip or the model is another: the next place is where the way begins. */
  restart(): void {
    this.isKnown = false;
  }

  /** How far the model has gone since the last call, level; 0 at first, and if nothing travels. */
  since(model: Model | null, clip: AnimationClip | null): Vector3 {
    const place = model && clip && placeOf(model, clip);
    if (!place) {
      this.restart();
      return new Vector3();
    }
    const step = this.isKnown ? place.clone().sub(this.last) : new Vector3();
    this.last.copy(place);
    this.isKnown = true;
    return step.setY(0);
  }
}

/** The middle of the nodes that a clip moves and that hang on no other such node. */
function placeOf({ root }: Model, clip: AnimationClip): Vector3 | null {
  const names = clip.tracks.filter(({ name }) => name.endsWith(".position")).map(({ name }) => name.slice(0, -".position".length));
  const moved = names.flatMap((name) => root.getObjectByName(name) ?? []);
  const all = new Set(moved);
  const sum = new Vector3();
  let count = 0;
  for (const node of moved) {
    let above = node.parent;
    while (above && !all.has(above)) above = above.parent;
    if (above) continue;
    sum.add(node.getWorldPosition(new Vector3()));
    count += 1;
  }
  return count > 0 ? sum.divideScalar(count) : null;
}
