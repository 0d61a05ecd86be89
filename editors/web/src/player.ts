// The page that a person shares: one model, which plays by itself, and nothing else.

import "./style/player.css";
import { h } from "./dom";
import { BendBar } from "./panels/bendbar";
import { Clips } from "./panels/clips";
import type { Played } from "./player/page";
import { clipLetters, isForPage, letterOf, placeOf, viewLetters, viewPlaces } from "./shortcuts";
import { State } from "./state";
import { followTheme } from "./theme";
import { VIEWS } from "./viewport/view";
import { Viewer } from "./viewport/viewer";

const ID = "model";

function start(page: HTMLElement, { name, model, clip, view }: Played): void {
  const state = new State();
  const place = h("div", { class: "viewport" });
  const bytes = Uint8Array.from(atob(model), (letter) => letter.charCodeAt(0)).buffer;
  const viewer = new Viewer(state, { model: async () => bytes }, place);
  viewer.canvas.setAttribute("aria-description", "The arrow keys turn the view, plus and minus zoom, and space plays or pauses.");
  const failure = h("p", { class: "player-failure", hidden: true, attributes: { role: "alert" } });
  const clips = new Clips(viewer);
  const bend = new BendBar(viewer);
  place.append(failure);
  page.append(h("header", { class: "bar" }, h("h1", { class: "bar-title" }, name)), h("main", { class: "studio player", attributes: { "aria-label": "Model" } }, place, bend.element, clips.panel));
  viewer.setShading("smooth");
  followTheme(({ accent, grid, ink }) => viewer.setColors(accent, grid, ink));
  addEventListener("keydown", (event) => {
    const act = isForPage(event) && (viewPlaces(viewer, event)[placeOf(event)] || { ...viewLetters(viewer), ...clipLetters(clips) }[letterOf(event)]);
    if (!act) return;
    event.preventDefault();
    act();
  });

  let isFirst = true;
  viewer.on(["model"], () => {
    failure.textContent = viewer.requests.failure === "" ? "" : `The model could not be shown: ${viewer.requests.failure}`;
    failure.hidden = viewer.requests.failure === "";
    if (!viewer.model || !isFirst) return;
    isFirst = false;
    const [left, up] = VIEWS.threeQuarter;
    viewer.view.orbit(view[0] - left, view[1] - up);
    const { player } = viewer.playback;
    const chosen = player.clips.find((one) => one.name === clip);
    if (chosen && chosen !== player.clip) viewer.playback.moved(() => player.choose(chosen));
  });
  state.setLink("open");
  state.receive({ type: "drawings", drawings: [{ id: ID, name, folder: "" }] });
  state.show(ID);
  state.receive({ type: "build", drawing: ID, build: { revision: 1, milliseconds: 0, model: "model.glb", picture: null, paper: null, stale: false, incomplete: false, triangles: 0, size: null, findings: [], parts: [], clips: [], originals: null, exports: null } });
}

const page = document.getElementById("page");
const shown = document.getElementById("shown");
if (page && shown?.textContent) start(page, JSON.parse(shown.textContent) as Played);
