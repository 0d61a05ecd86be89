// Hides parts: they are not drawn, cast no shadow, and the pointer does not meet them.

import type { Mesh } from "three";
import type { Model } from "./model";

/** Shows the meshes of all parts except the hidden ones. Child parts have their own state: a hidden part may carry one that is shown. */
export function applyHidden(model: Model, hidden: ReadonlySet<Mesh>): void {
  // A mesh that is not `visible` would take its children with it. Layers count for the mesh alone: in the picture, in shadows and for rays.
  for (const mesh of model.meshes) mesh.layers.mask = hidden.has(mesh) ? 0 : 1;
}

export const isHidden = ({ layers }: Mesh): boolean => layers.mask === 0;
