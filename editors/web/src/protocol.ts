// What the page and its host say to each other. What comes in is checked once, here: unknown messages are dropped, and what is
// missing in a known one is empty.

export type Severity = "error" | "warning" | "hint";

export interface Listed {
  readonly id: string;
  readonly name: string;
  readonly folder: string;
}

/** A diagnostic. Lines and columns count from 1, `from` and `to` are places in `text` from 0; all in characters. */
export interface Finding {
  readonly severity: Severity;
  readonly code: string;
  readonly message: string;
  readonly label: string;
  readonly help: readonly string[];
  readonly line: number;
  readonly column: number;
  readonly text: string;
  readonly from: number;
  readonly to: number;
}

export type Kind = "main" | "sub" | "legend" | "unused" | "terrain";
export type Source = "own" | "legend" | "default" | "builtin";

export interface Part {
  readonly name: string;
  /** Null for what hangs on the root, and for what is in no model. */
  readonly parent: string | null;
  readonly kind: Kind;
  readonly element: string;
  readonly string: { readonly line: number; readonly column: number; readonly text: string; readonly boundBy: string } | null;
  readonly attributes: readonly { readonly name: string; readonly value: string; readonly from: Source }[];
  readonly joint: string | null;
}

export interface Build {
  readonly revision: number;
  readonly milliseconds: number;
  readonly model: string | null;
  readonly picture: string | null;
  readonly stale: boolean;
  readonly triangles: number;
  readonly findings: readonly Finding[];
  readonly parts: readonly Part[];
}

export type FromHost =
  | { readonly type: "drawings"; readonly drawings: readonly Listed[] }
  | { readonly type: "build"; readonly drawing: string; readonly build: Build }
  | { readonly type: "gone"; readonly drawing: string }
  | { readonly type: "light"; readonly drawing: string; readonly part: string | null };

export type ToHost =
  | { readonly type: "pick"; readonly drawing: string; readonly part: string }
  | { readonly type: "want"; readonly drawing: string }
  | { readonly type: "open"; readonly drawing: string; readonly line: number; readonly column: number };

type Raw = Readonly<Record<string, unknown>>;

const object = (value: unknown): Raw => (typeof value === "object" && value !== null ? (value as Raw) : {});
const list = (value: unknown): readonly unknown[] => (Array.isArray(value) ? value : []);
const text = (value: unknown): string => (typeof value === "string" ? value : typeof value === "number" ? String(value) : "");
const textOrNull = (value: unknown): string | null => (typeof value === "string" ? value : null);
const number = (value: unknown): number => (typeof value === "number" && Number.isFinite(value) ? value : 0);

function oneOf<T extends string>(value: unknown, all: readonly T[], otherwise: T): T {
  return all.find((one) => one === value) ?? otherwise;
}

/** The message that `data` is, or null if it is none that the page knows. */
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
    default:
      return null;
  }
}

function readListed(value: unknown): Listed {
  const raw = object(value);
  return { id: text(raw["id"]), name: text(raw["name"]) || text(raw["id"]), folder: text(raw["folder"]) };
}

function readBuild(raw: Raw): Build {
  return {
    revision: number(raw["revision"]),
    milliseconds: number(raw["milliseconds"]),
    model: textOrNull(raw["model"]),
    picture: textOrNull(raw["picture"]),
    stale: raw["stale"] === true,
    triangles: number(raw["triangles"]),
    findings: list(raw["findings"]).map(readFinding),
    parts: list(raw["parts"]).map(readPart),
  };
}

function readFinding(value: unknown): Finding {
  const raw = object(value);
  return {
    severity: oneOf<Severity>(raw["severity"], ["error", "warning", "hint"], "error"),
    code: text(raw["code"]),
    message: text(raw["message"]),
    label: text(raw["label"]),
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
  return {
    name: text(raw["name"]),
    parent: textOrNull(raw["parent"]),
    kind: oneOf<Kind>(raw["kind"], ["main", "sub", "legend", "unused", "terrain"], "main"),
    element: text(raw["element"]),
    string: string && { line: number(string["line"]), column: number(string["column"]), text: text(string["text"]), boundBy: text(string["bound_by"]) },
    attributes: Object.entries(object(raw["attributes"])).map(([name, attribute]) => {
      const { value, from } = object(attribute);
      return { name, value: text(value), from: oneOf<Source>(from, ["own", "legend", "default", "builtin"], "builtin") };
    }),
    joint: textOrNull(raw["joint"]),
  };
}
