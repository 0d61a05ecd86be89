// What the pointer does to the model: lights parts up, picks them, and in the posing mode turns them.

import type { State } from "../state";
import { pick, type Hit } from "./picking";
import { Posing } from "./posing";
import type { Viewer } from "./viewer";

/** A press that moves less, in pixels, is a click. */
const STILL = 5;
/** In larger models, looking for what is under the pointer at every move takes longer than a frame. */
const MOST_TRIANGLES = 1_500_000;

export class Pointer {
  readonly posing: Posing;
  private press: { readonly x: number; readonly y: number; readonly id: number } | null = null;
  private over: { readonly x: number; readonly y: number } | null = null;
  private poses = false;

  /** `picked` hears of clicks on parts, `turned` of limbs that are being turned and by how many degrees. */
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
      turned(node ? viewer.partOf(node) : name, degrees);
    });
    // Before the orbit's own listeners, which are the canvas's: a press on a limb must not turn the view too.
    canvas.parentElement!.addEventListener("pointerdown", (event) => this.down(event), { capture: true });
    addEventListener("pointermove", (event) => this.move(event));
    addEventListener("pointerup", (event) => this.up(event));
    addEventListener("pointercancel", () => this.stop());
    canvas.addEventListener("pointerleave", () => this.hover(null));
    viewer.stage.beforeFrame(() => this.look());
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

  /** Gives up what is being dragged; true if something was. */
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
      // A second finger: this is a pinch, neither a click nor a turn of a limb.
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
    const hit = this.hit(event.clientX, event.clientY);
    const part = hit && this.viewer.partOf(hit.node);
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
    if (place && (!model || model.triangles > MOST_TRIANGLES)) return;
    if (!place) return this.state.hover(null);
    // Once a frame at most.
    this.over = place;
    this.viewer.stage.ask();
  }

  private look(): boolean {
    const { over } = this;
    this.over = null;
    if (!over) return false;
    const hit = this.hit(over.x, over.y);
    this.state.hover(hit && this.viewer.partOf(hit.node));
    return false;
  }

  /** Limbs are turned in the model itself; what is beside it for comparison only has names. */
  private hit(x: number, y: number, toTurn = false): Hit | null {
    const { model, beside, view, canvas } = this.viewer;
    return model && pick(toTurn ? model.meshes : [...model.meshes, ...(beside.copy?.meshes ?? [])], view, canvas, x, y);
  }
}
