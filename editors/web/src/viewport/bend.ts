// Terrain that bends with the view (docs/view-dependent.md): from 45° above, tops and fronts are as large as drawn.

import { Box3, Matrix4, Mesh, SkinnedMesh, Vector3, type BufferGeometry, type Object3D } from "three";
import { wayOf } from "./extension";

/** The elevation with the largest stretch, in radians. */
const MOST = Math.PI / 4;
/** By how much a bounding sphere must grow: three.js underestimates its radius under a shear. */
const STRETCHED_RADIUS = 2 / Math.sqrt(3);

/** The stretch for a viewer at an elevation in radians. */
export function ratioAt(elevation: number): number {
  return 1 + (Math.SQRT2 - 1) * (1 - Math.abs(Math.abs(elevation) - MOST) / MOST);
}

/**
 * The bend for the unit vector towards the viewer in a node's frame, with +Y up: a scale along (up − h)/√2, where h is the viewer's
 * horizontal direction. `amount` scales the effect, 0 to 1.
 */
export function bendFor(towards: Vector3, amount: number): Matrix4 {
  const horizontal = new Vector3(towards.x, 0, towards.z);
  const bend = new Matrix4();
  // From straight above nothing is stretched.
  if (horizontal.lengthSq() < 1e-16) return bend;
  const { x, y, z } = new Vector3(0, 1, 0).sub(horizontal.normalize()).multiplyScalar(Math.SQRT1_2);
  const more = amount * (ratioAt(Math.asin(Math.min(Math.max(towards.y, -1), 1))) - 1);
  // prettier-ignore
  return bend.set(
    1 + more * x * x, more * x * y, more * x * z, 0,
    more * y * x, 1 + more * y * y, more * y * z, 0,
    more * z * x, more * z * y, 1 + more * z * z, 0,
    0, 0, 0, 1,
  );
}

interface Bent {
  readonly node: Object3D;
  /** Its bounds in the world without the bend. */
  readonly box: Box3;
  last: Matrix4;
}

/** The view-dependent nodes of a model. */
export class Bend {
  private readonly bent: Bent[] = [];
  /** The bounds of everything else. */
  private readonly still = new Box3();

  /** World matrices must be up to date. */
  constructor(root: Object3D) {
    const geometries = new Set<BufferGeometry>();
    const others: Mesh[] = [];
    const walk = (object: Object3D): void => {
      if (wayOf(object, "bend")) {
        object.matrixAutoUpdate = false;
        this.bent.push({ node: object, box: new Box3().setFromObject(object), last: new Matrix4() });
        // Child nodes bend with it, once.
        object.traverse((below) => {
          if (below instanceof Mesh) geometries.add(below.geometry);
        });
        return;
      }
      if (object instanceof Mesh) others.push(object);
      object.children.forEach(walk);
    };
    walk(root);
    if (this.isEmpty) return;
    for (const mesh of others) this.still.union(boxOf(mesh));
    for (const geometry of geometries) {
      geometry.computeBoundingSphere();
      if (geometry.boundingSphere) geometry.boundingSphere.radius *= STRETCHED_RADIUS;
    }
  }

  get isEmpty(): boolean {
    return this.bent.length === 0;
  }

  /** Bends all nodes for a viewer in a direction of the world; true if anything changed. */
  follow(towards: Vector3, amount: number): boolean {
    let changed = false;
    for (const one of this.bent) {
      const { node } = one;
      node.parent?.updateWorldMatrix(true, false);
      const bend = bendFor(inFrame(frameOf(node), towards), amount);
      node.updateMatrix();
      node.matrix.multiply(bend);
      node.matrixWorldNeedsUpdate = true;
      changed ||= !bend.equals(one.last);
      one.last = bend;
    }
    return changed;
  }

  /** The first node's bend in the world, for the ground under the model. */
  inWorld(): Matrix4 {
    const [first] = this.bent;
    return first ? inWorld(frameOf(first.node), first.last) : new Matrix4();
  }

  /** Points that enclose the model when it is bent for a viewer in a direction of the world. */
  points(towards: Vector3, amount: number): Vector3[] {
    const points = this.still.isEmpty() ? [] : cornersOf(this.still);
    for (const { node, box } of this.bent) {
      const frame = frameOf(node);
      const bend = inWorld(frame, bendFor(inFrame(frame, towards), amount));
      if (!box.isEmpty()) points.push(...cornersOf(box).map((corner) => corner.applyMatrix4(bend)));
    }
    return points;
  }
}

export function cornersOf({ min, max }: Box3): Vector3[] {
  return [0, 1, 2, 3, 4, 5, 6, 7].map((corner) => new Vector3(corner & 1 ? max.x : min.x, corner & 2 ? max.y : min.y, corner & 4 ? max.z : min.z));
}

/** The bounds of a mesh in the world, without its children. */
function boxOf(mesh: Mesh): Box3 {
  const bounded = mesh instanceof SkinnedMesh ? mesh : mesh.geometry;
  bounded.computeBoundingBox();
  return (bounded.boundingBox ?? new Box3()).clone().applyMatrix4(mesh.matrixWorld);
}

/** The world transform of a node, without its bend. */
function frameOf({ parent, position, quaternion, scale }: Object3D): Matrix4 {
  const own = new Matrix4().compose(position, quaternion, scale);
  return parent ? own.premultiply(parent.matrixWorld) : own;
}

/** A matrix in a frame, expressed in the world. */
const inWorld = (frame: Matrix4, matrix: Matrix4): Matrix4 => frame.clone().multiply(matrix).multiply(frame.clone().invert());

const inFrame = (frame: Matrix4, direction: Vector3): Vector3 => direction.clone().transformDirection(frame.clone().invert());
