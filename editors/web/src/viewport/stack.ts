// The view of the layers: exactly from the side, in parallel projection.

import type { Viewer } from "./viewer";

export class Stack {
  /** Goes back to the view before; null while the layers are not shown. */
  private back: (() => void) | null = null;
  private arrived = false;

  constructor(private readonly viewer: Viewer) {
    viewer.view.onChange(() => this.follow());
    viewer.on(["display"], () => this.follow());
    viewer.on(["model"], () => {
      if (!viewer.model) this.leave();
    });
  }

  get isOn(): boolean {
    return this.back !== null;
  }

  /** Whether the camera is there: depths can be read off. */
  get isExact(): boolean {
    return this.isOn && this.arrived;
  }

  /** Looks at the layers from the side, or goes back to the view before. */
  toggle(): void {
    const { view, model } = this.viewer;
    if (this.back) {
      const { back } = this;
      this.leave();
      return back();
    }
    if (!model) return;
    const wasParallel = view.isParallel;
    const goBack = view.remember();
    this.back = () => {
      this.viewer.setParallel(wasParallel);
      goBack();
    };
    this.viewer.setParallel(true);
    view.frame("side");
    this.viewer.layersShown();
  }

  /** The view stays as it is, and is an ordinary one again. */
  private leave(): void {
    if (!this.back) return;
    this.back = null;
    this.arrived = false;
    this.viewer.layersShown();
  }

  /** Whoever turns the view away from the side has left. */
  private follow(): void {
    if (!this.back) return;
    const { view } = this.viewer;
    const isThere = view.isParallel && view.isAt("side");
    if (this.arrived && !isThere) return this.leave();
    if (isThere !== this.arrived) {
      this.arrived = isThere;
      this.viewer.layersShown();
    }
  }
}
