// Reads what changed between two models; src/page/delta/mod.rs tells what is where in it.

import { Box3, BufferAttribute, BufferGeometry, Mesh, Sphere, Vector3, type Material } from "three";
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";

/** What changed between two models with the same hierarchy, by the numbers of nodes in the file. */
export interface Delta {
  /** The nodes whose own fields changed, with all of these. */
  readonly moved: readonly MovedNode[];
  /** What the meshes of nodes have now. */
  readonly meshes: ReadonlyMap<number, readonly Surface[]>;
}

/** Fields of a node, as in the file. */
export interface MovedNode {
  readonly node: number;
  readonly matrix?: number[];
  readonly translation?: number[];
  readonly rotation?: number[];
  readonly scale?: number[];
  readonly extras?: Readonly<Record<string, unknown>>;
}

/** What a mesh is made of. */
export interface Surface {
  readonly geometry: BufferGeometry;
  readonly material: Material;
}

/** The text of a delta. */
interface Text {
  readonly nodes: readonly MovedNode[];
  /** A glTF that has nothing but materials. */
  readonly materials: object;
  readonly layouts: readonly Layout[];
  readonly primitives: readonly Primitive[];
  readonly meshes: readonly (readonly [node: number, primitives: readonly number[]])[];
}

interface Layout {
  readonly attributes: readonly (readonly [name: string, type: number, components: number, normalized: boolean])[];
  readonly indices: number | null;
}

type Primitive = readonly [material: number, layout: number, vertices: number, corners: number, min: readonly number[] | null, max: readonly number[] | null];

/** "okdl", as a number. */
const MAGIC = 0x6f6b646c;
/** How many bytes are before the text. */
const HEAD = 8;
/** The names that three.js has for attributes; it takes others in small letters. */
const NAMES: Readonly<Record<string, string>> = { TEXCOORD_0: "uv", TEXCOORD_1: "uv1", COLOR_0: "color", WEIGHTS_0: "skinWeight", JOINTS_0: "skinIndex" };
const ARRAYS = { 5120: Int8Array, 5121: Uint8Array, 5122: Int16Array, 5123: Uint16Array, 5125: Uint32Array, 5126: Float32Array } as const;

/** Whether bytes are a delta, and no model. */
export const isDelta = (bytes: ArrayBuffer): boolean => bytes.byteLength >= HEAD && new DataView(bytes).getUint32(0) === MAGIC;

/** Reads a delta. The geometries share its memory. */
export async function readDelta(bytes: ArrayBuffer): Promise<Delta> {
  const length = new DataView(bytes).getUint32(4, true);
  const text = JSON.parse(new TextDecoder().decode(new Uint8Array(bytes, HEAD, length))) as Text;
  const { parser } = await new GLTFLoader().parseAsync(JSON.stringify(text.materials), "");
  const materials = (await parser.getDependencies("material")) as Material[];
  // The loader adapts a material to the attributes of what has it: without normals, faces are flat.
  const adapted = new Map<string, Material>();
  const adapt = (geometry: BufferGeometry, material: number, layout: number): Material => {
    const key = `${material} ${layout}`;
    let known = adapted.get(key);
    if (!known) {
      const mesh = new Mesh(geometry, materials[material]);
      parser.assignFinalMaterial(mesh);
      adapted.set(key, (known = mesh.material as Material));
    }
    return known;
  };
  let at = HEAD + length;
  const attribute = (type: number, components: number, count: number, normalized = false): BufferAttribute => {
    const array = new ARRAYS[type as keyof typeof ARRAYS](bytes, at, components * count);
    at += (array.byteLength + 3) & ~3;
    return new BufferAttribute(array, components, normalized);
  };
  const surfaces = text.primitives.map(([material, layout, vertices, corners, min, max]): Surface => {
    const geometry = new BufferGeometry();
    const { attributes, indices } = text.layouts[layout]!;
    for (const [name, type, components, normalized] of attributes) geometry.setAttribute(NAMES[name] ?? name.toLowerCase(), attribute(type, components, vertices, normalized));
    if (indices !== null) geometry.setIndex(attribute(indices, 1, corners));
    if (min && max) {
      geometry.boundingBox = new Box3(new Vector3().fromArray(min), new Vector3().fromArray(max));
      geometry.boundingSphere = geometry.boundingBox.getBoundingSphere(new Sphere());
    }
    return { geometry, material: adapt(geometry, material, layout) };
  });
  return { moved: text.nodes, meshes: new Map(text.meshes.map(([node, primitives]) => [node, primitives.map((number) => surfaces[number]!)])) };
}
