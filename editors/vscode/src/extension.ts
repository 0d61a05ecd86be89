// Where the editor begins and ends the extension.

import * as vscode from "vscode";
import { register } from "./commands";
import { looksAfter, Server } from "./server";
import { Status } from "./status";

let server: Server | undefined;

export function activate(context: vscode.ExtensionContext): void {
  const output = vscode.window.createOutputChannel("Okoshi", { log: true });
  server = new Server(output);
  const started = server;
  context.subscriptions.push(
    output,
    started,
    new Status(started),
    vscode.workspace.onDidChangeConfiguration((event) => started.settingsChanged(event)),
    vscode.workspace.onDidOpenTextDocument((document) => {
      if (looksAfter(document)) void started.start();
    }),
  );
  register(context, started, output);
  void started.start();
}

export async function deactivate(): Promise<void> {
  await server?.stop();
}
