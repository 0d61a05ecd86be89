// What a page without drawings shows: a drawing and its model, which moves, before the module has come.

import { Pause, Pencil, Play } from "lucide";
import { button, fill, h, icon } from "../dom";
import { isForPage, letterOf, viewLetters } from "../shortcuts";
import { State } from "../state";
import { followTheme } from "../theme";
import { Viewer } from "../viewport/viewer";
import type { Ready } from "./ready";

const ID = "first";
/** The picture has no other parts to leave room for. */
const CLOSER = 1.2;

export class Welcome {
  readonly element = h("section", { class: "welcome", hidden: true, attributes: { "aria-label": "A drawing and its model" } });
  private readonly place = h("div", { class: "welcome-stage" });
  private readonly button = button({ icon: Pencil, label: "Change this one", wide: true, class: "welcome-change", press: () => this.begin() });
  private readonly drawing: HTMLImageElement;
  private stage: Stage | null = null;

  /** `change` begins the drawing that is shown. */
  constructor(private readonly state: State, private readonly ready: Ready, private readonly change: () => void) {
    const { about } = ready.first;
    this.drawing = h("img", { class: "welcome-drawing", attributes: { alt: `The drawing: ${about.toLowerCase()}`, draggable: "false" } });
    fill(this.element, h("div", { class: "welcome-paper" }, this.drawing), this.place, this.button);
    state.on(["drawings", "starters", "current", "link"], () => this.draw());
    // As for all that can be begun.
    state.on("starters", () => this.wait(false));
    state.on("link", () => state.link !== "open" && this.wait(false));
  }

  private begin(): void {
    this.wait(true);
    this.change();
  }

  private wait(on: boolean): void {
    this.button.disabled = on;
    this.button.lastElementChild!.textContent = on ? "One moment…" : "Change this one";
  }

  private draw(): void {
    const { state } = this;
    const shows = state.known && state.current === null && state.list.length === 0 && state.offer !== null;
    this.element.hidden = !shows;
    if (shows === (this.stage !== null)) return;
    if (shows) this.drawing.src = this.ready.at(this.ready.made.drawings[this.ready.first.name]!);
    else this.stage?.end();
    this.stage = shows ? new Stage(this.place, this.ready) : null;
  }
}

/** The model, which plays by itself. */
class Stage {
  private readonly state = new State();
  private readonly viewer: Viewer;
  private readonly unfollow: () => void;
  private readonly playing: HTMLButtonElement;

  constructor(place: HTMLElement, ready: Ready) {
    const { name, about, picture } = ready.first;
    const { state } = this;
    const viewport = h("div", { class: "viewport" });
    this.viewer = new Viewer(state, { model: () => ready.model() }, viewport);
    const { viewer } = this;
    // Seen until the model is, or in its place where it cannot be drawn.
    const still = h("img", { class: "welcome-still", attributes: { alt: "", draggable: "false", ...(picture !== null ? { src: ready.at(picture) } : {}) } });
    this.playing = button({ icon: Pause, label: "Pause", press: () => this.toggle() });
    this.playing.hidden = true;
    this.playing.classList.add("welcome-play");
    viewport.append(still, this.playing);
    fill(place, viewport);
    viewer.canvas.setAttribute("aria-description", "The arrow keys turn the view, plus and minus zoom, and space plays or pauses.");
    viewer.setShading("smooth");
    this.unfollow = followTheme(({ accent, grid, ink }) => viewer.setColors(accent, grid, ink));
    viewer.canvas.addEventListener("keydown", (event) => {
      if (!isForPage(event)) return;
      const act = event.key === " " ? () => this.toggle() : viewLetters(viewer)[letterOf(event)];
      if (!act) return;
      event.preventDefault();
      act();
    });
    // The wheel scrolls the page.
    viewport.addEventListener("wheel", (event) => event.stopPropagation(), { capture: true });
    let isFirst = true;
    viewer.on(["model"], () => {
      if (viewer.model && isFirst) {
        isFirst = false;
        viewer.view.zoom(CLOSER);
      }
      still.hidden = viewer.model !== null;
      this.playing.hidden = viewer.playback.player.clip === null;
      this.draw();
    });
    viewer.on(["time"], () => this.draw());
    state.setLink("open");
    state.receive({ type: "drawings", drawings: [{ id: ID, name: about, folder: "" }] });
    state.show(ID);
    state.receive({ type: "build", drawing: ID, build: { revision: 1, milliseconds: 0, model: name, picture: null, paper: null, stale: false, incomplete: false, triangles: 0, size: null, findings: [], parts: [], clips: [], originals: null, exports: null } });
  }

  /** Gives back what it takes of the graphics card. */
  end(): void {
    this.unfollow();
    // A model that is still on its way is not taken any more.
    this.state.show(null);
    this.viewer.end();
    this.viewer.canvas.parentElement?.remove();
  }

  private toggle(): void {
    const { playback } = this.viewer;
    playback.moved(() => playback.player.play(!playback.player.playing));
  }

  private draw(): void {
    const plays = this.viewer.playback.player.playing;
    const label = plays ? "Pause" : "Play";
    if (this.playing.getAttribute("aria-label") === label) return;
    this.playing.setAttribute("aria-label", label);
    this.playing.title = label;
    fill(this.playing, icon(plays ? Pause : Play));
  }
}
