// The drawings before and after that of a paused clip, translucent, in the same place.

import { CustomBlending, Group, Mesh, MeshBasicMaterial, OneFactor, OneMinusSrcAlphaFactor, SkinnedMesh, SrcAlphaFactor, type Object3D } from "three";
import { clone } from "three/addons/utils/SkeletonUtils.js";
import { LAYERS } from "./batches";
import type { Player } from "./clips";
import type { ExposureSheet } from "./exposure-sheet";
import type { Exposures } from "./exposures";
import { isOverlay, type Model } from "./model";
import type { Pose } from "./pose";
import { isHidden } from "./visibility";

/** Orange is before, blue is after: they differ for the colour-blind too. */
const BEFORE = 0xd9622b;
const AFTER = 0x2b78d9;
const OPACITY = 0.35;
/** The order in which they are drawn: before everything else. */
const BEHIND = -1;
/** Copies of larger models take too long. */
const MOST_MESHES = 2_000;
/** Key times in a file have single precision. */
const NEAR = 1e-4;

/** The times of the drawings, or of the keys, before and after the one at a time; null where the clip ends. */
export function neighbors({ keys, time }: Pick<Player, "keys" | "time">, exposure: Pick<ExposureSheet, "runs" | "frames" | "fps" | "frameAt" | "drawingIn"> | null): readonly [before: number | null, after: number | null] {
  if (exposure && exposure.runs.length > 0) {
    const at = exposure.drawingIn(exposure.frameAt(time));
    const begin = (drawing: number): number | null => {
      const run = exposure.runs[drawing];
      return run ? run.start / exposure.fps + NEAR : null;
    };
    return [at > 0 ? begin(at - 1) : null, begin(at + 1)];
  }
  // A held drawing begins at its key.
  const current = keys.times.findLast((key) => key <= time + NEAR) ?? time;
  const before = keys.times.findLast((key) => key < (keys.held ? current : time) - NEAR);
  return [before ?? null, keys.times.find((key) => key > time + NEAR) ?? null];
}

/** The viewer's state. */
interface Shown {
  readonly model: Model | null;
  readonly player: Player;
  readonly pose: Pose;
  readonly exposures: Exposures;
}

export class OnionSkin {
  /** Whether it is wanted; it is shown while a clip is paused. */
  wanted = false;
  private readonly place = new Group();
  private readonly materials = [BEFORE, AFTER].map(materialOf);
  private skins: Object3D[] = [];
  /** What it was made of. */
  private model: Model | null = null;
  private made = "";

  constructor(scene: Object3D, private readonly shown: Shown) {
    scene.add(this.place);
  }

  /** How many drawings it shows. */
  get count(): number {
    return this.skins.length;
  }

  /** Follows time, clip, model and hidden parts. True if anything changed. */
  follow(hidden: ReadonlySet<string>): boolean {
    const { model, player, pose, exposures } = this.shown;
    const { clip, time } = player;
    if (!model || !clip || !this.wanted || player.playing || model.meshes.length > MOST_MESHES) return this.clear();
    const times = neighbors(player, exposures.current);
    const made = JSON.stringify([clip.name, times, [...hidden]]);
    if (model === this.model && made === this.made) return false;
    this.clear();
    this.model = model;
    this.made = made;
    pose.release();
    times.forEach((time, at) => {
      if (time === null) return;
      player.seek(time);
      const skin = copyOf(model.root, this.materials[at]!);
      this.place.add(skin);
      this.skins.push(skin);
    });
    player.seek(time);
    pose.apply();
    return true;
  }

  /** Removes what is shown; `follow` makes it anew. True if there was anything. */
  clear(): boolean {
    for (const skin of this.skins) {
      skin.removeFromParent();
      skin.traverse((object) => {
        if (object instanceof SkinnedMesh) object.skeleton.dispose();
      });
    }
    const any = this.skins.length > 0;
    this.skins = [];
    this.model = null;
    this.made = "";
    return any;
  }
}

/** As on paper, the neighbours lie under the drawing: they are blended before it is drawn, which three.js does not do with what is `transparent`. */
function materialOf(color: number): MeshBasicMaterial {
  const blend = { blending: CustomBlending, blendSrc: SrcAlphaFactor, blendDst: OneMinusSrcAlphaFactor, blendSrcAlpha: OneFactor, blendDstAlpha: OneMinusSrcAlphaFactor } as const;
  return new MeshBasicMaterial({ ...blend, color, opacity: OPACITY, depthWrite: false });
}

/** A copy that stays as the original is now. It shares the geometries. */
function copyOf(root: Object3D, material: MeshBasicMaterial): Object3D {
  const copy = clone(root);
  const over: Object3D[] = [];
  copy.traverse((object) => {
    if (isOverlay(object)) over.push(object);
    if (!(object instanceof Mesh)) return;
    object.material = material;
    object.castShadow = false;
    object.renderOrder = BEHIND;
    // Copies are in no batch.
    if (!isHidden(object)) object.layers.mask = LAYERS.alone;
  });
  for (const object of over) object.removeFromParent();
  return copy;
}
