// What the program has to say, over the page, until it is read.

import { X } from "lucide";
import { button, fill, h } from "../dom";

export interface Action {
  readonly label: string;
  readonly press: () => void;
}

export class Notices {
  readonly element = h("div", { class: "notices", attributes: { role: "status" } });

  /** Says something, with what can be done about it. Something else about the same thing replaces it. */
  say(about: string, words: string, actions: readonly Action[] = []): void {
    this.take(about);
    const close = (): void => notice.remove();
    const buttons = actions.map(({ label, press }) =>
      h("button", { class: "button choice", attributes: { type: "button" }, on: { click: () => (close(), press()) } }, label),
    );
    const notice = h("div", { class: "notice", attributes: { "data-about": about } }, h("p", {}, words), button({ icon: X, label: "Close this message", press: close }));
    if (buttons.length > 0) notice.append(h("div", { class: "choices" }, ...buttons));
    this.element.append(notice);
  }

  /** Takes back what was said about something. */
  take(about: string): void {
    for (const notice of [...this.element.children]) if (notice instanceof HTMLElement && notice.dataset["about"] === about) notice.remove();
  }
}

/** `a.bvh, b.bvh and 2 more` */
export function listed(names: readonly string[]): string {
  const shown = names.length > 3 ? names.slice(0, 2) : names;
  return shown.join(", ") + (shown.length < names.length ? ` and ${names.length - shown.length} more` : "");
}

/** Asks for one of some choices; null if it was closed. The first is the one that loses nothing. */
export function ask<Answer extends string>(place: HTMLElement, words: string, choices: readonly (readonly [answer: Answer, label: string])[]): Promise<Answer | null> {
  const dialog = h("dialog", { class: "ask", attributes: { "aria-label": words } });
  const buttons = choices.map(([answer, label]) => h("button", { class: "button choice", attributes: { type: "button" }, on: { click: () => dialog.close(answer) } }, label));
  fill(dialog, h("p", {}, words), h("div", { class: "choices" }, ...buttons));
  place.append(dialog);
  dialog.showModal();
  return new Promise((resolve) =>
    dialog.addEventListener("close", () => {
      dialog.remove();
      resolve(choices.find(([answer]) => answer === dialog.returnValue)?.[0] ?? null);
    }),
  );
}
