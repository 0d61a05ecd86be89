// The messages between page and host. Incoming messages are checked here, once: unknown ones are dropped, and missing fields become
// empty.

export type Severity = "error" | "warning" | "hint";

export interface Listed {
  readonly id: string;
  readonly name: string;
  readonly folder: string;
}

/** A diagnostic. Lines and columns count from 1, `from` and `to` are offsets in `text` from 0; all in characters. */
export interface Finding {
  readonly severity: Severity;
  readonly code: string;
  readonly message: string;
  readonly label: string;
  /** Where it is on the page; empty if that is not known, or if the message says it. */
  readonly place: string;
  readonly help: readonly string[];
  readonly line: number;
  readonly column: number;
  readonly text: string;
  readonly from: number;
  readonly to: number;
}

export type Kind = "main" | "sub" | "legend" | "unused" | "terrain" | "character" | "region";
export type Source = "own" | "legend" | "default" | "builtin";

export interface StringOfPart {
  readonly line: number;
  readonly column: number;
  readonly text: string;
  readonly boundBy: string;
  /** The other shape that it may mean, if that is uncertain. */
  readonly mayMean: string | null;
}

export interface Part {
  readonly name: string;
  /** Null for children of the root, and for parts that are not in the model. */
  readonly parent: string | null;
  readonly kind: Kind;
  readonly element: string;
  /** Where its name is from: "string", "label", "id" or "automatic"; null for parts that are not in the hierarchy. */
  readonly namedBy: string | null;
  readonly string: StringOfPart | null;
  readonly attributes: readonly { readonly name: string; readonly value: string; readonly from: Source }[];
  readonly joint: string | null;
  /** How far its plane is in front of the drawing plane, in drawing units; null for parts without a node. */
  readonly depth: number | null;
  /** Why, in words; null for a part in the plane of its parent. */
  readonly depthWhy: string | null;
  /** What it shows from behind beside its own back; null for nothing. */
  readonly back: string | null;
  /** What is done to its form without a string that says so; null for nothing. */
  readonly form: string | null;
  /** What undoes the depth, the back and the form in a string; null for what is not automatic. */
  readonly undo: { readonly depth: string | null; readonly back: string | null; readonly form: string | null };
}

/** Facts about a figure's clip that are not in the model's animation of the same name. Frames count from 0. */
export interface ClipFacts {
  readonly name: string;
  /** The name of the figure's root part. */
  readonly figure: string;
  /** The link to the motion file. */
  readonly file: string;
  readonly seconds: number;
  readonly fps: number;
  /** The number of frames as shown. */
  readonly frames: number;
  /** The number of distinct poses shown. */
  readonly drawings: number;
  /** Whether in-betweens were omitted or poses held. */
  readonly limited: boolean;
  /** The exposure sheet: source frames, and for how many frames each is shown. */
  readonly exposure: readonly (readonly [source: number, frames: number])[];
  /** The drawings that are chosen by hand: source frames, and for how many frames each is to be shown. */
  readonly chosen: readonly (readonly [source: number, frames: number])[];
  /** The omitted source frames. */
  readonly omitted: readonly number[];
  /** The shown frames that repeat the pose before. */
  readonly held: readonly number[];
  /** For each source frame: the sum of the squared distances of all joints to the frame before, in squares of the motion file's unit. */
  readonly ssd: readonly number[];
  /** The number of source frames for which an entry of `ssd` is the maximum. */
  readonly ssdStep: number;
  /** The joint that drives a part, and why. */
  readonly joints: ReadonlyMap<string, { readonly joint: string; readonly why: string }>;
  /** Parts that no joint drives. */
  readonly unmatched: readonly string[];
  readonly performance: PerformanceFacts | null;
}

/** What a performance does to a clip. Frames count from 0. */
export interface PerformanceFacts {
  /** The link to the file of the track. */
  readonly track: string;
  readonly marks: readonly {
    readonly name: string;
    /** As `#rrggbb`; empty if unknown. */
    readonly color: string;
    readonly parts: readonly string[];
    /** Its largest movement over that of the emphasised mark, 0 to 1. */
    readonly ratio: number;
    readonly emphasized: boolean;
    readonly damped: boolean;
  }[];
  /** The frames of the largest movements. */
  readonly keys: { readonly performance: number; readonly motion: number } | null;
  /** The shown frame in which the key pose stands, which limited animation may move. */
  readonly shown: number | null;
  /** Whether the motion has the timing of the performance. */
  readonly timed: boolean;
  /** How many frames both have. */
  readonly frames: { readonly performance: number; readonly motion: number };
  readonly filming: "camera" | "root" | "none";
  /** The shown frame in which the camera, or the figure, is nearest. */
  readonly nearest: number | null;
  /** Frames of the performance with the frames of the motion that they show, ascending; between them the timing is linear. */
  readonly timing: readonly (readonly [performance: number, motion: number])[];
  /** For each mark and frame how much it moves, as a ratio of the largest movement. */
  readonly input: readonly (readonly number[])[];
  /** The number of frames for which an entry is the maximum. */
  readonly inputStep: number;
  /** The same of the joints of the motion that the marks perform. */
  readonly motion: readonly (readonly number[])[];
  readonly motionStep: number;
}

/** Lengths along x, y and z. */
export interface Size {
  readonly width: number;
  readonly height: number;
  readonly depth: number;
}

export interface Build {
  readonly revision: number;
  readonly milliseconds: number;
  readonly model: string | null;
  readonly picture: string | null;
  /** The address of the page of the drawing; null if none was ever read. */
  readonly paper: string | null;
  readonly stale: boolean;
  /** Whether the model is only what can be built of a drawing with errors. */
  readonly incomplete: boolean;
  readonly triangles: number;
  /** The size of the model in its rest pose, in metres; null without a model. */
  readonly size: Size | null;
  readonly findings: readonly Finding[];
  readonly parts: readonly Part[];
  readonly clips: readonly ClipFacts[];
  /** The address of the clips before they were performed and limited; null if none was. */
  readonly originals: string | null;
  /** The address of other files of the drawing, without their endings; null if there are none. */
  readonly exports: string | null;
}

export interface Point {
  readonly x: number;
  readonly y: number;
}

/** Left, top, right and bottom. */
export type Box = readonly [number, number, number, number];

/** The page of a drawing, in user units, y down. */
export interface Paper {
  /** Left, top, width and height. */
  readonly page: Box;
  /** The drawing as SVG. */
  readonly picture: string;
  /** The pictures that it links to and that are not in it: they are too large. */
  readonly leftOut: readonly string[];
  /** The shapes in paint order, as path data to be filled by the even-odd rule. */
  readonly shapes: readonly { readonly part: string; readonly area: string }[];
  /** The strings that are written on it, with their estimated boxes. */
  readonly strings: readonly { readonly part: string; readonly box: Box }[];
}

/** A drawing to start from. */
export interface Starter {
  readonly name: string;
  readonly about: string;
  /** The address of its picture; null for an empty page. */
  readonly picture: string | null;
}

/** What is offered while there are no drawings; the host asks for the key when one is chosen. */
export interface Offer {
  readonly key: string;
  readonly starters: readonly Starter[];
}

export type FromHost =
  | { readonly type: "drawings"; readonly drawings: readonly Listed[] }
  | { readonly type: "build"; readonly drawing: string; readonly build: Build }
  | { readonly type: "gone"; readonly drawing: string }
  | ({ readonly type: "starters" } & Offer)
  | { readonly type: "unbegun"; readonly why: string }
  /** With `copy`, what is changed is a copy of the drawing, which is open in another program. */
  | { readonly type: "editing"; readonly key: string; readonly copy: boolean }
  | { readonly type: "steps"; readonly drawing: string; readonly undo: string | null; readonly redo: string | null }
  | { readonly type: "light"; readonly drawing: string; readonly part: string | null };

export type ToHost =
  | { readonly type: "pick"; readonly drawing: string; readonly part: string }
  | { readonly type: "want"; readonly drawing: string }
  | { readonly type: "begin"; readonly key: string; readonly starter: string }
  | { readonly type: "open"; readonly drawing: string; readonly line: number; readonly column: number };

type Raw = Readonly<Record<string, unknown>>;

const object = (value: unknown): Raw => (typeof value === "object" && value !== null ? (value as Raw) : {});
const list = (value: unknown): readonly unknown[] => (Array.isArray(value) ? value : []);
const text = (value: unknown): string => (typeof value === "string" ? value : typeof value === "number" ? String(value) : "");
const textOrNull = (value: unknown): string | null => (typeof value === "string" ? value : null);
const number = (value: unknown): number => (typeof value === "number" && Number.isFinite(value) ? value : 0);

/** A count. */
const whole = (value: unknown): number => Math.max(Math.floor(number(value)), 0);

function oneOf<T extends string>(value: unknown, all: readonly T[], otherwise: T): T {
  return all.find((one) => one === value) ?? otherwise;
}

/** Parses messages of a connection: a build may only hold what changed since the build that was sent before. */
export class Messages {
  /** The last build of each drawing. */
  private readonly builds = new Map<string, Build>();

  /** Null if the type of the message is unknown, `missed` if it refers to a build that did not arrive. */
  read(data: unknown): FromHost | "missed" | null {
    const raw = object(data);
    const changes = object(raw["build"]);
    if (raw["type"] === "build" && typeof changes["since"] === "number") {
      const last = this.builds.get(text(raw["drawing"]));
      if (last?.revision !== changes["since"]) return "missed";
      return this.keep({ type: "build", drawing: text(raw["drawing"]), build: readBuild(changes, last.parts) });
    }
    return this.keep(read(data));
  }

  private keep(message: FromHost | null): FromHost | null {
    if (message?.type === "build") this.builds.set(message.drawing, message.build);
    return message;
  }
}

/** Parses a message that stands by itself; null if its type is unknown. */
export function read(data: unknown): FromHost | null {
  const raw = object(data);
  const drawing = text(raw["drawing"]);
  switch (raw["type"]) {
    case "drawings":
      return { type: "drawings", drawings: list(raw["drawings"]).map(readListed) };
    case "build":
      return { type: "build", drawing, build: readBuild(object(raw["build"])) };
    case "gone":
      return { type: "gone", drawing };
    case "light":
      return { type: "light", drawing, part: textOrNull(raw["part"]) };
    case "starters":
      return { type: "starters", key: text(raw["key"]), starters: list(raw["starters"]).map(readStarter) };
    case "editing":
      return { type: "editing", key: text(raw["key"]), copy: raw["copy"] === true };
    case "steps":
      return { type: "steps", drawing, undo: textOrNull(raw["undo"]), redo: textOrNull(raw["redo"]) };
    case "unbegun":
      return { type: "unbegun", why: text(raw["why"]) };
    default:
      return null;
  }
}

function readStarter(value: unknown): Starter {
  const raw = object(value);
  return { name: text(raw["name"]), about: text(raw["about"]), picture: textOrNull(raw["picture"]) };
}

function readListed(value: unknown): Listed {
  const raw = object(value);
  return { id: text(raw["id"]), name: text(raw["name"]) || text(raw["id"]), folder: text(raw["folder"]) };
}

/** `kept`: the parts of the build to which it refers. */
function readBuild(raw: Raw, kept: readonly Part[] = []): Build {
  return {
    revision: number(raw["revision"]),
    milliseconds: number(raw["milliseconds"]),
    model: textOrNull(raw["model"]),
    picture: textOrNull(raw["picture"]),
    paper: textOrNull(raw["paper"]),
    stale: raw["stale"] === true,
    incomplete: raw["incomplete"] === true,
    triangles: number(raw["triangles"]),
    size: readSize(raw["size"]),
    findings: list(raw["findings"]).map(readFinding),
    parts: list(raw["parts"]).flatMap((part) => (Array.isArray(part) ? kept.slice(whole(part[0]), whole(part[0]) + whole(part[1])) : readPart(part))),
    clips: list(raw["clips"]).map(readClip),
    originals: textOrNull(raw["originals"]),
    exports: textOrNull(raw["exports"]),
  };
}

export function readPaper(value: unknown): Paper {
  const raw = object(value);
  const box = (value: unknown): Box => {
    const [a, b, c, d] = list(value).map(number);
    return [a ?? 0, b ?? 0, c ?? 0, d ?? 0];
  };
  return {
    page: box(raw["page"]),
    picture: text(raw["picture"]),
    leftOut: list(raw["left_out"]).map(text),
    shapes: list(raw["shapes"]).map((shape) => ({ part: text(list(shape)[0]), area: text(list(shape)[1]) })),
    strings: list(raw["strings"]).map((string) => ({ part: text(list(string)[0]), box: box(list(string)[1]) })),
  };
}

function readSize(value: unknown): Size | null {
  const raw = object(value);
  return typeof raw["height"] === "number" ? { width: number(raw["width"]), height: number(raw["height"]), depth: number(raw["depth"]) } : null;
}

function readClip(value: unknown): ClipFacts {
  const raw = object(value);
  const reasons = object(raw["joint_reasons"]);
  return {
    name: text(raw["name"]),
    figure: text(raw["figure"]),
    file: text(raw["file"]),
    seconds: number(raw["seconds"]),
    fps: number(raw["fps"]),
    frames: whole(raw["frames"]),
    drawings: whole(raw["drawings"]),
    limited: raw["limited"] === true,
    exposure: list(raw["exposure"]).map((run) => [whole(list(run)[0]), whole(list(run)[1])]),
    chosen: list(raw["chosen"]).map((run) => [whole(list(run)[0]), whole(list(run)[1])]),
    omitted: list(raw["omitted"]).map(whole),
    held: list(raw["held"]).map(whole),
    ssd: list(raw["ssd"]).map(number),
    ssdStep: Math.max(whole(raw["ssd_step"]), 1),
    joints: new Map(Object.entries(object(raw["joints"])).map(([part, joint]) => [part, { joint: text(joint), why: text(reasons[part]) }])),
    unmatched: list(raw["unmatched"]).map(text),
    performance: raw["performance"] === undefined || raw["performance"] === null ? null : readPerformance(object(raw["performance"])),
  };
}

function readPerformance(raw: Raw): PerformanceFacts {
  const frames = (value: unknown) => ({ performance: whole(object(value)["performed"]), motion: whole(object(value)["motion"]) });
  const curves = (value: unknown) => list(value).map((curve) => list(curve).map(number));
  return {
    track: text(raw["track"]),
    marks: list(raw["marks"]).map((value) => {
      const mark = object(value);
      const color = text(mark["color"]);
      return {
        name: text(mark["name"]),
        color: /^#[0-9a-f]{6}$/i.test(color) ? color : "",
        parts: list(mark["performs"]).map(text),
        ratio: number(mark["ratio"]),
        emphasized: mark["emphasized"] === true,
        damped: mark["damped"] === true,
      };
    }),
    keys: raw["keys"] === undefined || raw["keys"] === null ? null : frames(raw["keys"]),
    shown: typeof raw["shown"] === "number" ? whole(raw["shown"]) : null,
    timed: raw["timed"] === true,
    frames: frames(raw["lengths"]),
    filming: oneOf(raw["filming"], ["camera", "root", "none"], "none"),
    nearest: typeof raw["nearest"] === "number" ? whole(raw["nearest"]) : null,
    timing: list(raw["timing"]).map((point) => [whole(list(point)[0]), whole(list(point)[1])]),
    input: curves(raw["input_curves"]),
    inputStep: Math.max(whole(raw["input_step"]), 1),
    motion: curves(raw["motion_curves"]),
    motionStep: Math.max(whole(raw["motion_step"]), 1),
  };
}

function readFinding(value: unknown): Finding {
  const raw = object(value);
  return {
    severity: oneOf<Severity>(raw["severity"], ["error", "warning", "hint"], "error"),
    code: text(raw["code"]),
    message: text(raw["message"]),
    label: text(raw["label"]),
    place: text(raw["place"]),
    help: list(raw["help"]).map(text),
    line: number(raw["line"]),
    column: number(raw["column"]),
    text: text(raw["text"]),
    from: number(raw["from"]),
    to: number(raw["to"]),
  };
}

function readPart(value: unknown): Part {
  const raw = object(value);
  const string = raw["string"] === undefined || raw["string"] === null ? null : object(raw["string"]);
  const undo = object(raw["undo"]);
  return {
    name: text(raw["name"]),
    parent: textOrNull(raw["parent"]),
    kind: oneOf<Kind>(raw["kind"], ["main", "sub", "legend", "unused", "terrain", "character", "region"], "main"),
    element: text(raw["element"]),
    namedBy: textOrNull(raw["named_by"]),
    string: string && {
      line: number(string["line"]),
      column: number(string["column"]),
      text: text(string["text"]),
      boundBy: text(string["bound_by"]),
      mayMean: textOrNull(string["may_mean"]),
    },
    attributes: Object.entries(object(raw["attributes"])).map(([name, attribute]) => {
      const { value, from } = object(attribute);
      return { name, value: text(value), from: oneOf<Source>(from, ["own", "legend", "default", "builtin"], "builtin") };
    }),
    joint: textOrNull(raw["joint"]),
    depth: typeof raw["depth"] === "number" ? number(raw["depth"]) : null,
    depthWhy: textOrNull(raw["depth_why"]),
    back: textOrNull(raw["back"]),
    form: textOrNull(raw["form"]),
    undo: { depth: textOrNull(undo["depth_why"]), back: textOrNull(undo["back"]), form: textOrNull(undo["form"]) },
  };
}
