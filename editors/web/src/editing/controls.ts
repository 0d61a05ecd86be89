// The controls of an attribute, by the types of its arguments.

import { fill, h, inCode } from "../dom";
import { kindPictures } from "./kinds";
import type { Draft } from "./draft";
import type { Argument, Field, NumberControl } from "./messages";
import { PAUSE, digits, flagsOf, hexOf, least, quoted, saying, silent, unquoted, valuesOf, withValue } from "./values";

/** Called with the words that are to stand behind the attribute; with null it is to be taken away. */
export type Sending = (value: string | null) => void;
/** Called with the words while they are still being decided. */
export type Trying = (value: string) => void;

/** Text without the signs of code, for places that hold nothing but text. */
const plain = (text: string): string => text.replaceAll("`", "");

/** What a slider says that was moved by keys, once its number is sent. */
export const SETTLED = "settled";

/** What a control makes of a field as it was said last. */
type Saying = (make: (now: Field) => Field) => void;

/** The controls of a field. */
export function fieldControls(draft: Draft<Field>, send: Sending, attempt: Trying): HTMLElement[] {
  const field = draft.now();
  const say: Saying = (make) => {
    const next = make(draft.now());
    draft.say(next);
    send(next.value);
  };
  const look: Saying = (make) => attempt(make(draft.now()).value ?? "");
  const all: HTMLElement[] = [];
  const isColor = field.variants.some(({ arguments: [first] }) => first?.takes.type === "hex");
  if (isColor) return [color(field, say, look)];
  const isChosen = field.chosen !== null && field.chosen in field.variants;
  const first = isChosen ? field.chosen! : Math.max(field.variants.findIndex(({ arguments: all }) => all.length > 0), 0);
  if (field.variants.length === 0) return [];
  const place = h("div", { class: "arguments" });
  // Where the form was drawn again around a control of the field, the place is the one that stayed.
  const draw = (which: number): void => fill(all[0]?.parentElement?.querySelector(":scope > .arguments") ?? place, ...field.variants[which]!.arguments.map((argument, at) => control(field, which, argument, at, say, look)));
  const bare = field.variants.findIndex(({ word, counts }) => word === null && counts.includes(0));
  if (bare >= 0) all.push(onOff(field, bare, say));
  if (field.variants.length > (bare >= 0 ? 2 : 1)) all.push(choose(field, say, draw));
  // Numbers of a list that is not chosen would be of something else.
  if (field.variants.length === 1 || field.chosen !== null || bare >= 0) draw(first);
  all.push(place);
  all.push(...field.flags.map((flag) => switchOf(field, flag, say)));
  return all;
}

/** A switch for an attribute that needs no argument. */
function onOff(field: Field, bare: number, say: Saying): HTMLElement {
  const box = h("input", { attributes: { type: "checkbox", "data-key": `${field.attribute} on` } });
  box.checked = field.value !== null;
  // What others say cannot be unsaid here.
  box.disabled = field.value !== null && field.from !== "own";
  box.addEventListener("change", () => say((now) => (box.checked ? saying(now, bare, [], flagsOf(now)) : silent(now))));
  return h("label", { class: "switch" }, box, h("span", {}, field.attribute));
}

/** A flag, such as a second copy. */
function switchOf(field: Field, flag: Field["flags"][number], say: Saying): HTMLElement {
  const box = h("input", { attributes: { type: "checkbox", "data-key": `${field.attribute} -${flag.letter}` } });
  box.checked = flag.on;
  box.addEventListener("change", () => {
    if (field.variants.length === 0) return;
    say((now) => {
      const on = new Set(flagsOf(now));
      if (box.checked) on.add(flag.letter);
      else on.delete(flag.letter);
      const chosen = now.chosen ?? 0;
      return saying(now, chosen, valuesOf(now.variants[chosen]!), on);
    });
  });
  return h("label", { class: "switch" }, box, h("span", {}, ...inCode(flag.summary)));
}

/** A list of the words that an attribute can begin with, and of the lists without one. */
function choose(field: Field, say: Saying, draw: (which: number) => void): HTMLElement {
  const pick = (which: number): void => {
    const values = least(field.variants[which]!);
    // Where something must be typed first, it is asked for.
    if (values) say((now) => saying(now, which, least(now.variants[which]!) ?? values, flagsOf(now)));
    else draw(which);
  };
  if (field.attribute === "Shape") {
    const kinds = field.variants.map(({ word, summary }) => ({ name: word ?? "", summary }));
    return kindPictures("Shape: which", "Shape which", kinds, field.chosen, field.default, pick);
  }
  const select = h("select", { class: "select", attributes: { "aria-label": `${field.attribute}: which`, "data-key": `${field.attribute} which` } });
  const title = ({ word, summary, arguments: all }: Field["variants"][number]): string => (word === null ? all.map(({ name }) => name).join(" and ") : summary === "" ? word : `${word} — ${summary}`);
  const nothing = field.value === null ? [h("option", { attributes: { value: "" } }, `(${field.default})`)] : [];
  fill(select, ...nothing, ...field.variants.map((variant, at) => h("option", { attributes: { value: String(at) } }, plain(title(variant)))));
  select.value = field.chosen === null ? "" : String(field.chosen);
  select.addEventListener("change", () => {
    if (select.value === "") say(silent);
    else pick(Number(select.value));
  });
  return select;
}

function control(field: Field, which: number, argument: Argument, at: number, say: Saying, look: Saying): HTMLElement {
  const variant = field.variants[which]!;
  const all = (value: string) => (now: Field): Field => saying(now, which, withValue(now.variants[which]!, at, value), flagsOf(now));
  const set = (value: string): void => say(all(value));
  const label = `${field.attribute}: ${argument.name}`;
  const key = `${field.attribute} ${variant.word ?? ""} ${at}`;
  const { takes } = argument;
  const head = h("span", { class: "argument-name", title: argument.summary }, argument.name);
  const note = h("span", { class: "muted argument-note" }, ...inCode(argument.summary));
  if (takes.type === "number") return h("div", { class: "argument" }, head, ...numberControl(takes, argument, label, key, set, (value) => look(all(value))), note);
  if (takes.type === "choice") {
    const select = h("select", { class: "select", attributes: { "aria-label": label, "data-key": key } }, ...takes.words.map(([word, summary]) => h("option", { attributes: { value: word } }, plain(`${word} — ${summary}`))));
    select.value = argument.value ?? "";
    select.addEventListener("change", () => set(select.value));
    return h("div", { class: "argument" }, head, select, note);
  }
  const input = h("input", { class: "text-field", attributes: { type: "text", "aria-label": label, "data-key": key, spellcheck: "false" } });
  input.value = takes.type === "names" ? variant.arguments.length === 1 ? (field.value ?? "") : (argument.value ?? "") : unquoted(argument.value ?? "");
  input.addEventListener("change", () => {
    if (input.value.trim() === "") return say(silent);
    const value = takes.type === "names" ? input.value.trim() : quoted(input.value, takes.type === "file");
    // Names stand for all that follow: they replace the whole list.
    if (value !== null) takes.type === "names" ? say((now) => saying(now, which, [value], flagsOf(now))) : set(value);
  });
  return h("div", { class: "argument" }, head, input, note);
}

/** A slider with the number beside it, which can be typed and may be outside of the slider. `clear` is called if the number is deleted. */
export function numberControl(takes: NumberControl, argument: Argument, label: string, key: string, set: (value: string) => void, attempt: (value: string) => void, clear: () => void = () => {}): HTMLElement[] {
  const { low, high, step, min, max } = takes;
  const written = argument.value === null ? NaN : Number(argument.value);
  const known = Number.isFinite(written) ? written : takes.start;
  const range = h("input", { class: "slider", attributes: { type: "range", min: low, max: high, step, "aria-label": label, "data-key": `${key} slider` } });
  const number = h("input", { class: "number-field", attributes: { type: "number", min, max, step: "any", "aria-label": `${label}, as a number`, "data-key": `${key} number` } });
  range.value = String(known ?? low);
  number.value = argument.value !== null && Number.isFinite(written) ? argument.value : "";
  number.placeholder = known === null ? "" : digits(known, step);
  // A slider rests on multiples of its step only; one that was not moved says nothing.
  let sent = number.value;
  let [moved, over] = [false, false];
  const commit = (value: string): void => {
    moved = false;
    if (value === sent || over) return;
    sent = value;
    set(value);
  };
  let timer: ReturnType<typeof setTimeout> | undefined;
  let byKey = false;
  const later = (value: string): void => {
    clearTimeout(timer);
    timer = setTimeout(() => {
      timer = undefined;
      commit(value);
      range.dispatchEvent(new Event(SETTLED, { bubbles: true }));
    }, PAUSE);
  };
  const flush = (): void => {
    clearTimeout(timer);
    timer = undefined;
  };
  range.addEventListener("keydown", ({ key }) => {
    byKey = true;
    // The form puts another slider in the place of one that is given up.
    if (key !== "Escape" || !moved) return;
    flush();
    over = true;
  });
  range.addEventListener("pointerdown", () => (byKey = false));
  range.addEventListener("input", () => {
    moved = true;
    number.value = digits(range.valueAsNumber, step);
    attempt(number.value);
  });
  range.addEventListener("change", (event) => {
    const value = digits(range.valueAsNumber, step);
    if (!byKey) return flush(), commit(value);
    // The form waits with what was typed, too.
    event.stopPropagation();
    later(value);
  });
  number.addEventListener("input", () => {
    if (Number.isFinite(number.valueAsNumber)) range.value = number.value;
  });
  number.addEventListener("change", () => {
    flush();
    if (Number.isFinite(number.valueAsNumber)) commit(String(number.valueAsNumber));
    else if (number.value === "" && number.validity.valid && sent !== "") clear();
  });
  range.addEventListener("blur", () => {
    if (timer === undefined) return;
    flush();
    commit(digits(range.valueAsNumber, step));
  });
  return [range, number];
}

/** A swatch, which opens the browser's picker, and the colour as text. */
function color(field: Field, say: Saying, look: Saying): HTMLElement {
  const now = field.value === null ? null : hexOf(field.value);
  const swatch = h("input", { class: "color-field", attributes: { type: "color", "aria-label": `${field.attribute}: swatch`, "data-key": `${field.attribute} swatch` } });
  swatch.value = now?.hex ?? "#808080";
  const value = (): string => `${swatch.value}${now?.opacity ?? ""}`;
  const painted = (value: string) => (now: Field): Field => ({ ...now, value, from: "own" });
  swatch.addEventListener("input", () => look(painted(value())));
  swatch.addEventListener("change", () => say(painted(value())));
  const text = h("input", { class: "text-field", attributes: { type: "text", "aria-label": `${field.attribute}: as text`, "data-key": `${field.attribute} text`, spellcheck: "false" } });
  text.value = field.from === "builtin" ? (now?.hex ?? "") : (field.value ?? "");
  text.addEventListener("change", () => say(text.value.trim() === "" ? silent : painted(text.value.trim())));
  return h("div", { class: "argument color" }, swatch, text);
}
