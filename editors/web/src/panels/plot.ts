// Shared by the charts: numbers on axes, and coordinates.

import { svg } from "../dom";

/** The smallest distance between frame numbers, in pixels. */
export const APART = 56;

/** A number or a word in a chart. */
export const word = (x: number, y: number, anchor: string, text: string): SVGTextElement => {
  const element = svg("text", { class: "chart-number", x: round(x), y: round(y), "text-anchor": anchor });
  element.textContent = text;
  return element;
};

export const round = (value: number): number => Math.round(value * 100) / 100;
/** The centre of a pixel, where lines one pixel wide are sharp. */
export const half = (value: number): number => Math.floor(value) + 0.5;

/** The smallest whole number not below another that is 1, 2 or 5 times a power of ten. */
export function niceStep(value: number): number {
  const ten = 10 ** Math.max(Math.floor(Math.log10(Math.max(value, 1))), 0);
  for (const times of [1, 2, 5]) if (value <= times * ten) return times * ten;
  return 10 * ten;
}
