// The page, with whatever host.

import { followAddress, openGallery } from "./address";
import { CameraPanel } from "./camera/panel";
import { Commands } from "./commands";
import { h } from "./dom";
import { DrawingTools } from "./drawing/tools";
import { EditBar } from "./editing/bar";
import { Editing } from "./editing/editing";
import { FormPanel } from "./editing/form";
import { Handles } from "./editing/handles";
import { HangingByDrag } from "./editing/hanging";
import { Offers } from "./editing/offers";
import { SheetEditor } from "./editing/sheet";
import { Exports } from "./exports";
import type { Host } from "./host/host";
import { Bar } from "./panels/bar";
import { BendBar } from "./panels/bendbar";
import { Captions } from "./panels/captions";
import { Clips } from "./panels/clips";
import { Findings } from "./panels/findings";
import { Gallery } from "./panels/gallery";
import { Help } from "./panels/help";
import { Inspector } from "./panels/inspector";
import { Layers } from "./panels/layers";
import { PartMenu } from "./panels/part-menu";
import { Notes } from "./panels/notes";
import { PaperPanel } from "./panels/paper";
import { PoseBar } from "./panels/posebar";
import { Side } from "./panels/side";
import { Toolbar } from "./panels/toolbar";
import { Tree } from "./panels/tree";
import { Keys, listenToKeys } from "./shortcuts";
import { Pointer } from "./viewport/pointer";
import { Viewer } from "./viewport/viewer";
import { State } from "./state";
import { followTheme } from "./theme";

/** What a host's own entry adds to. */
export interface Shown {
  readonly state: State;
  /** The header. */
  readonly bar: HTMLElement;
  readonly exports: Exports;
  readonly gallery: Gallery;
  readonly editing: Editing;
  readonly side: Side;
  /** The tools that change the drawing. */
  readonly edits: HTMLElement;
}

export function start(page: HTMLElement, host: Host): Shown {
  const state = new State();
  const place = h("div", { class: "viewport" });
  const viewer = new Viewer(state, host, place);
  const commands = new Commands(viewer, state);
  const exports = new Exports(viewer, state, host);
  const editing = new Editing(state, host);
  commands.editing = editing;
  const form = new FormPanel(editing, state);

  const choose = (part: string): void => {
    state.select(part);
    picked(part);
  };
  const picked = (part: string): void => {
    if (state.current !== null) host.send({ type: "pick", drawing: state.current, part });
  };
  const paper = new PaperPanel(state, host, picked, () => byDoubleClick());
  const tree = new Tree(state, picked);
  new HangingByDrag(tree.list, editing, state);
  const inspector = new Inspector(state, viewer, commands, editing, form.element, choose);
  const findings = new Findings(state, {
    opening: host.showsFindings ? "byHand" : "byItself",
    go: ({ line, column }) => {
      const part = state.parts.all.find(({ string }) => string?.line === line);
      if (part) state.select(part.name);
      if (state.current !== null) host.send({ type: "open", drawing: state.current, line, column });
    },
    unfocused: () => viewer.canvas.focus(),
  });
  const poseBar = new PoseBar(viewer, commands, editing, state);
  commands.giveUpRecording = () => poseBar.giveUpRecording();
  const pointer = new Pointer(viewer, state, picked, (part, degrees) => poseBar.show(part, degrees));
  commands.pointer = pointer;
  const clips = new Clips(viewer);
  const keys = new Keys();
  const help = new Help(keys, host);
  commands.help = () => help.toggle();
  const drawing = new DrawingTools(paper, state, editing, keys);
  commands.drawing = drawing;
  viewer.on(["model"], () => {
    if (drawing.isBegun) viewer.view.frame();
  });
  for (const type of ["pointerdown", "wheel"]) viewer.canvas.addEventListener(type, () => (drawing.isBegun = false));
  state.on("current", () => (drawing.isBegun = false));
  const camera = new CameraPanel(host, state, page);
  if (camera.isPossible) commands.recordPuppet = () => camera.toggle();

  const side = new Side(state, tree, inspector);
  editing.tries = (attempt) => viewer.requests.tries(attempt);
  editing.rename = () => {
    if (state.selected === null) return;
    side.showPart();
    form.rename();
  };
  editing.listen(["mode"], () => {
    if (editing.isOn && state.selected !== null) side.showPart();
  });
  editing.listen(["picking"], () => place.classList.toggle("picking", editing.isPicking));
  const byDoubleClick = (): void => {
    if (editing.isOn) editing.rename();
  };
  const toField = (attribute: string): void => {
    side.showPart();
    form.goTo(attribute);
  };
  const partMenu = new PartMenu(state, viewer, commands, editing, { rename: () => editing.rename(), hang: () => form.askParent(), field: toField }, tree.element);
  viewer.canvas.addEventListener("dblclick", byDoubleClick);
  tree.element.addEventListener("dblclick", byDoubleClick);
  const handles = new Handles(viewer, editing, state);
  const sheet = new SheetEditor(viewer, editing, clips, state);
  form.shown = (form) => {
    handles.show(form);
    sheet.show(form);
  };
  place.append(handles.element, new EditBar(editing, state, viewer).element, new Offers(editing, state, commands, viewer.canvas).element);
  place.append(new Captions(viewer).element, new Layers(viewer, state).element, poseBar.element, new Notes(state, viewer, exports, editing, () => drawing.begin()).element, findings.element, side.opener);
  const toolbar = new Toolbar(viewer, commands, exports, paper);
  const gallery = new Gallery(state, host);
  const studio = h("main", { class: "studio", attributes: { "aria-label": "Model" } }, toolbar.element, h("div", { class: "views" }, paper.element, place), new BendBar(viewer).element, clips.panel, side.element);
  const bar = new Bar(state, viewer).element;
  page.append(bar, studio, gallery.element, help.element);
  studio.append(partMenu.element);

  const shows = (): boolean => state.current !== null;
  const untitled = document.title;
  let before: string | null = null;
  const showEither = (): void => {
    // The focus does not stay in what is hidden, and is not taken while a page opens. The link to all drawings has lost it already.
    const enters = before === null && document.activeElement !== document.body;
    studio.hidden = !shows();
    page.dataset["shows"] = shows() ? "drawing" : "gallery";
    document.title = state.drawing ? `${state.drawing.name} · okoshi` : untitled;
    if (state.current !== null) host.send({ type: "want", drawing: state.current });
    if (!shows() && before !== null) gallery.focus(before);
    else if (shows() && enters) viewer.canvas.focus();
    before = state.current;
  };
  state.on(["current", "link"], showEither);
  showEither();

  viewer.setShading("smooth");
  followTheme(({ accent, grid, ink }) => viewer.setColors(accent, grid, ink));
  followAddress(state);
  listenToKeys(viewer, commands, exports, keys, { clips, findings, paper, side, gallery: () => state.list.length > 1 && openGallery() }, shows);
  host.listen(
    (message) => state.receive(message),
    (link, note) => state.setLink(link, note),
  );
  return { state, bar, exports, gallery, editing, side, edits: toolbar.edits };
}
