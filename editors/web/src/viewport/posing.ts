// Turns limbs with the pointer and with keys.

import { Quaternion, Vector3, type Object3D } from "three";
import { nodeName, sharesOf } from "./model";
import type { Hit } from "./picking";
import type { Pose } from "./pose";
import type { View } from "./view";

/** Closer to the joint than this, in pixels, the direction of the pointer is too uncertain. */
const NEAR = 10;
/** Radians about the limb's own axis per pixel to the right. */
const TWIST = 0.01;

interface Drag {
  readonly node: Object3D;
  readonly name: string;
  readonly before: Quaternion | undefined;
  x: number;
  y: number;
  /** The angle since the drag began, in radians. */
  turned: number;
}

export class Posing {
  private drag: Drag | null = null;

  /** `onTurn` is called with the limb that is turned and the angle of this drag in degrees. */
  constructor(
    private readonly pose: Pose,
    private readonly view: View,
    private readonly canvas: HTMLElement,
    private readonly onTurn: (name: string, degrees: number) => void,
  ) {}

  get drags(): boolean {
    return this.drag !== null;
  }

  begin({ limb: node }: Hit, x: number, y: number): void {
    const name = nodeName(node);
    this.drag = { node, name, before: this.pose.get(name), x, y, turned: 0 };
    this.onTurn(name, 0);
  }

  move(x: number, y: number, aboutLimb: boolean): void {
    const drag = this.drag;
    if (!drag) return;
    let angle: number;
    if (aboutLimb) {
      angle = (x - drag.x) * TWIST;
      this.pose.turnAboutLimb(drag.node, angle);
    } else {
      const joint = this.onScreen(drag.node);
      const from = [drag.x - joint.x, joint.y - drag.y] as const;
      const to = [x - joint.x, joint.y - y] as const;
      if (Math.hypot(...from) < NEAR || Math.hypot(...to) < NEAR) angle = 0;
      else angle = Math.atan2(from[0] * to[1] - from[1] * to[0], from[0] * to[0] + from[1] * to[1]);
      this.pose.turnInWorld(drag.node, this.directionToViewer(drag.node), angle);
    }
    drag.x = x;
    drag.y = y;
    drag.turned += angle;
    this.onTurn(drag.name, (drag.turned * 180) / Math.PI);
  }

  end(): void {
    this.drag = null;
  }

  /** Puts the limb back to where the drag began. */
  cancel(): void {
    if (this.drag) this.pose.put(this.drag.name, this.drag.before);
    this.drag = null;
  }

  /** Turns a limb by degrees, counter-clockwise as seen on the screen, or about its own axis. */
  turn(node: Object3D, degrees: number, aboutLimb: boolean): void {
    const angle = (degrees * Math.PI) / 180;
    if (aboutLimb) this.pose.turnAboutLimb(node, angle);
    else this.pose.turnInWorld(node, this.directionToViewer(node), angle);
    this.onTurn(nodeName(node), this.pose.degrees(nodeName(node)));
  }

  /** The model was replaced: goes on with the same limb of the new one. */
  renew(node: (name: string) => Object3D | undefined): void {
    if (!this.drag) return;
    const again = node(this.drag.name);
    this.drag = again ? { ...this.drag, node: again } : null;
  }

  /** Where a node turns. Of nodes that share a turn it is between the two in the middle: the last is beyond the joint, and moves as it turns. */
  private joint(node: Object3D): Vector3 {
    const steps = sharesOf(node) - 1;
    const place = (above: number): Vector3 => {
      let at = node;
      for (let number = 0; number < above && at.parent; number++) at = at.parent;
      at.updateWorldMatrix(true, false);
      return new Vector3().setFromMatrixPosition(at.matrixWorld);
    };
    return place(Math.floor(steps / 2)).lerp(place(Math.ceil(steps / 2)), 0.5);
  }

  private onScreen(node: Object3D): { x: number; y: number } {
    const at = this.joint(node).project(this.view.camera);
    const { left, top, width, height } = this.canvas.getBoundingClientRect();
    return { x: left + ((at.x + 1) / 2) * width, y: top + ((1 - at.y) / 2) * height };
  }

  private directionToViewer(node: Object3D): Vector3 {
    if (this.view.isParallel) return new Vector3(0, 0, 1).applyQuaternion(this.view.camera.quaternion);
    return this.view.camera.position.clone().sub(this.joint(node)).normalize();
  }
}
