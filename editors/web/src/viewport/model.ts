// A loaded model: which of its nodes are parts, its shading, and its resources on the graphics card.

import { Box3, BufferAttribute, DoubleSide, Group, Mesh, MeshStandardMaterial, PerspectiveCamera, SkinnedMesh, Texture, TextureLoader, Vector3, type AnimationClip, type BufferGeometry, type InterleavedBufferAttribute, type KeyframeTrack, type Material, type Object3D, type TypedArray } from "three";
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";
import { Bend } from "./bend";
import { Turns } from "./turn";

export type Shading = "smooth" | "flat" | "wire" | "edges";

/** Reads a GLB. Throws an error with a readable message if it is invalid. */
export async function readModel(bytes: ArrayBuffer): Promise<Model> {
  const { scene, animations } = await readFile(bytes);
  return new Model(scene, animations);
}

/** The scene and the clips of a GLB. */
export async function readFile(bytes: ArrayBuffer): Promise<{ readonly scene: Group; readonly animations: readonly AnimationClip[] }> {
  const loader = new GLTFLoader();
  loader.register((parser) => {
    // Textures are read as <img> elements: the other loader fetches blobs, which the page's content security policy forbids.
    parser.textureLoader = new TextureLoader(parser.options.manager);
    return { name: "okoshi-images" };
  });
  const { scene, animations } = await loader.parseAsync(bytes, "");
  return { scene, animations };
}

export class Model {
  /** Nodes by their names in the file. */
  private readonly nodes = new Map<string, Object3D>();
  /** Nodes by the element that they were made from: a part and its copies. */
  private readonly made = new Map<string, Object3D[]>();
  private readonly materials = new Map<Material, { readonly flat: boolean }>();
  readonly meshes: Mesh[] = [];
  private readonly cameras: PerspectiveCamera[] = [];
  /** The cameras that film clips. */
  private readonly films = new Map<AnimationClip, PerspectiveCamera>();
  /** Geometries that the next model uses too. */
  private readonly reusedGeometries = new Set<BufferGeometry>();
  readonly box: Box3;
  readonly bend: Bend;
  readonly turns: Turns;
  readonly clips: readonly AnimationClip[];
  readonly triangles: number;

  constructor(readonly root: Group, clips: readonly AnimationClip[]) {
    let triangles = 0;
    root.traverse((object) => {
      const name = nodeName(object);
      if (name && !this.nodes.has(name)) this.nodes.set(name, object);
      const element = elementOf(object);
      if (element !== null) {
        const same = this.made.get(element);
        if (same) same.push(object);
        else this.made.set(element, [object]);
      }
      if (object instanceof PerspectiveCamera) this.cameras.push(object);
      if (!(object instanceof Mesh)) return;
      this.meshes.push(object);
      object.castShadow = true;
      triangles += (object.geometry.index ?? object.geometry.getAttribute("position")).count / 3;
      for (const material of materialsOf(object)) {
        if (this.materials.has(material)) continue;
        this.materials.set(material, { flat: "flatShading" in material && material.flatShading === true });
        // Transparent surfaces show their inside. Others are double-sided only if the file says so: the rest are closed, and
        // skipping back faces halves the triangles to draw.
        if (material.transparent || material.alphaTest > 0) material.side = DoubleSide;
        material.polygonOffset = true;
        material.polygonOffsetFactor = material.polygonOffsetUnits = 1;
      }
    });
    this.triangles = Math.round(triangles);
    root.updateMatrixWorld(true);
    this.box = new Box3().setFromObject(root);
    this.bend = new Bend(root);
    this.turns = new Turns(root);
    this.clips = this.turns.others(clips);
    if (this.cameras.length > 0) {
      for (const clip of this.clips) {
        const moved = new Set(clip.tracks.map(targetOf));
        const camera = this.cameras.find((one) => isCarried(one, moved));
        if (camera) this.films.set(clip, camera);
      }
    }
    if (this.box.isEmpty()) this.box.set(new Vector3(-0.5, 0, -0.5), new Vector3(0.5, 1, 0.5));
  }

  /** The camera that films a clip: one that it moves, or what carries it. */
  cameraOf(clip: AnimationClip): PerspectiveCamera | undefined {
    return this.films.get(clip);
  }

  /** The tracks of a clip that change how the model looks, without those of cameras. */
  tracksOf(clip: AnimationClip): readonly KeyframeTrack[] {
    if (this.cameras.length === 0) return clip.tracks;
    const cameras = new Set(this.cameras.map(({ name }) => name));
    return clip.tracks.filter((track) => !cameras.has(targetOf(track)));
  }

  node(name: string): Object3D | undefined {
    return this.nodes.get(name);
  }

  /** The nodes of a part, including copies. */
  nodesOf(part: { readonly name: string; readonly element: string }): readonly Object3D[] {
    const made = this.made.get(part.element);
    if (made) return made;
    const node = this.nodes.get(part.name);
    return node ? [node] : [];
  }

  /** The meshes of a node, without those of child parts. */
  meshesOf(node: Object3D): Mesh[] {
    const meshes: Mesh[] = [];
    const collect = (object: Object3D): void => {
      if (object instanceof Mesh && !isOverlay(object)) meshes.push(object);
      for (const child of object.children) if (elementOf(child) === null) collect(child);
    };
    collect(node);
    return meshes;
  }

  shade(shading: Shading): void {
    for (const [material, { flat }] of this.materials) {
      if ("flatShading" in material) material.flatShading = flat || shading === "flat";
      if ("wireframe" in material) material.wireframe = shading === "wire";
      material.needsUpdate = true;
    }
  }

  /** Calls `light` with each lit material. */
  light(light: (material: MeshStandardMaterial) => void): void {
    for (const material of this.materials.keys()) if (material instanceof MeshStandardMaterial) light(material);
  }

  /** Reuses the geometries that did not change since another model: they are on the graphics card already. */
  reuseGeometries(before: Model): void {
    const same = new Map<BufferGeometry, BufferGeometry>();
    this.meshes.forEach((mesh, index) => {
      const last = before.meshes[index]?.geometry;
      if (last && !same.has(mesh.geometry) && isSame(mesh.geometry, last)) same.set(mesh.geometry, last);
    });
    for (const mesh of this.meshes) {
      const last = same.get(mesh.geometry);
      if (!last) continue;
      mesh.geometry = last;
      before.reusedGeometries.add(last);
    }
  }

  dispose(): void {
    for (const { geometry } of this.meshes) if (!this.reusedGeometries.has(geometry)) geometry.dispose();
    for (const mesh of this.meshes) if (mesh instanceof SkinnedMesh) mesh.skeleton.dispose();
    for (const material of this.materials.keys()) {
      // The environment map belongs to the lights.
      if (material instanceof MeshStandardMaterial) material.envMap = null;
      for (const value of Object.values(material)) if (value instanceof Texture) value.dispose();
      material.dispose();
    }
    this.root.removeFromParent();
  }
}

/** Marks objects that are drawn over a model and are not part of it. */
const OVER = "isOverlay";
export const isOverlay = (object: Object3D): boolean => object.userData[OVER] === true;

/** The name in the file; three.js removes some characters from names that its animations use. */
export function nodeName(object: Object3D): string {
  const name: unknown = object.userData["name"];
  return typeof name === "string" ? name : object.name;
}

/** The name, as three.js has it, of the node that a track moves. */
const targetOf = ({ name }: KeyframeTrack): string => name.slice(0, name.lastIndexOf("."));

/** Whether an object or one that carries it has one of the names. */
function isCarried(object: Object3D, names: ReadonlySet<string>): boolean {
  for (let at: Object3D | null = object; at; at = at.parent) if (names.has(at.name)) return true;
  return false;
}

/** The id of the element that a node was made from; null if the node is not that of a part. */
export function elementOf(object: Object3D): string | null {
  const okoshi: unknown = object.userData["okoshi"];
  if (typeof okoshi !== "object" || okoshi === null || !("element" in okoshi)) return null;
  return typeof okoshi.element === "string" ? okoshi.element : null;
}

/** The part node that an object belongs to. */
export function partNode(object: Object3D): Object3D | null {
  for (let at: Object3D | null = object; at; at = at.parent) if (elementOf(at) !== null) return at;
  return null;
}

/** Whether two geometries have equal data. */
function isSame(one: BufferGeometry, other: BufferGeometry): boolean {
  const names = Object.keys(one.attributes);
  if (names.length !== Object.keys(other.attributes).length || Object.keys(one.morphAttributes).length > 0) return false;
  return isSameList(one.index, other.index) && names.every((name) => isSameList(one.getAttribute(name), other.attributes[name] ?? null));
}

function isSameList(one: BufferAttribute | InterleavedBufferAttribute | null, other: BufferAttribute | InterleavedBufferAttribute | null): boolean {
  if (!one || !other) return one === other;
  if (!(one instanceof BufferAttribute && other instanceof BufferAttribute)) return false;
  if (one.itemSize !== other.itemSize || one.normalized !== other.normalized || one.array.constructor !== other.array.constructor) return false;
  if (one.array.byteLength !== other.array.byteLength) return false;
  // glTF aligns all numbers to their size, so numbers of four bytes can be compared as such.
  const [a, b] = one.array.BYTES_PER_ELEMENT === 4 ? [words(one.array), words(other.array)] : [one.array, other.array];
  for (let at = 0; at < a.length; at++) if (a[at] !== b[at]) return false;
  return true;
}

/** The bits of numbers of four bytes. */
const words = ({ buffer, byteOffset, length }: TypedArray): Uint32Array => new Uint32Array(buffer, byteOffset, length);

const materialsOf = ({ material }: Mesh): Material[] => (Array.isArray(material) ? material : [material]);

/** A mesh of the same shape in the same place, to be drawn over another one. The pointer ignores it, and copies leave it out. */
export function overlay(mesh: Mesh, material: Material, geometry = mesh.geometry): Mesh {
  const copy = mesh instanceof SkinnedMesh ? new SkinnedMesh(geometry, material) : new Mesh(geometry, material);
  if (copy instanceof SkinnedMesh) copy.bind((mesh as SkinnedMesh).skeleton, (mesh as SkinnedMesh).bindMatrix);
  copy.raycast = () => {};
  copy.userData[OVER] = true;
  mesh.add(copy);
  return copy;
}
