// The model on the stage: which one it is, how it looks, what is marked in it, how it is posed, and the clip that plays.

import type { Host } from "../host/host";
import { count, wantsStillness } from "../dom";
import type { State } from "../state";
import type { Build } from "../protocol";
import { Beside } from "./beside";
import { Comparison } from "./comparison";
import { Exposure } from "./exposure";
import { Ground } from "./ground";
import { Highlight, type Mark } from "./highlight";
import { Newest } from "./loading";
import { elementOf, nodeName, readModel, type Model, type Shading } from "./model";
import { drawingAt, Player } from "./clips";
import { Pose } from "./pose";
import { Stage } from "./stage";
import { View } from "./view";
import { Box3, Vector3, type Camera, type Object3D } from "three";

/** A model that was asked for. */
interface Wanted {
  readonly drawing: string;
  readonly connection: number;
  readonly revision: number;
  readonly address: string;
  readonly clips: Build["clips"];
  readonly originals: string | null;
}

const isSame = (a: Wanted, b: Wanted | null): boolean => b !== null && a.drawing === b.drawing && a.connection === b.connection && a.address === b.address;

/**
 * model: another is shown, or none · look: shading, projection or mode changed · time: the clip moved · pose: a limb did ·
 * beside: what stands beside the model changed
 */
export type ViewerTopic = "model" | "look" | "time" | "pose" | "beside";

export class Viewer {
  readonly canvas = document.createElement("canvas");
  readonly view: View;
  readonly stage: Stage;
  readonly pose = new Pose(() => this.model);
  readonly player = new Player();
  readonly beside: Beside;
  readonly comparison: Comparison;
  private readonly ground: Ground;
  private readonly highlight = new Highlight();
  private readonly listeners = new Map<ViewerTopic, (() => void)[]>();
  private readonly loading: Newest<Wanted, { model: Model; bytes: ArrayBuffer }>;
  private shown: Wanted | null = null;
  /** What was asked for last and is not shown yet. */
  private awaited: Wanted | null = null;
  model: Model | null = null;
  /** The file that the model was read from. */
  bytes: ArrayBuffer | null = null;
  /** Why the newest model is not shown, in words. */
  failure = "";
  shading: Shading = "smooth";
  /** What is known of the shown model's clips. */
  exposures: readonly Exposure[] = [];
  /** The figure whose drawings are counted, where a clip moves several. */
  figure: string | null = null;
  /** How much of the bend of terrain is done: 1 is as drawn, 0 true 3D. */
  bent = 1;

  constructor(private readonly state: State, host: Host, place: HTMLElement) {
    this.canvas.tabIndex = 0;
    this.canvas.setAttribute("role", "img");
    this.canvas.setAttribute("aria-label", "No model yet");
    place.prepend(this.canvas);
    this.view = new View(this.canvas);
    this.stage = new Stage(place, this.canvas, this.view);
    this.ground = new Ground(this.stage.scene);
    this.beside = new Beside(this.stage.scene);
    this.loading = new Newest(
      async ({ address }) => {
        const bytes = await host.model(address);
        const model = await readModel(bytes);
        model.shade(this.shading);
        model.light((material) => this.stage.lights.reach(material));
        // The first model's shaders are made before it is put in, so that nothing stalls; those after it mostly use the same.
        if (!this.model) await this.stage.renderer.compileAsync(model.root, this.view.camera, this.stage.scene);
        return { model, bytes };
      },
      ({ model, bytes }, wanted) => this.take(model, bytes, wanted),
      (error, wanted) => this.failed(error, wanted),
    );
    this.comparison = new Comparison(this.beside, this, {
      read: (address) => host.model(address),
      mayAsk: (connection) => this.state.link === "open" && connection === this.state.connection,
      changed: () => {
        this.surround();
        this.markAll();
        this.drawEdges();
        this.stage.moved();
        this.tell("beside");
      },
    });
    this.stage.beforeFrame((seconds) => this.step(seconds));
    this.stage.follow = (camera) => this.bend(camera);
    state.on(["current", "build", "link"], () => this.update());
    state.on("selection", () => this.mark("selected"));
    state.on("hover", () => this.mark("hovered"));
    state.on("light", () => this.mark("lit"));
  }

  on(topics: readonly ViewerTopic[], listener: () => void): void {
    for (const topic of topics) this.listeners.set(topic, [...(this.listeners.get(topic) ?? []), listener]);
  }

  /** The part that a node stands for. */
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

  /** What is known of a clip, for each figure that it moves. */
  exposuresOf(clip: { readonly name: string } | null): readonly Exposure[] {
    return clip ? this.exposures.filter(({ facts }) => facts.name === clip.name) : [];
  }

  /** What is known of the clip that is shown: of the chosen figure, else of one whose clip is limited. */
  get exposure(): Exposure | null {
    const all = this.exposuresOf(this.player.clip);
    return all.find(({ facts }) => facts.figure === this.figure) ?? all.find(({ facts }) => facts.limited) ?? all[0] ?? null;
  }

  chooseFigure(figure: string): void {
    this.figure = figure;
    this.tell("time");
  }

  /** Shows the clip as it was before it was limited beside it as it is, or no longer. */
  compare(on: boolean): void {
    this.comparison.want(on);
    this.tell("beside");
  }

  setShading(shading: Shading): void {
    this.shading = shading;
    this.model?.shade(shading);
    this.drawEdges();
    this.stage.invalidate();
    this.canvas.dataset["shading"] = shading;
    this.tell("look");
  }

  setParallel(parallel: boolean): void {
    this.view.setParallel(parallel);
    this.tell("look");
  }

  setBent(amount: number): void {
    this.bent = amount;
    this.stage.invalidate();
    this.tell("look");
  }

  /** Puts the camera where terrain looks as it is drawn. */
  lookAsDrawn(): void {
    this.setBent(1);
    this.setParallel(true);
    this.view.frame("drawn");
  }

  /** Colours that follow the page's. */
  setColors(accent: string, grid: string, ink: string): void {
    this.highlight.color(accent, ink);
    this.ground.color(grid);
    this.stage.invalidate();
  }

  posed(): void {
    this.pose.apply();
    this.canvas.dataset["posed"] = this.pose.names.join(" ");
    this.stage.moved();
    this.tell("pose");
  }

  /** The clip was stopped, started or moved by a person. */
  moved(change: () => void): void {
    this.pose.release();
    change();
    this.comparison.follow();
    this.pose.apply();
    this.stage.moved();
    this.tell("time");
  }

  /** Draws the model by itself while `draw` runs: no marks, no ground. */
  bare<T>(draw: () => T): T {
    this.highlight.show(false);
    this.ground.group.visible = false;
    try {
      return draw();
    } finally {
      this.highlight.show(true);
      this.ground.group.visible = true;
      this.stage.invalidate();
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
    // The same model; its parts may be bound by other strings now.
    if (isSame(wanted, this.awaited ?? this.shown)) return this.markAll();
    // Of a host that is away nothing is asked, and of the next one no model of the last: its addresses are others.
    if (this.state.link !== "open" || drawing.connection !== this.state.connection) return;
    this.awaited = wanted;
    this.loading.want(wanted);
  }

  private take(model: Model, bytes: ArrayBuffer, wanted: Wanted): void {
    if (wanted === this.awaited) this.awaited = null;
    if (wanted.drawing !== this.state.current) return model.dispose();
    const first = this.model === null;
    this.pose.release();
    for (const mark of ["hovered", "lit", "selected"] as const) this.highlight.clear(mark);
    this.highlight.edges([]);
    this.beside.remove();
    // The model before the last goes now, if no picture was made since.
    this.stage.settle();
    const before = this.model;
    before?.root.removeFromParent();
    if (before) model.takeOver(before);
    this.model = model;
    this.bytes = bytes;
    this.shown = wanted;
    this.failure = "";
    // The person may have changed it while the model was read.
    model.shade(this.shading);
    this.exposures = wanted.clips.map((facts) => new Exposure(facts));
    this.player.take(model, !wantsStillness());
    this.pose.apply();
    this.stage.scene.add(model.root);
    this.surround();
    this.comparison.take(wanted);
    this.drawEdges();
    if (first) this.view.frame("threeQuarter", false);
    this.markAll();
    this.canvas.dataset["revision"] = String(wanted.revision);
    this.canvas.setAttribute("aria-label", `Model of ${this.state.drawing?.name ?? "the drawing"}: ${count(model.triangles, "triangle")}`);
    this.stage.afterNext(() => {
      // Not before the new model has taken over its shaders, or they would be made anew.
      before?.dispose();
      // Shadows take longer than all else, and follow a picture later.
      this.stage.moved();
    });
    this.stage.drawNow();
    this.tell("model", "time", "beside");
  }

  private failed(error: unknown, wanted: Wanted): void {
    if (wanted !== this.awaited) return;
    this.awaited = null;
    if (wanted.drawing !== this.state.current || this.state.link === "lost") return;
    this.failure = error instanceof Error ? error.message : String(error);
    this.tell("model");
  }

  private remove(): void {
    for (const mark of ["hovered", "lit", "selected"] as const) this.highlight.clear(mark);
    this.highlight.edges([]);
    this.comparison.clear();
    this.exposures = [];
    this.figure = null;
    this.pose.reset();
    this.model?.dispose();
    this.model = null;
    this.bytes = null;
    this.shown = this.awaited = null;
    this.failure = "";
    this.player.clear();
    this.ground.group.visible = false;
    delete this.canvas.dataset["revision"];
    this.canvas.setAttribute("aria-label", "No model yet");
    this.stage.moved();
    this.tell("model", "time", "pose", "beside");
  }

  /** Lays the ground under all that is there, and tells the view of it. */
  private surround(): void {
    const { model } = this;
    const { boxes, offset } = this.beside;
    if (!model) return;
    const box = boxes ? new Box3().union(boxes[0]).union(boxes[1]) : model.box;
    this.ground.fit(box);
    this.view.bound(
      box,
      model.bend.isEmpty
        ? null
        : (towards) => {
            const points = model.bend.points(towards, this.bent);
            return boxes ? points.flatMap((point) => [point, point.clone().setX(point.x + offset)]) : points;
          },
    );
    this.canvas.dataset["beside"] = boxes ? String(offset) : "";
  }

  private drawEdges(): void {
    this.highlight.edges(this.shading === "edges" ? [...(this.model?.meshes ?? []), ...(this.beside.copy?.meshes ?? [])] : []);
  }

  private markAll(): void {
    for (const mark of ["hovered", "lit", "selected"] as const) this.mark(mark);
  }

  private mark(mark: Mark): void {
    const name = { hovered: this.state.hovered, lit: this.state.lit, selected: this.state.selected }[mark];
    const nodes = this.nodesOf(name);
    const { copy } = this.beside;
    this.highlight.set(mark, [
      ...nodes.flatMap((node) => this.model?.meshesOf(node) ?? []),
      ...(copy ? this.nodesOf(name, copy).flatMap((node) => copy.meshesOf(node)) : []),
    ]);
    this.canvas.dataset[mark] = nodes.map(nodeName).join(" ");
    this.stage.invalidate();
  }

  /** Bends what bends with the view. */
  private bend(camera: Camera): void {
    const { model } = this;
    if (!model || model.bend.isEmpty) return;
    const towards = new Vector3(0, 0, 1).applyQuaternion(camera.quaternion);
    const bends = [model, this.beside.copy].map((one) => one?.bend.follow(towards, this.bent));
    if (!bends.includes(true)) return;
    this.ground.bend(model.bend.inWorld());
    this.stage.renderer.shadowMap.needsUpdate = true;
  }

  private step(seconds: number): boolean {
    this.highlight.measure(this.stage.renderer);
    if (!this.player.playing) return false;
    const { keys, time } = this.player;
    this.pose.release();
    const more = this.player.advance(seconds);
    this.comparison.follow();
    this.pose.apply();
    // A drawing that is held is not drawn again.
    if (this.beside.copy || !keys.held || drawingAt(keys, time) !== drawingAt(keys, this.player.time)) this.stage.moved();
    this.tell("time");
    return more;
  }

  private tell(...topics: ViewerTopic[]): void {
    for (const topic of topics) for (const listener of this.listeners.get(topic) ?? []) listener();
  }
}
