// The clips of the selected part's figure: which ones it plays, for how long, how fast, and as limited animation.

import { Plus, RotateCcw } from "lucide";
import { fill, h, icon, inCode } from "../dom";
import { fieldControls, numberControl, type Sending, type Trying } from "./controls";
import type { Change, ClipForm, Field, MotionForm } from "./messages";

/** What a clip is limited to when that is switched on: drawings to leave out, and frames to hold. */
const LIMITS = "2 8";

/** What the controls do. */
export interface ClipActions {
  make(change: Change): void;
  attempt(change: Change): void;
  /** Whether one more clip is being chosen. */
  readonly adds: boolean;
  /** Asks for one more clip. */
  add(): void;
}

/** A section for each clip, and what adds one. */
export function clipFields(part: string, { clips, new: fresh, choices, summary }: MotionForm, actions: ClipActions): HTMLElement[] {
  const isFirst = clips.length === 0;
  const sections = clips.map((clip, at) => section(part, clip, at, choices, summary, actions));
  if (isFirst || actions.adds) return [...sections, section(part, fresh, clips.length, choices, summary, actions)];
  const add = h("button", { class: "button framed", attributes: { type: "button", "data-key": "Motion add" }, on: { click: () => actions.add() } }, icon(Plus), "Add a clip");
  return [...sections, h("p", { class: "form-add" }, add)];
}

function section(part: string, clip: ClipForm, at: number, choices: MotionForm["choices"], summary: string, actions: ClipActions): HTMLElement {
  const title = at === 0 ? "Motion" : `Motion ${at + 1}`;
  const change = (motion: string | null, limited: string | null): Change => ({ change: "clip", part, clip: at, motion, limited });
  // A change says all of a clip. Those that are made before the form shows the last one go on from what was said last.
  let said = AS_WRITTEN;
  let limits = clip.limited.from === "own" ? clip.limited.value : null;
  const set = (different: Different): void => {
    said = joined(said, different);
    actions.make(change(words(clip, said), limits));
  };
  const attempt = (different: Different): void => actions.attempt(change(words(clip, joined(said, different)), limits));
  const now = (): string | null => (said === AS_WRITTEN ? clip.words : words(clip, said));
  const limit = (limited: string | null): void => {
    limits = limited;
    actions.make(change(now(), limits));
  };
  const tryLimit = (limited: string): void => actions.attempt(change(now(), limited));
  const leave = (): void => actions.make(change(null, null));
  const head = h("div", { class: "field-head" }, h("h3", {}, title), ...origin(clip, title, leave));
  const place = h("section", { class: "field", attributes: { "data-attribute": "Motion", "aria-label": title } }, head);
  fill(place, head, h("p", { class: "muted field-note" }, ...inCode(`${summary.charAt(0).toUpperCase()}${summary.slice(1)}.`)), choice(clip, title, choices, set, leave), ...(clip.words === null ? [] : [...details(clip, title, set, attempt), ...limiting(clip, title, limit, tryLimit)]));
  return place;
}

/** Which clip it is. */
function choice(clip: ClipForm, title: string, choices: MotionForm["choices"], set: (different: Different) => void, leave: () => void): HTMLElement {
  const select = h("select", { class: "select", attributes: { "aria-label": `${title}: clip`, "data-key": `${title} clip` } });
  const option = (value: string, text: string): HTMLElement => h("option", { attributes: { value } }, text);
  const now = clip.words === null ? "none" : clip.word === null ? "other" : `=${clip.word}`;
  fill(
    select,
    option("none", "none"),
    clip.words !== null && clip.word === null && option("other", clip.arguments),
    option("=", "the one that fits the figure"),
    ...choices.map(([word, about]) => option(`=${word}`, `${word} — ${about.replaceAll("`", "")}`)),
  );
  select.value = now;
  select.addEventListener("change", () => {
    if (select.value === "none") leave();
    else if (select.value !== "other") set({ word: select.value.slice(1) });
  });
  return select;
}

/** What is said of a clip. A file, or clips that play in turn, are written in the drawing. */
function details(clip: ClipForm, title: string, set: (different: Different) => void, attempt: (different: Different) => void): HTMLElement[] {
  const number = (which: "seconds" | "speed"): HTMLElement[] => {
    const argument = clip[which];
    const { takes } = argument;
    if (takes.type !== "number" || clip.word === null) return [];
    const controls = numberControl(takes, argument, `${title}: ${which}`, `${title} ${which}`, (value) => set({ [which]: value }), (value) => attempt({ [which]: value }), () => set({ [which]: "" }));
    return [h("div", { class: "argument" }, h("span", { class: "argument-name", title: argument.summary }, which), ...controls, h("span", { class: "muted argument-note" }, ...inCode(argument.summary)))];
  };
  const flags = clip.flags.map(({ letter, summary, on }) => {
    const box = h("input", { attributes: { type: "checkbox", "data-key": `${title} -${letter}` } });
    box.checked = on;
    box.addEventListener("change", () => set({ flags: { [letter]: box.checked } }));
    return h("label", { class: "switch" }, box, h("span", {}, ...inCode(summary)));
  });
  return [...number("seconds"), ...number("speed"), ...flags];
}

/** Its limited animation. */
function limiting(clip: ClipForm, title: string, limit: Sending, attempt: Trying): HTMLElement[] {
  const { limited } = clip;
  const own = limited.from === "own";
  const box = h("input", { attributes: { type: "checkbox", "data-key": `${title} limited` } });
  box.checked = own;
  box.addEventListener("change", () => limit(box.checked ? (limited.value ?? LIMITS) : null));
  const about = own || limited.value === null ? limited.summary : `limited in its own way: \`Limited ${limited.value}\` is for all clips`;
  const field: Field = { ...limited, attribute: title === "Motion" ? "Limited" : title.replace("Motion", "Limited") };
  return [h("label", { class: "switch" }, box, h("span", {}, ...inCode(about))), ...(own ? fieldControls(field, limit, attempt) : [])];
}

function origin(clip: ClipForm, title: string, leave: () => void): HTMLElement[] {
  if (clip.words === null) return [];
  const said = h("span", { class: "muted field-from", ...(clip.string === null ? {} : { title: clip.string }) }, clip.from === "own" ? "set here" : "for the whole drawing");
  const reset = h("button", { class: "button reset", title: "Take this clip away", attributes: { type: "button", "aria-label": `Reset ${title}`, "data-key": `${title} reset` }, on: { click: leave } }, icon(RotateCcw), "Reset");
  return [said, reset];
}

/** What differs from the words of a clip. Numbers are left out if they are empty. */
interface Different {
  readonly word?: string;
  readonly seconds?: string;
  readonly speed?: string;
  readonly flags?: Readonly<Record<string, boolean>>;
}

/** Nothing: the words stay as they are written. */
const AS_WRITTEN: Different = {};

/** What differs after one more change. */
const joined = (before: Different, more: Different): Different => ({ ...before, ...more, flags: { ...before.flags, ...more.flags } });

/** The words behind `Motion`. */
export function words(clip: ClipForm, { word, seconds, speed, flags: switched }: Different): string {
  const letters = clip.flags.filter(({ letter, on }) => switched?.[letter] ?? on).map(({ letter }) => letter);
  const flags = letters.length > 0 ? `-${letters.join("")}` : "";
  // What comes from a file stays as it is written, unless another clip takes its place.
  if (clip.words !== null && clip.word === null && word === undefined) return join(flags, clip.arguments);
  const fast = speed ?? clip.speed.value ?? "";
  return join(flags, word ?? clip.word ?? "", seconds ?? clip.seconds.value ?? "", fast === "" || Number(fast) === 1 ? "" : `speed ${fast}`, clip.name ?? "");
}

const join = (...words: readonly string[]): string => words.filter((word) => word !== "").join(" ");
