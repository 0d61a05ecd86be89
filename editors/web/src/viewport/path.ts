// The space that a model needs over a whole clip.

import { Box3, SkinnedMesh, Vector3, type AnimationClip } from "three";
import type { Model } from "./model";

/** At how many times of a clip the model is measured, and how many of its meshes at most in all: the more parts, the fewer times. */
const SAMPLES = 24;
const MEASURED = 20_000;
/** A longer path, in diagonals of the model, is not framed as a whole: the figure would be too small. */
const LONGEST = 4;

/** The bounds of a model over a clip. `sample` poses the model at a time in seconds. */
export function pathOf(model: Model, clip: AnimationClip, sample: (time: number) => void): Box3 {
  const path = model.box.clone();
  const samples = Math.min(Math.max(Math.floor(MEASURED / Math.max(model.meshes.length, 1)), 4), SAMPLES);
  for (let at = 0; at <= samples; at++) {
    sample((clip.duration * at) / samples);
    model.root.updateMatrixWorld(true);
    // three.js keeps the bounds of skinned meshes, whatever their bones do.
    for (const mesh of model.meshes) if (mesh instanceof SkinnedMesh) mesh.computeBoundingBox();
    path.expandByObject(model.root);
  }
  const diagonal = (box: Box3): number => box.getSize(new Vector3()).length();
  return diagonal(path) > LONGEST * diagonal(model.box) ? model.box : path;
}
