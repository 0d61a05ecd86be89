// Formatting, offered for annotated drawings only: for other SVG files the editor would ask which of several formatters it should use.

import * as vscode from "vscode";
import { DocumentFormattingRequest, DocumentRangeFormattingRequest, type TextEdit } from "vscode-languageclient";
import { hasStrings } from "./drawing";
import type { Server } from "./server";

/** How long after the last change a text is searched for strings, in milliseconds. */
const SETTLE_PAUSE = 300;

/** Registers a formatter for each open drawing while it has strings and the server runs. */
export class Formatting implements vscode.Disposable {
  private readonly offered = new Map<string, vscode.Disposable>();
  private readonly timers = new Map<string, ReturnType<typeof setTimeout>>();
  private readonly disposables: vscode.Disposable[];

  constructor(private readonly server: Server) {
    this.disposables = [
      server.onDidChange(() => this.updateAll()),
      vscode.workspace.onDidOpenTextDocument((document) => this.update(document)),
      vscode.workspace.onDidCloseTextDocument((document) => this.withdraw(document.uri.toString())),
      vscode.workspace.onDidChangeTextDocument(({ document }) => this.soon(document)),
    ];
    this.updateAll();
  }

  dispose(): void {
    for (const disposable of [...this.disposables, ...this.offered.values()]) disposable.dispose();
    for (const timer of this.timers.values()) clearTimeout(timer);
  }

  private updateAll(): void {
    for (const document of vscode.workspace.textDocuments) this.update(document);
  }

  private soon(document: vscode.TextDocument): void {
    if (!this.server.handles(document)) return;
    const key = document.uri.toString();
    clearTimeout(this.timers.get(key));
    this.timers.set(key, setTimeout(() => this.update(document), SETTLE_PAUSE));
  }

  private update(document: vscode.TextDocument): void {
    const key = document.uri.toString();
    const wanted = this.server.running !== undefined && !document.isClosed && this.server.handles(document) && hasStrings(document.getText());
    if (!wanted) this.withdraw(key);
    else if (!this.offered.has(key)) this.offered.set(key, this.offer(document.uri));
  }

  private withdraw(key: string): void {
    clearTimeout(this.timers.get(key));
    this.timers.delete(key);
    this.offered.get(key)?.dispose();
    this.offered.delete(key);
  }

  private offer(uri: vscode.Uri): vscode.Disposable {
    const selector = { scheme: uri.scheme, pattern: uri.fsPath };
    return vscode.Disposable.from(
      vscode.languages.registerDocumentFormattingEditProvider(selector, {
        provideDocumentFormattingEdits: (document, options, token) =>
          this.edits(document, (client, textDocument) =>
            client.sendRequest(DocumentFormattingRequest.type, { textDocument, options: client.code2ProtocolConverter.asFormattingOptions(options, {}) }, token),
          ),
      }),
      vscode.languages.registerDocumentRangeFormattingEditProvider(selector, {
        provideDocumentRangeFormattingEdits: (document, range, options, token) =>
          this.edits(document, (client, textDocument) =>
            client.sendRequest(
              DocumentRangeFormattingRequest.type,
              { textDocument, range: client.code2ProtocolConverter.asRange(range), options: client.code2ProtocolConverter.asFormattingOptions(options, {}) },
              token,
            ),
          ),
      }),
    );
  }

  private async edits(
    document: vscode.TextDocument,
    ask: (client: NonNullable<Server["running"]>, textDocument: { uri: string }) => Promise<TextEdit[] | null>,
  ): Promise<vscode.TextEdit[] | undefined> {
    const client = this.server.running;
    if (!client) return undefined;
    return client.protocol2CodeConverter.asTextEdits(await ask(client, client.code2ProtocolConverter.asTextDocumentIdentifier(document)));
  }
}
