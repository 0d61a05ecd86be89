// Drawings to start from, which are offered while there are none.

import { FilePlus, Image } from "lucide";
import { fill, h, icon } from "../dom";
import type { Host } from "../host/host";
import type { Offer, Starter } from "../protocol";
import type { State } from "../state";

export class Starters {
  readonly element = h("ul", { class: "cards starters", hidden: true, attributes: { "aria-label": "Drawings to start from" } });
  private shown: Offer | null = null;

  constructor(private readonly state: State, private readonly host: Host) {
    state.on("starters", () => this.enable());
    // An open connection goes on with what was chosen while it was being made.
    state.on("link", () => state.link !== "open" && this.enable());
  }

  /** Whether there is something to choose. */
  get areOffered(): boolean {
    return this.state.list.length === 0 && (this.state.offer?.starters.length ?? 0) > 0;
  }

  draw(): void {
    this.element.hidden = !this.areOffered;
    const { offer } = this.state;
    if (this.element.hidden || offer === null || offer === this.shown) return;
    this.shown = offer;
    fill(this.element, ...offer.starters.map((starter) => h("li", {}, this.card(starter))));
  }

  private card({ name, about, picture }: Starter): HTMLButtonElement {
    const place = h("span", { class: "card-picture" }, icon(picture === null ? FilePlus : Image));
    if (picture !== null) {
      void this.host.picture(picture).then(
        (source) => {
          const image = h("img", { attributes: { alt: "", width: 256, height: 256 } });
          image.addEventListener("load", () => fill(place, image));
          image.src = source;
        },
        () => {},
      );
    }
    return h(
      "button",
      {
        class: "card",
        attributes: { type: "button", "data-starter": name },
        on: { click: () => this.begin(name) },
      },
      place,
      h("span", { class: "card-text" }, h("span", { class: "card-name" }, name), h("span", { class: "card-facts muted" }, about)),
    );
  }

  /** Begins a drawing that is offered. */
  begin(starter: string): void {
    const { offer } = this.state;
    if (offer === null || !this.areOffered) return;
    // One click begins one drawing; the page shows it as soon as it is there.
    for (const button of this.buttons()) button.disabled = true;
    this.host.send({ type: "begin", key: offer.key, starter });
  }

  private enable(): void {
    for (const button of this.buttons()) button.disabled = false;
  }

  private buttons(): HTMLButtonElement[] {
    return [...this.element.querySelectorAll("button")];
  }
}
