// Showing what the server wants shown: pictures go beside the text, all else where the editor thinks best.

import * as vscode from "vscode";
import type { ShowDocumentParams, ShowDocumentRequest } from "vscode-languageclient/node";
import { isPicture } from "./drawing";

/** Shows a picture in the editor's own viewer, which is nearer than the system's; leaves other documents to the library. */
export async function showDocument(
  params: ShowDocumentParams,
  token: vscode.CancellationToken,
  next: ShowDocumentRequest.HandlerSignature,
): Promise<{ success: boolean }> {
  const uri = vscode.Uri.parse(params.uri);
  if (!isPicture(uri.path)) {
    const result = await next(params, token);
    return "success" in result ? result : { success: false };
  }
  // A picture that is already shown is renewed by its viewer when the file changes.
  const shown = vscode.window.tabGroups.all.find(({ tabs }) => tabs.some(({ input }) => inputUri(input) === uri.toString()));
  await vscode.commands.executeCommand("vscode.open", uri, {
    viewColumn: shown?.viewColumn ?? vscode.ViewColumn.Beside,
    preserveFocus: params.takeFocus !== true,
    preview: true,
  });
  return { success: true };
}

function inputUri(input: unknown): string | undefined {
  return input instanceof vscode.TabInputCustom || input instanceof vscode.TabInputText ? input.uri.toString() : undefined;
}
