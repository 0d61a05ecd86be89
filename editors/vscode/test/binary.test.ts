import assert from "node:assert/strict";
import { test } from "node:test";
import { candidates, firstExecutable, parseVersion, type Environment } from "../src/binary";

const linux: Environment = {
  platform: "linux",
  env: { PATH: "/usr/local/bin:relative/bin::/usr/bin:." },
  home: "/home/ann",
  folder: "/home/ann/drawings",
  extension: "/home/ann/.vscode/extensions/okoshi",
};
const windows: Environment = {
  platform: "win32",
  env: { Path: 'C:\\Tools;"C:\\Program Files\\Okoshi";.' },
  home: "C:\\Users\\Ann",
  folder: "D:\\drawings",
  extension: "C:\\Users\\Ann\\.vscode\\extensions\\okoshi",
};

test("a bare name is looked up on the PATH and where cargo installs", () => {
  assert.deepEqual(candidates("okoshi-next", linux), ["/usr/local/bin/okoshi-next", "/usr/bin/okoshi-next", "/home/ann/.cargo/bin/okoshi-next"]);
  assert.deepEqual(candidates("okoshi-next", windows), [
    "C:\\Tools\\okoshi-next.exe",
    "C:\\Program Files\\Okoshi\\okoshi-next.exe",
    "C:\\Users\\Ann\\.cargo\\bin\\okoshi-next.exe",
  ]);
});

test("the program that the extension brings comes first, unless another is set", () => {
  assert.deepEqual(candidates("okoshi", linux), [
    "/home/ann/.vscode/extensions/okoshi/bin/okoshi",
    "/usr/local/bin/okoshi",
    "/usr/bin/okoshi",
    "/home/ann/.cargo/bin/okoshi",
  ]);
  assert.equal(candidates("okoshi", windows)[0], "C:\\Users\\Ann\\.vscode\\extensions\\okoshi\\bin\\okoshi.exe");
  for (const set of ["okoshi-next", "/opt/okoshi", "~/bin/okoshi", "./okoshi", "${workspaceFolder}/okoshi"]) {
    for (const path of candidates(set, linux)) assert.ok(!path.startsWith(linux.extension), `${set}: ${path}`);
  }
});

test("relative folders on the PATH are ignored", () => {
  for (const path of candidates("okoshi", linux)) assert.ok(path.startsWith("/"), path);
  for (const path of candidates("okoshi", windows)) assert.match(path, /^[A-Z]:\\/);
});

test("nothing written is the default", () => {
  assert.deepEqual(candidates("  ", linux), candidates("okoshi", linux));
});

test("paths are taken as they are, from home, or from the workspace folder", () => {
  assert.deepEqual(candidates("/opt/okoshi/okoshi", linux), ["/opt/okoshi/okoshi"]);
  assert.deepEqual(candidates("~/bin/okoshi", linux), ["/home/ann/bin/okoshi"]);
  assert.deepEqual(candidates("${workspaceFolder}/target/debug/okoshi", linux), ["/home/ann/drawings/target/debug/okoshi"]);
  assert.deepEqual(candidates("target/debug/okoshi", linux), ["/home/ann/drawings/target/debug/okoshi"]);
  assert.deepEqual(candidates("~\\okoshi", windows), ["C:\\Users\\Ann\\okoshi.exe"]);
  assert.deepEqual(candidates("C:/okoshi.exe", windows), ["C:\\okoshi.exe"]);
});

test("a folder's name is put in as it is, dollars too", () => {
  assert.deepEqual(candidates("${workspaceFolder}/okoshi", { ...linux, folder: "/a$&b" }), ["/a$&b/okoshi"]);
});

test("without a workspace folder there is no place for what hangs on it", () => {
  const bare = { ...linux, folder: undefined };
  assert.deepEqual(candidates("target/debug/okoshi", bare), []);
  assert.deepEqual(candidates("${workspaceFolder}/okoshi", bare), []);
});

test("without a PATH cargo's folder is left", () => {
  assert.deepEqual(candidates("okoshi-next", { ...linux, env: {} }), ["/home/ann/.cargo/bin/okoshi-next"]);
});

test("the first that runs is taken, and no more are asked", async () => {
  const asked: string[] = [];
  const runs = async (path: string) => {
    asked.push(path);
    return path === "/b";
  };
  assert.equal(await firstExecutable(["/a", "/b", "/c"], runs), "/b");
  assert.deepEqual(asked, ["/a", "/b"]);
  assert.equal(await firstExecutable(["/a"], runs), undefined);
});

test("a version is okoshi's, or none", () => {
  assert.equal(parseVersion("okoshi 0.1.0\n"), "0.1.0");
  assert.equal(parseVersion("okoshi 1.2.3-rc.1\r\n"), "1.2.3-rc.1");
  assert.equal(parseVersion("cargo 1.90.0\n"), undefined);
  assert.equal(parseVersion(""), undefined);
});
