// Finds what is under the pointer.

import { Raycaster, Vector2, type Mesh, type Object3D, type Vector3 } from "three";
import { LAYERS } from "./batches";
import { limbAt, partNode } from "./model";
import type { View } from "./view";

export interface Hit {
  /** The node of the part. */
  readonly node: Object3D;
  /** The node that turns what was hit: that of the part, or a bone of it. */
  readonly limb: Object3D;
  readonly point: Vector3;
}

/** The nearest part among these meshes at a point of the window, or null. */
export function pick(meshes: readonly Mesh[], view: View, canvas: HTMLElement, x: number, y: number): Hit | null {
  const caster = new Raycaster();
  caster.layers.mask = LAYERS.alone | LAYERS.batched;
  caster.setFromCamera(place(canvas, x, y), view.camera);
  // Both sides of a surface are hit.
  for (const { object, point, face } of caster.intersectObjects([...meshes], false)) {
    const node = partNode(object);
    if (node) return { node, limb: (face && limbAt(object, face.a)) ?? node, point };
  }
  return null;
}

/** A point of the window in normalized device coordinates. */
export function place(canvas: HTMLElement, x: number, y: number): Vector2 {
  const { left, top, width, height } = canvas.getBoundingClientRect();
  return new Vector2(((x - left) / width) * 2 - 1, 1 - ((y - top) / height) * 2);
}
