// Keeps a figure that travels in the picture.

import { Camera, Vector3, type AnimationClip, type Object3D } from "three";
import type { Model } from "./model";

/** How far a clip has carried the model over the ground. */
export class Travel {
  /** Whether the view goes along. */
  wanted = false;
  private model: Model | null = null;
  private clip: AnimationClip | null = null;
  /** The nodes that the clip moves and that hang on no other such node, without cameras. */
  private roots: readonly Object3D[] = [];
  /** Where they were last; none if the way begins at the next place. */
  private last: Vector3 | null = null;

  /** The next place is where the way begins. */
  restart(): void {
    this.last = null;
  }

  /** How far the model has gone since the last call, level; 0 in another model or clip, and if nothing travels. */
  since(model: Model | null, clip: AnimationClip | null): Vector3 {
    if (model !== this.model || clip !== this.clip) {
      this.model = model;
      this.clip = clip;
      this.roots = model && clip ? rootsOf(model, clip) : [];
      this.last = null;
    }
    const place = new Vector3();
    for (const node of this.roots) place.add(node.getWorldPosition(new Vector3()).divideScalar(this.roots.length));
    const step = this.last ? place.clone().sub(this.last).setY(0) : new Vector3();
    this.last = place;
    return step;
  }
}

function rootsOf({ root }: Model, clip: AnimationClip): readonly Object3D[] {
  const names = clip.tracks.filter(({ name }) => name.endsWith(".position")).map(({ name }) => name.slice(0, -".position".length));
  const moved = new Set(names.flatMap((name) => root.getObjectByName(name) ?? []));
  return [...moved].filter((node) => {
    if (node instanceof Camera) return false;
    for (let above = node.parent; above; above = above.parent) if (moved.has(above)) return false;
    return true;
  });
}
