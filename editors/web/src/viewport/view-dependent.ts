// Lets terrain bend and characters turn to the viewer before a frame.

import { Vector3, type Camera } from "three";
import type { Ground } from "./ground";
import type { Model } from "./model";
import type { RenderLoop } from "./render-loop";
import type { SideBySide } from "./side-by-side";

/** What follows the viewer. */
interface Shown {
  readonly model: Model | null;
  readonly sideBySide: SideBySide;
}

export class ViewDependent {
  /** The share of the bend of terrain: 1 is as drawn, 0 true 3D. */
  bent = 1;

  constructor(private readonly shown: Shown, private readonly ground: Ground, private readonly renderLoop: RenderLoop) {
    renderLoop.follow = (camera) => this.follow(camera);
  }

  private follow(camera: Camera): void {
    const { model, sideBySide } = this.shown;
    if (!model) return;
    const towards = new Vector3(0, 0, 1).applyQuaternion(camera.quaternion);
    const turned = [model, sideBySide.copy].map((one) => one?.turns.follow(towards));
    if (turned.includes(true)) this.renderLoop.moves();
    if (model.bend.isEmpty) return;
    const bends = [model, sideBySide.copy].map((one) => one?.bend.follow(towards, this.bent));
    if (!bends.includes(true)) return;
    this.ground.bend(model.bend.inWorld());
    this.renderLoop.moves();
  }
}
