import assert from "node:assert/strict";
import { test } from "node:test";
import manifest from "../package.json";
import { configuration, initializationOptions, settingsFrom } from "../src/settings";

const from = (values: Record<string, unknown>) => settingsFrom((name) => values[name]);

test("the manifest's defaults are those of the extension", () => {
  const properties = manifest.contributes.configuration.properties;
  const defaults = Object.fromEntries(Object.entries(properties).map(([name, one]) => [name.replace("okoshi.", ""), one.default]));
  assert.deepEqual(from(defaults), from({}));
});

test("each of the manifest's values is accepted", () => {
  const { "okoshi.analyse": analyse, "okoshi.trace.server": trace } = manifest.contributes.configuration.properties;
  for (const value of analyse.enum) assert.equal(from({ analyse: value }).analyse, value);
  for (const value of trace.enum) assert.equal(from({ "trace.server": value }).traced, value !== "off");
});

test("values of the wrong type count as not set", () => {
  for (const wrong of [null, 3, true, [], {}, "", "  ", "sometimes"]) {
    const { path, analyse, traced } = from({ path: wrong === "sometimes" ? "" : wrong, analyse: wrong, "trace.server": wrong });
    assert.deepEqual({ path, analyse, traced }, { path: "okoshi", analyse: "onType", traced: false });
  }
});

test("the server gets the setting for checks and the support for panels", () => {
  const settings = from({ analyse: "onSave", path: "/bin/okoshi" });
  assert.deepEqual(initializationOptions(settings), { analyse: "onSave", preview: true });
  assert.deepEqual(configuration(settings), { settings: { okoshi: { analyse: "onSave" } } });
});

test("an untrusted folder cannot choose the program", () => {
  const { supported, restrictedConfigurations } = manifest.capabilities.untrustedWorkspaces;
  assert.equal(supported, "limited");
  assert.deepEqual(restrictedConfigurations, ["okoshi.path"]);
  assert.equal(manifest.contributes.configuration.properties["okoshi.path"].scope, "machine-overridable");
});
