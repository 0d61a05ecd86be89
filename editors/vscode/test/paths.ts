// Paths of the repository. The tests are run from the extension's folder.

import { readdirSync } from "node:fs";
import { join } from "node:path";

export const repository = join(process.cwd(), "..", "..");

/** All drawings below a folder of the repository, sorted by name. */
export function drawings(folder: string): string[] {
  return readdirSync(join(repository, folder), { recursive: true, encoding: "utf8" })
    .filter((name) => name.endsWith(".svg"))
    .sort()
    .map((name) => join(repository, folder, name));
}
