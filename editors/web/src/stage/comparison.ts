// Full and limited side by side: whether that is asked for, where the full clips come from, and when what stands beside the model is
// put there anew.

import type { Beside } from "./beside";
import type { Player } from "./clips";
import { Newest } from "./loading";
import { readFile, type Model } from "./model";
import type { Pose } from "./pose";
import type { View } from "./view";

/** A build's full clips. */
interface Source {
  readonly connection: number;
  readonly originals: string | null;
}

/** What is compared. */
interface Shown {
  readonly model: Model | null;
  readonly player: Player;
  readonly pose: Pose;
  readonly view: View;
}

interface Around {
  read(address: string): Promise<ArrayBuffer>;
  /** Whether the host of this connection is there to be asked. */
  mayAsk(connection: number): boolean;
  /** Something was put beside the model, or taken away, or could not be read. */
  changed(): void;
}

export class Comparison {
  private readonly fetching: Newest<Source, void>;
  private source: Source | null = null;
  /** The build whose full clips are there, or on their way. */
  private fetched: Source | null = null;
  /** Goes back to where the camera was before something stood beside the model. */
  private back: (() => void) | null = null;
  /** The clip for which the two were put beside each other. */
  private arranged: unknown = null;
  /** Whether it is asked for. */
  wanted = false;
  /** Why it is not there though it is asked for, in words. */
  failure = "";

  constructor(private readonly beside: Beside, private readonly shown: Shown, private readonly around: Around) {
    this.fetching = new Newest(
      async (source) => {
        const originals = await readFile(await around.read(source.originals ?? ""));
        if (source === this.fetched) beside.originals = originals;
      },
      (_, source) => {
        if (source === this.fetched && this.wanted) this.put();
      },
      (error, source) => {
        if (source !== this.fetched) return;
        this.fetched = null;
        // Of a host that went away the page says so itself.
        if (!around.mayAsk(source.connection)) return;
        this.failure = error instanceof Error ? error.message : String(error);
        around.changed();
      },
    );
  }

  /** Whether the clips are there as they were before they were limited. */
  get isPossible(): boolean {
    return this.source !== null && this.source.originals !== null && this.shown.player.clips.length > 0;
  }

  /** Whether it is asked for and on its way. */
  get isComing(): boolean {
    return this.wanted && this.beside.copy === null && this.failure === "";
  }

  want(on: boolean): void {
    if (on && !this.isPossible) return;
    this.wanted = on;
    this.failure = "";
    if (on) this.update();
    else this.remove();
  }

  /** Another model is shown, of this build: with the clips of the last build until those of this one are there. */
  take(source: Source): void {
    this.source = source;
    this.failure = "";
    this.update();
  }

  /** There is no model any more. */
  clear(): void {
    this.beside.remove();
    this.beside.originals = this.source = this.fetched = this.back = null;
    this.wanted = false;
    this.failure = "";
  }

  /** The clip moved, or another is shown. */
  follow(): void {
    const { player } = this.shown;
    if (!this.beside.copy || !player.clip) return;
    if (this.arranged === player.clip) return this.beside.seek(player.time, player.clip.duration);
    this.arrange();
    this.around.changed();
    this.shown.view.frame();
  }

  private update(): void {
    const { source } = this;
    if (!this.wanted || !source || !this.shown.model) return;
    if (source.originals === null) return this.remove();
    this.put();
    if (this.fetched?.originals === source.originals && this.fetched.connection === source.connection) return;
    if (!this.around.mayAsk(source.connection)) return;
    this.fetched = source;
    this.fetching.want(source);
  }

  private put(): void {
    const { model, pose, view } = this.shown;
    const { originals } = this.beside;
    if (!model || !originals) return;
    const first = this.back === null;
    this.back ??= view.remember();
    pose.release();
    this.beside.put(model, originals);
    this.arrange();
    pose.apply();
    this.around.changed();
    if (first) view.frame();
  }

  /** Gives both the room that the clip takes. Limbs must not be turned by hand meanwhile. */
  private arrange(): void {
    const { model, player } = this.shown;
    if (!model) return;
    const { time } = player;
    this.arranged = player.clip;
    this.beside.choose(player.clip, (at) => player.seek(at), model);
    player.seek(time);
    if (player.clip) this.beside.seek(time, player.clip.duration);
  }

  private remove(): void {
    this.beside.remove();
    this.around.changed();
    this.back?.();
    this.back = null;
  }
}
