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
/** If more than this part of the meshes does not fit in the place of what they were, all batches are made anew: moving what is in them takes longer. */
const MANY = 0.1;

/** Layers of meshes: those that are drawn by themselves, those in batches, and hidden ones. The camera only sees the first. */
export const LAYERS = { alone: 1, batched: 2, hidden: 0 } as const;

/** What all meshes of a batch have in common. */
interface Look {
  readonly key: string;
  /** What their materials have in common. */
  readonly surface: string;
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
  readonly look: Look;
  readonly geometries: Map<BufferGeometry, { readonly id: number; users: number }>;
}

export class Batches {
  readonly group = new Group();
  private readonly batches: Batch[] = [];
  private readonly places = new Map<Mesh, Place>();
  private common: ReadonlyMap<string, Material>;
  private wires = false;
  private lines: Material | null = null;

  /** Batches the meshes of a model. A copy of a model shares its materials. World matrices must be up to date. */
  constructor(meshes: readonly Mesh[], shared: ReadonlyMap<string, Material> = new Map()) {
    // Instances are placed in the world.
    this.group.matrixWorldAutoUpdate = false;
    this.common = this.gather(meshes, shared);
    this.follow();
  }

  /** The materials of the batches, by what their meshes have in common. */
  get materials(): ReadonlyMap<string, Material> {
    return this.common;
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
    for (const batch of this.batches) this.line(batch);
    this.countEnds();
  }

  /** Surfaces are drawn as wires, or no longer. */
  drawWires(on: boolean): void {
    if (on === this.wires) return;
    this.wires = on;
    this.countEnds();
  }

  /** Some of all meshes have other geometries or materials, and any may have moved. World matrices must be up to date. */
  change(changed: readonly Mesh[], all: readonly Mesh[]): void {
    if (all.length < LARGE) return;
    const looks = new Looks();
    const others = changed.filter((mesh) => !this.replace(mesh, looks));
    if (others.length > MANY * all.length) this.rebuild(all);
    else for (const mesh of others) this.move(mesh, looks);
    this.follow();
  }

  dispose(): void {
    this.group.removeFromParent();
    for (const { mesh } of this.batches) mesh.dispose();
  }

  private rebuild(meshes: readonly Mesh[]): void {
    for (const { mesh } of this.batches.splice(0)) {
      mesh.removeFromParent();
      mesh.dispose();
    }
    this.places.clear();
    for (const mesh of meshes) mesh.layers.mask = LAYERS.alone;
    this.common = this.gather(meshes, this.common);
    this.countEnds();
  }

  /** Makes batches of meshes that have enough in common. Returns the materials of these, of which some may be there already. */
  private gather(meshes: readonly Mesh[], shared: ReadonlyMap<string, Material>): ReadonlyMap<string, Material> {
    const looks = new Looks();
    const groups = new Map<string, { readonly look: Look; readonly meshes: Mesh[] }>();
    for (const mesh of meshes.length < LARGE ? [] : meshes) {
      const look = looks.of(mesh);
      if (!look) continue;
      const same = groups.get(look.key);
      if (same) same.meshes.push(mesh);
      else groups.set(look.key, { look, meshes: [mesh] });
    }
    const materials = new Map<string, Material>();
    for (const [key, { look, meshes }] of groups) {
      if (meshes.length < FEW) continue;
      const material = shared.get(key) ?? uncolored(look.material);
      materials.set(key, material);
      for (const part of divided(meshes)) this.build({ ...look, material }, part);
    }
    return materials;
  }

  private build(look: Look, meshes: readonly Mesh[]): void {
    const geometries = new Set(meshes.map(({ geometry }) => geometry));
    const room = (count: (geometry: BufferGeometry) => number) => Math.ceil([...geometries].reduce((sum, geometry) => sum + count(geometry), 0) * ROOM);
    const mesh = new BatchedMesh(meshes.length, room(vertices), room(indices), look.material);
    mesh.matrixWorldAutoUpdate = false;
    mesh.castShadow = true;
    // Culling each instance takes longer than drawing it; neither is the order of opaque surfaces worth its time.
    mesh.frustumCulled = mesh.perObjectFrustumCulled = mesh.sortObjects = false;
    const batch = { mesh, look, geometries: new Map() };
    this.batches.push(batch);
    this.group.add(mesh);
    for (const one of meshes) this.add(batch, one);
    if (this.lines) this.line(batch);
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

  /** Writes the new geometry of a mesh over its old one; false if it looks different, does not fit in there, or if others use either. */
  private replace(mesh: Mesh, looks: Looks): boolean {
    const place = this.places.get(mesh);
    if (!place) return false;
    const { batch, instance, geometry: before } = place;
    const { geometry } = mesh;
    if (looks.surface(mesh) !== batch.look.surface || !hasSameLayout(geometry, before) || isMirrored(mesh)) return false;
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

  /** Draws a mesh in another batch, or by itself. */
  private move(mesh: Mesh, looks: Looks): void {
    const place = this.places.get(mesh);
    if (place) this.remove(mesh, place);
    const key = looks.of(mesh)?.key;
    const batch = this.batches.findLast(({ look }) => look.key === key);
    if (batch) this.add(batch, mesh);
    else mesh.layers.mask = LAYERS.alone;
  }

  private put(mesh: Mesh, place: Place): void {
    place.batch.mesh.setColorAt(place.instance, colorOf(mesh));
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

  /** Gives a batch the material of its edges, or takes it. */
  private line({ mesh, look }: Batch): void {
    mesh.material = this.lines ? ([look.material, this.lines] as unknown as Material) : look.material;
    this.assignMaterials(mesh.geometry);
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

/** What meshes must share with others to be drawn with them. */
class Looks {
  private readonly surfaces = new Map<Material, string | null>();

  /** Null for a mesh that must be drawn by itself. */
  of(mesh: Mesh): Look | null {
    const { geometry, material } = mesh;
    const surface = this.surface(mesh);
    if (surface === null || Array.isArray(material) || mesh instanceof SkinnedMesh || isMirrored(mesh)) return null;
    if (Object.keys(geometry.morphAttributes).length > 0) return null;
    const layout: unknown[] = [surface];
    for (const [name, { array, itemSize, normalized }] of Object.entries(geometry.attributes).sort(([a], [b]) => (a < b ? -1 : 1))) layout.push(name, array.constructor.name, itemSize, normalized);
    layout.push(geometry.index !== null);
    for (let at: Object3D | null = mesh; at; at = at.parent) if (wayOf(at, "bend") ?? wayOf(at, "turn")) return null;
    return { key: layout.join(" "), surface, material };
  }

  /** What is seen of the material of a mesh, but for its colour; null if others cannot be drawn with it. */
  surface({ material }: Mesh): string | null {
    if (Array.isArray(material)) return null;
    let known = this.surfaces.get(material);
    if (known === undefined) this.surfaces.set(material, (known = surfaceOf(material)));
    return known;
  }
}

function surfaceOf(material: Material): string | null {
  const isPlain = material.type === "MeshStandardMaterial" || material.type === "MeshBasicMaterial";
  if (!isPlain || material.transparent || material.alphaTest > 0) return null;
  for (const [name, value] of Object.entries(material)) if (value instanceof Texture && name !== "envMap") return null;
  const features: unknown[] = [material.type, material.side, material.vertexColors];
  if (material instanceof MeshStandardMaterial) features.push(material.roughness, material.metalness, material.emissive.getHex(), material.emissiveIntensity);
  return features.join(" ");
}

const isMirrored = ({ matrixWorld }: Mesh): boolean => matrixWorld.determinant() <= 0;

/** Whether two geometries have the same attributes, of the same kinds. */
function hasSameLayout(one: BufferGeometry, other: BufferGeometry): boolean {
  if ((one.index === null) !== (other.index === null)) return false;
  const names = Object.keys(one.attributes);
  return names.length === Object.keys(other.attributes).length && names.every((name) => {
    const [a, b] = [one.attributes[name]!, other.attributes[name]];
    return b !== undefined && a.array.constructor === b.array.constructor && a.itemSize === b.itemSize && a.normalized === b.normalized;
  });
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
