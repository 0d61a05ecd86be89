// Creates elements. Text is only ever set as text: strings from drawings are never parsed as markup.

import type { IconNode } from "lucide";

type Child = Node | string | null | undefined | false;
export interface Properties {
  readonly class?: string;
  readonly title?: string;
  readonly hidden?: boolean;
  /** Attributes by name; null and false omit one, true sets it without a value. */
  readonly attributes?: Readonly<Record<string, string | number | boolean | null>>;
  readonly on?: { readonly [Name in keyof HTMLElementEventMap]?: (event: HTMLElementEventMap[Name]) => void };
}

export function h<Tag extends keyof HTMLElementTagNameMap>(tag: Tag, properties: Properties = {}, ...children: Child[]): HTMLElementTagNameMap[Tag] {
  const element = document.createElement(tag);
  if (properties.class) element.className = properties.class;
  if (properties.title) element.title = properties.title;
  if (properties.hidden) element.hidden = true;
  for (const [name, value] of Object.entries(properties.attributes ?? {})) {
    if (value !== null && value !== false) element.setAttribute(name, value === true ? "" : String(value));
  }
  for (const [name, listener] of Object.entries(properties.on ?? {})) element.addEventListener(name, listener as EventListener);
  fill(element, ...children);
  return element;
}

/** Replaces the children of an element. */
export function fill(element: Element, ...children: Child[]): void {
  element.replaceChildren(...children.filter((child): child is Node | string => child !== null && child !== undefined && child !== false && child !== ""));
}

const SVG = "http://www.w3.org/2000/svg";

/** An SVG element. */
export function svg<Tag extends keyof SVGElementTagNameMap>(tag: Tag, attributes: Readonly<Record<string, string | number>>): SVGElementTagNameMap[Tag] {
  const element = document.createElementNS(SVG, tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, String(value));
  return element;
}

export function icon(node: IconNode): SVGSVGElement {
  const picture = svg("svg", { viewBox: "0 0 24 24", class: "icon", "aria-hidden": "true" });
  for (const [tag, attributes] of node) {
    const shape = document.createElementNS(SVG, tag);
    for (const [name, value] of Object.entries(attributes)) if (value !== undefined) shape.setAttribute(name, String(value));
    picture.append(shape);
  }
  return picture;
}

export interface ButtonOptions {
  readonly icon?: IconNode;
  /** What it does, in words; shown beside the icon if `wide`. */
  readonly label: string;
  /** The key with the same effect. */
  readonly key?: string;
  readonly wide?: boolean;
  readonly class?: string;
  readonly press: (event: MouseEvent) => void;
}

export function button({ icon: node, label, key, wide, class: name, press }: ButtonOptions): HTMLButtonElement {
  return h(
    "button",
    {
      class: ["button", wide ? "wide" : "", name ?? ""].filter(Boolean).join(" "),
      title: key ? `${label} (${key})` : label,
      attributes: { type: "button", "aria-label": wide ? null : label, "aria-keyshortcuts": key && key.length === 1 ? key : null },
      on: { click: press },
    },
    node && icon(node),
    wide && h("span", {}, label),
  );
}

/** Formats text between backticks as code. */
export function inCode(text: string): (Node | string)[] {
  return text.split("`").map((piece, at) => (at % 2 === 1 ? h("code", {}, piece) : piece));
}

/** A number and a noun. */
export function count(number: number, one: string, many = `${one}s`): string {
  return `${number.toLocaleString("en")} ${number === 1 ? one : many}`;
}

/** Hides or shows an element. If the focus is in it, it goes elsewhere instead of getting lost. */
export function setHidden(element: HTMLElement, hidden: boolean, elsewhere: HTMLElement): void {
  if (hidden && element.contains(document.activeElement)) elsewhere.focus();
  element.hidden = hidden;
}

/** Makes what is being typed into a field a change, as when the field is left. */
export async function leaveField(): Promise<void> {
  const field = document.activeElement;
  if (!(field instanceof HTMLInputElement)) return;
  field.blur();
  await painted();
  field.focus();
}

/** Whether a key saves, and does nothing else. */
export const isSave = ({ key, ctrlKey, metaKey, altKey, shiftKey }: KeyboardEvent): boolean => (ctrlKey || metaKey) && !altKey && !shiftKey && key.toLowerCase() === "s";

/** Whether the user's system asks for reduced motion. */
export const prefersReducedMotion = (): boolean => matchMedia("(prefers-reduced-motion: reduce)").matches;

/** Waits until the browser has painted, or a moment where it does not: in a hidden tab. */
export function painted(): Promise<void> {
  return new Promise((resolve) => {
    requestAnimationFrame(() => setTimeout(resolve));
    setTimeout(resolve, 100);
  });
}
