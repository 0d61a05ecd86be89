// A copy of the model beside it, which plays a clip as it was before it was performed or limited.

import { AnimationClip, AnimationMixer, Box3, Group, LoopOnce, SkinnedMesh, Vector3, type AnimationAction, type KeyframeTrack, type Object3D } from "three";
import { clone } from "three/addons/utils/SkeletonUtils.js";
import { isOverlay, Model, nodeName } from "./model";

/** The gap between the two, relative to the width of the model. */
const GAP = 0.12;
/** At how many times of a clip its bounding box is sampled. */
const SAMPLES = 24;

/** How the two clips run: both begin and end together, or both at the speed of the same clock, and the shorter one waits at its end. */
export type Clock = "together" | "same";

/** The nodes and clips of a file without meshes. */
export interface Originals {
  readonly scene: Object3D;
  readonly animations: readonly AnimationClip[];
}

export class SideBySide {
  originals: Originals | null = null;
  copy: Model | null = null;
  /** The bounds of both during the clip. */
  boxes: readonly [Box3, Box3] | null = null;
  private readonly place = new Group();
  private mixer: AnimationMixer | null = null;
  private action: AnimationAction | null = null;
  private clip: AnimationClip | null = null;
  private clock: Clock = "together";

  constructor(scene: Object3D) {
    scene.add(this.place);
  }

  /** The distance of the copy to the right, in metres. */
  get offset(): number {
    return this.place.position.x;
  }

  /** Until when the player must wait for the copy, in seconds: 0 if both end together. */
  get waits(): number {
    return this.clip && this.clock === "same" ? this.clip.duration : 0;
  }

  /** Puts a copy of the model there, without overlays. Limbs turned by hand must be released before. */
  put(model: Model, originals: Originals): void {
    this.remove();
    const root = clone(model.root) as Group;
    const over: Object3D[] = [];
    root.traverse((object) => {
      if (isOverlay(object)) over.push(object);
    });
    for (const object of over) object.removeFromParent();
    this.originals = originals;
    this.place.position.x = 0;
    this.copy = new Model(root, model.clips, [], model);
    this.copy.addTo(this.place);
    this.mixer = new AnimationMixer(root);
  }

  /** The copy shares everything but its skeletons with the model, which disposes of the rest. */
  remove(): void {
    this.mixer?.stopAllAction();
    for (const mesh of this.copy?.meshes ?? []) if (mesh instanceof SkinnedMesh) mesh.skeleton.dispose();
    this.copy?.batches.dispose();
    this.copy?.remove();
    this.copy = this.mixer = this.action = this.clip = this.boxes = null;
  }

  /** Plays the original of a clip, and moves the copy so far away that the two never overlap. */
  choose(clip: AnimationClip | null, clock: Clock, sample: (time: number) => void, model: Model): void {
    const { copy, mixer, originals } = this;
    if (!copy || !mixer || !originals) return;
    mixer.stopAllAction();
    this.clock = clock;
    const full = clip && (originals.animations.find(({ name }) => name === clip.name) ?? clip);
    const nodes = nodesByName(full === clip ? model.root : originals.scene);
    this.clip = full && onNodes(full, nodes, nodesByName(copy.root));
    this.action = this.clip && mixer.clipAction(this.clip).setLoop(LoopOnce, 1);
    if (this.action) {
      this.action.clampWhenFinished = true;
      this.action.play();
    }
    const [own, other] = [model.box.clone(), model.box.clone()];
    for (let at = 0; clip && at <= SAMPLES; at++) {
      const time = (Math.max(clip.duration, this.waits) * at) / SAMPLES;
      sample(time);
      this.seek(time, clip.duration);
      own.union(new Box3().setFromObject(model.root));
      other.union(boxOf(copy.root, this.place));
    }
    this.place.position.x = (own.max.x - other.min.x) + Math.max(own.max.x - own.min.x, 1e-6) * GAP;
    this.place.updateMatrixWorld(true);
    this.boxes = [own, other.translate(new Vector3(this.offset, 0, 0))];
  }

  /** Seeks to a time of a clip of this duration. */
  seek(time: number, duration: number): void {
    if (!this.action || !this.mixer || !this.clip) return;
    this.action.paused = false;
    this.action.enabled = true;
    const own = this.clip.duration;
    this.action.time = this.clock === "same" ? Math.min(time, own) : duration > 0 ? Math.min(time / duration, 1) * own : 0;
    this.mixer.update(0);
  }
}

/** The bounds of a copy without its offset. */
function boxOf(root: Object3D, place: Object3D): Box3 {
  place.updateMatrixWorld(true);
  return new Box3().setFromObject(root).translate(new Vector3(-place.position.x, 0, 0));
}

/** Nodes by their names in the file; several may share one. */
function nodesByName(root: Object3D): Map<string, Object3D[]> {
  const nodes = new Map<string, Object3D[]>();
  root.traverse((object) => {
    const name = nodeName(object);
    const same = nodes.get(name);
    if (same) same.push(object);
    else nodes.set(name, [object]);
  });
  return nodes;
}

/**
 * A clip retargeted to the nodes of the same names. three.js makes names unique within a file, so the same node may have different
 * names in two files; this goes by the names in the files.
 */
export function onNodes(clip: AnimationClip, from: ReadonlyMap<string, readonly Object3D[]>, to: ReadonlyMap<string, readonly Object3D[]>): AnimationClip {
  const targets = new Map<string, Object3D>();
  for (const [name, nodes] of from) {
    nodes.forEach((node, at) => {
      const target = to.get(name)?.[at];
      if (!target) return;
      targets.set(node.uuid, target);
      if (node.name !== "" && !targets.has(node.name)) targets.set(node.name, target);
    });
  }
  const tracks: KeyframeTrack[] = [];
  for (const track of clip.tracks) {
    const dot = track.name.lastIndexOf(".");
    const target = targets.get(track.name.slice(0, dot));
    if (!target) continue;
    const moved = track.clone();
    moved.name = target.uuid + track.name.slice(dot);
    tracks.push(moved);
  }
  return new AnimationClip(clip.name, clip.duration, tracks);
}
