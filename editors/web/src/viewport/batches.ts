// Draws the plain meshes of a large model with few draw calls. The meshes stay in the hierarchy, where poses, clips, marks and the pointer
// use them, but are drawn as instances in batches.

import { BatchedMesh, Color, Group, Mesh, MeshBasicMaterial, MeshStandardMaterial, SkinnedMesh, Texture, type BufferGeometry, type Material, type Object3D } from "three";
import { wayOf } from "./extension";

/** Models with fewer meshes are drawn mesh by mesh. */
const LARGE = 300;
/** Fewer meshes of a look are drawn mesh by mesh. */
const FEW = 8;
/** The most vertices in a batch, unless one mesh has more: a batch that grows is copied. */
const FULL = 1 << 20;
/** How much room batches have for meshes that change, relative to what is in them. */
const ROOM = 1.1;

/** Layers of meshes: those that are drawn by themselves, those in batches, and hidden ones. The camera only sees the first. */
export const LAYERS = { alone: 1, batched: 2, hidden: 0 } as const;

/** What all meshes of a batch have in common. */
interface Look {
  readonly key: string;
  readonly material: Material;
}

/** Where a mesh is drawn. */
interface Place {
  readonly batch: Batch;
  readonly instance: number;
  readonly geometry: BufferGeometry;
}

/** A batch, with the numbers of its geometries and how many meshes use each. */
interface Batch {
  readonly mesh: BatchedMesh;
  readonly key: string;
  readonly geometries: Map<BufferGeometry, { readonly id: number; users: number }>;
}

export class Batches {
  readonly group = new Group();
  /** The materials of the batches, by what their meshes have in common. */
  readonly materials: ReadonlyMap<string, Material>;
  private readonly batches: Batch[] = [];
  private readonly places = new Map<Mesh, Place>();
  private wires = false;
  private lines: Material | null = null;

  /** Batches the meshes of a model. A copy of a model shares its materials. World matrices must be up to date. */
  constructor(meshes: readonly Mesh[], shared: ReadonlyMap<string, Material> = new Map()) {
    // Instances are placed in the world.
    this.group.matrixWorldAutoUpdate = false;
    const looks = new Map<string, { readonly material: Material; readonly meshes: Mesh[] }>();
    for (const mesh of meshes.length < LARGE ? [] : meshes) {
      const look = lookOf(mesh);
      if (!look) continue;
      const same = looks.get(look.key);
      if (same) same.meshes.push(mesh);
      else looks.set(look.key, { material: look.material, meshes: [mesh] });
    }
    const materials = new Map<string, Material>();
    for (const [key, { material, meshes }] of looks) {
      if (meshes.length < FEW) continue;
      const common = shared.get(key) ?? uncolored(material);
      materials.set(key, common);
      for (const part of divided(meshes)) this.build(key, common, part);
    }
    this.materials = materials;
    this.follow();
  }

  get isEmpty(): boolean {
    return this.batches.length === 0;
  }

  /** Places all instances where their meshes are. World matrices must be up to date. */
  follow(): void {
    for (const [{ matrixWorld }, { batch, instance }] of this.places) batch.mesh.setMatrixAt(instance, matrixWorld);
  }

  /** Shows or hides a mesh, in a batch or not. */
  show(mesh: Mesh, on: boolean): void {
    const place = this.places.get(mesh);
    place?.batch.mesh.setVisibleAt(place.instance, on);
    mesh.layers.mask = !on ? LAYERS.hidden : place ? LAYERS.batched : LAYERS.alone;
  }

  /** Draws lines along the edges of all triangles too, in this material, or no longer. */
  drawEdges(lines: Material | null): void {
    if (lines === this.lines) return;
    this.lines = lines;
    for (const { mesh, key } of this.batches) {
      const surface = this.materials.get(key)!;
      mesh.material = lines ? ([surface, lines] as unknown as Material) : surface;
      this.assignMaterials(mesh.geometry);
    }
    this.countEnds();
  }

  /** Surfaces are drawn as wires, or no longer. */
  drawWires(on: boolean): void {
    if (on === this.wires) return;
    this.wires = on;
    this.countEnds();
  }

  /** The geometry or material of a mesh changed. */
  change(mesh: Mesh): void {
    const place = this.places.get(mesh);
    const look = lookOf(mesh);
    if (place && look?.key === place.batch.key && this.replace(mesh, place)) return;
    if (place) this.remove(mesh, place);
    const batch = look && this.batches.findLast(({ key }) => key === look.key);
    if (batch) this.add(batch, mesh);
    else mesh.layers.mask = LAYERS.alone;
  }

  dispose(): void {
    this.group.removeFromParent();
    for (const { mesh } of this.batches) mesh.dispose();
  }

  private build(key: string, material: Material, meshes: readonly Mesh[]): void {
    const geometries = new Set(meshes.map(({ geometry }) => geometry));
    const room = (count: (geometry: BufferGeometry) => number) => Math.ceil([...geometries].reduce((sum, geometry) => sum + count(geometry), 0) * ROOM);
    const mesh = new BatchedMesh(meshes.length, room(vertices), room(indices), material);
    mesh.matrixWorldAutoUpdate = false;
    mesh.castShadow = true;
    // Culling each instance takes longer than drawing it; neither is the order of opaque surfaces worth its time.
    mesh.frustumCulled = mesh.perObjectFrustumCulled = mesh.sortObjects = false;
    const batch = { mesh, key, geometries: new Map() };
    this.batches.push(batch);
    this.group.add(mesh);
    for (const one of meshes) this.add(batch, one);
  }

  private add(batch: Batch, mesh: Mesh): void {
    const { geometry } = mesh;
    let known = batch.geometries.get(geometry);
    if (!known) {
      makeRoom(batch.mesh, geometry);
      this.assignMaterials(batch.mesh.geometry);
      known = { id: batch.mesh.addGeometry(geometry), users: 0 };
      batch.geometries.set(geometry, known);
    }
    known.users++;
    const { instanceCount, maxInstanceCount } = batch.mesh;
    if (instanceCount === maxInstanceCount) batch.mesh.setInstanceCount(Math.ceil((maxInstanceCount + 1) * ROOM));
    this.put(mesh, { batch, instance: batch.mesh.addInstance(known.id), geometry });
    mesh.layers.mask = LAYERS.batched;
  }

  /** Writes the new geometry of a mesh over its old one; false if others use that too, or have the new one, or if it does not fit in there. */
  private replace(mesh: Mesh, { batch, instance, geometry: before }: Place): boolean {
    const { geometry } = mesh;
    const known = batch.geometries.get(before);
    if (geometry !== before) {
      if (known?.users !== 1 || batch.geometries.has(geometry)) return false;
      const { reservedVertexCount, reservedIndexCount } = batch.mesh.getGeometryRangeAt(known.id)!;
      if (vertices(geometry) > reservedVertexCount || indices(geometry) > reservedIndexCount) return false;
      batch.mesh.setGeometryAt(known.id, geometry);
      batch.geometries.delete(before);
      batch.geometries.set(geometry, known);
    }
    this.put(mesh, { batch, instance, geometry });
    return true;
  }

  private put(mesh: Mesh, place: Place): void {
    place.batch.mesh.setColorAt(place.instance, colorOf(mesh));
    place.batch.mesh.setMatrixAt(place.instance, mesh.matrixWorld);
    this.places.set(mesh, place);
  }

  private remove(mesh: Mesh, { batch, instance, geometry }: Place): void {
    batch.mesh.deleteInstance(instance);
    this.places.delete(mesh);
    const known = batch.geometries.get(geometry);
    if (!known || --known.users > 0) return;
    batch.mesh.deleteGeometry(known.id);
    batch.geometries.delete(geometry);
  }

  /** With several materials, groups say which part of a geometry has which: here all of it has each. */
  private assignMaterials(geometry: BufferGeometry): void {
    geometry.clearGroups();
    if (this.lines) for (const material of [0, 1]) geometry.addGroup(0, Infinity, material);
  }

  /** Batches remember what to draw, but wires have twice as many ends as surfaces. While they cull, they count anew. */
  private countEnds(): void {
    for (const { mesh } of this.batches) mesh.perObjectFrustumCulled = this.wires || this.lines !== null;
    for (const { batch, instance } of this.places.values()) {
      const isVisible = batch.mesh.getVisibleAt(instance);
      batch.mesh.setVisibleAt(instance, !isVisible).setVisibleAt(instance, isVisible);
    }
  }
}

/** What a mesh must share with others to be drawn with them; null if it must be drawn by itself. */
function lookOf(mesh: Mesh): Look | null {
  const { geometry, material } = mesh;
  if (mesh instanceof SkinnedMesh || Array.isArray(material) || Object.keys(geometry.morphAttributes).length > 0) return null;
  const isPlain = material.type === "MeshStandardMaterial" || material.type === "MeshBasicMaterial";
  if (!isPlain || material.transparent || material.alphaTest > 0 || mesh.matrixWorld.determinant() <= 0) return null;
  const features: unknown[] = [material.type, material.side, material.vertexColors];
  for (const [name, value] of Object.entries(material)) if (value instanceof Texture && name !== "envMap") return null;
  if (material instanceof MeshStandardMaterial) features.push(material.roughness, material.metalness, material.emissive.getHex(), material.emissiveIntensity);
  for (const [name, { array, itemSize, normalized }] of Object.entries(geometry.attributes).sort(([a], [b]) => (a < b ? -1 : 1))) features.push(name, array.constructor.name, itemSize, normalized);
  features.push(geometry.index !== null);
  for (let at: Object3D | null = mesh; at; at = at.parent) if (wayOf(at, "bend") ?? wayOf(at, "turn")) return null;
  return { key: features.join(" "), material };
}

/** A material whose surfaces have the colours of their instances. */
function uncolored(material: Material): Material {
  const common = material.clone();
  if (common instanceof MeshStandardMaterial || common instanceof MeshBasicMaterial) common.color.setScalar(1);
  return common;
}

function colorOf({ material }: Mesh): Color {
  return material instanceof MeshStandardMaterial || material instanceof MeshBasicMaterial ? material.color : new Color();
}

const vertices = (geometry: BufferGeometry): number => geometry.getAttribute("position").count;
const indices = (geometry: BufferGeometry): number => geometry.index?.count ?? 0;

/** Meshes in groups that are not too large. */
function divided(meshes: readonly Mesh[]): Mesh[][] {
  const groups: Mesh[][] = [];
  let room = 0;
  for (const mesh of meshes) {
    room -= vertices(mesh.geometry);
    if (room < 0 || groups.length === 0) {
      groups.push([]);
      room = FULL - vertices(mesh.geometry);
    }
    groups.at(-1)!.push(mesh);
  }
  return groups;
}

/** Lets another geometry fit in. */
function makeRoom(batch: BatchedMesh, geometry: BufferGeometry): void {
  const fits = () => batch.unusedVertexCount >= vertices(geometry) && batch.unusedIndexCount >= indices(geometry);
  if (fits()) return;
  batch.optimize();
  if (fits()) return;
  const larger = (used: number, more: number) => Math.ceil((used + more) * ROOM);
  const { position } = batch.geometry.attributes;
  batch.setGeometrySize(larger(position!.count - batch.unusedVertexCount, vertices(geometry)), larger((batch.geometry.index?.count ?? 0) - batch.unusedIndexCount, indices(geometry)));
}
