// The canvas: one scene, drawn when something asked for it and not otherwise.

import { Scene, SRGBColorSpace, NoToneMapping, VSMShadowMap, WebGLRenderer, type Camera } from "three";
import type { View } from "./view";
import { Lights } from "./lights";

/** More pixels than this for each of the page's cost much and show little. */
const FINEST = 2;

/** Called before each picture, with the seconds since the last; true asks for one more. */
export type BeforeFrame = (seconds: number) => boolean;

export class Stage {
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

  /** Throws where the browser has no WebGL 2. */
  constructor(readonly place: HTMLElement, readonly canvas: HTMLCanvasElement, private readonly view: View) {
    this.renderer = new WebGLRenderer({ canvas, antialias: !isSoftware(), alpha: true, stencil: true, powerPreference: "low-power" });
    this.renderer.setClearAlpha(0);
    // No curve between light and screen: a part's colour is that of the drawing.
    this.renderer.outputColorSpace = SRGBColorSpace;
    this.renderer.toneMapping = NoToneMapping;
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.type = VSMShadowMap;
    // Made anew when something moved, not whenever one looks from elsewhere.
    this.renderer.shadowMap.autoUpdate = false;
    this.lights = new Lights(this.scene, this.renderer);
    new ResizeObserver(() => this.resize()).observe(place);
    this.watchPixels();
    canvas.addEventListener("webglcontextrestored", () => this.moved());
    view.onChange(() => this.invalidate());
    this.resize();
  }

  /** Asks for a picture at the next chance. */
  readonly invalidate = (): void => {
    this.stale = true;
    this.ask();
  };

  /** Asks for the steps before a picture; it is drawn only if one of them wants it. */
  readonly ask = (): void => {
    if (this.asked) return;
    this.asked = true;
    requestAnimationFrame(this.frame);
  };

  /** Asks for a picture, as something in it moved. */
  readonly moved = (): void => {
    this.renderer.shadowMap.needsUpdate = true;
    this.invalidate();
  };

  beforeFrame(step: BeforeFrame): void {
    this.steps.push(step);
  }

  /** Draws without waiting for the browser to ask: what was saved is seen a moment sooner. */
  drawNow(): void {
    this.stale = true;
    this.frame(performance.now());
  }

  /** Does something after the next picture, once. */
  afterNext(step: () => void): void {
    this.once.push(step);
  }

  /** Does what waits for the next picture at once: in a tab that is not looked at there is none. */
  settle(): void {
    const { once } = this;
    this.once = [];
    for (const step of once) step();
  }

  /** Draws now. */
  draw(camera: Camera = this.view.camera): void {
    this.lights.follow(camera);
    this.follow(camera);
    this.renderer.render(this.scene, camera);
  }

  private readonly frame = (now: number): void => {
    this.asked = false;
    // After a rest the first step is none: no jump.
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
    // At once: a canvas that was resized is empty until it is drawn.
    this.draw();
    this.invalidate();
  }

  /** Tells when the page moves to a screen with other pixels. */
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

/** Whether there is no graphics card: then smooth edges cost five times as much as all else, and pictures come late. */
function isSoftware(): boolean {
  const context = document.createElement("canvas").getContext("webgl2");
  const named = context?.getExtension("WEBGL_debug_renderer_info");
  const name: unknown = named ? context?.getParameter(named.UNMASKED_RENDERER_WEBGL) : "";
  context?.getExtension("WEBGL_lose_context")?.loseContext();
  return typeof name === "string" && /swiftshader|llvmpipe|softpipe|software|microsoft basic render/i.test(name);
}
