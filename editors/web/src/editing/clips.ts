// The clips of the selected part's figure: which ones it plays, for how long, how fast, and as limited animation.

import { Plus, RotateCcw } from "lucide";
import { fill, h, icon, inCode } from "../dom";
import { fieldControls, numberControl, type Trying } from "./controls";
import { clipDraft, within, type Draft } from "./draft";
import { readHeld } from "./drawings";
import type { Argument, Change, ClipForm, Field, MotionForm } from "./messages";
import { saying, silent } from "./values";

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
export function clipFields(part: string, motion: MotionForm, actions: ClipActions): HTMLElement[] {
  const { clips } = motion;
  const isFirst = clips.length === 0;
  const sections = clips.map((_, at) => section(part, motion, at, actions));
  if (isFirst || actions.adds) return [...sections, section(part, motion, clips.length, actions)];
  const add = h("button", { class: "button framed", attributes: { type: "button", "data-key": "Motion add" }, on: { click: () => actions.add() } }, icon(Plus), "Add a clip");
  return [...sections, h("p", { class: "form-add" }, add)];
}

/** What says a clip in the drawing. */
export function clipChange(part: string, at: number, { words, limited, held }: ClipForm): Change {
  const own = ({ from, value }: Field): string | null => (words !== null && from === "own" ? value : null);
  return { change: "clip", part, clip: at, motion: words, limited: own(limited), held: own(held) };
}

function section(part: string, motion: MotionForm, at: number, actions: ClipActions): HTMLElement {
  const { summary } = motion;
  const title = at === 0 ? "Motion" : `Motion ${at + 1}`;
  const draft = clipDraft(motion, at);
  const clip = draft.now();
  const change = (clip: ClipForm): Change => clipChange(part, at, clip);
  const set = (different: Different): void => {
    draft.say(changed(draft.now(), different));
    actions.make(change(draft.now()));
  };
  const attempt = (different: Different): void => actions.attempt(change(changed(draft.now(), different)));
  const limits = within(draft, "limited");
  const limit = (): void => actions.make(change(draft.now()));
  const tryLimit = (value: string): void => actions.attempt(change({ ...draft.now(), limited: { ...limits.now(), from: "own", value } }));
  const leave = (): void => {
    draft.say({ ...draft.now(), words: null, word: null, file: null });
    actions.make(change(draft.now()));
  };
  const head = h("div", { class: "field-head" }, h("h3", {}, title), ...origin(clip, title, leave));
  const place = h("section", { class: "field", attributes: { "data-attribute": "Motion", "aria-label": title } }, head);
  fill(place, head, h("p", { class: "muted field-note" }, ...inCode(`${summary.charAt(0).toUpperCase()}${summary.slice(1)}.`)), choice(clip, title, motion, set, leave), ...(clip.words === null ? [] : [...details(clip, title, set, attempt), ...limiting(limits, title, limit, tryLimit), ...chosen(within(draft, "held"), title, limit)]));
  return place;
}

/** Which clip it is. */
function choice(clip: ClipForm, title: string, { choices, files }: MotionForm, set: (different: Different) => void, leave: () => void): HTMLElement {
  const select = h("select", { class: "select", attributes: { "aria-label": `${title}: clip`, "data-key": `${title} clip` } });
  const option = (value: string, text: string): HTMLElement => h("option", { attributes: { value } }, text);
  const { words, word, file } = clip;
  const isOther = words !== null && word === null && file === null;
  // A file that is elsewhere, or missing, is one to choose, too.
  const all = file === null || files.includes(file) ? files : [file, ...files];
  const now = words === null ? "none" : isOther ? "other" : file === null ? `=${word}` : `"${file}"`;
  fill(
    select,
    option("none", "none"),
    isOther && option("other", clip.arguments),
    option("=", "the one that fits the figure"),
    ...choices.map(([word, about]) => option(`=${word}`, `${word} — ${about.replaceAll("`", "")}`)),
    all.length > 0 && h("optgroup", { attributes: { label: "Motion files" } }, ...all.map((file) => option(`"${file}"`, file))),
  );
  select.value = now;
  select.addEventListener("change", () => {
    const { value } = select;
    if (value === "none") leave();
    else if (value.startsWith("=")) set({ word: value.slice(1) });
    else if (value.startsWith('"')) set({ file: value.slice(1, -1) });
  });
  return select;
}

/** What is said of a clip. Clips that play in turn are written in the drawing. */
function details(clip: ClipForm, title: string, set: (different: Different) => void, attempt: (different: Different) => void): HTMLElement[] {
  const number = (which: Numbers): HTMLElement[] => {
    const argument = clip[which];
    const { takes } = argument;
    if (takes.type !== "number") return [];
    const controls = numberControl(takes, argument, `${title}: ${which}`, `${title} ${which}`, (value) => set({ [which]: value }), (value) => attempt({ [which]: value }), () => set({ [which]: "" }));
    return [h("div", { class: "argument" }, h("span", { class: "argument-name", title: argument.summary }, which), ...controls, h("span", { class: "muted argument-note" }, ...inCode(argument.summary)))];
  };
  const flags = clip.flags.map(({ letter, summary, on }) => {
    const box = h("input", { attributes: { type: "checkbox", "data-key": `${title} -${letter}` } });
    box.checked = on;
    box.addEventListener("change", () => set({ flags: { [letter]: box.checked } }));
    return h("label", { class: "switch" }, box, h("span", {}, ...inCode(summary)));
  });
  const numbers: readonly Numbers[] = clip.word !== null ? ["seconds", "speed"] : clip.file !== null ? ["start", "end", "speed"] : [];
  return [...numbers.flatMap(number), ...flags];
}

/** Its limited animation. */
function limiting(draft: Draft<Field>, title: string, limit: () => void, attempt: Trying): HTMLElement[] {
  const limited = draft.now();
  const own = limited.from === "own";
  const box = h("input", { attributes: { type: "checkbox", "data-key": `${title} limited` } });
  box.checked = own;
  box.addEventListener("change", () => {
    const now = draft.now();
    const which = Math.max(now.chosen ?? 0, 0);
    const numbers = (now.value ?? LIMITS).split(" ");
    draft.say(box.checked ? saying(now, which, numbers, new Set()) : { ...silent(now), from: "default" });
    limit();
  });
  const about = own || limited.value === null ? limited.summary : `limited in its own way: \`Limited ${limited.value}\` is for all clips`;
  const named: Draft<Field> = {
    now: () => ({ ...draft.now(), attribute: title.replace("Motion", "Limited") }),
    say: (next) => draft.say({ ...next, attribute: limited.attribute }),
  };
  return [h("label", { class: "switch" }, box, h("span", {}, ...inCode(about))), ...(own ? fieldControls(named, limit, attempt) : [])];
}

/** Its drawings that are chosen by hand, above the timeline. */
function chosen(draft: Draft<Field>, title: string, send: () => void): HTMLElement[] {
  const { from, value } = draft.now();
  if (from !== "own" || value === null) return [];
  const count = readHeld(value).size;
  const forget = (): void => {
    draft.say({ ...silent(draft.now()), from: "builtin" });
    send();
  };
  const words = count === 1 ? "One drawing is chosen by hand" : `${count} drawings are chosen by hand`;
  const reset = h("button", { class: "button reset", title: "Let no drawing stand as it was dragged", attributes: { type: "button", "aria-label": `Reset ${title.replace("Motion", "Held")}`, "data-key": `${title} held` }, on: { click: forget } }, icon(RotateCcw), "Reset");
  return [h("div", { class: "field-origin" }, h("span", { class: "muted field-from", title: `Held ${value}` }, words), reset)];
}

function origin(clip: ClipForm, title: string, leave: () => void): HTMLElement[] {
  if (clip.words === null) return [];
  const said = h("span", { class: "muted field-from", ...(clip.string === null ? {} : { title: clip.string }) }, clip.from === "own" ? "set here" : "for the whole drawing");
  const reset = h("button", { class: "button reset", title: "Take this clip away", attributes: { type: "button", "aria-label": `Reset ${title}`, "data-key": `${title} reset` }, on: { click: leave } }, icon(RotateCcw), "Reset");
  return [said, reset];
}

type Numbers = "seconds" | "start" | "end" | "speed";

/** What is changed about a clip. Numbers are left out if they are empty. */
interface Different extends Readonly<Partial<Record<Numbers, string>>> {
  readonly word?: string;
  readonly file?: string;
  readonly flags?: Readonly<Record<string, boolean>>;
}

/** A clip with something changed. */
function changed(clip: ClipForm, { word, file, flags: switched, ...numbers }: Different): ClipForm {
  const flags = clip.flags.map((flag) => ({ ...flag, on: switched?.[flag.letter] ?? flag.on }));
  const letters = flags.filter(({ on }) => on).map(({ letter }) => letter);
  const dashed = letters.length > 0 ? `-${letters.join("")}` : "";
  const isOther = word !== undefined || file !== undefined;
  // Clips that play in turn stay as they are written, unless another one takes their place.
  if (clip.words !== null && clip.word === null && clip.file === null && !isOther) return { ...clip, flags, words: join(dashed, clip.arguments) };
  // What is said of a part of a file is of no other clip. A file ends in one way.
  const gone = isOther ? { start: "", end: "" } : numbers.end ? { seconds: "" } : {};
  const says = { ...numbers, ...gone };
  const number = (which: Numbers): Argument => ({ ...clip[which], value: says[which] === undefined ? clip[which].value : says[which] || null });
  const next = {
    ...clip,
    flags,
    word: isOther ? (word ?? null) : clip.word,
    file: isOther ? (file ?? null) : clip.file,
    up: isOther ? null : clip.up,
    seconds: number("seconds"),
    start: number("start"),
    end: number("end"),
    speed: number("speed"),
  };
  if (next.word === null && next.file === null) next.word = "";
  const value = (before: string, which: Numbers): string => (next[which].value === null ? "" : join(before, next[which].value));
  const speed = Number(next.speed.value ?? 1) === 1 ? "" : value("speed", "speed");
  const ofFile = [`"${next.file}"`, clip.name ?? "", next.up ?? "", value("", "seconds"), value("from", "start"), value("to", "end"), speed];
  const said = next.file === null ? join(next.word ?? "", value("", "seconds"), speed, clip.name ?? "") : join(...ofFile);
  return { ...next, arguments: said, words: join(dashed, said) };
}

const join = (...words: readonly string[]): string => words.filter((word) => word !== "").join(" ");
