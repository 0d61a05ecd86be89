// Keyboard shortcuts.

import type { Commands } from "./commands";
import type { Exports } from "./exports";
import { isRemembered, remember } from "./panels/remembered";
import type { Viewer } from "./viewport/viewer";

export interface Places {
  readonly clips: { toggle(): void; step(keys: 1 | -1): void; compare(): void; followTravel(): void; onionSkin(): void; film(): void; readonly chart: { toggle(): void }; readonly performance: { toggle(): void } };
  readonly findings: { flip(): void };
  readonly paper: { toggle(): void };
  readonly side: { focusTree(): void; focusSearch(): void };
  /** Shows all drawings, if there are several. */
  readonly gallery: () => void;
}

/** What a key does; nothing that is possible at the moment. */
type Act = (() => void) | false | null | undefined;
type Acts = Readonly<Record<string, Act>>;

/** Degrees per press of an arrow key. */
const TURN = 10;
const ZOOM = 1.2;
const POSE = 5;

const NO_LETTERS = "okoshi.no-letters";

/** Whether single letters, digits and signs are shortcuts: who dictates to the computer can turn them off. The browser stores it. */
export class Keys {
  private on = !isRemembered(NO_LETTERS);

  get letters(): boolean {
    return this.on;
  }

  set letters(on: boolean) {
    this.on = on;
    remember(NO_LETTERS, !on);
  }
}

/** Whether a key is for the page: a field or an open dialog handles its own keys, buttons handle space and enter. */
export function isForPage(event: KeyboardEvent): boolean {
  if (event.ctrlKey || event.metaKey || event.altKey || event.defaultPrevented) return false;
  // Also what is in a shadow root.
  const [first] = event.composedPath();
  const target = first instanceof Element ? first : null;
  if (target?.closest("input, select, textarea, dialog, [contenteditable]")) return false;
  return !(target?.closest("button, a") && (event.key === " " || event.key === "Enter"));
}

/** What keys do with the view, by their position on the keyboard, whatever Shift makes of them. */
export const viewPlaces = (viewer: Viewer, { shiftKey }: KeyboardEvent): Acts => ({
  Digit0: () => viewer.view.look("threeQuarter"),
  Digit1: () => viewer.view.look(shiftKey ? "back" : "front"),
  Digit3: () => viewer.view.look(shiftKey ? "otherSide" : "side"),
  Digit7: () => viewer.view.look(shiftKey ? "bottom" : "top"),
  Digit4: viewer.bends && (() => viewer.lookAsDrawn()),
  Digit5: () => viewer.setParallel(!viewer.view.isParallel),
});

/** What they do with it by their names. */
export const viewLetters = (viewer: Viewer): Acts => ({
  ArrowLeft: () => viewer.view.orbit(-TURN, 0),
  ArrowRight: () => viewer.view.orbit(TURN, 0),
  ArrowUp: () => viewer.view.orbit(0, TURN),
  ArrowDown: () => viewer.view.orbit(0, -TURN),
  "+": () => viewer.view.zoom(ZOOM),
  "=": () => viewer.view.zoom(ZOOM),
  "-": () => viewer.view.zoom(1 / ZOOM),
  Home: () => viewer.view.frame(),
  b: viewer.bends && (() => viewer.toggleBend()),
});

/** What they do with clips. */
export const clipLetters = (clips: Places["clips"]): Acts => ({
  j: () => clips.step(-1),
  k: () => clips.step(1),
  c: () => clips.chart.toggle(),
  i: () => clips.performance.toggle(),
  o: () => clips.compare(),
  v: () => clips.followTravel(),
  n: () => clips.onionSkin(),
  m: () => clips.film(),
  " ": () => clips.toggle(),
});

/** The place of a key, the same for digits wherever they are. */
export const placeOf = ({ code }: KeyboardEvent): string => code.replace("Numpad", "Digit");
export const letterOf = ({ key }: KeyboardEvent): string => (key.length === 1 ? key.toLowerCase() : key);

export function listenToKeys(viewer: Viewer, commands: Commands, exports: Exports, keys: Keys, places: Places, shows: () => boolean): void {
  addEventListener("keydown", (event) => {
    if (!event.defaultPrevented && shows() && steps(event)) return event.preventDefault();
    if (!isForPage(event)) return;
    if (!keys.letters && event.key.length === 1 && event.key !== " ") return;
    if (event.key === "?") {
      event.preventDefault();
      return commands.help();
    }
    if (!shows()) return;
    // Wherever the key is: on some keyboards it is one of the digits with Shift.
    const act = event.key === "/" ? () => places.side.focusSearch() : byPlace(event) || byLetter(event);
    if (!act) return;
    event.preventDefault();
    act();
  });

  /** Undo and redo. While a text is being typed they are about that text. */
  function steps(event: KeyboardEvent): boolean {
    const { key, ctrlKey, metaKey, altKey, shiftKey, target } = event;
    const { editing } = commands;
    if (!editing?.isOn || !(ctrlKey || metaKey) || altKey) return false;
    if (target instanceof HTMLInputElement && target.matches(":is([type=text], [type=number], [type=search])") && target.value !== target.defaultValue && !target.dataset["sent"]) return false;
    const letter = key.toLowerCase();
    if (letter === "z" && !shiftKey) editing.undo();
    else if (letter === "y" || letter === "z") editing.redo();
    else return false;
    return true;
  }

  function byPlace(event: KeyboardEvent): Act {
    const acts: Acts = {
      ...viewPlaces(viewer, event),
      Digit2: () => places.paper.toggle(),
      Comma: commands.isPosing && (() => commands.turn(POSE, event.shiftKey)),
      Period: commands.isPosing && (() => commands.turn(-POSE, event.shiftKey)),
    };
    return acts[placeOf(event)];
  }

  function byLetter(event: KeyboardEvent): Act {
    const { clips, findings, gallery, side } = places;
    const { shiftKey } = event;
    const acts: Acts = {
      ...viewLetters(viewer),
      ...clipLetters(clips),
      f: shiftKey ? () => void commands.toggleFullScreen() : () => viewer.frameSelected(),
      l: () => viewer.stack.toggle(),
      z: () => commands.nextShading(),
      p: () => commands.togglePosing(),
      s: () => void exports.screenshot(shiftKey),
      d: () => void (shiftKey ? exports.film() : exports.model()),
      t: () => side.focusTree(),
      h: shiftKey ? () => commands.isolate() : () => commands.hide(),
      a: () => commands.showAll(),
      e: () => findings.flip(),
      g: () => gallery(),
      r: commands.recordPuppet,
      w: commands.editing?.isPossible && (() => commands.editing?.toggle()),
      F2: commands.editing?.isOn && (() => commands.editing?.rename()),
      Escape: () => commands.escape(),
    };
    return acts[letterOf(event)];
  }
}
