// Builds drawings with the program, as messages of a host.

import { execFileSync, spawnSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { basename, dirname, join } from "node:path";
import { PATIENCE } from "./closing";

export interface Made {
  readonly model: Buffer | null;
  /** The clips before limiting. */
  readonly originals?: Buffer | null;
  /** Other files of the drawing, by their endings. */
  readonly exports?: Readonly<Record<string, Buffer>>;
  readonly picture: Buffer | null;
  readonly build: Record<string, unknown>;
}

interface Diagnostic {
  readonly code: string;
  readonly severity: string;
  readonly message: string;
  readonly label: string | null;
  readonly help: string | null;
  readonly line: number;
  readonly column: number;
  readonly end_line: number;
  readonly end_column: number;
}

/** Builds a drawing's text in the folder of its links. */
export function make(okoshi: string, text: string, beside: string): Made {
  const scratch = mkdtempSync(join(tmpdir(), "okoshi-web-"));
  const drawing = join(scratch, basename(beside));
  try {
    writeFileSync(drawing, text);
    // The files that it links to are not beside it.
    const run = (command: string, ...args: string[]) => spawnSync(okoshi, [command, "--base", dirname(beside), ...args], { encoding: "utf8", maxBuffer: 1 << 28, timeout: PATIENCE });
    const began = performance.now();
    const built = run("build", "-q", drawing, "-o", join(scratch, "a.glb")).status === 0;
    // Including the start of the program: a running host is faster.
    const milliseconds = performance.now() - began;
    if (built) execFileSync(okoshi, ["render", "-q", join(scratch, "a.glb"), "-o", join(scratch, "a.png"), "--size", "256x256"], { timeout: PATIENCE });
    const { parts, size_in_metres: size } = JSON.parse(run("inspect", drawing, "--json").stdout) as { parts: unknown[]; size_in_metres: unknown };
    const { drawings } = JSON.parse(run("check", drawing, "--format", "json").stdout) as { drawings: { diagnostics: Diagnostic[] }[] };
    const lines = text.split("\n");
    const findings = drawings[0]!.diagnostics.map(({ code, severity, message, label, help, line, column, end_line, end_column }) => {
      const source = lines[line - 1] ?? "";
      const to = end_line === line ? end_column - 1 : Array.from(source).length;
      return { severity, code, message, label: label ?? undefined, help: help === null ? [] : [help], line, column, text: source, from: column - 1, to };
    });
    return {
      model: built ? readFileSync(join(scratch, "a.glb")) : null,
      picture: built ? readFileSync(join(scratch, "a.png")) : null,
      build: { milliseconds, stale: !built, triangles: 0, size, findings, parts },
    };
  } finally {
    rmSync(scratch, { recursive: true, force: true });
  }
}
