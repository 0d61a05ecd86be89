// The entry points of the extension in VS Code for the Web, where the program is a module.

import type * as vscode from "vscode";
import type { Server } from "../server";
import { start } from "../start";
import { Module } from "./module";

let server: Server | undefined;

export function activate(context: vscode.ExtensionContext): void {
  const module = new Module(context.extensionUri, String(context.extension.packageJSON.version));
  context.subscriptions.push(module);
  server = start(context, () => module, () => ({}));
}

export async function deactivate(): Promise<void> {
  await server?.stop();
}
