// The camera of a clip: looking through it, and taking over from it.

import assert from "node:assert/strict";
import type { Page } from "playwright-core";
import { camera, overlaps, picture, resize, seekTo, shown, still } from "./browser";
import { film } from "./film";
import { aside, EXPOSURE, kick, SECONDS } from "./kick";
import type { MockHost } from "./mock";
import { assertLike, browse } from "./setup";

/** The tangent of half the vertical field of view. */
const HALF = 0.25;
/** The camera goes along with the middle of the body, and comes nearer. */
const FAR = [0, 1.1, 8] as const;
const NEAR = [0.6, 1.1, 3] as const;
const BODY = [40, 90, 160] as const;

const filmed = (host: MockHost): void => {
  const { model, ...rest } = kick();
  host.add("kick.svg");
  host.built("kick.svg", { ...rest, model: film(model!, "kick", 2 * Math.atan(HALF), SECONDS, [FAR, NEAR]) });
};
const button = (page: Page) => page.getByRole("button", { name: "Camera", exact: true });
const isOn = async (page: Page): Promise<boolean> => (await button(page).getAttribute("aria-pressed")) === "true";
const seek = async (page: Page, time: number): Promise<void> => {
  await seekTo(page, time);
  await page.locator("canvas").focus();
  await still(page);
};
/** Position, direction to the viewer and vertical angle of the model's camera. */
const lens = async (page: Page): Promise<{ position: number[]; towards: number[]; half: number }> => {
  const words = (await camera(page)).split(" ");
  assert.equal(words.at(-1), "filmed");
  const numbers = words.slice(0, 7).map(Number);
  return { position: numbers.slice(0, 3), towards: numbers.slice(3, 6), half: Math.tan((numbers[6]! * Math.PI) / 360) };
};
const assertNear = (found: readonly number[], expected: readonly number[], most: number): void => {
  found.forEach((number, at) => assert.ok(Math.abs(number - expected[at]!) <= most, `${found.join(" ")} is not near ${expected.join(" ")}`));
};
/** The window's place of a point above the middle of the picture, as a share of its half height. */
const above = async (page: Page, share: number): Promise<{ x: number; y: number }> => {
  const box = (await page.locator("canvas").boundingBox())!;
  return { x: box.x + box.width / 2, y: box.y + (box.height / 2) * (1 - share) };
};

browse("the page looks through the camera of a clip, and back", filmed, async (page) => {
  await shown(page);
  await seek(page, 0);
  const before = await camera(page);
  assert.equal(await isOn(page), false);
  await page.keyboard.press("m");
  await still(page);
  assert.equal(await isOn(page), true);
  const { position, towards, half } = await lens(page);
  assertNear(position, FAR, 1e-4);
  assertNear(towards, [0, 0, 1], 1e-6);
  assertNear([half], [HALF], 1e-5);
  // At the end the body is in the middle, from 0.8 to 1.4 m high; from afar it is lower than half of what it is nearby.
  await seek(page, SECONDS);
  assertNear((await lens(page)).position, NEAR, 1e-4);
  const near = await picture(page);
  assertLike(near.at(await above(page, 0)), BODY, "the middle");
  const high = 0.25 / (HALF * 2.88);
  assertLike(near.at(await above(page, high)), BODY, "the upper part of the body");
  await seek(page, SECONDS / 2);
  assertNear((await lens(page)).position, [0.3, 1.1, 5.5], 1e-4);
  await seek(page, 0);
  const far = await picture(page);
  assert.ok(Math.abs(far.at(await above(page, high))[2] - BODY[2]) > 30, "the body is smaller from afar");
  // The switch goes back to the user's own view.
  await button(page).click();
  await still(page);
  assert.equal(await isOn(page), false);
  assert.equal(await camera(page), before);
  // Another clip has no camera, and is shown from there.
  await button(page).click();
  await page.locator(".clip-choice").selectOption({ index: 1 });
  await still(page);
  assert.equal(await button(page).isVisible(), false);
  assert.equal(await camera(page), before);
  await page.locator("canvas").focus();
  await page.keyboard.press("m");
  assert.equal(await camera(page), before);
  await page.locator(".clip-choice").selectOption({ index: 0 });
  await still(page);
  assert.equal(await isOn(page), true);
});

browse("what the camera shows in a square fits into a page of any shape", filmed, async (page) => {
  await shown(page);
  await seek(page, 0);
  await page.keyboard.press("m");
  for (const [width, height] of [[1300, 700], [761, 800], [500, 900], [380, 700], [320, 700]] as const) {
    await resize(page, width, height);
    await still(page);
    assert.deepEqual(await overlaps(page), [], `at ${width} pixels`);
    const box = (await page.locator("canvas").boundingBox())!;
    assertNear([(await lens(page)).half], [HALF / Math.min(box.width / box.height, 1)], 1e-3);
  }
});

browse("whoever drags takes over from the camera, where it is", filmed, async (page) => {
  await shown(page);
  await seek(page, SECONDS);
  const on = async (): Promise<void> => {
    await page.locator("canvas").focus();
    await page.keyboard.press("m");
    await still(page);
    assert.equal(await isOn(page), true);
  };
  await on();
  const middle = await above(page, 0);
  // A click selects a part; the view stays.
  await page.mouse.click(middle.x, middle.y);
  await still(page);
  assert.equal(await isOn(page), true);
  assert.match((await page.getAttribute("canvas", "data-selected")) ?? "", /Body/);
  await page.mouse.move(middle.x, middle.y);
  await page.mouse.down();
  await page.mouse.move(middle.x + 4, middle.y, { steps: 2 });
  await page.mouse.up();
  await still(page);
  assert.equal(await isOn(page), false);
  const [, , , ...words] = (await camera(page)).split(" ");
  assert.equal(words.at(-1), "perspective");
  // The picture is as high as before where the model is, so the camera is nearer or farther as its angle is another.
  const away = NEAR[2] * (HALF / Math.tan((30 * Math.PI) / 360));
  assertNear(words.slice(0, 3).map(Number), [NEAR[0], NEAR[1], away], 0.35);
  assertNear([Number(words[3])], [2 * HALF * NEAR[2]], 0.2);
  const [, , , x] = (await camera(page)).split(" ").map(Number);
  assert.ok(Math.abs(x! - NEAR[0]) > 0.01, "the drag turned the view");
  // So do keys and the wheel.
  await on();
  await page.keyboard.press("ArrowLeft");
  await still(page);
  assert.equal(await isOn(page), false);
  await on();
  await page.mouse.wheel(0, 100);
  await still(page);
  assert.equal(await isOn(page), false);
});

browse("following the figure leaves its camera alone", filmed, async (page) => {
  await shown(page);
  await seek(page, 0);
  await page.keyboard.press("v");
  const numbers = async () => (await camera(page)).split(" ").slice(0, 6).map(Number);
  const before = await numbers();
  await seek(page, SECONDS);
  const step = aside(EXPOSURE.at(-1)![0]);
  assertNear(await numbers(), before.map((number, at) => number + (at % 3 === 0 ? step : 0)), 1e-3);
});

browse("a build while the page looks through the camera goes on with the new one", filmed, async (page, host) => {
  await shown(page);
  await seek(page, 0);
  await page.keyboard.press("m");
  const { model, ...rest } = kick();
  host.built("kick.svg", { ...rest, model: film(model!, "kick", 2 * Math.atan(HALF), SECONDS, [NEAR, FAR]) });
  await shown(page, 2);
  assertNear((await lens(page)).position, NEAR, 1e-4);
  host.built("kick.svg", kick());
  await shown(page, 3);
  assert.equal(await button(page).isVisible(), false);
  assert.ok(!(await camera(page)).endsWith("filmed"));
});
