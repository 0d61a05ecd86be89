// Finds the program. Independent of the editor; touches the disk only through its arguments.

import { posix, win32 } from "node:path";
import { DEFAULT } from "./settings";

/** Where the extension runs. */
export interface Environment {
  /** `process.platform`. */
  readonly platform: string;
  readonly env: Readonly<Record<string, string | undefined>>;
  /** The home folder. */
  readonly home: string;
  /** The first workspace folder, if there is one. */
  readonly folder: string | undefined;
  /** The extension's own folder: packages for one system bring the program in its `bin`. */
  readonly extension: string;
}

/**
 * The possible paths of the program, most likely first, for a value of the setting `okoshi.path`.
 *
 * The default, `okoshi`, is the program that the extension brings, if it brings one. A bare name is looked up on the `PATH` and then in
 * `~/.cargo/bin`, which programs started from a desktop often lack.
 * Relative folders on the `PATH` are ignored: with them a drawing's folder could choose the program.
 */
export function candidates(setting: string, { platform, env, home, folder, extension }: Environment): string[] {
  const windows = platform === "win32";
  const path = windows ? win32 : posix;
  let name = setting.trim() || DEFAULT;
  if (name === "~" || name.startsWith("~/") || (windows && name.startsWith("~\\"))) name = path.join(home, name.slice(1));
  if (name.includes("${workspaceFolder}")) {
    if (folder === undefined) return [];
    name = name.replaceAll("${workspaceFolder}", () => folder);
  }
  const named = (file: string) => (windows && path.extname(file) === "" ? [`${file}.exe`] : [file]);
  if (path.isAbsolute(name)) return named(path.normalize(name));
  if (name.includes("/") || (windows && name.includes("\\"))) {
    return folder === undefined ? [] : named(path.resolve(folder, name));
  }
  const variable = windows ? Object.keys(env).find((key) => key.toUpperCase() === "PATH") : "PATH";
  const listed = (variable === undefined ? "" : (env[variable] ?? "")).split(path.delimiter);
  const own = name === DEFAULT ? [path.join(extension, "bin")] : [];
  const folders = [...own, ...listed.map((entry) => entry.replace(/^"(.*)"$/, "$1")), path.join(home, ".cargo", "bin")];
  const files = folders.filter((entry) => path.isAbsolute(entry)).flatMap((entry) => named(path.join(entry, name)));
  return [...new Set(files)];
}

/** The first of the paths for which `runs` is true. */
export async function firstExecutable(paths: readonly string[], runs: (path: string) => Promise<boolean>): Promise<string | undefined> {
  for (const path of paths) {
    if (await runs(path)) return path;
  }
  return undefined;
}

/** The version in the output of `okoshi --version`; undefined for another program. */
export function parseVersion(output: string): string | undefined {
  return /^okoshi (\d+\.\d+\.\d+\S*)\s*$/m.exec(output)?.[1];
}
