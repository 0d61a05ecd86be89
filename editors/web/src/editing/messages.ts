// What page and host say to each other about changes. Answers are checked here, as messages are in `protocol.ts`.

/** A change of a drawing. Parts are called as in the list. */
export type Change =
  | { readonly change: "set"; readonly part: string; readonly attribute: string; readonly value: string }
  | { readonly change: "reset"; readonly part: string; readonly attribute: string }
  | { readonly change: "name"; readonly part: string; readonly name: string }
  | { readonly change: "hang"; readonly part: string; readonly parent: string | null }
  | { readonly change: "leave-out"; readonly part: string };

/** A change that can be made instead of one that was refused. It goes back as it came. */
export interface Choice {
  readonly title: string;
  readonly change: unknown;
}

/** Why a change was not made, as a sentence without its full stop. */
export interface Refusal {
  readonly why: string;
  readonly choices: readonly Choice[];
}

export interface NumberControl {
  readonly type: "number";
  readonly min: number | null;
  readonly max: number | null;
  readonly low: number;
  readonly high: number;
  readonly step: number;
  /** What it is without being written; null if that is not known. */
  readonly start: number | null;
}

export type Control = NumberControl | { readonly type: "choice"; readonly words: readonly (readonly [word: string, summary: string])[] } | { readonly type: "hex" | "color" | "file" | "text" | "names" };

export interface Argument {
  readonly name: string;
  readonly summary: string;
  readonly takes: Control;
  /** As it is written; null if it is left out. */
  readonly value: string | null;
}

/** An argument list: a word, if it begins with one, and what follows. */
export interface Variant {
  readonly word: string | null;
  readonly summary: string;
  /** How many arguments may follow. */
  readonly counts: readonly number[];
  readonly arguments: readonly Argument[];
}

export interface Field {
  readonly attribute: string;
  readonly summary: string;
  readonly manual: string;
  readonly value: string | null;
  readonly from: string;
  /** The string that says it. */
  readonly string: string | null;
  /** The other parts for which a legend says it, too. */
  readonly shared: readonly string[];
  readonly default: string;
  readonly flags: readonly { readonly letter: string; readonly summary: string; readonly on: boolean }[];
  readonly variants: readonly Variant[];
  /** The index of the variant that the value is of. */
  readonly chosen: number | null;
}

/** What can be changed about a part. */
export interface PartForm {
  /** Its name, which may become another one while the form is shown. */
  part: string;
  /** Whether a person named it. */
  readonly named: boolean;
  /** Whether it has a place in the figure: a name that others use, and a parent. */
  readonly node: boolean;
  readonly parent: string | null;
  readonly parents: readonly string[];
  readonly fields: readonly Field[];
}

type Raw = Readonly<Record<string, unknown>>;
const object = (value: unknown): Raw => (typeof value === "object" && value !== null ? (value as Raw) : {});
const list = (value: unknown): readonly unknown[] => (Array.isArray(value) ? value : []);
const text = (value: unknown): string => (typeof value === "string" ? value : "");
const textOrNull = (value: unknown): string | null => (typeof value === "string" ? value : null);
const number = (value: unknown, otherwise: number): number => (typeof value === "number" && Number.isFinite(value) ? value : otherwise);
const numberOrNull = (value: unknown): number | null => (typeof value === "number" && Number.isFinite(value) ? value : null);

export function readRefusal(value: unknown): Refusal {
  const raw = object(value);
  return {
    why: text(raw["why"]) || "the program did not answer",
    choices: list(raw["choices"]).map((value) => {
      const choice = object(value);
      return { title: text(choice["title"]), change: choice["change"] };
    }),
  };
}

export function readForm(value: unknown): PartForm {
  const raw = object(value);
  return {
    part: text(raw["part"]),
    named: raw["named"] === true,
    node: raw["node"] === true,
    parent: textOrNull(raw["parent"]),
    parents: list(raw["parents"]).map(text),
    fields: list(raw["fields"]).map(readField),
  };
}

function readField(value: unknown): Field {
  const raw = object(value);
  return {
    attribute: text(raw["attribute"]),
    summary: text(raw["summary"]),
    manual: text(raw["manual"]),
    value: textOrNull(raw["value"]),
    from: text(raw["from"]),
    string: textOrNull(raw["string"]),
    shared: list(raw["shared"]).map(text),
    default: text(raw["default"]),
    flags: list(raw["flags"]).map((value) => {
      const flag = object(value);
      return { letter: text(flag["letter"]), summary: text(flag["summary"]), on: flag["on"] === true };
    }),
    variants: list(raw["variants"]).map((value) => {
      const variant = object(value);
      return {
        word: textOrNull(variant["word"]),
        summary: text(variant["summary"]),
        counts: list(variant["counts"]).map((count) => number(count, 0)),
        arguments: list(variant["arguments"]).map(readArgument),
      };
    }),
    chosen: numberOrNull(raw["chosen"]),
  };
}

function readArgument(value: unknown): Argument {
  const raw = object(value);
  return { name: text(raw["name"]), summary: text(raw["summary"]), takes: readControl(object(raw["takes"])), value: textOrNull(raw["value"]) };
}

function readControl(raw: Raw): Control {
  const type = text(raw["type"]);
  switch (type) {
    case "number":
      return { type, min: numberOrNull(raw["min"]), max: numberOrNull(raw["max"]), low: number(raw["low"], 0), high: number(raw["high"], 1), step: number(raw["step"], 0.01), start: numberOrNull(raw["start"]) };
    case "choice":
      return { type, words: list(raw["words"]).map((word) => [text(list(word)[0]), text(list(word)[1])] as const) };
    case "hex":
    case "color":
    case "file":
    case "names":
      return { type };
    default:
      return { type: "text" };
  }
}
