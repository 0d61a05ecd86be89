// Drawing on the page of a drawing, as a person does with a mouse.

import type { Page } from "playwright-core";

export type Spot = readonly [x: number, y: number];

/** The place in the window of a point of the drawing whose page has this size. */
export async function spot(page: Page, [x, y]: Spot, [width, height]: Spot): Promise<{ x: number; y: number }> {
  const sheet = (await page.locator(".paper-sheet").boundingBox())!;
  return { x: sheet.x + (x / width) * sheet.width, y: sheet.y + (y / height) * sheet.height };
}

/** Drags the mouse over points of the drawing. */
export async function drag(page: Page, points: readonly Spot[], size: Spot): Promise<void> {
  const places = [];
  for (const point of points) places.push(await spot(page, point, size));
  const [first, ...others] = places;
  await page.mouse.move(first!.x, first!.y);
  await page.mouse.down();
  for (const { x, y } of others) await page.mouse.move(x, y, { steps: 2 });
  await page.mouse.up();
}

/** Points around a middle. */
export const oval = ([x, y]: Spot, width: number, height: number): Spot[] => Array.from({ length: 41 }, (_, at) => [x + (width / 2) * Math.cos((at / 40) * 2 * Math.PI), y + (height / 2) * Math.sin((at / 40) * 2 * Math.PI)]);

/** A limb with round ends from one point to another. */
export function limb([x, y]: Spot, [toX, toY]: Spot, width: number): Spot[] {
  const way = Math.atan2(toY - y, toX - x);
  const end = (cx: number, cy: number, from: number): Spot[] => Array.from({ length: 9 }, (_, at) => [cx + (width / 2) * Math.cos(from + (at / 8) * Math.PI), cy + (width / 2) * Math.sin(from + (at / 8) * Math.PI)]);
  const ring = [...end(toX, toY, way - Math.PI / 2), ...end(x, y, way + Math.PI / 2)];
  return [...ring, ring[0]!];
}

/** What a child draws first, on a page of 210 × 297: a body, a head, two arms, two legs. */
export const FIRST_FIGURE: readonly (readonly Spot[])[] = [
  oval([105, 160], 56, 84),
  oval([105, 90], 52, 56),
  limb([80, 135], [42, 172], 16),
  limb([130, 135], [168, 172], 16),
  limb([93, 196], [88, 258], 18),
  limb([117, 196], [122, 258], 18),
];
