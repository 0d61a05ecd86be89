// Limbs that were turned by hand. Turns are kept by the names of nodes, apart from the model, so that the next model gets them too.

import { Quaternion, Vector3, type Object3D } from "three";
import { nodeName, type Model } from "./model";

/** A limb's own axis: away from its joint. */
export const LIMB = new Vector3(0, 1, 0);

export class Pose {
  /** What comes after a node's own rotation. */
  private readonly turns = new Map<string, Quaternion>();
  /** The rotations that nodes have without their turns: from the file, or from the clip that plays. */
  private readonly bases = new Map<Object3D, Quaternion>();

  constructor(private readonly model: () => Model | null) {}

  get isEmpty(): boolean {
    return this.turns.size === 0;
  }

  get names(): string[] {
    return [...this.turns.keys()];
  }

  /** Takes all turns out of the model: what comes next reads and writes the nodes' own rotations. */
  release(): void {
    for (const [node, base] of this.bases) node.quaternion.copy(base);
    this.bases.clear();
  }

  /** Puts all turns in. */
  apply(): void {
    this.release();
    for (const [name, turn] of this.turns) {
      const node = this.model()?.node(name);
      if (!node) continue;
      this.bases.set(node, node.quaternion.clone());
      node.quaternion.multiply(turn);
    }
  }

  /** Turns a node by radians about an axis in the world, from where it is now. */
  turnInWorld(node: Object3D, axis: Vector3, angle: number): void {
    node.parent?.updateWorldMatrix(true, false);
    const parent = node.parent?.getWorldQuaternion(new Quaternion()) ?? new Quaternion();
    const turn = new Quaternion().setFromAxisAngle(axis, angle);
    this.set(node, parent.clone().invert().multiply(turn).multiply(parent).multiply(node.quaternion));
  }

  /** Turns a node by radians about the limb's own axis. */
  turnAboutLimb(node: Object3D, angle: number): void {
    this.set(node, node.quaternion.clone().multiply(new Quaternion().setFromAxisAngle(LIMB, angle)));
  }

  /** The turn that a node has, to be put back. */
  get(name: string): Quaternion | undefined {
    return this.turns.get(name)?.clone();
  }

  put(name: string, turn: Quaternion | undefined): void {
    if (turn) this.turns.set(name, turn);
    else this.turns.delete(name);
    this.apply();
  }

  reset(): void {
    this.turns.clear();
    this.release();
  }

  /** How far a node is turned from its own rotation, in degrees. */
  degrees(name: string): number {
    const turn = this.turns.get(name);
    return turn ? (turn.angleTo(new Quaternion()) * 180) / Math.PI : 0;
  }

  private set(node: Object3D, rotation: Quaternion): void {
    const base = this.bases.get(node) ?? node.quaternion;
    this.turns.set(nodeName(node), base.clone().invert().multiply(rotation).normalize());
    this.apply();
  }
}
