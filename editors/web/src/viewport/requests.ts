// Requests the model of the newest build of the drawing that is shown: one at a time, and again if it changed meanwhile.

import type { Host } from "../host/host";
import type { State } from "../state";
import { Latest } from "./latest";
import { isSame, load, type Loaded, type Wanted } from "./loading";
import type { Model, Shading } from "./model";
import type { RenderLoop } from "./render-loop";

/** What the requests are for. */
interface Display {
  readonly model: Model | null;
  readonly shading: Shading;
  /** Shows a model that was loaded. */
  take(loaded: Loaded, wanted: Wanted): void;
  /** Shows no model. */
  remove(): void;
  /** The same model as before is that of a newer build. */
  kept(): void;
  /** The newest model could not be loaded. */
  failed(): void;
}

export class ModelRequests {
  private readonly loading: Latest<Wanted, Loaded>;
  /** The request for the model that is shown. */
  private shown: Wanted | null = null;
  /** The last request that is not shown yet. */
  private awaited: Wanted | null = null;
  /** The file of the model; null if only what changed in it was read. */
  private bytes: ArrayBuffer | null = null;
  /** Why the newest model is not shown, as a message. */
  failure = "";

  constructor(private readonly state: State, private readonly host: Host, private readonly display: Display, renderLoop: RenderLoop) {
    this.loading = new Latest(
      (wanted) => load(wanted, { model: display.model, shown: this.shown, shading: display.shading }, host, renderLoop),
      (loaded, wanted) => this.take(loaded, wanted),
      (error, wanted) => this.failed(error, wanted),
    );
  }

  /** Follows drawing, build and connection. */
  update(): void {
    const { drawing } = this.state;
    const build = drawing?.build;
    const before = this.awaited ?? this.shown;
    if (!drawing || (before && before.drawing !== drawing.id)) this.remove();
    if (!drawing || !build) return;
    if (build.model === null) {
      if (before) this.remove();
      return;
    }
    const { clips, originals } = build;
    const wanted: Wanted = { drawing: drawing.id, connection: drawing.connection, revision: build.revision, address: build.model, clips, originals };
    // The same model, but its parts may be bound to other strings now.
    if (isSame(wanted, this.awaited ?? this.shown)) return this.display.kept();
    // Addresses hold within one connection: a lost host cannot be asked, and a new one not for a model of the last.
    if (this.state.link !== "open" || drawing.connection !== this.state.connection) return;
    this.awaited = wanted;
    this.loading.want(wanted);
  }

  /** The file of the model; null if the server that has it is gone. */
  async file(): Promise<ArrayBuffer | null> {
    const { shown, state } = this;
    if (this.bytes || !shown || shown.connection !== state.connection || state.link !== "open") return this.bytes;
    return this.host.model(shown.address);
  }

  private take(loaded: Loaded, wanted: Wanted): void {
    // The model that changed may be gone meanwhile.
    if ("changes" in loaded && (!this.display.model || this.shown !== loaded.since)) {
      if (wanted === this.awaited) this.loading.want(wanted);
      return;
    }
    if (wanted === this.awaited) this.awaited = null;
    if (wanted.drawing !== this.state.current) {
      if ("model" in loaded) loaded.model.dispose();
      return;
    }
    this.shown = wanted;
    this.bytes = "changes" in loaded ? null : loaded.bytes;
    this.failure = "";
    this.display.take(loaded, wanted);
  }

  private failed(error: unknown, wanted: Wanted): void {
    if (wanted !== this.awaited) return;
    this.awaited = null;
    if (wanted.drawing !== this.state.current || this.state.link === "lost") return;
    this.failure = error instanceof Error ? error.message : String(error);
    this.display.failed();
  }

  private remove(): void {
    this.bytes = null;
    this.shown = this.awaited = null;
    this.failure = "";
    this.display.remove();
  }
}
