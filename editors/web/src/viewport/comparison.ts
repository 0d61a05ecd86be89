// Controls the comparison of clips with their originals, as they were before they were performed or limited: whether it is on, where
// the originals come from, and when the copy is rebuilt.

import { Replaced } from "../host/replaced";
import type { SideBySide } from "./side-by-side";
import type { Player } from "./clips";
import type { Exposures } from "./exposures";
import { Latest } from "./latest";
import type { Model } from "./model";
import { readFile } from "./model-file";
import type { Pose } from "./pose";
import type { View } from "./view";

/** Where the original clips of a build are. */
interface Source {
  readonly connection: number;
  readonly originals: string | null;
}

/** The viewer's state. */
interface Shown {
  readonly model: Model | null;
  readonly player: Player;
  readonly pose: Pose;
  readonly view: View;
  readonly exposures: Exposures;
}

/** Where the files of original clips are from, and who is told of the copy. */
export interface ComparisonHost {
  read(address: string): Promise<ArrayBuffer>;
  /** Whether the host of this connection can be asked. */
  mayAsk(connection: number): boolean;
  /** The copy was added or removed, or could not be loaded. */
  changed(): void;
}

export class Comparison {
  private readonly fetching: Latest<Source, void>;
  private source: Source | null = null;
  /** The build whose original clips are loaded or being loaded. */
  private fetched: Source | null = null;
  /** Moves the camera back to where it was before the comparison. */
  private back: (() => void) | null = null;
  /** The clip for which the two were arranged. */
  private arranged: unknown = null;
  /** Whether the comparison is on. */
  wanted = false;
  /** Why there is no copy although the comparison is on, as a message. */
  failure = "";

  constructor(private readonly sideBySide: SideBySide, private readonly shown: Shown, private readonly host: ComparisonHost) {
    this.fetching = new Latest(
      async (source) => {
        const originals = await readFile(await host.read(source.originals ?? ""));
        if (source === this.fetched) sideBySide.originals = originals;
      },
      (_, source) => {
        if (source === this.fetched && this.wanted) this.put();
      },
      (error, source) => {
        if (source !== this.fetched) return;
        this.fetched = null;
        // The next build has its own.
        if (error instanceof Replaced) return;
        // If the host is gone, the page reports that already.
        if (!host.mayAsk(source.connection)) return;
        this.failure = error instanceof Error ? error.message : String(error);
        host.changed();
      },
    );
  }

  /** Whether there are original clips to compare with. */
  get isPossible(): boolean {
    return this.source !== null && this.source.originals !== null && this.shown.player.clips.length > 0;
  }

  /** Whether the comparison is on and being loaded. */
  get isComing(): boolean {
    return this.wanted && this.sideBySide.copy === null && this.failure === "";
  }

  want(on: boolean): void {
    if (on && !this.isPossible) return;
    this.wanted = on;
    this.failure = "";
    if (on) this.update();
    else this.remove();
  }

  /** The model of another build is shown; until its original clips are loaded, those of the last build are used. */
  take(source: Source): void {
    this.source = source;
    this.failure = "";
    this.update();
  }

  /** The model was removed. */
  clear(): void {
    this.sideBySide.remove();
    this.sideBySide.originals = this.source = this.fetched = this.back = null;
    this.wanted = false;
    this.failure = "";
  }

  /** The time or the clip changed. */
  follow(): void {
    const { player } = this.shown;
    if (!this.sideBySide.copy || !player.clip) return;
    if (this.arranged === player.clip) return this.sideBySide.seek(player.time, player.clip.duration);
    this.arrange();
    this.host.changed();
    this.shown.view.frame();
  }

  private update(): void {
    const { source } = this;
    if (!this.wanted || !source || !this.shown.model) return;
    if (source.originals === null) return this.remove();
    this.put();
    if (this.fetched?.originals === source.originals && this.fetched.connection === source.connection) return;
    if (!this.host.mayAsk(source.connection)) return;
    this.fetched = source;
    this.fetching.want(source);
  }

  private put(): void {
    const { model, pose, view } = this.shown;
    const { originals } = this.sideBySide;
    if (!model || !originals) return;
    const first = this.back === null;
    this.back ??= view.rememberPlace();
    pose.release();
    this.sideBySide.put(model, originals);
    this.arrange();
    pose.apply();
    this.host.changed();
    if (first) view.frame();
  }

  /** Gives both the space that the clip needs. Limbs turned by hand must be released meanwhile. */
  private arrange(): void {
    const { model, player } = this.shown;
    if (!model) return;
    const { time } = player;
    this.arranged = player.clip;
    this.sideBySide.choose(player.clip, this.shown.exposures.performed ? "same" : "together", (at) => player.seek(at), model);
    player.waitFor(this.sideBySide.waits);
    player.seek(time);
    if (player.clip) this.sideBySide.seek(time, player.clip.duration);
  }

  private remove(): void {
    this.sideBySide.remove();
    this.shown.player.waitFor(0);
    this.host.changed();
    this.back?.();
    this.back = null;
  }
}
