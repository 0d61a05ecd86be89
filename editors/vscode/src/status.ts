// The status item of drawings, and the context keys for menus and the walkthrough.

import * as vscode from "vscode";
import { DocumentSymbolRequest } from "vscode-languageclient";
import { countOutline, type Outline } from "./drawing";
import type { Server } from "./server";
import { words, type Facts } from "./status-text";

/** How long after the last change the parts of a drawing are counted, in milliseconds. */
const SETTLE_PAUSE = 400;

export class Status implements vscode.Disposable {
  private readonly item: vscode.LanguageStatusItem;
  private readonly disposables: vscode.Disposable[];
  private timer: ReturnType<typeof setTimeout> | undefined;
  private facts: Facts | undefined;

  constructor(private readonly server: Server) {
    this.item = vscode.languages.createLanguageStatusItem("okoshi.status", server.selector);
    this.item.name = "Okoshi";
    this.disposables = [
      this.item,
      server.onDidChange(() => this.soon()),
      vscode.window.onDidChangeActiveTextEditor(() => this.soon()),
      vscode.workspace.onDidChangeTextDocument(({ document }) => {
        if (document === vscode.window.activeTextEditor?.document) this.soon();
      }),
      vscode.languages.onDidChangeDiagnostics(({ uris }) => {
        const active = vscode.window.activeTextEditor?.document.uri.toString();
        if (uris.some((uri) => uri.toString() === active)) this.soon();
      }),
    ];
    this.soon();
  }

  dispose(): void {
    clearTimeout(this.timer);
    for (const disposable of this.disposables) disposable.dispose();
  }

  private soon(): void {
    this.show();
    clearTimeout(this.timer);
    this.timer = setTimeout(() => void this.count(), SETTLE_PAUSE);
  }

  private async count(): Promise<void> {
    const document = vscode.window.activeTextEditor?.document;
    const client = this.server.running;
    this.facts = undefined;
    if (document && client && this.server.handles(document)) {
      const found = vscode.languages.getDiagnostics(document.uri).filter(({ source }) => source === "okoshi");
      const of = (severity: vscode.DiagnosticSeverity) => found.filter((one) => one.severity === severity).length;
      let outline: readonly Outline[] = [];
      try {
        const textDocument = client.code2ProtocolConverter.asTextDocumentIdentifier(document);
        outline = ((await client.sendRequest(DocumentSymbolRequest.type, { textDocument })) ?? []) as readonly Outline[];
      } catch {
        // The document was closed or the server stopped meanwhile: there is nothing to count.
      }
      if (document !== vscode.window.activeTextEditor?.document) return;
      this.facts = {
        parts: countOutline(outline),
        errors: of(vscode.DiagnosticSeverity.Error),
        warnings: of(vscode.DiagnosticSeverity.Warning),
      };
    }
    this.show();
  }

  private show(): void {
    const { text, detail, severity, busy } = words(this.server.state, this.facts);
    this.item.text = text;
    this.item.detail = detail;
    this.item.busy = busy;
    this.item.severity = {
      information: vscode.LanguageStatusSeverity.Information,
      warning: vscode.LanguageStatusSeverity.Warning,
      error: vscode.LanguageStatusSeverity.Error,
    }[severity];
    this.item.command =
      this.server.state.kind === "missing"
        ? { title: "How to Install", command: "okoshi.openWalkthrough" }
        : { title: "Show Output", command: "okoshi.showOutput" };
    const document = vscode.window.activeTextEditor?.document;
    const set = (name: string, value: boolean) => void vscode.commands.executeCommand("setContext", `okoshi.${name}`, value);
    set("running", this.server.state.kind === "running");
    set("isDrawing", document !== undefined && this.server.handles(document));
    set("hasParts", (this.facts?.parts ?? 0) > 0);
  }
}
