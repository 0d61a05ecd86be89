// The commands of the extension that need no program on this machine.

import * as vscode from "vscode";
import type { Previews } from "./preview/panels";
import type { Server } from "./server";

/** A command, by its name. */
export type Commands = Readonly<Record<string, (argument?: unknown) => unknown>>;

/** The commands that the extension has everywhere. */
export function everywhere(context: vscode.ExtensionContext, server: Server, previews: Previews, output: vscode.LogOutputChannel): Commands {
  return {
    "okoshi.preview": (drawing) => preview(server, previews, drawing),
    "okoshi.restart": () => server.restart(),
    "okoshi.showOutput": () => output.show(),
    "okoshi.openWalkthrough": () =>
      vscode.commands.executeCommand("workbench.action.openWalkthrough", { category: `${context.extension.id}#begin` }, false),
  };
}

/**
 * The drawing in the active editor, or a message that there is none. Editors can show SVG files as pictures; the text of such a
 * drawing is read without being shown.
 */
export async function activeDrawing(server: Server): Promise<vscode.TextDocument | undefined> {
  const input = vscode.window.tabGroups.activeTabGroup.activeTab?.input;
  const shown = vscode.window.activeTextEditor?.document;
  const document =
    input instanceof vscode.TabInputCustom && input.uri.path.endsWith(".svg") ? await vscode.workspace.openTextDocument(input.uri) : shown;
  if (document && server.handles(document)) return document;
  void vscode.window.showInformationMessage("Open a drawing, an SVG file, first.");
  return undefined;
}

/** Shows a drawing in 3D: the one that the code lens or menu passes, otherwise the active one. */
async function preview(server: Server, previews: Previews, named: unknown): Promise<void> {
  const uri = named instanceof vscode.Uri ? named : typeof named === "string" ? vscode.Uri.parse(named) : (await activeDrawing(server))?.uri;
  if (!uri) return;
  await previews.show(uri);
  // It may be starting at the moment.
  await server.start();
  if (!server.running) await server.restart();
}
