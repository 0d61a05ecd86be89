// Panels that show drawings in 3D beside their text, one for each drawing.

import * as vscode from "vscode";
import { nameOf } from "../drawing";
import type { Server } from "../server";
import { html } from "./page";
import { linkFor, Session, type Editor } from "./session";
import { Remote, utf16Offset, type Place, type Position, type TextEdit } from "./messages";

const TYPE = "okoshi.preview";

export class Previews implements vscode.Disposable, vscode.WebviewPanelSerializer {
  private readonly shown = new Map<string, Preview>();
  private readonly disposables: vscode.Disposable[];

  constructor(
    private readonly extension: vscode.Uri,
    private readonly server: Server,
    private readonly output: vscode.LogOutputChannel,
  ) {
    this.disposables = [
      vscode.window.registerWebviewPanelSerializer(TYPE, this),
      server.onDidChange(() => this.each((preview) => preview.follow())),
      server.onPreviewMessages(({ uri, messages }) => this.shown.get(uri.toString())?.session.messages(messages)),
      vscode.workspace.onDidCloseTextDocument(({ uri }) => this.shown.get(uri.toString())?.closed()),
      vscode.workspace.onDidOpenTextDocument((document) => {
        if (server.handles(document)) this.shown.get(document.uri.toString())?.follow();
      }),
      vscode.window.onDidChangeTextEditorSelection(({ textEditor }) => this.shown.get(textEditor.document.uri.toString())?.session.moved()),
      vscode.window.onDidChangeActiveTextEditor((editor) => {
        // There is no active editor while a panel has the focus: the highlight stays.
        if (editor) this.each(({ session }) => session.moved());
      }),
    ];
  }

  /** Shows a drawing in its panel, or opens a panel beside the text. The text keeps the focus. */
  async show(uri: vscode.Uri): Promise<void> {
    const there = this.shown.get(uri.toString());
    if (there) return there.panel.reveal(undefined, true);
    const panel = vscode.window.createWebviewPanel(
      TYPE,
      title(uri),
      { viewColumn: vscode.ViewColumn.Beside, preserveFocus: true },
      // The page keeps its camera, pose and clip.
      { retainContextWhenHidden: true, ...this.options },
    );
    await this.fill(panel, uri);
  }

  /** Restores a panel after the window was reloaded. */
  async deserializeWebviewPanel(panel: vscode.WebviewPanel, state: unknown): Promise<void> {
    const { drawing } = (state ?? {}) as { drawing?: unknown };
    if (typeof drawing !== "string") return panel.dispose();
    const uri = vscode.Uri.parse(drawing);
    if (this.shown.has(uri.toString())) return panel.dispose();
    panel.webview.options = this.options;
    await this.fill(panel, uri);
  }

  dispose(): void {
    for (const disposable of this.disposables) disposable.dispose();
  }

  private async fill(panel: vscode.WebviewPanel, uri: vscode.Uri): Promise<void> {
    const key = uri.toString();
    const preview = new Preview(uri, panel, this.server, this.output);
    this.shown.set(key, preview);
    panel.onDidDispose(() => {
      if (this.shown.get(key) === preview) this.shown.delete(key);
      preview.dispose();
    });
    panel.title = title(uri);
    panel.iconPath = vscode.Uri.joinPath(this.extension, "icon.png");
    const at = (name: string) => panel.webview.asWebviewUri(vscode.Uri.joinPath(this.folder, name)).toString();
    const template = await vscode.workspace.fs.readFile(vscode.Uri.joinPath(this.folder, "page.html"));
    panel.webview.html = html(new TextDecoder().decode(template), {
      script: at("page.js"),
      style: at("page.css"),
      source: panel.webview.cspSource,
      nonce: crypto.randomUUID(),
    });
    preview.follow();
  }

  private get folder(): vscode.Uri {
    return vscode.Uri.joinPath(this.extension, "dist", "page");
  }

  private get options(): vscode.WebviewOptions {
    return { enableScripts: true, localResourceRoots: [this.folder] };
  }

  private each(act: (preview: Preview) => void): void {
    for (const preview of [...this.shown.values()]) act(preview);
  }
}

/** The panel of a drawing. */
class Preview implements Editor, vscode.Disposable {
  readonly session: Session;
  /** The run of the server that was subscribed to. */
  private asked: number | undefined;
  private queue: Promise<void> = Promise.resolve();
  private watcher: vscode.FileSystemWatcher | undefined;
  private disposed = false;

  constructor(
    private readonly uri: vscode.Uri,
    readonly panel: vscode.WebviewPanel,
    private readonly server: Server,
    private readonly output: vscode.LogOutputChannel,
  ) {
    this.session = new Session(uri.toString(), this);
    panel.webview.onDidReceiveMessage((data: unknown) => void this.session.receive(data));
  }

  /** Follows server and text: subscribes when both are available. */
  follow(): void {
    this.queue = this.queue.then(() => this.followNow()).catch((error: unknown) => this.log(String(error)));
  }

  /** The text was closed: it is reopened without being shown, so that the panel follows the file. */
  closed(): void {
    this.asked = undefined;
    this.follow();
  }

  dispose(): void {
    this.disposed = true;
    this.watcher?.dispose();
    this.session.dispose();
  }

  post(message: object): void {
    void this.panel.webview.postMessage({ okoshi: message });
  }

  cursor(): Position | null {
    const active = vscode.window.activeTextEditor;
    const editor = active ?? vscode.window.visibleTextEditors.find(({ document }) => this.isOurs(document));
    if (!editor || !this.isOurs(editor.document)) return null;
    // A plain object: of the editor's own only the fields that it hides arrive in a worker.
    const { line, character } = editor.selection.active;
    return { line, character };
  }

  async show({ uri, range: { start, end } }: Place): Promise<void> {
    const document = await vscode.workspace.openTextDocument(vscode.Uri.parse(uri));
    const range = new vscode.Range(start.line, start.character, end.line, end.character);
    // The panel keeps the focus: a key meant for the page would replace the selection.
    await this.select(document, range, true);
  }

  async goTo(line: number, column: number): Promise<void> {
    const document = await vscode.workspace.openTextDocument(this.uri);
    const at = Math.min(line, document.lineCount) - 1;
    const place = new vscode.Position(at, utf16Offset(document.lineAt(at).text, column));
    await this.select(document, new vscode.Range(place, place), false);
  }

  async save(name: string, bytes: Uint8Array): Promise<void> {
    const folder = this.isFile ? vscode.Uri.joinPath(this.uri, "..") : vscode.workspace.workspaceFolders?.[0]?.uri;
    const target = await vscode.window.showSaveDialog(folder ? { defaultUri: vscode.Uri.joinPath(folder, name) } : {});
    if (!target) return;
    try {
      await vscode.workspace.fs.writeFile(target, bytes);
    } catch (error) {
      void vscode.window.showErrorMessage(`${nameOf(target.path)} was not written: ${error instanceof Error ? error.message : String(error)}`);
    }
  }

  async edit(version: number, edits: readonly TextEdit[]): Promise<boolean> {
    const document = await vscode.workspace.openTextDocument(this.uri);
    if (document.version !== version) return false;
    const change = new vscode.WorkspaceEdit();
    for (const { range: { start, end }, newText } of edits) change.replace(this.uri, new vscode.Range(start.line, start.character, end.line, end.character), newText);
    return vscode.workspace.applyEdit(change);
  }

  async step(back: boolean): Promise<void> {
    // The editor undoes in the text that has the focus.
    const document = await vscode.workspace.openTextDocument(this.uri);
    await vscode.window.showTextDocument(document, { viewColumn: this.column(document), preview: false });
    await vscode.commands.executeCommand(back ? "undo" : "redo");
    this.panel.reveal(undefined, false);
  }

  async saveText(): Promise<void> {
    const document = await vscode.workspace.openTextDocument(this.uri);
    // A text that is as it was saved stays as it is.
    if (document.isDirty || document.isUntitled) await document.save();
  }

  log(message: string): void {
    this.output.warn(message);
  }

  /** Whether it is a file that may come back; untitled texts are none. */
  private get isFile(): boolean {
    return this.uri.scheme !== "untitled";
  }

  private isOurs(document: vscode.TextDocument): boolean {
    return document.uri.toString() === this.uri.toString();
  }

  private async followNow(): Promise<void> {
    if (this.disposed) return;
    const document = await this.read();
    if (this.disposed) return;
    this.watch(document === undefined);
    if (!document) {
      this.asked = undefined;
      if (this.isFile) this.session.gone();
      else this.session.disconnect({ state: "lost", note: "The drawing was closed. This is its last model." });
      return;
    }
    const { running: client, runs, state } = this.server;
    if (!client || state.kind !== "running") {
      this.asked = undefined;
      return this.session.disconnect(linkFor(state));
    }
    if (this.asked === runs) return;
    this.asked = runs;
    await this.session.connect(new Remote(client, client.code2ProtocolConverter.asUri(this.uri)));
  }

  /** The drawing's text, opened if its file exists. Closed untitled drawings no longer exist. */
  private async read(): Promise<vscode.TextDocument | undefined> {
    const open = vscode.workspace.textDocuments.find((document) => this.isOurs(document));
    if (open || !this.isFile) return open;
    try {
      return await vscode.workspace.openTextDocument(this.uri);
    } catch {
      return undefined;
    }
  }

  /** Waits for a missing file. */
  private watch(wanted: boolean): void {
    if (!wanted) {
      this.watcher?.dispose();
      this.watcher = undefined;
    } else if (!this.watcher && this.isFile) {
      const pattern = new vscode.RelativePattern(vscode.Uri.joinPath(this.uri, ".."), escaped(nameOf(this.uri.path)));
      this.watcher = vscode.workspace.createFileSystemWatcher(pattern, false, false, true);
      this.watcher.onDidCreate(() => this.follow());
      this.watcher.onDidChange(() => this.follow());
    }
  }

  private async select(document: vscode.TextDocument, selection: vscode.Range, preserveFocus: boolean): Promise<void> {
    await vscode.window.showTextDocument(document, { viewColumn: this.column(document), selection, preserveFocus, preview: false });
  }

  /** The column where the text is or should be; never the panel's, which would be covered. */
  private column(document: vscode.TextDocument): vscode.ViewColumn {
    const key = document.uri.toString();
    const elsewhere = (column: vscode.ViewColumn | undefined) => column !== undefined && column !== this.panel.viewColumn;
    const editors = vscode.window.visibleTextEditors.filter((editor) => editor.document.uri.toString() === key);
    const groups = vscode.window.tabGroups.all.filter(({ tabs }) =>
      tabs.some(({ input }) => input instanceof vscode.TabInputText && input.uri.toString() === key),
    );
    const found = [...editors, ...groups, ...vscode.window.tabGroups.all].find(({ viewColumn }) => elsewhere(viewColumn));
    return found?.viewColumn ?? vscode.ViewColumn.Beside;
  }
}

const title = (uri: vscode.Uri) => `Preview ${nameOf(uri.path)}`;

/** A file name, escaped for a glob pattern. */
const escaped = (name: string) => name.replace(/[*?{}[\]]/g, "[$&]");
