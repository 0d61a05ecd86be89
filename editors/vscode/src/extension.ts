// The entry points of the extension.

import * as vscode from "vscode";
import { register } from "./commands";
import { Formatting } from "./formatting";
import { Previews } from "./preview/panels";
import { isDrawingDocument, Server } from "./server";
import { Status } from "./status";

let server: Server | undefined;

export function activate(context: vscode.ExtensionContext): void {
  const output = vscode.window.createOutputChannel("Okoshi", { log: true });
  server = new Server(context.extensionUri, output);
  const started = server;
  const previews = new Previews(context.extensionUri, started, output);
  context.subscriptions.push(
    output,
    started,
    new Status(started),
    new Formatting(started),
    previews,
    vscode.workspace.onDidChangeConfiguration((event) => started.settingsChanged(event)),
    vscode.workspace.onDidOpenTextDocument((document) => {
      if (isDrawingDocument(document)) void started.start();
    }),
  );
  register(context, started, previews, output);
  void started.start();
}

export async function deactivate(): Promise<void> {
  await server?.stop();
}
