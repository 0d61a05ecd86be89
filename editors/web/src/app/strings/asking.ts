// What the program knows of the texts of a drawing. Answers are checked here, as messages are in `protocol.ts`.

import type { Severity } from "../../protocol";

export interface Problem {
  /** Places in the text. */
  readonly from: number;
  readonly to: number;
  readonly severity: Severity;
  readonly code: string;
  readonly message: string;
  readonly help: string | null;
}

export interface Line {
  /** The byte of the drawing at which the text begins: by it the program knows the text. */
  readonly start: number;
  readonly text: string;
  /** The name of what it is about. */
  readonly part: string | null;
  readonly problems: readonly Problem[];
}

/** What is at a place of a text. */
export interface Place {
  readonly hover: { readonly from: number; readonly to: number; readonly markdown: string } | null;
  /** What can be done, in words. */
  readonly actions: readonly string[];
  /** The place in bytes. */
  readonly byte: number;
}

export interface Proposals {
  readonly from: number;
  readonly to: number;
  readonly options: readonly { readonly label: string; readonly kind: string; readonly detail: string; readonly text: string }[];
}

type Raw = Readonly<Record<string, unknown>>;
const object = (value: unknown): Raw => (typeof value === "object" && value !== null ? (value as Raw) : {});
const list = (value: unknown): readonly unknown[] => (Array.isArray(value) ? value : []);
const text = (value: unknown): string => (typeof value === "string" ? value : "");
const textOrNull = (value: unknown): string | null => (typeof value === "string" ? value : null);
const number = (value: unknown): number => (typeof value === "number" ? value : 0);

export const readLines = (body: unknown): readonly Line[] =>
  list(body).map((value) => {
    const raw = object(value);
    return { start: number(raw["start"]), text: text(raw["text"]), part: textOrNull(raw["part"]), problems: list(raw["problems"]).map(readProblem) };
  });

function readProblem(value: unknown): Problem {
  const raw = object(value);
  const severity = raw["severity"];
  return { from: number(raw["from"]), to: number(raw["to"]), severity: severity === "warning" || severity === "hint" ? severity : "error", code: text(raw["code"]), message: text(raw["message"]), help: textOrNull(raw["help"]) };
}

export function readPlace(body: unknown): Place {
  const raw = object(body);
  const hover = raw["hover"] === null ? null : object(raw["hover"]);
  return { hover: hover && { from: number(hover["from"]), to: number(hover["to"]), markdown: text(hover["markdown"]) }, actions: list(raw["actions"]).map((action) => text(object(action)["title"])), byte: number(raw["byte"]) };
}

export function readProposals(body: unknown): Proposals | null {
  const raw = object(body);
  if (!Array.isArray(raw["options"])) return null;
  const options = raw["options"].map((value) => {
    const option = object(value);
    return { label: text(option["label"]), kind: text(option["kind"]), detail: text(option["detail"]), text: text(option["text"]) };
  });
  return { from: number(raw["from"]), to: number(raw["to"]), options };
}

/** What is wrong, and a way out, as sentences. */
export const sentences = (message: string, help: string | null): string => [message, ...(help === null ? [] : [help])].map((words) => `${words.charAt(0).toUpperCase()}${words.slice(1)}.`).join(" ");
