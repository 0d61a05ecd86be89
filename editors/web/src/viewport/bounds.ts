// Fits the ground and the view to the model: over its whole clip, as it is bent, and with the copy beside it.

import { Box3, type AnimationClip } from "three";
import { cornersOf } from "./bend";
import type { Ground } from "./ground";
import type { Model } from "./model";
import { pathOf } from "./path";
import type { Playback } from "./playback";
import type { View } from "./view";
import type { ViewDependent } from "./view-dependent";

export class Bounds {
  /** The bounds of the model over a clip. */
  private path: { readonly model: Model; readonly clip: AnimationClip; readonly box: Box3 } | null = null;

  constructor(
    private readonly view: View,
    private readonly ground: Ground,
    private readonly playback: Playback,
    private readonly viewDependent: ViewDependent,
    private readonly canvas: HTMLCanvasElement,
  ) {}

  /** The model changed, or is about to go. */
  forget(): void {
    this.path = null;
  }

  /** Fits ground and view to a model. */
  fit(model: Model): void {
    const { boxes, offset } = this.playback.sideBySide;
    const box = boxes ? new Box3().union(boxes[0]).union(boxes[1]) : model.box;
    this.ground.fit(box);
    this.view.bound(
      box,
      model.bend.isEmpty
        ? boxes
          ? null
          : () => cornersOf(this.wholePath(model))
        : (towards) => {
            const points = model.bend.points(towards, this.viewDependent.bent);
            return boxes ? points.flatMap((point) => [point, point.clone().setX(point.x + offset)]) : points;
          },
    );
    this.canvas.dataset["beside"] = boxes ? String(offset) : "";
  }

  /** The bounds of the model over the clip that is shown; those at rest without one, and of a figure that the view goes along with. */
  private wholePath(model: Model): Box3 {
    const { player, travel, pose } = this.playback;
    const { clip, time } = player;
    if (!clip || travel.wanted) return model.box;
    if (this.path?.model !== model || this.path.clip !== clip) {
      pose.release();
      this.path = { model, clip, box: pathOf(model, clip, (at) => player.seek(at)) };
      player.seek(time);
      pose.apply();
    }
    return this.path.box;
  }
}
