// The program on this machine, with its language server.

import { execFile } from "node:child_process";
import { access, constants, stat } from "node:fs/promises";
import { homedir } from "node:os";
import { promisify } from "node:util";
import * as vscode from "vscode";
import { LanguageClient, type BaseLanguageClient, type LanguageClientOptions } from "vscode-languageclient/node";
import { candidates, firstExecutable, parseVersion } from "./binary";
import { settings, type Program } from "./server";

/** How long a program may take to report its version, in milliseconds. */
const VERSION_TIMEOUT = 10_000;

export class Installed implements Program {
  readonly schemes = ["file"];

  /** `extension`: the folder of the extension. */
  constructor(
    private readonly extension: vscode.Uri,
    private readonly output: vscode.LogOutputChannel,
  ) {}

  async find(): Promise<string | undefined> {
    const { path } = settings();
    const places = candidates(path, {
      platform: process.platform,
      env: process.env,
      home: homedir(),
      folder: vscode.workspace.workspaceFolders?.find(({ uri }) => uri.scheme === "file")?.uri.fsPath,
      extension: this.extension.fsPath,
    });
    const found = await firstExecutable(places, canRun);
    if (found === undefined) this.output.warn(`The program ${path} was not found. Looked at: ${places.join(", ") || "nowhere"}`);
    return found;
  }

  async version(found: string): Promise<string | undefined> {
    try {
      const { stdout } = await promisify(execFile)(found, ["--version"], { timeout: VERSION_TIMEOUT, windowsHide: true });
      return parseVersion(stdout);
    } catch {
      return undefined;
    }
  }

  client(found: string, options: LanguageClientOptions): BaseLanguageClient {
    // Without `transport`, which would add the argument `--stdio`.
    return new LanguageClient("okoshi", "Okoshi", { command: found, args: ["lsp"] }, options);
  }
}

async function canRun(path: string): Promise<boolean> {
  try {
    if (!(await stat(path)).isFile()) return false;
    await access(path, constants.X_OK);
    return true;
  } catch {
    return false;
  }
}
