// The model in the viewport: loading, display, marks, pose and clips.

import type { Host } from "../host/host";
import { count, prefersReducedMotion } from "../dom";
import type { State } from "../state";
import { SideBySide } from "./side-by-side";
import { cornersOf } from "./bend";
import { Comparison } from "./comparison";
import { ExposureSheet } from "./exposure-sheet";
import { Ground } from "./ground";
import { Highlight, type Mark } from "./highlight";
import { Latest } from "./latest";
import { isSame, load, type Loaded, type Wanted } from "./loading";
import { elementOf, nodeName, type Model, type Shading } from "./model";
import { pathOf } from "./path";
import { drawingAt, Player } from "./clips";
import { OnionSkin } from "./onion-skin";
import { Pose } from "./pose";
import { RenderLoop } from "./render-loop";
import { Stack } from "./stack";
import { Travel } from "./travel";
import { View } from "./view";
import { applyHidden, isAlone, isHidden } from "./visibility";
import { Box3, Vector3, type AnimationClip, type Camera, type Object3D, type PerspectiveCamera } from "three";

/**
 * model: another is shown, or none · display: shading, projection or mode changed · time: the clip moved · pose: a limb moved ·
 * sideBySide: the copy beside the model changed · layers: they are shown from the side, or no longer
 */
export type ViewerTopic = "model" | "display" | "time" | "pose" | "sideBySide" | "layers";

export class Viewer {
  readonly canvas = document.createElement("canvas");
  readonly view: View;
  readonly renderLoop: RenderLoop;
  readonly pose = new Pose(() => this.model);
  readonly player = new Player();
  readonly sideBySide: SideBySide;
  readonly comparison: Comparison;
  readonly stack: Stack;
  readonly travel = new Travel();
  readonly onionSkin: OnionSkin;
  /** Whether the page looks through the cameras of clips. */
  private filming = false;
  /** The bounds of the model over a clip. */
  private path: { readonly model: Model; readonly clip: AnimationClip; readonly box: Box3 } | null = null;
  private readonly ground: Ground;
  private readonly highlight = new Highlight();
  private readonly listeners = new Map<ViewerTopic, (() => void)[]>();
  private readonly loading: Latest<Wanted, Loaded>;
  /** The request for the model that is shown. */
  shown: Wanted | null = null;
  /** The last request that is not shown yet. */
  private awaited: Wanted | null = null;
  model: Model | null = null;
  /** The file of the model; null if only what changed in it was read. */
  private bytes: ArrayBuffer | null = null;
  /** Why the newest model is not shown, as a message. */
  failure = "";
  shading: Shading = "smooth";
  /** The exposure sheets of the model's clips. */
  exposures: readonly ExposureSheet[] = [];
  /** The figure whose drawings are counted, if a clip moves several. */
  figure: string | null = null;
  /** The share of the bend of terrain: 1 is as drawn, 0 true 3D. */
  bent = 1;

  constructor(private readonly state: State, private readonly host: Host, place: HTMLElement) {
    this.canvas.tabIndex = 0;
    // Screen readers pass the arrow keys on to it.
    this.canvas.setAttribute("role", "application");
    this.canvas.setAttribute("aria-description", "The arrow keys turn the view, plus and minus zoom. Help lists all keys.");
    this.canvas.setAttribute("aria-label", "No model yet");
    place.prepend(this.canvas);
    this.view = new View(this.canvas);
    this.renderLoop = new RenderLoop(place, this.canvas, this.view);
    this.ground = new Ground(this.renderLoop.scene);
    this.sideBySide = new SideBySide(this.renderLoop.scene);
    this.onionSkin = new OnionSkin(this.renderLoop.scene, this);
    this.loading = new Latest(
      (wanted) => load(wanted, this, host, this.renderLoop),
      (loaded, wanted) => this.take(loaded, wanted),
      (error, wanted) => this.failed(error, wanted),
    );
    this.comparison = new Comparison(this.sideBySide, this, {
      read: (address) => host.model(address),
      mayAsk: (connection) => this.state.link === "open" && connection === this.state.connection,
      changed: () => {
        this.surround();
        this.hideParts();
        this.renderLoop.moved();
        this.notify("sideBySide");
      },
    });
    this.stack = new Stack(this);
    this.renderLoop.beforeFrame((seconds) => this.step(seconds));
    this.renderLoop.follow = (camera) => this.follow(camera);
    this.renderLoop.placed = () => {
      this.model?.batches.follow();
      this.sideBySide.copy?.batches.follow();
    };
    this.view.leftFilm = () => {
      this.filming = false;
      this.notify("time");
    };
    state.on(["current", "build", "link"], () => this.update());
    state.on("selection", () => this.mark("selected"));
    state.on("hover", () => this.mark("hovered"));
    state.on("light", () => this.mark("lit"));
    this.on(["time", "model"], () => this.followOnionSkin());
    state.on("hidden", () => {
      this.hideParts();
      this.followOnionSkin();
      this.renderLoop.moved();
    });
  }

  on(topics: readonly ViewerTopic[], listener: () => void): void {
    for (const topic of topics) this.listeners.set(topic, [...(this.listeners.get(topic) ?? []), listener]);
  }

  /** The name of the part of a node. */
  partOf(node: Object3D): string {
    const element = elementOf(node);
    const part = element === null ? undefined : this.state.parts.at(element);
    return part?.name ?? nodeName(node);
  }

  nodesOf(name: string | null, model = this.model): readonly Object3D[] {
    const part = name === null ? undefined : this.state.parts.carrier(name);
    if (part && model) return model.nodesOf(part);
    const node = name === null ? undefined : model?.node(name);
    return node ? [node] : [];
  }

  /** The exposure sheets of a clip, one for each figure that it moves. */
  exposuresOf(clip: { readonly name: string } | null): readonly ExposureSheet[] {
    return clip ? this.exposures.filter(({ facts }) => facts.name === clip.name) : [];
  }

  /** The exposure sheet to display: that of the chosen figure, otherwise of one whose clip is limited. */
  get exposure(): ExposureSheet | null {
    const all = this.exposuresOf(this.player.clip);
    return all.find(({ facts }) => facts.figure === this.figure) ?? all.find(({ facts }) => facts.limited) ?? all[0] ?? null;
  }

  /** The exposure sheet of the performed clip to display: that of the chosen figure, otherwise of one that is performed; null if none is. */
  get performed(): ExposureSheet | null {
    const all = this.exposuresOf(this.player.clip).filter(({ facts }) => facts.performance !== null);
    return all.find(({ facts }) => facts.figure === this.figure) ?? all[0] ?? null;
  }

  chooseFigure(figure: string): void {
    this.figure = figure;
    this.notify("time");
  }

  /** Switches the comparison with the original clip on or off. */
  compare(on: boolean): void {
    this.comparison.want(on);
    this.notify("sideBySide");
  }

  setShading(shading: Shading): void {
    this.shading = shading;
    this.model?.shade(shading);
    this.drawEdges();
    this.renderLoop.invalidate();
    this.canvas.dataset["shading"] = shading;
    this.notify("display");
  }

  setParallel(parallel: boolean): void {
    this.view.setParallel(parallel);
    this.notify("display");
  }

  setBent(amount: number): void {
    this.bent = amount;
    this.renderLoop.invalidate();
    this.notify("display");
  }

  /** The layers are shown from the side, or no longer. */
  layersShown(): void {
    this.canvas.dataset["layers"] = this.stack.isExact ? "shown" : "";
    this.notify("layers");
  }

  /** Moves until the selected part and what hangs on it fill the picture; the whole model if none is selected. */
  frameSelected(): void {
    const box = new Box3();
    for (const node of this.nodesOf(this.state.selected)) box.expandByObject(node);
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
    this.highlight.color(accent, ink);
    this.ground.color(grid);
    this.renderLoop.invalidate();
  }

  posed(): void {
    this.pose.apply();
    this.canvas.dataset["posed"] = this.pose.names.join(" ");
    this.renderLoop.moved();
    this.notify("pose");
  }

  /** The user stopped, started or moved the clip. */
  moved(change: () => void): void {
    this.pose.release();
    change();
    this.comparison.follow();
    this.goAlong();
    this.pose.apply();
    this.renderLoop.moved();
    this.notify("time");
  }

  /** Shows the drawings before and after that of a paused clip, or no longer. */
  showOnionSkin(on: boolean): void {
    this.onionSkin.wanted = on;
    this.notify("time");
  }

  private followOnionSkin(): void {
    if (this.onionSkin.follow(this.state.hidden)) this.renderLoop.invalidate();
    this.canvas.dataset["onionSkin"] = String(this.onionSkin.count);
  }

  /** Lets the view go along with a figure that travels, or no longer. */
  followTravel(on: boolean): void {
    this.travel.wanted = on;
    this.travel.restart();
    this.goAlong();
    this.notify("time");
  }

  /** The camera that films the clip. */
  private get clipCamera(): PerspectiveCamera | null {
    const { clip } = this.player;
    return (clip && this.model?.cameraOf(clip)) ?? null;
  }

  /** Whether a camera films the clip. */
  get isFilmable(): boolean {
    return this.clipCamera !== null;
  }

  /** Whether the page looks through the camera of the clip. */
  get isFilming(): boolean {
    return this.filming && this.isFilmable;
  }

  /** Looks through the cameras of clips, or no longer. */
  film(on: boolean): void {
    this.filming = on;
    this.travel.restart();
    this.goAlong();
    this.notify("time");
  }

  private goAlong(): void {
    const camera = this.filming ? this.clipCamera : null;
    this.view.film(camera);
    if (!camera && this.travel.wanted) this.view.shift(this.travel.since(this.model, this.player.clip));
  }

  /** Runs `draw` while marks and ground are hidden. */
  bare<T>(draw: () => T): T {
    this.highlight.show(false);
    this.ground.group.visible = false;
    try {
      return draw();
    } finally {
      this.highlight.show(true);
      this.ground.group.visible = true;
      this.renderLoop.invalidate();
    }
  }

  private update(): void {
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
    if (isSame(wanted, this.awaited ?? this.shown)) return this.hideParts();
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
    if ("changes" in loaded && (!this.model || this.shown !== loaded.since)) {
      if (wanted === this.awaited) this.loading.want(wanted);
      return;
    }
    if (wanted === this.awaited) this.awaited = null;
    if (wanted.drawing !== this.state.current) {
      if ("model" in loaded) loaded.model.dispose();
      return;
    }
    const first = this.model === null;
    this.pose.release();
    for (const mark of ["hovered", "lit", "selected"] as const) this.highlight.clear(mark);
    this.highlight.edges([]);
    this.sideBySide.remove();
    // Disposes of the model before the last if no frame was drawn since.
    this.renderLoop.settle();
    const before = this.replace(loaded);
    const model = this.model!;
    this.shown = wanted;
    this.failure = "";
    this.exposures = wanted.clips.map((facts) => new ExposureSheet(facts));
    this.player.take(model, !prefersReducedMotion());
    this.pose.apply();
    model.addTo(this.renderLoop.scene);
    this.surround();
    this.comparison.take(wanted);
    this.hideParts();
    if (first) this.view.frame("threeQuarter", false);
    this.goAlong();
    this.canvas.dataset["revision"] = String(wanted.revision);
    this.canvas.setAttribute("aria-label", `Model of ${this.state.drawing?.name ?? "the drawing"}: ${count(model.triangles, "triangle")}`);
    this.renderLoop.afterNext(() => {
      // Not before the new model has taken over the shaders, or they would be compiled again.
      before?.dispose();
      // Shadows take longer than everything else, and follow one frame later.
      this.renderLoop.moved();
    });
    this.renderLoop.drawNow();
    this.notify("model", "time", "sideBySide");
  }

  /** Shows what was loaded; the model that it replaces, if it is another one, is returned. */
  private replace(loaded: Loaded): Model | null {
    const before = this.model;
    this.path = null;
    if ("changes" in loaded) {
      this.player.release();
      this.onionSkin.clear();
      before?.update(loaded.changes);
      before?.light((material) => this.renderLoop.reach(material));
      this.bytes = null;
      return null;
    }
    before?.remove();
    if (before) loaded.model.reuseGeometries(before);
    this.model = loaded.model;
    this.bytes = loaded.bytes;
    // The user may have changed it while the model was loading.
    this.model.shade(this.shading);
    return before;
  }

  private failed(error: unknown, wanted: Wanted): void {
    if (wanted !== this.awaited) return;
    this.awaited = null;
    if (wanted.drawing !== this.state.current || this.state.link === "lost") return;
    this.failure = error instanceof Error ? error.message : String(error);
    this.notify("model");
  }

  private remove(): void {
    for (const mark of ["hovered", "lit", "selected"] as const) this.highlight.clear(mark);
    this.highlight.edges([]);
    this.comparison.clear();
    this.exposures = [];
    this.figure = null;
    this.pose.reset();
    this.model?.dispose();
    this.model = this.path = null;
    this.bytes = null;
    this.shown = this.awaited = null;
    this.failure = "";
    this.player.clear();
    this.goAlong();
    this.ground.group.visible = false;
    delete this.canvas.dataset["revision"];
    this.canvas.setAttribute("aria-label", "No model yet");
    this.renderLoop.moved();
    this.notify("model", "time", "pose", "sideBySide");
  }

  /** Fits the ground and the view to the scene. */
  private surround(): void {
    const { model } = this;
    const { boxes, offset } = this.sideBySide;
    if (!model) return;
    const box = boxes ? new Box3().union(boxes[0]).union(boxes[1]) : model.box;
    this.ground.fit(box);
    this.view.bound(
      box,
      model.bend.isEmpty
        ? boxes
          ? null
          : () => cornersOf(this.wholePath(model))
        : (towards) => {
            const points = model.bend.points(towards, this.bent);
            return boxes ? points.flatMap((point) => [point, point.clone().setX(point.x + offset)]) : points;
          },
    );
    this.canvas.dataset["beside"] = boxes ? String(offset) : "";
  }

  /** The bounds of the model over the clip that is shown; those at rest without one, and of a figure that the view goes along with. */
  private wholePath(model: Model): Box3 {
    const { clip, time } = this.player;
    if (!clip || this.travel.wanted) return model.box;
    if (this.path?.model !== model || this.path.clip !== clip) {
      this.pose.release();
      this.path = { model, clip, box: pathOf(model, clip, (at) => this.player.seek(at)) };
      this.player.seek(time);
      this.pose.apply();
    }
    return this.path.box;
  }

  private drawEdges(): void {
    const models = [this.model, this.sideBySide.copy].filter((model) => model !== null);
    const on = this.shading === "edges";
    this.highlight.edges(on ? models.flatMap(({ meshes }) => meshes.filter(isAlone)) : []);
    for (const { batches } of models) batches.drawEdges(on ? this.highlight.lines : null);
  }

  /** Hides the hidden parts in the model and in the copy beside it. */
  private hideParts(): void {
    const { hidden } = this.state;
    for (const model of [this.model, this.sideBySide.copy]) {
      if (!model) continue;
      const nodes = [...hidden].flatMap((name) => this.nodesOf(name, model));
      applyHidden(model, new Set(nodes.flatMap((node) => model.meshesOf(node))));
    }
    this.canvas.dataset["hidden"] = [...hidden].join(" ");
    this.drawEdges();
    this.markAll();
  }

  private markAll(): void {
    for (const mark of ["hovered", "lit", "selected"] as const) this.mark(mark);
  }

  private mark(mark: Mark): void {
    const name = { hovered: this.state.hovered, lit: this.state.lit, selected: this.state.selected }[mark];
    const nodes = this.nodesOf(name);
    const { copy } = this.sideBySide;
    const meshes = [...nodes.flatMap((node) => this.model?.meshesOf(node) ?? []), ...(copy ? this.nodesOf(name, copy).flatMap((node) => copy.meshesOf(node)) : [])];
    // Pointing at a hidden part in the list shows where it is.
    this.highlight.set(mark, mark === "hovered" ? meshes : meshes.filter((mesh) => !isHidden(mesh)));
    this.canvas.dataset[mark] = nodes.map(nodeName).join(" ");
    this.renderLoop.invalidate();
  }

  /** Lets view-dependent nodes follow the viewer. */
  private follow(camera: Camera): void {
    const { model } = this;
    if (!model) return;
    const towards = new Vector3(0, 0, 1).applyQuaternion(camera.quaternion);
    const turned = [model, this.sideBySide.copy].map((one) => one?.turns.follow(towards));
    if (turned.includes(true)) this.renderLoop.moves();
    if (model.bend.isEmpty) return;
    const bends = [model, this.sideBySide.copy].map((one) => one?.bend.follow(towards, this.bent));
    if (!bends.includes(true)) return;
    this.ground.bend(model.bend.inWorld());
    this.renderLoop.moves();
  }

  private step(seconds: number): boolean {
    this.highlight.measure(this.renderLoop.size);
    if (!this.player.playing) return false;
    const { keys, time } = this.player;
    this.pose.release();
    const more = this.player.advance(seconds);
    this.comparison.follow();
    this.goAlong();
    this.pose.apply();
    // A held drawing is not drawn again.
    if (this.sideBySide.copy || !keys.held || drawingAt(keys, time) !== drawingAt(keys, this.player.time)) this.renderLoop.moved();
    this.notify("time");
    return more;
  }

  private notify(...topics: ViewerTopic[]): void {
    for (const topic of topics) for (const listener of this.listeners.get(topic) ?? []) listener();
  }
}
