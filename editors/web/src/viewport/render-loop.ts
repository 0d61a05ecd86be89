// The canvas and its scene, which is drawn on demand only.

import { Color, NoToneMapping, Scene, SRGBColorSpace, Vector2, VSMShadowMap, WebGLRenderer, type Camera, type MeshStandardMaterial, type Object3D } from "three";
import type { View } from "./view";
import { whenDrawn } from "./drawn";
import { Lights } from "./lights";
import { SmoothEdges } from "./smooth-edges";

/** The highest pixel ratio: more costs much and shows little. */
const FINEST = 2;

/** How long the first frame of a model is waited for before its shadows are drawn, in milliseconds. */
const SHADOWS = 250;

/** Called before each frame with the seconds since the last one; true requests another frame. */
export type BeforeFrame = (seconds: number) => boolean;

/** The graphics context with what is made in it. */
interface Graphics {
  readonly renderer: WebGLRenderer;
  readonly lights: Lights;
  /** Null where the graphics card smooths edges. */
  readonly smooth: SmoothEdges | null;
}

export class RenderLoop {
  readonly scene = new Scene();
  /** Called with the camera before the scene is drawn. */
  follow: (camera: Camera) => void = () => {};
  /** Called when everything in the scene has its place in the world, if anything moved. */
  placed: () => void = () => {};
  /** Null until there is something to draw. */
  private graphics: Graphics | null = null;
  private ended = false;
  private readonly sizes = new ResizeObserver(() => this.resize());
  private readonly steps: BeforeFrame[] = [];
  private once: (() => void)[] = [];
  private asked = false;
  private stale = false;
  /** Whether the shadows are those of an earlier frame. */
  private shadowsAreStale = false;
  /** Gives up the shadows that are waited for. */
  private giveUpShadows: () => void = () => {};
  /** Whether anything but the camera changed since the last frame: in large models placing everything takes longer than drawing it. */
  private placesAreStale = true;
  private last = 0;
  private frames = 0;

  constructor(readonly place: HTMLElement, readonly canvas: HTMLCanvasElement, private readonly view: View) {
    this.sizes.observe(place);
    this.watchPixels();
    canvas.addEventListener("webglcontextrestored", () => this.moved());
    view.onChange(() => this.redraw());
    this.scene.matrixWorldAutoUpdate = false;
    this.resize();
  }

  /** Creates the graphics context, unless there is one. Throws an error with a readable message if the browser has no WebGL 2. */
  start(): void {
    if (this.graphics || this.ended) return;
    const { canvas } = this;
    const software = isSoftware();
    const context = canvas.getContext("webgl2", { antialias: !software, alpha: true, depth: true, stencil: true, powerPreference: "low-power" });
    if (!context) throw new Error("this browser has no WebGL 2, or it is disabled. Turn on hardware acceleration, or try another browser.");
    const renderer = new WebGLRenderer({ canvas, context });
    renderer.setClearAlpha(0);
    // No tone mapping: a part has exactly the colour of the drawing.
    renderer.outputColorSpace = SRGBColorSpace;
    renderer.toneMapping = NoToneMapping;
    renderer.shadowMap.enabled = true;
    renderer.shadowMap.type = VSMShadowMap;
    // Updated when something moves, not when the camera does.
    renderer.shadowMap.autoUpdate = false;
    const smooths = software && renderer.extensions.has("EXT_color_buffer_float");
    const smooth = smooths ? new SmoothEdges(renderer, () => this.view.camera, () => this.draw(), () => (canvas.dataset["smooth"] = "true")) : null;
    this.graphics = { renderer, lights: new Lights(this.scene, renderer), smooth };
    this.resize();
  }

  /** Draws nothing more, and gives the graphics context back. */
  end(): void {
    this.ended = true;
    this.sizes.disconnect();
    this.giveUpShadows();
    if (!this.graphics) return;
    const { renderer, smooth } = this.graphics;
    this.graphics = null;
    smooth?.stop();
    this.settle();
    renderer.dispose();
    renderer.forceContextLoss();
  }

  /** The size of the picture in CSS pixels. */
  get size(): Vector2 {
    return this.graphics?.renderer.getSize(new Vector2()) ?? new Vector2(1, 1);
  }

  /** Lets a material reflect the environment if that is seen. */
  reach(material: MeshStandardMaterial): void {
    this.graphics?.lights.reach(material);
  }

  /** Compiles the shaders of objects before they are drawn, so that the page does not stall. */
  async compile(objects: Object3D): Promise<void> {
    await this.graphics?.renderer.compileAsync(objects, this.view.camera, this.scene);
  }

  /** Runs `draw` with a background of this colour. */
  withBackground<T>(color: string, draw: () => T): T {
    const renderer = this.graphics?.renderer;
    renderer?.setClearColor(new Color(color), 1);
    try {
      return draw();
    } finally {
      renderer?.setClearColor(0x000000, 0);
      this.invalidate();
    }
  }

  /** Requests a frame. */
  readonly invalidate = (): void => {
    this.placesAreStale = true;
    this.redraw();
  };

  /** Requests a frame of the same scene. */
  private redraw(): void {
    this.stale = true;
    this.graphics?.smooth?.stop();
    this.ask();
  }

  /** Requests a call of the steps before a frame; the frame is drawn only if one of them asks for it. */
  readonly ask = (): void => {
    if (this.asked || this.ended) return;
    this.asked = true;
    requestAnimationFrame(this.frame);
  };

  /** Requests a frame because something in the scene moved. */
  readonly moved = (): void => {
    this.moves();
    this.invalidate();
  };

  /**
   * Requests the shadows of another model once the frame that shows it is drawn: they take longer than everything else, and in software
   * the picture would wait for them. While one model follows the other, those in between have none of their own.
   */
  shadowsLater(): void {
    if (!this.graphics) return;
    this.giveUpShadows();
    this.canvas.dataset["shadows"] = "late";
    this.giveUpShadows = whenDrawn(this.graphics.renderer.getContext() as WebGL2RenderingContext, SHADOWS, this.moved);
  }

  /** Something in the scene moved; the frame that shows it was requested, or is being drawn. */
  moves(): void {
    this.placesAreStale = this.shadowsAreStale = true;
  }

  beforeFrame(step: BeforeFrame): void {
    this.steps.push(step);
  }

  /** Draws at once, without waiting for an animation frame: a saved drawing shows a moment earlier. */
  drawNow(): void {
    this.stale = this.placesAreStale = true;
    this.frame(performance.now());
  }

  /** Calls `step` once after the next frame. */
  afterNext(step: () => void): void {
    this.once.push(step);
  }

  /** Makes the calls that wait for the next frame: in a hidden tab there is none. */
  settle(): void {
    const { once } = this;
    this.once = [];
    for (const step of once) step();
  }

  /** Draws the scene. */
  draw(camera: Camera = this.view.camera): void {
    if (!this.graphics) return;
    const { renderer, lights } = this.graphics;
    lights.follow(camera);
    this.follow(camera);
    if (this.placesAreStale) {
      this.scene.updateMatrixWorld();
      this.placed();
      this.placesAreStale = false;
    }
    renderer.shadowMap.needsUpdate = this.shadowsAreStale;
    if (this.shadowsAreStale) this.canvas.dataset["shadows"] = "";
    this.shadowsAreStale = false;
    renderer.render(this.scene, camera);
  }

  private readonly frame = (now: number): void => {
    this.asked = false;
    // The first step after a pause takes no time, so that nothing jumps.
    const seconds = this.last === 0 ? 0 : Math.min((now - this.last) / 1000, 0.25);
    let more = false;
    for (const step of this.steps) more = step(seconds) || more;
    this.last = more ? now : 0;
    if (this.stale && this.graphics) {
      this.stale = false;
      this.draw();
      this.canvas.dataset["smooth"] = "false";
      this.graphics.smooth?.restart();
      this.canvas.dataset["frames"] = String(++this.frames);
      this.canvas.dataset["view"] = this.view.describe();
      this.settle();
    }
    if (more) this.ask();
  };

  private resize(): void {
    const { clientWidth: width, clientHeight: height } = this.place;
    if (width === 0 || height === 0) return;
    this.graphics?.renderer.setPixelRatio(Math.min(devicePixelRatio, FINEST));
    this.graphics?.renderer.setSize(width, height, false);
    this.view.resize(width / height);
    // At once: resizing clears the canvas.
    this.draw();
    this.invalidate();
  }

  /** Resizes when the page moves to a screen with another pixel ratio. */
  private watchPixels(): void {
    matchMedia(`(resolution: ${devicePixelRatio}dppx)`).addEventListener(
      "change",
      () => {
        this.resize();
        this.watchPixels();
      },
      { once: true },
    );
  }
}

/** Whether WebGL runs on the processor: then antialiasing takes five times as long as everything else. */
function isSoftware(): boolean {
  // Most browsers refuse this without creating a context, which would take a second.
  const context = document.createElement("canvas").getContext("webgl2", { failIfMajorPerformanceCaveat: true });
  if (!context) return true;
  const named = context.getExtension("WEBGL_debug_renderer_info");
  const name: unknown = named ? context.getParameter(named.UNMASKED_RENDERER_WEBGL) : "";
  context.getExtension("WEBGL_lose_context")?.loseContext();
  return typeof name === "string" && /swiftshader|llvmpipe|softpipe|software|microsoft basic render/i.test(name);
}
