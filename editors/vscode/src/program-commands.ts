// The commands that run the program on this machine.

import { execFile } from "node:child_process";
import { basename, dirname } from "node:path";
import { promisify } from "node:util";
import * as vscode from "vscode";
import { activeDrawing, type Commands } from "./commands";
import type { Server } from "./server";

/** The commands of an extension that has a program. */
export function ofProgram(server: Server): Commands {
  return {
    "okoshi.build": () => build(server),
    "okoshi.newDrawing": () => newDrawing(server),
  };
}

async function build(server: Server): Promise<void> {
  const drawing = await activeDrawing(server);
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
