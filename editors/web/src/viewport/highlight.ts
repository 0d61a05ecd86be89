// Marks parts: an outline that shows through other parts, and a lighter surface while the pointer or the editor's cursor is on the
// part.

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
} from "three";
import { mergeVertices } from "three/addons/utils/BufferGeometryUtils.js";
import { overlay } from "./model";

/** Widths of outlines in CSS pixels, and how much lighter the surface becomes. */
const MARK_STYLES = {
  hovered: { width: 2, light: 0.16 },
  lit: { width: 4, light: 0.3 },
  selected: { width: 3.5, light: 0 },
} as const;
/** Merging the vertices of larger meshes takes too long for a click; their outline may have gaps at edges. */
const MAX_CORNERS = 300_000;

export type Mark = "hovered" | "lit" | "selected";

export class Highlight {
  private readonly marked: Record<Mark, Mesh[]> = { hovered: [], lit: [], selected: [] };
  private readonly materials = {
    hovered: new MarkMaterials(1, MARK_STYLES.hovered.light),
    lit: new MarkMaterials(2, MARK_STYLES.lit.light),
    selected: new MarkMaterials(3, MARK_STYLES.selected.light),
  };
  /** For lines along all triangle edges. */
  readonly lines = new MeshBasicMaterial({ wireframe: true, transparent: true, opacity: 0.28, depthWrite: false });
  private lined: Mesh[] = [];

  color(color: string, ink: string): void {
    for (const { outline } of Object.values(this.materials)) outline.uniforms["color"]!.value.set(color);
    this.lines.color.set(ink);
  }

  /** Called before each frame with the size of the picture: the width of outlines is in its pixels. */
  measure(size: Vector2): void {
    for (const mark of Object.keys(MARK_STYLES) as Mark[]) {
      const width = 2 * MARK_STYLES[mark].width;
      this.materials[mark].outline.uniforms["step"]!.value.set(width / size.x, width / size.y);
    }
  }

  /** Marks these meshes and no others. */
  set(mark: Mark, meshes: readonly Mesh[]): void {
    this.clear(mark);
    const { tint, mask, outline } = this.materials[mark];
    for (const mesh of meshes) {
      if (tint.opacity > 0) this.add(mark, overlay(mesh, tint), 5);
      // Each mark masks its whole part before the outline is drawn, one mark after the other.
      this.add(mark, overlay(mesh, mask), 8 + 2 * mask.stencilRef);
      this.add(mark, overlay(mesh, outline, joined(mesh.geometry)), 9 + 2 * mask.stencilRef);
    }
  }

  clear(mark: Mark): void {
    for (const mesh of this.marked[mark]) {
      mesh.removeFromParent();
      if (mesh.material === this.materials[mark].outline) mesh.geometry.dispose();
    }
    this.marked[mark] = [];
  }

  /** Draws the triangle edges of these meshes and no others. */
  edges(meshes: readonly Mesh[]): void {
    for (const mesh of this.lined) mesh.removeFromParent();
    this.lined = meshes.map((mesh) => overlay(mesh, this.lines));
    for (const mesh of this.lined) mesh.renderOrder = 2;
  }

  /** Shows or hides all marks. */
  show(on: boolean): void {
    for (const mesh of Object.values(this.marked).flat()) mesh.visible = on;
  }

  private add(mark: Mark, mesh: Mesh, order: number): void {
    mesh.renderOrder = order;
    this.marked[mark].push(mesh);
  }
}

/** The materials of one mark. */
class MarkMaterials {
  readonly tint: MeshBasicMaterial;
  /** Masks the part itself, so that the outline is drawn outside of it only. */
  readonly mask: MeshBasicMaterial;
  readonly outline: ShaderMaterial;

  constructor(stencilRef: number, opacity: number) {
    this.tint = new MeshBasicMaterial({ transparent: true, opacity, depthWrite: false, side: DoubleSide });
    const over = { depthTest: false, depthWrite: false, transparent: true, side: DoubleSide, stencilWrite: true, stencilRef };
    this.mask = new MeshBasicMaterial({ ...over, colorWrite: false, stencilFunc: AlwaysStencilFunc, stencilZPass: ReplaceStencilOp });
    this.outline = new ShaderMaterial({
      ...over,
      stencilFunc: NotEqualStencilFunc,
      uniforms: { color: { value: new Color() }, step: { value: new Vector2() } },
      vertexShader: `
        #include <skinning_pars_vertex>
        uniform vec2 step;
        void main() {
          #include <beginnormal_vertex>
          #include <skinbase_vertex>
          #include <skinnormal_vertex>
          #include <begin_vertex>
          #include <skinning_vertex>
          gl_Position = projectionMatrix * modelViewMatrix * vec4(transformed, 1.0);
          vec2 outward = (projectionMatrix * vec4(normalMatrix * objectNormal, 0.0)).xy / step;
          float far = length(outward);
          if (far > 0.0) gl_Position.xy += outward / far * step * gl_Position.w;
        }`,
      fragmentShader: `
        uniform vec3 color;
        void main() {
          gl_FragColor = vec4(color, 1.0);
          #include <colorspace_fragment>
        }`,
    });
  }
}

/** The same surface with shared normals, so that its hull has no gaps at edges. */
function joined(geometry: BufferGeometry): BufferGeometry {
  const bare = new BufferGeometry();
  bare.setAttribute("position", geometry.getAttribute("position"));
  bare.setIndex(geometry.index);
  for (const name of ["skinIndex", "skinWeight"]) if (geometry.hasAttribute(name)) bare.setAttribute(name, geometry.getAttribute(name));
  if (bare.getAttribute("position").count > MAX_CORNERS) {
    if (geometry.hasAttribute("normal")) bare.setAttribute("normal", geometry.getAttribute("normal"));
    return bare;
  }
  const merged = mergeVertices(bare);
  merged.computeVertexNormals();
  return merged;
}
