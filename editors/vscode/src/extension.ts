// The entry points of the extension where there is a program.

import type * as vscode from "vscode";
import { Installed } from "./installed";
import { ofProgram } from "./program-commands";
import type { Server } from "./server";
import { start } from "./start";

let server: Server | undefined;

export function activate(context: vscode.ExtensionContext): void {
  server = start(context, (output) => new Installed(context.extensionUri, output), ofProgram);
}

export async function deactivate(): Promise<void> {
  await server?.stop();
}
