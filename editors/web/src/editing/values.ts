// How the controls of a form become the words of a string.

import { cssColor } from "../panels/inspector";
import type { Argument, Field, Variant } from "./messages";

/** A key that is held down makes one change, this long after it is let go, in milliseconds. */
export const PAUSE = 350;

/** The words of a field with a variant, its arguments and its flags. */
function words(field: Field, variant: Variant, values: readonly string[], on: ReadonlySet<string>): string {
  const letters = field.flags.filter(({ letter }) => on.has(letter)).map(({ letter }) => letter);
  return [letters.length > 0 ? `-${letters.join("")}` : "", variant.word ?? "", ...values].filter((word) => word !== "").join(" ");
}

/** A field that says something: with one of its variants, arguments of it, and flags. */
export function saying(field: Field, chosen: number, values: readonly string[], on: ReadonlySet<string>): Field {
  const variant = field.variants[chosen];
  const variants = field.variants.map((one, at) => ({ ...one, arguments: one.arguments.map((argument, index) => ({ ...argument, value: at === chosen ? (values[index] ?? null) : null })) }));
  const flags = field.flags.map((flag) => ({ ...flag, on: on.has(flag.letter) }));
  return { ...field, value: variant ? words(field, variant, values, on) : null, from: "own", flags, variants, chosen };
}

/** A field of which nothing is said. */
export const silent = (field: Field): Field => ({ ...saying(field, -1, [], new Set()), from: "builtin", chosen: null });

/** The flags that a field has now. */
export const flagsOf = (field: Field): ReadonlySet<string> => new Set(field.flags.filter(({ on }) => on).map(({ letter }) => letter));

/** The values that a variant has now, without those that are left out at its end. */
export function valuesOf(variant: Variant): string[] {
  const values: string[] = [];
  for (const { value } of variant.arguments) {
    if (value === null) break;
    values.push(value);
  }
  return values;
}

/** The same with one of them replaced. As many others are written as the variant then needs. */
export function withValue(variant: Variant, at: number, value: string): string[] {
  const before = valuesOf(variant);
  const least = Math.max(at + 1, before.length);
  const counts = variant.counts.filter((count) => count >= least);
  const count = counts.length > 0 ? Math.min(...counts) : least;
  return variant.arguments.slice(0, count).map((argument, index) => (index === at ? value : (before[index] ?? start(argument))));
}

/** The fewest values with which a variant can be written; null if one of them must be typed first. */
export function least(variant: Variant): string[] | null {
  const count = Math.min(...variant.counts, variant.arguments.length);
  const needed = variant.arguments.slice(0, variant.counts.length > 0 ? count : 1);
  return needed.every(({ takes }) => takes.type === "number") ? needed.map(start) : null;
}

function start({ takes, value }: Argument): string {
  if (value !== null) return value;
  return takes.type === "number" ? digits(takes.start ?? takes.low, takes.step) : "";
}

/** A number with as many digits as its slider tells apart. */
export function digits(number: number, step: number): string {
  const places = Math.max(0, Math.ceil(-Math.log10(step) - 1e-9));
  return String(Number(number.toFixed(Math.min(places, 6))));
}

/** Text as it is shown in a field: without quotes around it. */
export const unquoted = (word: string): string => (/^".*"$/s.test(word) ? word.slice(1, -1) : word);

/** Text as it is written; null if it cannot be. */
export function quoted(text: string, always: boolean): string | null {
  const plain = text.trim();
  if (plain === "" || plain.includes('"')) return null;
  return always || !/^[\p{L}_][\p{L}\p{N}_.]*$/u.test(plain) ? `"${plain}"` : plain;
}

/** A value of `Color` as `#rrggbb`, with its opacity; null if it is none. */
export function hexOf(value: string): { readonly hex: string; readonly opacity: string } | null {
  const css = cssColor(value);
  if (css === null) return null;
  const context = document.createElement("canvas").getContext("2d");
  if (!context) return null;
  context.fillStyle = "#000";
  context.fillStyle = css;
  const written = context.fillStyle;
  if (written.startsWith("#")) return { hex: written, opacity: "" };
  const numbers = written.match(/[\d.]+/g)?.map(Number) ?? [];
  const two = (number: number): string => Math.round(Math.min(Math.max(number, 0), 255)).toString(16).padStart(2, "0");
  const [r = 0, g = 0, b = 0, a = 1] = numbers;
  return { hex: `#${two(r)}${two(g)}${two(b)}`, opacity: a < 1 ? two(a * 255) : "" };
}
