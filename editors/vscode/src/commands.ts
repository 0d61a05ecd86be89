// The commands of the extension.

import { execFile } from "node:child_process";
import { basename, dirname } from "node:path";
import { promisify } from "node:util";
import * as vscode from "vscode";
import type { Previews } from "./preview/panels";
import { isDrawingDocument, type Server } from "./server";

/** Registers the commands that package.json lists. */
export function register(context: vscode.ExtensionContext, server: Server, previews: Previews, output: vscode.LogOutputChannel): void {
  const commands: Record<string, (argument?: unknown) => unknown> = {
    "okoshi.preview": (drawing) => preview(server, previews, drawing),
    "okoshi.build": () => build(server),
    "okoshi.newDrawing": () => newDrawing(server),
    "okoshi.restart": () => server.restart(),
    "okoshi.showOutput": () => output.show(),
    "okoshi.openWalkthrough": () =>
      vscode.commands.executeCommand("workbench.action.openWalkthrough", { category: `${context.extension.id}#begin` }, false),
  };
  for (const [name, run] of Object.entries(commands)) {
    context.subscriptions.push(vscode.commands.registerCommand(name, run));
  }
}

/**
 * The drawing in the active editor, or a message that there is none. Editors can show SVG files as pictures; the text of such a
 * drawing is read without being shown.
 */
async function activeDrawing(): Promise<vscode.TextDocument | undefined> {
  const input = vscode.window.tabGroups.activeTabGroup.activeTab?.input;
  const shown = vscode.window.activeTextEditor?.document;
  const document =
    input instanceof vscode.TabInputCustom && input.uri.path.endsWith(".svg") ? await vscode.workspace.openTextDocument(input.uri) : shown;
  if (document && isDrawingDocument(document)) return document;
  void vscode.window.showInformationMessage("Open a drawing, an SVG file, first.");
  return undefined;
}

/** Shows a drawing in 3D: the one that the code lens or menu passes, otherwise the active one. */
async function preview(server: Server, previews: Previews, named: unknown): Promise<void> {
  const uri = named instanceof vscode.Uri ? named : typeof named === "string" ? vscode.Uri.parse(named) : (await activeDrawing())?.uri;
  if (!uri) return;
  await previews.show(uri);
  if (!server.running) await server.restart();
}

async function build(server: Server): Promise<void> {
  const drawing = await activeDrawing();
  if (!drawing) return;
  if (drawing.uri.scheme !== "file" || (drawing.isDirty && !(await drawing.save()))) {
    void vscode.window.showInformationMessage("Save the drawing first: the model is written beside it.");
    return;
  }
  const program = await findOrExplain(server);
  if (program === undefined) return;
  const file = drawing.uri.fsPath;
  const task = new vscode.Task(
    { type: "process" },
    vscode.workspace.getWorkspaceFolder(drawing.uri) ?? vscode.TaskScope.Global,
    `build ${basename(file)}`,
    "okoshi",
    new vscode.ProcessExecution(program, ["build", file], { cwd: dirname(file) }),
  );
  task.presentationOptions = { reveal: vscode.TaskRevealKind.Always, panel: vscode.TaskPanelKind.Dedicated, clear: true };
  await vscode.tasks.executeTask(task);
}

async function newDrawing(server: Server): Promise<void> {
  const program = await findOrExplain(server);
  if (program === undefined) return;
  const folder = vscode.workspace.workspaceFolders?.find(({ uri }) => uri.scheme === "file")?.uri;
  const target = await vscode.window.showSaveDialog({
    title: "New Drawing",
    saveLabel: "Create",
    filters: { Drawings: ["svg"] },
    ...(folder && { defaultUri: vscode.Uri.joinPath(folder, "drawing.svg") }),
  });
  if (!target) return;
  try {
    await promisify(execFile)(program, ["new", target.fsPath], { windowsHide: true });
    await vscode.window.showTextDocument(target);
  } catch (error) {
    void vscode.window.showErrorMessage(`The drawing was not created: ${message(error)}`);
  }
}

async function findOrExplain(server: Server): Promise<string | undefined> {
  const program = server.program ?? (await server.find());
  if (program === undefined) await vscode.commands.executeCommand("okoshi.openWalkthrough");
  return program;
}

function message(error: unknown): string {
  const { stderr } = error as { stderr?: unknown };
  if (typeof stderr === "string" && stderr.trim() !== "") return stderr.trim();
  return error instanceof Error ? error.message : String(error);
}
