// Keyboard shortcuts.

import type { Commands } from "./commands";
import { isRemembered, remember } from "./panels/remembered";
import type { Viewer } from "./viewport/viewer";

export interface Places {
  readonly clips: { toggle(): void; step(keys: 1 | -1): void; compare(): void; followTravel(): void; onionSkin(): void; film(): void; readonly chart: { toggle(): void }; readonly performance: { toggle(): void } };
  readonly findings: { flip(): void };
  readonly side: { focusTree(): void; focusSearch(): void };
  /** Shows all drawings, if there are several. */
  readonly gallery: () => void;
}

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

export function listenToKeys(viewer: Viewer, commands: Commands, keys: Keys, places: Places, shows: () => boolean): void {
  const { view } = viewer;
  addEventListener("keydown", (event) => {
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
    const act = event.key === "/" ? () => places.side.focusSearch() : byPlace(event) ?? byLetter(event);
    if (!act) return;
    event.preventDefault();
    act();
  });

  /** Keys by their position on the keyboard, whatever Shift makes of them. */
  function byPlace({ code, shiftKey }: KeyboardEvent): (() => void) | undefined {
    switch (code) {
      case "Digit0":
      case "Numpad0":
        return () => view.look("threeQuarter");
      case "Digit1":
      case "Numpad1":
        return () => view.look(shiftKey ? "back" : "front");
      case "Digit3":
      case "Numpad3":
        return () => view.look(shiftKey ? "otherSide" : "side");
      case "Digit7":
      case "Numpad7":
        return () => view.look(shiftKey ? "bottom" : "top");
      case "Digit4":
      case "Numpad4":
        return commands.bends ? () => viewer.lookAsDrawn() : undefined;
      case "Digit5":
      case "Numpad5":
        return () => commands.toggleParallel();
      case "Comma":
        return commands.isPosing ? () => commands.turn(POSE, shiftKey) : undefined;
      case "Period":
        return commands.isPosing ? () => commands.turn(-POSE, shiftKey) : undefined;
    }
    return undefined;
  }

  function byLetter({ key, shiftKey }: KeyboardEvent): (() => void) | undefined {
    switch (key.length === 1 ? key.toLowerCase() : key) {
      case "ArrowLeft":
        return () => view.orbit(-TURN, 0);
      case "ArrowRight":
        return () => view.orbit(TURN, 0);
      case "ArrowUp":
        return () => view.orbit(0, TURN);
      case "ArrowDown":
        return () => view.orbit(0, -TURN);
      case "+":
      case "=":
        return () => view.zoom(ZOOM);
      case "-":
        return () => view.zoom(1 / ZOOM);
      case "f":
        return shiftKey ? () => void commands.toggleFullScreen() : () => viewer.frameSelected();
      case "Home":
        return () => view.frame();
      case "b":
        return commands.bends ? () => commands.toggleBend() : undefined;
      case "l":
        return () => viewer.stack.toggle();
      case "z":
        return () => commands.nextShading();
      case "p":
        return () => commands.togglePosing();
      case "s":
        return () => void commands.screenshot(shiftKey);
      case "d":
        return () => void commands.download();
      case "t":
        return () => places.side.focusTree();
      case "h":
        return shiftKey ? () => commands.isolate() : () => commands.hide();
      case "a":
        return () => commands.showAll();
      case "e":
        return () => places.findings.flip();
      case "g":
        return () => places.gallery();
      case "j":
        return () => places.clips.step(-1);
      case "k":
        return () => places.clips.step(1);
      case "r":
        return commands.recordPuppet ?? undefined;
      case "c":
        return () => places.clips.chart.toggle();
      case "i":
        return () => places.clips.performance.toggle();
      case "o":
        return () => places.clips.compare();
      case "v":
        return () => places.clips.followTravel();
      case "n":
        return () => places.clips.onionSkin();
      case "m":
        return () => places.clips.film();
      case " ":
        return () => places.clips.toggle();
      case "Escape":
        return () => commands.escape();
    }
    return undefined;
  }
}
