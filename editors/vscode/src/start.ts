// What the extension consists of, with whatever its language server is started from.

import * as vscode from "vscode";
import { everywhere, type Commands } from "./commands";
import { Formatting } from "./formatting";
import { Previews } from "./preview/panels";
import { Server, type Program } from "./server";
import { Status } from "./status";

/** Starts the extension; `more` are commands beside those that it has everywhere. Returns its server. */
export function start(context: vscode.ExtensionContext, from: (output: vscode.LogOutputChannel) => Program, more: (server: Server) => Commands): Server {
  const output = vscode.window.createOutputChannel("Okoshi", { log: true });
  const server = new Server(from(output), output);
  const previews = new Previews(context.extensionUri, server, output);
  context.subscriptions.push(
    output,
    server,
    new Status(server),
    new Formatting(server),
    previews,
    vscode.workspace.onDidChangeConfiguration((event) => server.settingsChanged(event)),
    vscode.workspace.onDidOpenTextDocument((document) => {
      if (server.handles(document)) void server.start();
    }),
  );
  for (const [name, run] of Object.entries({ ...everywhere(context, server, previews, output), ...more(server) })) {
    context.subscriptions.push(vscode.commands.registerCommand(name, run));
  }
  void server.start();
  return server;
}
