// How a part is shown to be meant: a tint while the pointer or the editor's cursor is on it, an outline while it is selected.

import {
  AlwaysStencilFunc,
  BufferGeometry,
  Color,
  DoubleSide,
  Mesh,
  MeshBasicMaterial,
  NotEqualStencilFunc,
  ReplaceStencilOp,
  ShaderMaterial,
  Vector2,
  type Object3D,
  type WebGLRenderer,
} from "three";
import { mergeVertices } from "three/addons/utils/BufferGeometryUtils.js";
import { overlay, type Model } from "./model";

/** The outline's width in pixels of the page. */
const WIDTH = 2.5;
/** Joining the corners of larger meshes takes too long for a click; their outline may have gaps at edges. */
const MOST_CORNERS = 300_000;

export type Mark = "hovered" | "lit" | "selected";

export class Highlight {
  private readonly marked: Record<Mark, Mesh[]> = { hovered: [], lit: [], selected: [] };
  private readonly tints = { hovered: tint(0.3), lit: tint(0.45) };
  /** Marks where the part itself is, so that only what lies outside it is drawn. */
  private readonly mask = new MeshBasicMaterial({
    colorWrite: false,
    depthWrite: false,
    depthTest: false,
    transparent: true,
    side: DoubleSide,
    stencilWrite: true,
    stencilRef: 1,
    stencilFunc: AlwaysStencilFunc,
    stencilZPass: ReplaceStencilOp,
  });
  private readonly outline = new ShaderMaterial({
    uniforms: { color: { value: new Color() }, step: { value: new Vector2() } },
    vertexShader: `
      uniform vec2 step;
      void main() {
        gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
        vec2 outward = (projectionMatrix * vec4(normalMatrix * normal, 0.0)).xy / step;
        float far = length(outward);
        if (far > 0.0) gl_Position.xy += outward / far * step * gl_Position.w;
      }`,
    fragmentShader: `
      uniform vec3 color;
      void main() {
        gl_FragColor = vec4(color, 1.0);
        #include <colorspace_fragment>
      }`,
    depthTest: false,
    depthWrite: false,
    transparent: true,
    side: DoubleSide,
    stencilWrite: true,
    stencilRef: 1,
    stencilFunc: NotEqualStencilFunc,
  });

  /** Lines along all triangles. */
  private readonly lines = new MeshBasicMaterial({ wireframe: true, transparent: true, opacity: 0.28, depthWrite: false });
  private lined: Mesh[] = [];

  color(color: string, ink: string): void {
    for (const material of [this.tints.hovered, this.tints.lit]) material.color.set(color);
    this.lines.color.set(ink);
    (this.outline.uniforms["color"]!.value as Color).set(color);
  }

  /** Called before each picture: the outline's width is one of the screen. */
  measure(renderer: WebGLRenderer): void {
    const size = renderer.getSize(new Vector2());
    (this.outline.uniforms["step"]!.value as Vector2).set((2 * WIDTH) / size.x, (2 * WIDTH) / size.y);
  }

  /** Marks these nodes, and no others. */
  set(mark: Mark, model: Model, nodes: readonly Object3D[]): void {
    this.clear(mark);
    for (const mesh of nodes.flatMap((node) => model.meshesOf(node))) {
      if (mark === "selected") {
        this.add(mark, overlay(mesh, this.mask), 10);
        this.add(mark, overlay(mesh, this.outline, joined(mesh.geometry)), 11);
      } else {
        this.add(mark, overlay(mesh, this.tints[mark]), 5);
      }
    }
  }

  clear(mark: Mark): void {
    for (const mesh of this.marked[mark]) {
      mesh.removeFromParent();
      if (mesh.material === this.outline) mesh.geometry.dispose();
    }
    this.marked[mark] = [];
  }

  /** Draws the triangles' edges over a model, or takes them away. */
  edges(model: Model | null, on: boolean): void {
    for (const mesh of this.lined) mesh.removeFromParent();
    this.lined = on && model ? model.meshes.map((mesh) => overlay(mesh, this.lines)) : [];
    for (const mesh of this.lined) mesh.renderOrder = 2;
  }

  /** Pictures that are saved leave marks out. */
  show(on: boolean): void {
    for (const mesh of Object.values(this.marked).flat()) mesh.visible = on;
  }

  private add(mark: Mark, mesh: Mesh, order: number): void {
    mesh.renderOrder = order;
    this.marked[mark].push(mesh);
  }
}

function tint(opacity: number): MeshBasicMaterial {
  return new MeshBasicMaterial({ transparent: true, opacity, depthWrite: false, side: DoubleSide });
}

/** The same surface with one normal in each place, so that its hull has no gaps at edges. */
function joined(geometry: BufferGeometry): BufferGeometry {
  const bare = new BufferGeometry();
  bare.setAttribute("position", geometry.getAttribute("position"));
  bare.setIndex(geometry.index);
  if (bare.getAttribute("position").count > MOST_CORNERS) {
    if (geometry.hasAttribute("normal")) bare.setAttribute("normal", geometry.getAttribute("normal"));
    return bare;
  }
  const merged = mergeVertices(bare);
  merged.computeVertexNormals();
  return merged;
}
