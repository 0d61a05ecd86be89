// Keyboard shortcuts.

import type { Commands } from "./commands";
import type { Exports } from "./exports";
import { isRemembered, remember } from "./panels/remembered";
import type { Viewer } from "./viewport/viewer";

export interface Places {
  readonly clips: { toggle(): void; step(keys: 1 | -1): void; compare(): void; followTravel(): void; onionSkin(): void; film(): void; readonly chart: { toggle(): void }; readonly performance: { toggle(): void } };
  readonly findings: { flip(): void };
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

export function listenToKeys(viewer: Viewer, commands: Commands, exports: Exports, keys: Keys, places: Places, shows: () => boolean): void {
  const { view } = viewer;
  addEventListener("keydown", (event) => {
    if (!event.defaultPrevented && shows() && steps(event)) return event.preventDefault();
    if (event.ctrlKey || event.metaKey || event.altKey || event.defaultPrevented) return;
    const target = event.target instanceof Element ? event.target : null;
    // A field or an open dialog handles its own keys; buttons handle space and enter.
    if (target?.closest("input, select, textarea, dialog")) return;
    if (!keys.letters && event.key.length === 1 && event.key !== " ") return;
    if (event.key === "?") {
      event.preventDefault();
      return commands.help();
    }
    if (!shows()) return;
    if (target?.closest("button, a") && (event.key === " " || event.key === "Enter")) return;
    // Wherever the key is: on some keyboards it is one of the digits with Shift.
    const act = event.key === "/" ? () => places.side.focusSearch() : byPlace(event) || byLetter(event);
    if (!act) return;
    event.preventDefault();
    act();
  });

  /** Undo and redo. While a text is being typed they are about that text. */
  function steps({ key, ctrlKey, metaKey, altKey, shiftKey, target }: KeyboardEvent): boolean {
    const { editing } = commands;
    if (!editing?.isOn || !(ctrlKey || metaKey) || altKey) return false;
    if (target instanceof HTMLInputElement && target.matches(":is([type=text], [type=number], [type=search])") && target.value !== target.defaultValue && !target.dataset["sent"]) return false;
    const letter = key.toLowerCase();
    if (letter === "z" && !shiftKey) editing.undo();
    else if (letter === "y" || letter === "z") editing.redo();
    else return false;
    return true;
  }

  /** Keys by their position on the keyboard, whatever Shift makes of them. */
  function byPlace({ code, shiftKey }: KeyboardEvent): Act {
    const acts: Acts = {
      Digit0: () => view.look("threeQuarter"),
      Digit1: () => view.look(shiftKey ? "back" : "front"),
      Digit3: () => view.look(shiftKey ? "otherSide" : "side"),
      Digit7: () => view.look(shiftKey ? "bottom" : "top"),
      Digit4: commands.bends && (() => viewer.lookAsDrawn()),
      Digit5: () => commands.toggleParallel(),
      Comma: commands.isPosing && (() => commands.turn(POSE, shiftKey)),
      Period: commands.isPosing && (() => commands.turn(-POSE, shiftKey)),
    };
    return acts[code.replace("Numpad", "Digit")];
  }

  function byLetter({ key, shiftKey }: KeyboardEvent): Act {
    const { clips, findings, gallery, side } = places;
    const acts: Acts = {
      ArrowLeft: () => view.orbit(-TURN, 0),
      ArrowRight: () => view.orbit(TURN, 0),
      ArrowUp: () => view.orbit(0, TURN),
      ArrowDown: () => view.orbit(0, -TURN),
      "+": () => view.zoom(ZOOM),
      "=": () => view.zoom(ZOOM),
      "-": () => view.zoom(1 / ZOOM),
      f: shiftKey ? () => void commands.toggleFullScreen() : () => viewer.frameSelected(),
      Home: () => view.frame(),
      b: commands.bends && (() => commands.toggleBend()),
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
      j: () => clips.step(-1),
      k: () => clips.step(1),
      r: commands.recordPuppet,
      w: commands.editing?.isPossible && (() => commands.editing?.toggle()),
      F2: commands.editing?.isOn && (() => commands.editing?.rename()),
      c: () => clips.chart.toggle(),
      i: () => clips.performance.toggle(),
      o: () => clips.compare(),
      v: () => clips.followTravel(),
      n: () => clips.onionSkin(),
      m: () => clips.film(),
      " ": () => clips.toggle(),
      Escape: () => commands.escape(),
    };
    return acts[key.length === 1 ? key.toLowerCase() : key];
  }
}
