// All drawings of a folder, as cards that are updated with each build.

import { Image } from "lucide";
import { count, fill, h, icon } from "../dom";
import type { Host } from "../host/host";
import type { Drawing, State } from "../state";
import { badge } from "./findings";
import { Starters } from "./starters";

/** Pauses before a picture is asked for again, in milliseconds. */
const FIRST_PAUSE = 500;
const LAST_PAUSE = 8000;

interface Card {
  readonly element: HTMLAnchorElement;
  readonly picture: HTMLElement;
  readonly facts: HTMLElement;
  address: string;
}

export class Gallery {
  readonly element = h("main", { class: "gallery", attributes: { "aria-label": "Drawings" } });
  private readonly grid = h("ul", { class: "cards" });
  private readonly heading = h("h1");
  private readonly title = h("p", { class: "muted", attributes: { role: "status" } });
  readonly starters: Starters;
  private readonly cards = new Map<string, Card>();

  constructor(private readonly state: State, private readonly host: Host) {
    this.starters = new Starters(state, host);
    fill(this.element, h("header", { class: "gallery-head" }, this.heading, this.title), this.grid, this.starters.element);
    state.on(["drawings", "starters", "current"], () => this.draw());
    state.on("build", (id) => {
      // Nothing to do while it is hidden: to request pictures would make the host render them.
      if (this.element.hidden) return;
      const drawing = state.find(id);
      const card = this.cards.get(id);
      if (drawing && card) this.fill(card, drawing);
      this.count();
    });
  }

  /** Goes to the card of a drawing, or to the first. */
  focus(id: string | null): void {
    (this.cards.get(id ?? "") ?? [...this.cards.values()][0])?.element.focus();
  }

  /** Shows something between the heading and the drawings. */
  insert(element: HTMLElement): void {
    this.grid.before(element);
  }

  private draw(): void {
    this.element.hidden = this.state.current !== null || !this.state.known;
    if (this.element.hidden) return;
    const { list } = this.state;
    for (const id of this.cards.keys()) if (!list.some((drawing) => drawing.id === id)) this.cards.delete(id);
    for (const drawing of list) {
      let card = this.cards.get(drawing.id);
      if (!card) this.cards.set(drawing.id, (card = this.card(drawing)));
      this.fill(card, drawing);
    }
    const items = list.map(({ id }) => this.cards.get(id)!.element.parentElement!);
    // Only when the order changed: cards that are moved lose the focus.
    if (items.some((item, at) => this.grid.children[at] !== item) || items.length !== this.grid.children.length) fill(this.grid, ...items);
    this.starters.draw();
    this.count();
  }

  private count(): void {
    const { list, refusal } = this.state;
    if (this.starters.areOffered) {
      this.heading.textContent = this.host.invitation.heading;
      this.title.textContent = refusal ? `Nothing was written: ${refusal}.` : this.host.invitation.toStarters;
      return;
    }
    const failing = list.filter(({ build }) => build?.findings.some(({ severity }) => severity === "error")).length;
    this.heading.textContent = count(list.length, "drawing");
    this.title.textContent = list.length === 0 ? this.host.invitation.alone : failing > 0 ? `${failing} with problems` : "";
  }

  private card(drawing: Drawing): Card {
    const picture = h("span", { class: "card-picture" }, icon(Image));
    const facts = h("span", { class: "card-facts" });
    const element = h(
      "a",
      { class: "card", attributes: { href: `#${encodeURIComponent(drawing.id)}`, "data-drawing": drawing.id } },
      picture,
      h("span", { class: "card-text" }, h("span", { class: "card-name" }, drawing.name), drawing.folder && h("span", { class: "card-folder muted" }, drawing.folder), facts),
    );
    h("li", {}, element);
    return { element, picture, facts, address: "" };
  }

  private fill(card: Card, { build, parts, gone, name, connection }: Drawing): void {
    card.element.classList.toggle("gone", gone);
    fill(
      card.facts,
      gone
        ? h("span", { class: "muted" }, "its file is missing")
        : build
          ? h("span", { class: "muted" }, count(parts.main, "part"))
          : h("span", { class: "muted" }, "building…"),
      ...(["error", "warning", "hint"] as const).map((severity) => build && badge(severity, build.findings)),
    );
    const address = build?.picture ? `${connection} ${build.picture}` : "";
    if (address === card.address) return;
    card.address = address;
    if (!build?.picture) return fill(card.picture, icon(Image));
    this.load(card, build.picture, `Model of ${name}`, FIRST_PAUSE);
  }

  /** Shows a picture of a card; one that does not come is asked for again after a pause, in milliseconds. */
  private load(card: Card, picture: string, alt: string, pause: number): void {
    const { address } = card;
    const again = () => {
      if (pause > LAST_PAUSE) return;
      setTimeout(() => card.address === address && this.load(card, picture, alt, pause * 4), pause);
    };
    void this.host.picture(picture).then((source) => {
      if (card.address !== address) return;
      const image = h("img", { attributes: { alt, width: 256, height: 256 } });
      // The old picture stays until the new one is loaded.
      image.addEventListener("load", () => card.address === address && fill(card.picture, image));
      image.addEventListener("error", again);
      image.src = source;
    }, again);
  }
}
