// Changes that follow each other faster than the drawing is built, with the real program.

import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import { shown } from "./browser";
import { PATIENCE } from "./closing";
import { BY_OTHERS, edit, HELD_BACK } from "./edited";
import { FIGURE, source } from "./setup";

const BEFORE = source(FIGURE);

edit("of changes of one attribute that follow each other faster than builds, none is lost", async (edited) => {
  const { page } = edited;
  await page.getByRole("button", { name: "Edit" }).click();
  await edited.select("Arm");
  const number = (which: string) => edited.label(`Shape: ${which}, as a number`);
  /** Types numbers at once, without a moment for the form to say what came of the first. */
  const type = (numbers: Readonly<Record<string, string>>): Promise<void> =>
    page.evaluate((numbers) => {
      for (const [which, value] of Object.entries(numbers)) {
        const field = document.querySelector<HTMLInputElement>(`[aria-label="Shape: ${which}, as a number"]`)!;
        field.value = value;
        for (const type of ["input", "change"]) field.dispatchEvent(new Event(type, { bubbles: true }));
      }
    }, numbers);
  const says = (words: string) => edited.has(BEFORE.replace("default -8 8", words), words);
  await type({ z0: "-3", z1: "5" });
  await says("default -3 5");
  await page.locator(".part-form[aria-busy=false]").waitFor();

  // The form arrives while a number is being typed, and another number follows at once.
  await number("z1").focus();
  await page.keyboard.press("Control+a");
  await page.keyboard.type("6");
  await edited.label("Color: swatch").evaluate((one) => {
    (one as HTMLInputElement).value = "#123456";
    one.dispatchEvent(new Event("change"));
  });
  await edited.matches(/Color #123456/);
  await page.locator(".part-form[aria-busy=false]").waitFor();
  await page.evaluate(() => document.activeElement!.dispatchEvent(new Event("change", { bubbles: true })));
  await type({ z0: "-4" });
  await edited.has(BEFORE.replace("default -8 8", "default -4 6").replace("Bend 0", "Bend 0 Color #123456"), "typed while a form arrived");
});

edit("a form that arrives leaves the control alone that a person is in, and what is typed wins until it is sent or given up", async (edited) => {
  const { page } = edited;
  let now = BEFORE;
  const shows = (field: string, value: string) =>
    page.waitForFunction(([field, value]) => document.querySelector<HTMLInputElement>(`.part-form ${field}`)?.value === value, [field, value] as const);
  const [Z1, BEND, COLOR, NAME] = ['[aria-label="Shape: z1, as a number"]', '[data-attribute="Bend"] input[type=number]', '[aria-label="Color: as text"]', "[data-key=name]"];
  /** Another program saves, and the form that says so arrives. */
  const save = async (change: (text: string) => string, field: string, value: string): Promise<void> => {
    now = change(now);
    writeFileSync(edited.file, now);
    await shows(field, value);
  };
  const bend = (degrees: number): Promise<void> => save((text) => text.replace(/Bend \d+/, `Bend ${degrees}`), BEND, String(degrees));
  /** What is typed, and sent by Enter, replaces this in the file. */
  const says = async (typed: string, before: string, after: string): Promise<void> => {
    await page.keyboard.type(typed);
    await page.keyboard.press("Enter");
    now = now.replace(before, after);
    await edited.has(now, after);
    await page.locator(".part-form[aria-busy=false]").waitFor();
  };
  await page.getByRole("button", { name: "Edit" }).click();
  await edited.select("Arm");
  await page.locator("[data-attribute=Bend]").evaluate((one) => ((one as HTMLDetailsElement).open = true));

  // All of a number is selected.
  await page.locator(Z1).focus();
  await page.keyboard.press("Control+a");
  await bend(1);
  await says("12", "-8 8", "-8 12");
  // The caret is within a number, also after it was sent.
  await page.keyboard.press("Home");
  await page.keyboard.press("ArrowRight");
  await bend(2);
  await says("0", "-8 12", "-8 102");
  // The slider beside it still moves it, and its number the slider.
  await page.keyboard.press("Control+a");
  await page.keyboard.type("7");
  assert.equal(await edited.label("Shape: z1").inputValue(), "7");
  await says("", "-8 102", "-8 7");
  await edited.label("Shape: z1").evaluate((one: HTMLInputElement) => {
    one.value = "9";
    one.dispatchEvent(new Event("input", { bubbles: true }));
  });
  assert.equal(await page.locator(Z1).inputValue(), "9");
  await edited.label("Shape: z1").dispatchEvent("change");
  now = now.replace("-8 7", "-8 9");
  await edited.has(now, "slider");
  await page.locator(".part-form[aria-busy=false]").waitFor();

  // In another number a caret means nothing: what is typed replaces it.
  await page.locator(Z1).focus();
  await page.keyboard.press("End");
  await save((text) => text.replace("-8 9", "-8 30").replace("Head@", "Cap@"), Z1, "30");
  // Before its build is here, the page would be asked whether it means what it says.
  await page.locator("[data-part=Cap]").waitFor();
  await says("14", "-8 30", "-8 14");

  // What is typed, and not sent, stays; Escape shows what is so.
  await page.keyboard.press("Control+a");
  await page.keyboard.type("5");
  // As of a control that was here before, and that the form has just taken out.
  await page.locator(Z1).dispatchEvent("focusout", { bubbles: true });
  now = now.replace("-8 14", "-8 40").replace("Cap@", "Hat@");
  writeFileSync(edited.file, now);
  await page.locator("[data-part=Hat]").waitFor();
  await page.locator(".part-form[aria-busy=false]").waitFor();
  assert.equal(await page.locator(Z1).inputValue(), "5");
  await page.keyboard.press("Escape");
  await shows(Z1, "40");

  // Had the given up number been sent, it would be in the file now. Text keeps its caret as well.
  await page.locator(COLOR).fill("#123456");
  await says("", "Bend 2", "Bend 2 Color #123456");
  for (const key of ["Home", "ArrowRight"]) await page.keyboard.press(key);
  await page.keyboard.press("Shift+ArrowRight");
  await bend(3);
  await says("f", "#123456", "#f23456");
  await page.locator(NAME).focus();
  for (const key of ["Home", "ArrowRight"]) await page.keyboard.press(key);
  await bend(4);
  await says("l", "Arm@", "Alrm@");
  await edited.formOf("Alrm");
  await bend(5);
  await says("a", "Alrm@", "Alarm@");
}, { program: BY_OTHERS });

edit("a change that is built before the page knows that it is made is shown as the drawing, not as what is tried", async (edited) => {
  const { page } = edited;
  await page.getByRole("button", { name: "Edit" }).click();
  await edited.select("Arm");
  let tries = 0;
  page.on("response", (response) => response.url().endsWith("/tries") && tries++);
  await page.route("**/changes", async (route) => {
    // What is asked for once the change is made is asked for too late, and would not be tried again.
    await page.waitForFunction(() => document.querySelector("canvas")!.dataset["tried"] !== "");
    const response = await route.fetch();
    await page.waitForFunction(() => document.querySelector("canvas")!.dataset["revision"] === "2");
    // What was tried is tried again in the new build.
    for (const end = Date.now() + PATIENCE; tries < 2 && Date.now() < end; ) await new Promise((resolve) => setTimeout(resolve, 20));
    await route.fulfill({ response });
  });
  const kind = page.getByRole("radiogroup", { name: "Shape: which" }).getByRole("radio", { name: "inflate", exact: true });
  await Promise.all([page.waitForResponse("**/changes"), kind.click()]);
  assert.ok(tries >= 2);
  await page.locator(".part-form[aria-busy=false]").waitFor();
  await page.waitForFunction(() => document.querySelector("canvas")!.dataset["tried"] === "");
}, { program: HELD_BACK });

edit("what is tried is shown until the build of the change comes, also if what it looks like was asked for too late", async (edited) => {
  const { page } = edited;
  await page.getByRole("button", { name: "Edit" }).click();
  await edited.select("Arm");
  const states = await page.evaluateHandle(() => {
    const { dataset } = document.querySelector("canvas")!;
    const states: string[] = [];
    const note = () => states.push(`${dataset["revision"]} ${dataset["tried"] === "" ? "as it is" : "tried"}`);
    new MutationObserver(note).observe(document.querySelector("canvas")!, { attributeFilter: ["data-tried"] });
    return states;
  });
  const drag = (to: string, ...types: string[]) =>
    edited.label("Shape: z1").evaluate((one: HTMLInputElement, { to, types }) => {
      one.value = to;
      for (const type of types) one.dispatchEvent(new Event(type, { bubbles: true }));
    }, { to, types });
  await drag("10", "input");
  await page.waitForFunction(() => document.querySelector("canvas")!.dataset["tried"] !== "");
  let late = 0;
  await page.route("**/tries", async (route) => {
    await edited.until(() => edited.text() !== BEFORE, "made");
    const response = await route.fetch();
    if (response.status() === 204) late++;
    await route.fulfill({ response });
  });
  await drag("14", "input", "change");
  await shown(page, 2);
  await page.waitForFunction(() => document.querySelector("canvas")!.dataset["tried"] === "");
  assert.ok(late > 0, "it was asked for too late");
  assert.deepEqual(await states.jsonValue(), ["1 tried", "2 as it is"]);
}, { program: HELD_BACK, late: 1000 });

edit("a model that newer ones replace while it is asked for is no error, and the newest is shown", async ({ page, file }) => {
  const answers: string[] = [];
  page.on("response", (response) => answers.push(`${response.status()} ${new URL(response.url()).pathname}`));
  const address = (number: number): string => new URL(`builds/${number}.glb`, page.url()).href;
  /** Saves, and waits until the program has built it. */
  const built = async (number: number): Promise<void> => {
    writeFileSync(file, BEFORE.replace("-8 8", `-8 ${8 + number}`));
    const end = Date.now() + PATIENCE;
    while ((await fetch(address(number))).status !== 200 && Date.now() < end) await new Promise((resolve) => setTimeout(resolve, 20));
  };
  // The request for the second model is on its way until there are two newer ones.
  await page.route(`${address(2)}**`, async (route) => {
    await built(3);
    await built(4);
    await route.continue();
  }, { times: 1 });
  await built(2);
  await shown(page, 4);
  assert.deepEqual(answers.filter((one) => one.includes("/builds/")), ["204 /builds/2.glb", "200 /builds/4.glb"]);
}, { program: HELD_BACK, late: 0 });
