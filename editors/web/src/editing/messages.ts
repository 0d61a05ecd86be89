// What page and host say to each other about changes. Answers are checked here, as messages are in `protocol.ts`.

/** A change of a drawing. Parts are called as in the list. */
export type Change =
  | { readonly change: "set"; readonly part: string; readonly attribute: string; readonly value: string }
  | { readonly change: "reset"; readonly part: string; readonly attribute: string }
  | { readonly change: "name"; readonly part: string; readonly name: string }
  | { readonly change: "hang"; readonly part: string; readonly parent: string | null }
  | { readonly change: "leave-out"; readonly part: string }
  /** Without a motion the clip is taken away; the number after that of the last clip adds one. */
  | { readonly change: "clip"; readonly part: string; readonly clip: number; readonly motion: string | null; readonly limited: string | null; readonly held: string | null };

/** A shape, in user units of the drawing, y down. */
export type NewShape =
  /** Path data; each of its pieces is closed. */
  | { readonly path: string }
  /** Centre and radii. */
  | { readonly ellipse: readonly [number, number, number, number] }
  /** Left, top, width and height. */
  | { readonly rect: readonly [number, number, number, number] };

/** A change of what is drawn. */
export type DrawnChange =
  | { readonly change: "draw"; readonly shape: NewShape; readonly fill: string }
  /** To the right and down, in user units. */
  | { readonly change: "move"; readonly part: string; readonly by: readonly [number, number] }
  | { readonly change: "restack"; readonly part: string; readonly to: "front" | "forward" | "backward" | "back" }
  | { readonly change: "erase"; readonly part: string }
  | { readonly change: "paint"; readonly part: string; readonly fill: string };

/** A part that is turned, by degrees from how it is drawn, counter-clockwise. */
export interface Turn {
  readonly part: string;
  readonly degrees: number;
}

/** A moment of a movement, with the parts that are turned otherwise than in the one before. */
export interface Moment {
  readonly seconds: number;
  readonly turns: readonly Turn[];
}

/** A change that makes key poses of a pose, or of a movement. */
export type KeepPose = { readonly change: "keep-pose"; readonly turns: readonly Turn[] } | { readonly change: "keep-movement"; readonly moments: readonly Moment[] };

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

/** What can be changed about a clip. */
export interface ClipForm {
  /** What the string says behind `Motion`; null for a clip that is not there yet. */
  readonly words: string | null;
  /** The same without its flags. */
  readonly arguments: string;
  /** The word of a clip that comes along, empty for the one that fits; null for all others. */
  readonly word: string | null;
  /** The file that it plays; null for all others. */
  readonly file: string | null;
  /** The axis of the file that points up, as it is written. */
  readonly up: string | null;
  /** Its name, as it is written. */
  readonly name: string | null;
  readonly from: string;
  readonly string: string | null;
  readonly flags: Field["flags"];
  readonly seconds: Argument;
  /** Where in the file it begins and ends. */
  readonly start: Argument;
  readonly end: Argument;
  readonly speed: Argument;
  readonly limited: Field;
  /** Drawings that are chosen by hand. */
  readonly held: Field;
  /** The clip in the model: its name, and the part that it moves as the figure's root; null if it does not play. */
  readonly plays: { readonly name: string; readonly root: string } | null;
}

/** The clips of a figure, as they were said last. */
export interface MotionForm {
  /** The part that carries the figure. */
  readonly figure: string;
  readonly summary: string;
  readonly choices: readonly (readonly [word: string, summary: string])[];
  /** Motion files beside the drawing. */
  readonly files: readonly string[];
  clips: readonly ClipForm[];
  new: ClipForm;
}

/** Where a part is in the model. Directions are those in the frame of its node, points those of the drawing, y down. */
export interface PlaceForm {
  readonly meters: number;
  readonly right: readonly [number, number, number];
  readonly up: readonly [number, number, number];
  readonly front: readonly [number, number, number];
  readonly joint: readonly [number, number];
  /** What `Origin` has words for. */
  readonly points: readonly { readonly word: string; readonly at: readonly [number, number] }[];
}

/** What can be changed about a part, as it was said last. */
export interface PartForm {
  /** Its name, which may become another one while the form is shown. */
  part: string;
  /** Whether a person named it. */
  readonly named: boolean;
  /** Whether it has a place in the figure: a name that others use, and a parent. */
  readonly node: boolean;
  readonly parent: string | null;
  readonly parents: readonly string[];
  fields: readonly Field[];
  /** The clips of its figure; null if it is in none. */
  readonly motion: MotionForm | null;
  /** Null for a part that has no node of its own. */
  readonly place: PlaceForm | null;
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
    motion: raw["motion"] === undefined || raw["motion"] === null ? null : readMotion(object(raw["motion"])),
    place: raw["place"] === undefined || raw["place"] === null ? null : readPlace(object(raw["place"])),
  };
}

function readPlace(raw: Raw): PlaceForm {
  const numbers = (value: unknown): readonly number[] => list(value).map((one) => number(one, 0));
  const way = (value: unknown) => {
    const [x = 0, y = 0, z = 0] = numbers(value);
    return [x, y, z] as const;
  };
  const point = (value: unknown) => {
    const [x = 0, y = 0] = numbers(value);
    return [x, y] as const;
  };
  return {
    meters: number(raw["meters"], 0.01),
    right: way(raw["right"]),
    up: way(raw["up"]),
    front: way(raw["front"]),
    joint: point(raw["joint"]),
    points: list(raw["points"]).map((value) => ({ word: text(object(value)["word"]), at: point(object(value)["at"]) })),
  };
}

function readMotion(raw: Raw): MotionForm {
  return {
    figure: text(raw["figure"]),
    summary: text(raw["summary"]),
    choices: list(raw["choices"]).map(readWord),
    files: list(raw["files"]).map(text),
    clips: list(raw["clips"]).map(readClip),
    new: readClip(raw["new"]),
  };
}

function readClip(value: unknown): ClipForm {
  const raw = object(value);
  return {
    words: textOrNull(raw["words"]),
    arguments: text(raw["arguments"]),
    word: textOrNull(raw["word"]),
    file: textOrNull(raw["file"]),
    up: textOrNull(raw["up"]),
    name: textOrNull(raw["name"]),
    from: text(raw["from"]),
    string: textOrNull(raw["string"]),
    flags: readFlags(raw["flags"]),
    seconds: readArgument(raw["seconds"]),
    start: readArgument(raw["start"]),
    end: readArgument(raw["end"]),
    speed: readArgument(raw["speed"]),
    limited: readField(raw["limited"]),
    held: readField(raw["held"]),
    plays: raw["plays"] == null ? null : { name: text(object(raw["plays"])["name"]), root: text(object(raw["plays"])["root"]) },
  };
}

const readWord = (word: unknown): readonly [string, string] => [text(list(word)[0]), text(list(word)[1])];

const readFlags = (value: unknown): Field["flags"] =>
  list(value).map((value) => {
    const flag = object(value);
    return { letter: text(flag["letter"]), summary: text(flag["summary"]), on: flag["on"] === true };
  });

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
    flags: readFlags(raw["flags"]),
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
      return { type, words: list(raw["words"]).map(readWord) };
    case "hex":
    case "color":
    case "file":
    case "names":
      return { type };
    default:
      return { type: "text" };
  }
}
