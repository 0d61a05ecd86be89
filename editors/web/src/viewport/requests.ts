// Requests the model of the newest build of the drawing that is shown: one at a time, and again if it changed meanwhile.

import type { Host } from "../host/host";
import { Replaced } from "../host/replaced";
import type { State } from "../state";
import { Latest } from "./latest";
import { isSame, load, type Attempt, type Loaded, type Wanted } from "./loading";
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
  /** A change that is being tried. */
  private attempt: Attempt | null = null;
  /** Whether it is made, and only shown until its build comes. */
  private made = false;
  /** The file of the model; null if only what changed in it was read. */
  private bytes: ArrayBuffer | null = null;
  /** Why the newest model is not shown, as a message. */
  failure = "";

  constructor(private readonly state: State, private readonly host: Pick<Host, "model">, private readonly display: Display, renderLoop: RenderLoop) {
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
    if (isSame(wanted, before) && (this.attempt !== null || !isTried(before))) return this.display.kept();
    if (this.made) this.attempt = null;
    // Addresses hold within one connection: a lost host cannot be asked, and a new one not for a model of the last.
    if (this.state.link !== "open" || drawing.connection !== this.state.connection) return;
    this.awaited = wanted;
    this.loading.want(wanted);
  }

  /** Shows what a change would make of the drawing; with null, the drawing as it is, once the change is made, its next build. */
  tries(attempt: Attempt | "made" | null): void {
    const { shown } = this;
    this.made = attempt === "made";
    if (attempt === "made") return;
    this.attempt = attempt;
    if (attempt === null) return this.update();
    // A build that is on its way is shown first: it is what the change would be made in.
    if (!shown || (this.awaited && !this.awaited.attempt)) return;
    const { attempted: _, ...base } = shown;
    this.awaited = { ...base, attempt };
    this.loading.want(this.awaited);
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
    const { attempted } = loaded;
    this.shown = attempted === undefined ? wanted : { ...wanted, attempted };
    this.bytes = "changes" in loaded || attempted !== undefined ? null : loaded.bytes;
    this.failure = "";
    this.display.take(loaded, this.shown);
    // Whoever is still deciding goes on with the new build.
    if (!wanted.attempt && this.attempt && !this.made) this.tries(this.attempt);
  }

  private failed(error: unknown, wanted: Wanted): void {
    if (wanted !== this.awaited) return;
    this.awaited = null;
    // A change that cannot be made is not shown. One that is made already is shown by the build that comes.
    if (wanted.attempt) return this.made ? undefined : this.tries(null);
    // The build that replaced it is asked for as soon as the page reads of it.
    if (error instanceof Replaced) return;
    if (wanted.drawing !== this.state.current || this.state.link === "lost") return;
    this.failure = error instanceof Error ? error.message : String(error);
    this.display.failed();
  }

  private remove(): void {
    this.bytes = null;
    this.shown = this.awaited = this.attempt = null;
    this.failure = "";
    this.display.remove();
  }
}

/** Whether it is about a change that is only tried. */
const isTried = (wanted: Wanted | null): boolean => wanted !== null && (wanted.attempt ?? wanted.attempted) !== undefined;
