// Plays the clips of a model.

import { AnimationMixer, InterpolateDiscrete, LoopOnce, type AnimationAction, type AnimationClip, type KeyframeTrack } from "three";
import type { Model } from "./model";

export interface Keys {
  /** The times of all keys in seconds, ascending. */
  readonly times: readonly number[];
  /** Whether nothing moves between keys: each is a held drawing. */
  readonly held: boolean;
}

/** The keys of a clip. A key at the end of a clip of held drawings only ends the last one. */
export function keysOf(clip: { readonly tracks: readonly KeyframeTrack[]; readonly duration: number }): Keys {
  const times = new Set<number>();
  for (const track of clip.tracks) for (const time of track.times) times.add(time);
  const held = clip.tracks.length > 0 && clip.tracks.every((track) => track.getInterpolation() === InterpolateDiscrete);
  const sorted = [...times].sort((a, b) => a - b);
  if (held && sorted.length > 1 && sorted.at(-1)! >= clip.duration) sorted.pop();
  return { times: sorted, held };
}

/** The number of the held drawing at a time, from 1. */
export function drawingAt({ times }: Keys, time: number): number {
  let low = 0;
  let high = times.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    // Key times have single precision: a time read from one may lie slightly before it.
    if (times[middle]! <= time + 1e-5) low = middle + 1;
    else high = middle;
  }
  return Math.max(low, 1);
}

export class Player {
  private mixer: AnimationMixer | null = null;
  private action: AnimationAction | null = null;
  /** The tracks of a clip whose keys count. */
  private tracksOf = (clip: AnimationClip): readonly KeyframeTrack[] => clip.tracks;
  /** How long the clip beside this one takes, in seconds. */
  private beside = 0;
  clips: readonly AnimationClip[] = [];
  clip: AnimationClip | null = null;
  keys: Keys = { times: [], held: false };
  time = 0;
  speed = 1;
  loops = true;
  playing = false;

  /** Until when the clip is shown, in seconds: it waits at its end for a longer one beside it. */
  get end(): number {
    return Math.max(this.clip?.duration ?? 0, this.beside);
  }

  /** A clip of this duration runs beside this one by the same clock; 0 for none. */
  waitFor(seconds: number): void {
    this.beside = seconds;
    if (this.time > this.end) this.seek(this.end);
  }

  /** Continues in another model: with the clip of the same name at the same time, otherwise with one that is `preferred`, or its first. `plays` applies to the latter. */
  take(model: Model, plays: boolean, preferred: (clip: AnimationClip) => boolean = () => false): void {
    const before = this.clip;
    this.mixer?.stopAllAction();
    this.clips = model.clips;
    this.tracksOf = (clip) => model.tracksOf(clip);
    this.mixer = model.clips.length > 0 ? new AnimationMixer(model.root) : null;
    const same = before && model.clips.find(({ name }) => name === before.name);
    if (!same) {
      this.time = 0;
      this.playing = plays && model.clips.length > 0;
    }
    this.use(same ?? model.clips.find(preferred) ?? model.clips[0] ?? null);
  }

  /** Gives all nodes back what the clip moved, until the next model is taken. */
  release(): void {
    this.mixer?.stopAllAction();
  }

  /** The model was removed. */
  clear(): void {
    this.mixer = this.action = this.clip = null;
    this.clips = [];
    this.time = 0;
    this.playing = false;
  }

  /** The keys of a clip, without those of its camera. */
  keysIn(clip: AnimationClip): Keys {
    return keysOf({ tracks: this.tracksOf(clip), duration: clip.duration });
  }

  choose(clip: AnimationClip): void {
    this.time = 0;
    this.use(clip);
  }

  play(on: boolean): void {
    if (!this.clip) return;
    if (on && this.time >= this.end) this.time = 0;
    this.playing = on;
  }

  seek(time: number): void {
    this.time = Math.min(Math.max(time, 0), this.end);
    this.set();
  }

  /** Goes to the previous or next key. */
  step(keys: 1 | -1): void {
    const { times } = this.keys;
    const next = keys > 0 ? times.find((time) => time > this.time + 1e-5) : times.findLast((time) => time < this.time - 1e-5);
    this.playing = false;
    this.seek(next ?? (keys > 0 ? times[0] : times.at(-1)) ?? 0);
  }

  /** Advances the time. True while the clip plays. */
  advance(seconds: number): boolean {
    if (!this.playing || !this.clip) return false;
    const { end } = this;
    this.time += seconds * this.speed;
    if (this.time >= end) {
      if (this.loops && end > 0) this.time %= end;
      else {
        this.time = end;
        this.playing = false;
      }
    }
    this.set();
    return this.playing;
  }

  private use(clip: AnimationClip | null): void {
    this.mixer?.stopAllAction();
    this.clip = clip;
    this.beside = 0;
    this.keys = clip ? this.keysIn(clip) : { times: [], held: false };
    this.action = clip && this.mixer ? this.mixer.clipAction(clip).setLoop(LoopOnce, 1) : null;
    if (this.action) {
      this.action.clampWhenFinished = true;
      this.action.play();
    }
    this.time = Math.min(this.time, clip?.duration ?? 0);
    this.set();
  }

  private set(): void {
    if (!this.action || !this.mixer || !this.clip) return;
    this.action.paused = false;
    this.action.enabled = true;
    this.action.time = Math.min(this.time, this.clip.duration);
    this.mixer.update(0);
  }
}
