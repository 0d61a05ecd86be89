// A loaded model: which of its nodes are parts, its shading, and its resources on the graphics card.

import { Box3, BufferAttribute, DoubleSide, Group, Matrix4, Mesh, MeshStandardMaterial, PerspectiveCamera, Quaternion, SkinnedMesh, Texture, Vector3, type AnimationClip, type BufferGeometry, type InterleavedBufferAttribute, type KeyframeTrack, type Material, type Object3D, type TypedArray } from "three";
import { Batches } from "./batches";
import { Bend } from "./bend";
import type { Delta, MovedNode } from "./delta";
import { meshesAt, type ModelFile } from "./model-file";
import { Turns } from "./turn";

export type Shading = "smooth" | "flat" | "wire" | "edges";

export class Model {
  /** Nodes by their names in the file. */
  private readonly nodes = new Map<string, Object3D>();
  /** The meshes of nodes that bend: they follow their bones alone, so that they are not below their nodes. */
  /** How nodes are turned where nothing moves them. */
  private readonly rests = new Map<Object3D, Quaternion>();
  private readonly bent = new Map<Object3D, Mesh[]>();
  /** Nodes by the element that they were made from: a part and its copies. */
  private readonly made = new Map<string, Object3D[]>();
  private readonly materials = new Map<Material, { readonly flat: boolean }>();
  readonly meshes: Mesh[] = [];
  readonly batches: Batches;
  private readonly cameras: PerspectiveCamera[] = [];
  /** The cameras that film clips. */
  private readonly films = new Map<AnimationClip, PerspectiveCamera>();
  /** Geometries that the next model uses too. */
  private readonly reusedGeometries = new Set<BufferGeometry>();
  private shading: Shading = "smooth";
  readonly box = new Box3();
  readonly bend: Bend;
  readonly turns: Turns;
  readonly clips: readonly AnimationClip[];
  triangles = 0;

  /** `fileNodes`: the nodes by their numbers in the file. A copy gets the model that it is a copy of. */
  constructor(readonly root: Group, clips: readonly AnimationClip[], private readonly fileNodes: ModelFile["nodes"] = [], original?: Model) {
    root.traverse((object) => {
      if (object instanceof PerspectiveCamera) this.cameras.push(object);
      if (!(object instanceof Mesh)) return;
      this.meshes.push(object);
      object.castShadow = true;
      for (const material of materialsOf(object)) this.adopt(material);
    });
    this.measure();
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
    this.batches = new Batches(this.meshes, original?.batches.materials);
    for (const material of this.batches.materials.values()) this.adopt(material);
  }

  /** Changes the model to the next one with the same hierarchy. No pose, clip or mark may be applied to it meanwhile. */
  update({ moved, meshes }: Delta): void {
    for (const fields of moved) {
      const node = this.fileNodes[fields.node];
      if (node) setFields(node, fields);
    }
    const changed: Mesh[] = [];
    const replaced = new Set<BufferGeometry>();
    for (const [number, next] of meshes) {
      const node = this.fileNodes[number];
      if (node) meshesAt(node, next.length).forEach((mesh, at) => {
        replaced.add(mesh.geometry);
        mesh.geometry = next[at]!.geometry;
        mesh.material = next[at]!.material;
        for (const material of materialsOf(mesh)) this.adopt(material);
        changed.push(mesh);
      });
    }
    for (const { geometry } of this.meshes) replaced.delete(geometry);
    for (const geometry of replaced) geometry.dispose();
    this.measure();
    this.batches.change(changed, this.meshes);
    for (const material of this.batches.materials.values()) this.adopt(material);
    const used = new Set([...this.meshes.flatMap(materialsOf), ...this.batches.materials.values()]);
    for (const material of this.materials.keys()) if (!used.has(material)) this.discard(material);
  }

  /** Adds the model to a scene. */
  addTo(scene: Object3D): void {
    scene.add(this.root, this.batches.group);
  }

  /** Removes the model from its scene. */
  remove(): void {
    this.root.removeFromParent();
    this.batches.group.removeFromParent();
  }

  /** The rotation of a node as it is drawn, whatever a clip or a person does to it. */
  restOf(node: Object3D): Quaternion {
    return this.rests.get(node) ?? new Quaternion();
  }

  /** What is drawn. */
  get drawn(): Object3D {
    return this.batches.isEmpty ? this.root : this.batches.group;
  }

  /** Finds parts, bounds and triangles anew. */
  private measure(): void {
    this.nodes.clear();
    this.made.clear();
    this.bent.clear();
    this.rests.clear();
    this.root.traverse((object) => {
      this.rests.set(object, object.quaternion.clone());
      const owner = bonesOf(object)?.[0];
      if (owner) this.bent.set(owner, [...(this.bent.get(owner) ?? []), object as Mesh]);
      const name = nodeName(object);
      if (name && !this.nodes.has(name)) this.nodes.set(name, object);
      const element = elementOf(object);
      if (element === null) return;
      const same = this.made.get(element);
      if (same) same.push(object);
      else this.made.set(element, [object]);
    });
    this.root.updateMatrixWorld(true);
    this.box.setFromObject(this.root);
    if (this.box.isEmpty()) this.box.set(new Vector3(-0.5, 0, -0.5), new Vector3(0.5, 1, 0.5));
    this.triangles = Math.round(this.meshes.reduce((sum, { geometry }) => sum + (geometry.index ?? geometry.getAttribute("position")).count / 3, 0));
  }

  /** Makes a material look like the others. */
  private adopt(material: Material): void {
    if (this.materials.has(material)) return;
    this.materials.set(material, { flat: "flatShading" in material && material.flatShading === true });
    // Transparent surfaces show their inside. Others are double-sided only if the file says so: the rest are closed, and
    // skipping back faces halves the triangles to draw.
    if (material.transparent || material.alphaTest > 0) material.side = DoubleSide;
    material.polygonOffset = true;
    material.polygonOffsetFactor = material.polygonOffsetUnits = 1;
    if (this.shading !== "smooth") this.shadeMaterial(material);
  }

  private discard(material: Material): void {
    this.materials.delete(material);
    // The environment map belongs to the lights.
    if (material instanceof MeshStandardMaterial) material.envMap = null;
    for (const value of Object.values(material)) if (value instanceof Texture) value.dispose();
    material.dispose();
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
    return [...meshes, ...(this.bent.get(node) ?? [])];
  }

  shade(shading: Shading): void {
    this.shading = shading;
    for (const material of this.materials.keys()) this.shadeMaterial(material);
    this.batches.drawWires(shading === "wire");
  }

  private shadeMaterial(material: Material): void {
    const flat = this.materials.get(material)?.flat === true;
    if ("flatShading" in material) material.flatShading = flat || this.shading === "flat";
    if ("wireframe" in material) material.wireframe = this.shading === "wire";
    material.needsUpdate = true;
  }

  /** Calls `light` with each lit material. */
  light(light: (material: MeshStandardMaterial) => void): void {
    for (const material of this.materials.keys()) if (material instanceof MeshStandardMaterial) light(material);
  }

  /** Reuses the geometries that did not change since another model: they are on the graphics card already. */
  reuseGeometries(before: Model): void {
    if (!this.batches.isEmpty) return;
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
    for (const material of this.materials.keys()) this.discard(material);
    this.batches.dispose();
    this.remove();
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

/** Sets the fields of a node that a file may change. */
function setFields(node: Object3D, { matrix, translation = [0, 0, 0], rotation = [0, 0, 0, 1], scale = [1, 1, 1], extras }: MovedNode): void {
  if (matrix) new Matrix4().fromArray(matrix).decompose(node.position, node.quaternion, node.scale);
  else {
    node.position.fromArray(translation);
    node.quaternion.fromArray(rotation);
    node.scale.fromArray(scale);
  }
  const { name } = node.userData as { readonly name?: unknown };
  node.userData = { ...(name === undefined ? {} : { name }), ...extras };
}

/** What okoshi says about a node. */
function about(object: Object3D, field: "bone_of" | "mesh_of" | "shares"): unknown {
  const okoshi = object.userData["okoshi"] as Readonly<Record<string, unknown>> | undefined;
  return okoshi?.[field];
}

/** The bones of a mesh that bends, beginning with the node of its part; undefined for other meshes. */
function bonesOf(object: Object3D): readonly Object3D[] | undefined {
  if (!(object instanceof SkinnedMesh) || isOverlay(object)) return undefined;
  // A mesh with several materials is a group of meshes.
  const isBent = about(object, "mesh_of") ?? (object.parent && about(object.parent, "mesh_of"));
  return isBent === undefined || isBent === null ? undefined : object.skeleton.bones;
}

/** How many nodes make the turn of a node's joint together: the node and those above it. */
export const sharesOf = (node: Object3D): number => {
  const shares = about(node, "shares");
  return typeof shares === "number" && shares > 1 ? shares : 1;
};

/** The node that turns what is at a corner of a mesh: that of its part, or a bone of it. */
export function limbAt(object: Object3D, corner: number): Object3D | null {
  const bones = bonesOf(object);
  if (!bones) return partNode(object);
  const { geometry } = object as SkinnedMesh;
  const [numbers, weights] = [geometry.getAttribute("skinIndex"), geometry.getAttribute("skinWeight")];
  let [at, most] = [0, 0];
  for (let component = 0; component < weights.itemSize; component++) {
    const weight = weights.getComponent(corner, component);
    if (weight > most) [at, most] = [numbers.getComponent(corner, component), weight];
  }
  // The nodes above a bone that make its turn with it cannot be turned by themselves.
  while (at > 0 && at < bones.length - 1 && about(bones[at]!, "shares") === undefined) at++;
  // A garment follows the bones of what wears it, which turns with it.
  const isWorn = bones[1] && bones[1].parent !== bones[0];
  return (at === 0 && isWorn ? bones[0]!.parent : bones[at]) ?? null;
}

/** The part node that an object belongs to. */
export function partNode(object: Object3D): Object3D | null {
  for (let at: Object3D | null = bonesOf(object)?.[0] ?? object; at; at = at.parent) if (elementOf(at) !== null) return at;
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
