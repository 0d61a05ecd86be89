// The model in the viewport: puts together what loads, plays, marks and draws it.

import { Box3 } from "three";
import { count } from "../dom";
import type { Host } from "../host/host";
import type { State } from "../state";
import { Bounds } from "./bounds";
import { ViewerEvents, type ViewerTopic } from "./events";
import { Ground } from "./ground";
import type { Loaded, Wanted } from "./loading";
import { Marks } from "./marks";
import type { Model, Shading } from "./model";
import { PartNodes } from "./part-nodes";
import { Playback } from "./playback";
import { Pose } from "./pose";
import { RenderLoop } from "./render-loop";
import { ModelRequests } from "./requests";
import type { SideBySide } from "./side-by-side";
import { Stack } from "./stack";
import { View } from "./view";
import { ViewDependent } from "./view-dependent";

export class Viewer {
  readonly canvas = document.createElement("canvas");
  readonly view: View;
  readonly renderLoop: RenderLoop;
  readonly requests: ModelRequests;
  readonly parts: PartNodes;
  readonly pose = new Pose(() => this.model);
  readonly playback: Playback;
  readonly stack: Stack;
  private readonly events = new ViewerEvents();
  private readonly ground: Ground;
  private readonly marks: Marks;
  private readonly viewDependent: ViewDependent;
  private readonly bounds: Bounds;
  model: Model | null = null;
  shading: Shading = "smooth";

  constructor(private readonly state: State, host: Pick<Host, "model">, place: HTMLElement) {
    this.canvas.tabIndex = 0;
    // Screen readers pass the arrow keys on to it.
    this.canvas.setAttribute("role", "application");
    this.canvas.setAttribute("aria-description", "The arrow keys turn the view, plus and minus zoom. Help lists all keys.");
    this.canvas.setAttribute("aria-label", "No model yet");
    place.prepend(this.canvas);
    this.view = new View(this.canvas);
    this.renderLoop = new RenderLoop(place, this.canvas, this.view);
    this.ground = new Ground(this.renderLoop.scene);
    this.parts = new PartNodes(state, this);
    this.playback = new Playback(this, this.view, this.renderLoop, this.events, {
      read: (address) => host.model(address),
      mayAsk: (connection) => state.link === "open" && connection === state.connection,
      changed: () => {
        this.surround();
        this.renderLoop.moved();
        this.events.notify("sideBySide");
      },
    });
    this.viewDependent = new ViewDependent(this, this.ground, this.renderLoop);
    this.bounds = new Bounds(this.view, this.ground, this.playback, this.viewDependent, this.canvas);
    this.stack = new Stack(this);
    this.requests = new ModelRequests(state, host, this, this.renderLoop);
    this.renderLoop.beforeFrame((seconds) => {
      this.marks.measure();
      return this.playback.step(seconds);
    });
    this.renderLoop.placed = () => {
      this.model?.batches.follow();
      this.sideBySide.copy?.batches.follow();
    };
    state.on(["current", "build", "link"], () => this.requests.update());
    this.marks = new Marks(state, this, this.renderLoop);
    state.on("hidden", () => {
      this.marks.update();
      this.playback.followOnionSkin();
      this.renderLoop.moved();
    });
  }

  on(topics: readonly ViewerTopic[], listener: () => void): void {
    this.events.on(topics, listener);
  }

  /** The copy beside the model. */
  get sideBySide(): SideBySide {
    return this.playback.sideBySide;
  }

  /** The names of the hidden parts. */
  get hidden(): ReadonlySet<string> {
    return this.state.hidden;
  }

  setShading(shading: Shading): void {
    this.shading = shading;
    this.model?.shade(shading);
    this.marks.drawEdges();
    this.renderLoop.invalidate();
    this.canvas.dataset["shading"] = shading;
    this.events.notify("display");
  }

  setParallel(parallel: boolean): void {
    this.view.setParallel(parallel);
    this.events.notify("display");
  }

  /** The share of the bend of terrain: 1 is as drawn, 0 true 3D. */
  get bent(): number {
    return this.viewDependent.bent;
  }

  /** Whether the model has view-dependent nodes. */
  get bends(): boolean {
    return this.model?.bend.isEmpty === false;
  }

  /** Switches between the drawn look and true 3D. */
  toggleBend(): void {
    this.setBent(this.bent > 0 ? 0 : 1);
  }

  setBent(amount: number): void {
    this.viewDependent.bent = amount;
    this.renderLoop.invalidate();
    this.events.notify("display");
  }

  /** The layers are shown from the side, or no longer. */
  layersShown(): void {
    this.canvas.dataset["layers"] = this.stack.isExact ? "shown" : "";
    this.events.notify("layers");
  }

  /** Moves until the selected part and what hangs on it fill the picture; the whole model if none is selected. */
  frameSelected(): void {
    const box = new Box3();
    for (const node of this.parts.nodesOf(this.state.selected)) box.expandByObject(node);
    if (box.isEmpty()) this.view.frame();
    else this.view.frameBox(box);
  }

  /** Moves the camera to where terrain looks as it is drawn. */
  lookAsDrawn(): void {
    this.setBent(1);
    this.setParallel(true);
    this.view.frame("drawn");
  }

  /** Sets the colours of the page's theme. */
  setColors(accent: string, grid: string, ink: string): void {
    this.marks.setColors(accent, ink);
    this.ground.color(grid);
    this.renderLoop.invalidate();
  }

  /** Limbs were turned by hand. */
  posed(): void {
    this.pose.apply();
    this.canvas.dataset["posed"] = this.pose.names.join(" ");
    this.renderLoop.moved();
    this.events.notify("pose");
  }

  /** Runs `draw` while marks and ground are hidden. */
  bare<T>(draw: () => T): T {
    this.marks.show(false);
    this.ground.group.visible = false;
    try {
      return draw();
    } finally {
      this.marks.show(true);
      this.ground.group.visible = true;
      this.renderLoop.invalidate();
    }
  }

  /** Shows a model that was loaded. */
  take(loaded: Loaded, wanted: Wanted): void {
    const first = this.model === null;
    this.pose.release();
    this.marks.clear();
    this.sideBySide.remove();
    // Disposes of the model before the last if no frame was drawn since.
    this.renderLoop.settle();
    const before = this.replace(loaded);
    const model = this.model!;
    this.playback.take(model, wanted.clips);
    model.addTo(this.renderLoop.scene);
    this.bounds.fit(model);
    this.playback.comparison.take(wanted);
    this.marks.update();
    if (first) this.view.frame("threeQuarter", false);
    this.playback.goAlong();
    this.canvas.dataset["revision"] = String(wanted.revision);
    this.canvas.dataset["tried"] = wanted.attempted ?? "";
    this.canvas.setAttribute("aria-label", `Model of ${this.state.drawing?.name ?? "the drawing"}: ${count(model.triangles, "triangle")}`);
    this.renderLoop.afterNext(() => {
      // Not before the new model has taken over the shaders, or they would be compiled again.
      before?.dispose();
      this.renderLoop.shadowsLater();
    });
    this.renderLoop.drawNow();
    this.events.notify("model", "time", "sideBySide");
  }

  /** Shows no model. */
  remove(): void {
    this.marks.clear();
    this.playback.comparison.clear();
    this.playback.exposures.clear();
    this.pose.reset();
    this.model?.dispose();
    this.model = null;
    this.bounds.forget();
    this.playback.clear();
    this.ground.group.visible = false;
    delete this.canvas.dataset["revision"];
    this.canvas.setAttribute("aria-label", "No model yet");
    this.renderLoop.moved();
    this.events.notify("model", "time", "pose", "sideBySide");
  }

  /** Shows nothing more, and gives back what it has of the graphics card. */
  end(): void {
    this.remove();
    this.renderLoop.end();
  }

  /** The model stays, but its parts may be others. */
  kept(): void {
    this.marks.update();
  }

  /** The newest model could not be loaded. */
  failed(): void {
    this.events.notify("model");
  }

  /** Puts what was loaded in the place of the model. Returns the model that it replaces, if it is another one. */
  private replace(loaded: Loaded): Model | null {
    const before = this.model;
    this.bounds.forget();
    if ("changes" in loaded) {
      this.playback.release();
      before?.update(loaded.changes);
      before?.light((material) => this.renderLoop.reach(material));
      return null;
    }
    before?.remove();
    if (before) loaded.model.reuseGeometries(before);
    this.model = loaded.model;
    // The user may have changed it while the model was loading.
    this.model.shade(this.shading);
    return before;
  }

  /** The copy beside the model came or went. */
  private surround(): void {
    if (this.model) this.bounds.fit(this.model);
    this.marks.update();
  }
}
