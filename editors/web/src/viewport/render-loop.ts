// The canvas and its scene, which is drawn on demand only.

import { Scene, SRGBColorSpace, NoToneMapping, VSMShadowMap, WebGLRenderer, type Camera } from "three";
import type { View } from "./view";
import { Lights } from "./lights";

/** The highest pixel ratio: more costs much and shows little. */
const FINEST = 2;

/** Called before each frame with the seconds since the last one; true requests another frame. */
export type BeforeFrame = (seconds: number) => boolean;

export class RenderLoop {
  readonly scene = new Scene();
  readonly renderer: WebGLRenderer;
  readonly lights: Lights;
  /** Called with the camera before the scene is drawn. */
  follow: (camera: Camera) => void = () => {};
  private readonly steps: BeforeFrame[] = [];
  private once: (() => void)[] = [];
  private asked = false;
  private stale = false;
  private last = 0;
  private frames = 0;

  /** Throws if the browser has no WebGL 2. */
  constructor(readonly place: HTMLElement, readonly canvas: HTMLCanvasElement, private readonly view: View) {
    this.renderer = new WebGLRenderer({ canvas, antialias: !isSoftware(), alpha: true, stencil: true, powerPreference: "low-power" });
    this.renderer.setClearAlpha(0);
    // No tone mapping: a part has exactly the colour of the drawing.
    this.renderer.outputColorSpace = SRGBColorSpace;
    this.renderer.toneMapping = NoToneMapping;
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.type = VSMShadowMap;
    // Updated when something moves, not when the camera does.
    this.renderer.shadowMap.autoUpdate = false;
    this.lights = new Lights(this.scene, this.renderer);
    new ResizeObserver(() => this.resize()).observe(place);
    this.watchPixels();
    canvas.addEventListener("webglcontextrestored", () => this.moved());
    view.onChange(() => this.invalidate());
    this.resize();
  }

  /** Requests a frame. */
  readonly invalidate = (): void => {
    this.stale = true;
    this.ask();
  };

  /** Requests a call of the steps before a frame; the frame is drawn only if one of them asks for it. */
  readonly ask = (): void => {
    if (this.asked) return;
    this.asked = true;
    requestAnimationFrame(this.frame);
  };

  /** Requests a frame because something in the scene moved. */
  readonly moved = (): void => {
    this.renderer.shadowMap.needsUpdate = true;
    this.invalidate();
  };

  beforeFrame(step: BeforeFrame): void {
    this.steps.push(step);
  }

  /** Draws at once, without waiting for an animation frame: a saved drawing shows a moment earlier. */
  drawNow(): void {
    this.stale = true;
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
    this.lights.follow(camera);
    this.follow(camera);
    this.renderer.render(this.scene, camera);
  }

  private readonly frame = (now: number): void => {
    this.asked = false;
    // The first step after a pause takes no time, so that nothing jumps.
    const seconds = this.last === 0 ? 0 : Math.min((now - this.last) / 1000, 0.25);
    let more = false;
    for (const step of this.steps) more = step(seconds) || more;
    this.last = more ? now : 0;
    if (this.stale) {
      this.stale = false;
      this.draw();
      this.canvas.dataset["frames"] = String(++this.frames);
      this.canvas.dataset["view"] = this.view.describe();
      this.settle();
    }
    if (more) this.ask();
  };

  private resize(): void {
    const { clientWidth: width, clientHeight: height } = this.place;
    if (width === 0 || height === 0) return;
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, FINEST));
    this.renderer.setSize(width, height, false);
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
  const context = document.createElement("canvas").getContext("webgl2");
  const named = context?.getExtension("WEBGL_debug_renderer_info");
  const name: unknown = named ? context?.getParameter(named.UNMASKED_RENDERER_WEBGL) : "";
  context?.getExtension("WEBGL_lose_context")?.loseContext();
  return typeof name === "string" && /swiftshader|llvmpipe|softpipe|software|microsoft basic render/i.test(name);
}
