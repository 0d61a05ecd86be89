// Smooth edges without antialiasing, which software rendering cannot afford while anything moves: when the picture has been still for a
// moment, it is drawn again and again, each time moved by a fraction of a pixel, and the average is shown.

import { CustomBlending, FramebufferTexture, HalfFloatType, NoBlending, OneFactor, ShaderMaterial, Vector2, WebGLRenderTarget, type OrthographicCamera, type PerspectiveCamera, type Texture, type WebGLRenderer } from "three";
import { FullScreenQuad } from "three/addons/postprocessing/Pass.js";
import { whenDrawn } from "./drawn";

/** How long the picture must have been still, in milliseconds. */
const PAUSE = 200;
/** Pictures that take longer to draw, in milliseconds, are not smoothed: the next movement would have to wait. */
const SLOW = 250;
/** How far the pictures are moved, in sixteenths of a pixel: each in a row and a column of its own. */
const OFFSETS = [[1, -3], [-1, 3], [5, 1], [-3, -5], [-5, 5], [-7, -1], [3, 7], [7, -7]] as const;

export class SmoothEdges {
  private readonly copied = new ShaderMaterial({ ...shader(), blending: CustomBlending, blendSrc: OneFactor, blendDst: OneFactor });
  private readonly averaged = new ShaderMaterial({ ...shader(), blending: NoBlending });
  private readonly quad = new FullScreenQuad();
  private picture = new FramebufferTexture(1, 1);
  private sums = new WebGLRenderTarget(1, 1);
  private timer: ReturnType<typeof setTimeout> | undefined;
  private giveUp: () => void = () => {};
  private frame = 0;

  /** `draw` draws the scene with the camera, `done` is called when the edges are smooth. */
  constructor(
    private readonly renderer: WebGLRenderer,
    private readonly camera: () => PerspectiveCamera | OrthographicCamera,
    private readonly draw: () => void,
    private readonly done: () => void,
  ) {}

  /** The picture changed: smooths its edges after a pause. */
  restart(): void {
    this.stop();
    this.whenDrawn(() => (this.timer = setTimeout(() => this.next(0), PAUSE)));
  }

  /** The picture is about to change. */
  stop(): void {
    this.giveUp();
    clearTimeout(this.timer);
    cancelAnimationFrame(this.frame);
  }

  /** One picture after the other, so that the page is never blocked for long. */
  private next(number: number): void {
    this.frame = requestAnimationFrame(() => {
      this.add(number);
      if (number + 1 < OFFSETS.length) this.whenDrawn(() => this.next(number + 1));
      else this.done();
    });
  }

  /** Calls `then` when everything is drawn, unless that takes too long. */
  private whenDrawn(then: () => void): void {
    this.giveUp();
    this.giveUp = whenDrawn(this.renderer.getContext() as WebGL2RenderingContext, SLOW, (isDrawn) => isDrawn && then());
  }

  /** Adds a picture, and shows the average of all until now. */
  private add(number: number): void {
    const { renderer } = this;
    const { width, height } = renderer.getDrawingBufferSize(new Vector2());
    if (number === 0) this.fit(width, height);
    const camera = this.camera();
    const [right, down] = OFFSETS[number]!;
    camera.setViewOffset(width, height, right / 16, down / 16, width, height);
    this.draw();
    camera.clearViewOffset();
    renderer.copyFramebufferToTexture(this.picture);
    renderer.autoClear = false;
    renderer.setRenderTarget(this.sums);
    if (number === 0) renderer.clear();
    this.fill(this.copied, this.picture, 1);
    renderer.setRenderTarget(null);
    this.fill(this.averaged, this.sums.texture, 1 / (number + 1));
    renderer.autoClear = true;
  }

  private fit(width: number, height: number): void {
    if (this.sums.width === width && this.sums.height === height) return;
    this.picture.dispose();
    this.sums.dispose();
    this.picture = new FramebufferTexture(width, height);
    this.sums = new WebGLRenderTarget(width, height, { type: HalfFloatType, depthBuffer: false });
  }

  private fill(material: ShaderMaterial, map: Texture, weight: number): void {
    material.uniforms["map"]!.value = map;
    material.uniforms["weight"]!.value = weight;
    this.quad.material = material;
    this.quad.render(this.renderer);
  }
}

/** Copies a picture with a weight, as it is: its colours are those of the screen, multiplied by its opacity. */
const shader = () => ({
  uniforms: { map: { value: null }, weight: { value: 1 } },
  depthTest: false,
  depthWrite: false,
  vertexShader: `
    varying vec2 place;
    void main() {
      place = uv;
      gl_Position = vec4(position.xy, 0.0, 1.0);
    }`,
  fragmentShader: `
    uniform sampler2D map;
    uniform float weight;
    varying vec2 place;
    void main() {
      gl_FragColor = weight * texture2D(map, place);
    }`,
});
