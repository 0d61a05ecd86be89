// Hides parts: they are not drawn, cast no shadow, and the pointer does not meet them.

import type { Mesh } from "three";
import { LAYERS } from "./batches";
import type { Model } from "./model";

/** Shows the meshes of all parts except the hidden ones. Child parts have their own state: a hidden part may carry one that is shown. */
export function applyHidden(model: Model, hidden: ReadonlySet<Mesh>): void {
  // A mesh that is not `visible` would take its children with it. Layers count for the mesh alone: in the picture, in shadows and for rays.
  for (const mesh of model.meshes) model.batches.show(mesh, !hidden.has(mesh));
}

export const isHidden = ({ layers }: Mesh): boolean => layers.mask === LAYERS.hidden;

/** Whether a mesh is shown and not in a batch. */
export const isAlone = ({ layers }: Mesh): boolean => layers.mask === LAYERS.alone;
