import assert from "node:assert/strict";
import { shown } from "./browser";
import { browse, build, FIGURE, one } from "./setup";

browse("the list of parts is shown before there is a graphics context", one(FIGURE), async (page) => {
  await page.addInitScript(() => {
    const get = HTMLCanvasElement.prototype.getContext as (this: HTMLCanvasElement, ...rest: unknown[]) => RenderingContext | null;
    HTMLCanvasElement.prototype.getContext = function (this: HTMLCanvasElement, ...rest: unknown[]) {
      if (rest[0] !== "webgl2") return get.apply(this, rest);
      const words = document.querySelector<HTMLElement>(".tree")?.innerText ?? "";
      (window as unknown as { before: string }).before ??= words;
      return get.apply(this, rest);
    } as typeof HTMLCanvasElement.prototype.getContext;
  });
  await page.reload();
  await shown(page);
  assert.match(await page.evaluate(() => (window as unknown as { before: string }).before), /Body/);
});

browse("without WebGL the parts are listed, and a note says why there is no model", one(FIGURE), async (page) => {
  await page.addInitScript(() => {
    HTMLCanvasElement.prototype.getContext = (() => null) as typeof HTMLCanvasElement.prototype.getContext;
  });
  await page.reload();
  await page.waitForSelector(".notes:not([hidden])");
  await page.waitForFunction(() => /no WebGL 2/.test(document.querySelector<HTMLElement>(".notes")!.innerText));
  await page.waitForSelector("[data-part=Arm]");
  // Pressing keys does no harm.
  for (const key of ["1", "ArrowLeft", "z", "l", "Home"]) await page.keyboard.press(key);
});

browse("the environment is drawn only for materials that reflect it", one(FIGURE), async (page, host) => {
  await page.addInitScript(() => {
    const counted = window as unknown as { programs: number };
    counted.programs = 0;
    const { prototype } = WebGL2RenderingContext;
    const link = prototype.linkProgram;
    prototype.linkProgram = function (program) {
      counted.programs++;
      link.call(this, program);
    };
  });
  const programs = () => page.evaluate(() => (window as unknown as { programs: number }).programs);
  await page.reload();
  await shown(page, 1);
  const matt = await programs();
  host.built("figure.svg", build(FIGURE, (text) => text.replace("Arm@Body$", "Arm@Body$Metallic 1 ")));
  await shown(page, 2);
  // The shader of the part itself, and several that blur the environment.
  assert.ok((await programs()) > matt + 3, `${matt} programs, then ${await programs()}`);
});
