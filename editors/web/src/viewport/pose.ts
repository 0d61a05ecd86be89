// Limbs turned by hand. Turns are stored by node name, apart from the model, so that they carry over to the next model.

import { Quaternion, Vector3, type Object3D } from "three";
import { nodeName, sharesOf, type Model } from "./model";

/** The axis of a limb: away from its joint. */
export const LIMB_AXIS = new Vector3(0, 1, 0);

export class Pose {
  /** Applied after a node's own rotation. */
  private readonly turns = new Map<string, Quaternion>();
  /** The rotations of nodes without their turns: from the file, or from the clip that plays. */
  private readonly bases = new Map<Object3D, Quaternion>();

  constructor(private readonly model: () => Model | null) {}

  get isEmpty(): boolean {
    return this.turns.size === 0;
  }

  get names(): string[] {
    return [...this.turns.keys()];
  }

  /** Removes all turns from the model, so that the nodes have their own rotations. */
  release(): void {
    for (const [node, base] of this.bases) node.quaternion.copy(base);
    this.bases.clear();
  }

  /** Applies all turns. */
  apply(): void {
    this.release();
    for (const [name, turn] of this.turns) {
      const node = this.model()?.node(name);
      if (!node) continue;
      const shares = sharesOf(node);
      const share = shares > 1 ? new Quaternion().slerp(turn, 1 / shares) : turn;
      let at: Object3D | null = node;
      for (let number = 0; number < shares && at; number++, at = at.parent) {
        this.bases.set(at, at.quaternion.clone());
        at.quaternion.multiply(share);
      }
    }
  }

  /** Turns a node by radians about an axis in the world, from its current rotation. */
  turnInWorld(node: Object3D, axis: Vector3, angle: number): void {
    node.parent?.updateWorldMatrix(true, false);
    const parent = node.parent?.getWorldQuaternion(new Quaternion()) ?? new Quaternion();
    const turn = new Quaternion().setFromAxisAngle(axis, angle);
    this.turnFurther(node, parent.clone().invert().multiply(turn).multiply(parent));
  }

  /** Turns a node by radians about the limb's own axis. */
  turnAboutLimb(node: Object3D, angle: number): void {
    const own = node.quaternion;
    const turn = new Quaternion().setFromAxisAngle(LIMB_AXIS, angle);
    this.turnFurther(node, own.clone().multiply(turn).multiply(own.clone().invert()));
  }

  /** The turn of a node, to be restored later. */
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

  /** The angle between a node and its own rotation, in degrees. */
  degrees(name: string): number {
    const turn = this.turns.get(name);
    return turn ? (turn.angleTo(new Quaternion()) * 180) / Math.PI : 0;
  }

  /** By how much a node is turned in the plane of the drawing from how it is drawn, by hand and by a clip: degrees, counter-clockwise. */
  drawnTurn(node: Object3D): number {
    const rest = this.model()?.restOf(node) ?? new Quaternion();
    // The part of the turn that is about the node's z axis, which is across the drawing.
    const { z, w } = rest.clone().invert().multiply(node.quaternion);
    const angle = 2 * Math.atan2(z, w);
    return (Math.atan2(Math.sin(angle), Math.cos(angle)) * 180) / Math.PI;
  }

  /** Turns a node further, in its parent's frame. */
  private turnFurther(node: Object3D, further: Quaternion): void {
    const name = nodeName(node);
    const own = node.quaternion;
    // Where several nodes share a turn, the last one's rotation is about that of the joint.
    const turn = own.clone().invert().multiply(further).multiply(own);
    this.turns.set(name, (this.turns.get(name) ?? new Quaternion()).clone().multiply(turn).normalize());
    this.apply();
  }
}
