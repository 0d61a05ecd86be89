// Pointer input on the model: hovering, picking, and turning limbs in posing mode.

import type { State } from "../state";
import { pick, type Hit } from "./picking";
import { Posing } from "./posing";
import type { Viewer } from "./viewer";

/** A press that moves less than this, in pixels, is a click. */
const STILL = 5;
/** In larger models picking at every pointer move takes longer than a frame. */
const MAX_TRIANGLES = 1_500_000;

export class Pointer {
  readonly posing: Posing;
  private press: { readonly x: number; readonly y: number; readonly id: number } | null = null;
  private over: { readonly x: number; readonly y: number } | null = null;
  private poses = false;

  /** `picked` is called with parts that are clicked, `turned` with limbs that are being turned and the angle in degrees. */
  constructor(
    private readonly viewer: Viewer,
    private readonly state: State,
    private readonly picked: (part: string) => void,
    turned: (part: string, degrees: number) => void,
  ) {
    const { canvas } = viewer;
    this.posing = new Posing(viewer.pose, viewer.view, canvas, (name, degrees) => {
      const node = viewer.model?.node(name);
      viewer.posed();
      turned(node ? viewer.parts.nameOf(node) : name, degrees);
    });
    // Before the orbit controls, which listen on the canvas: a press on a limb must not turn the view too.
    canvas.parentElement!.addEventListener("pointerdown", (event) => this.down(event), { capture: true });
    addEventListener("pointermove", (event) => this.move(event));
    addEventListener("pointerup", (event) => this.up(event));
    addEventListener("pointercancel", () => this.stop());
    canvas.addEventListener("pointerleave", () => this.hover(null));
    viewer.renderLoop.beforeFrame(() => this.look());
    viewer.on(["model"], () => this.posing.renew((name) => viewer.model?.node(name)));
  }

  get posesLimbs(): boolean {
    return this.poses;
  }

  set posesLimbs(on: boolean) {
    this.poses = on;
    this.viewer.canvas.classList.toggle("poses", on);
    this.stop();
  }

  /** The part at a point of the window; null if there is none. */
  partAt(x: number, y: number): string | null {
    const hit = this.hit(x, y);
    return hit && this.viewer.parts.nameOf(hit.node);
  }

  /** Cancels a drag; true if there was one. */
  cancel(): boolean {
    if (!this.posing.drags) return false;
    this.posing.cancel();
    this.viewer.posed();
    this.stop();
    return true;
  }

  private down(event: PointerEvent): void {
    if (event.target !== this.viewer.canvas) return;
    if (this.press) {
      // A second finger: a pinch, neither a click nor a turn of a limb.
      this.press = null;
      this.cancel();
      return;
    }
    if (event.button !== 0) return;
    this.press = { x: event.clientX, y: event.clientY, id: event.pointerId };
    const hit = this.poses ? this.hit(event.clientX, event.clientY, true) : null;
    if (!hit) return;
    this.viewer.view.turns = false;
    this.viewer.canvas.setPointerCapture(event.pointerId);
    this.posing.begin(hit, event.clientX, event.clientY);
    this.viewer.canvas.focus({ preventScroll: true });
    event.preventDefault();
  }

  private move(event: PointerEvent): void {
    if (this.posing.drags && event.pointerId === this.press?.id) this.posing.move(event.clientX, event.clientY, event.shiftKey);
    else if (event.pointerType === "mouse" && event.buttons === 0 && event.target === this.viewer.canvas) this.hover({ x: event.clientX, y: event.clientY });
  }

  private up(event: PointerEvent): void {
    const { press } = this;
    if (!press || press.id !== event.pointerId) return;
    const clicked = Math.hypot(event.clientX - press.x, event.clientY - press.y) < STILL;
    this.stop();
    if (!clicked || event.target !== this.viewer.canvas) return;
    const part = this.partAt(event.clientX, event.clientY);
    this.state.select(part);
    if (part) this.picked(part);
  }

  private stop(): void {
    this.press = null;
    this.posing.end();
    this.viewer.view.turns = true;
  }

  private hover(place: { readonly x: number; readonly y: number } | null): void {
    const model = this.viewer.model;
    if (place && (!model || model.triangles > MAX_TRIANGLES)) return;
    if (!place) return this.state.hover(null);
    // At most once per frame.
    this.over = place;
    this.viewer.renderLoop.ask();
  }

  private look(): boolean {
    const { over } = this;
    this.over = null;
    if (!over) return false;
    this.state.hover(this.partAt(over.x, over.y));
    return false;
  }

  /** Only limbs of the model itself can be turned; those of the copy beside it can be picked. */
  private hit(x: number, y: number, toTurn = false): Hit | null {
    const { model, sideBySide, view, canvas } = this.viewer;
    return model && pick(toTurn ? model.meshes : [...model.meshes, ...(sideBySide.copy?.meshes ?? [])], view, canvas, x, y);
  }
}
