// The language server: found, started, stopped, and started anew when the settings ask for it.

import { execFile } from "node:child_process";
import { access, constants, stat } from "node:fs/promises";
import { homedir } from "node:os";
import { promisify } from "node:util";
import * as vscode from "vscode";
import {
  CloseAction,
  DidChangeConfigurationNotification,
  ErrorAction,
  LanguageClient,
  RevealOutputChannelOn,
  State as ClientState,
  type CloseHandlerResult,
  type ErrorHandler,
  type StaticFeature,
} from "vscode-languageclient/node";
import { candidates, firstThatRuns, versionIn } from "./binary";
import { hasStrings, isDrawing, selector } from "./drawing";
import { NEWS, news, type Message } from "./preview/wire";
import { configuration, initializationOptions, settingsFrom, type Settings } from "./settings";
import type { State } from "./status-text";
import { TraceChannel } from "./trace";

/** How often a server that ended by itself is started again within `CRASH_WINDOW`. */
const MOST_CRASHES = 4;
/** Milliseconds. */
const CRASH_WINDOW = 180_000;
/** How long a program may take to say its version, in milliseconds. */
const VERSION_TIMEOUT = 10_000;

/** The settings as they are now. */
export function settings(): Settings {
  const section = vscode.workspace.getConfiguration("okoshi");
  return settingsFrom((name) => section.get(name));
}

/** Whether the server looks after a document. */
export function looksAfter(document: vscode.TextDocument): boolean {
  return isDrawing(document.languageId, document.uri.scheme, document.uri.path);
}

/** What the server says for the page that shows a drawing. */
export interface News {
  readonly uri: vscode.Uri;
  readonly messages: readonly Message[];
}

/** The one server of a window. */
export class Server implements vscode.Disposable {
  private readonly changes = new vscode.EventEmitter<void>();
  private readonly newsOfPreviews = new vscode.EventEmitter<News>();
  private readonly tracing: TraceChannel;
  private client: LanguageClient | undefined;
  private found: string | undefined;
  private told = false;
  private crashes: number[] = [];
  private queue: Promise<void> = Promise.resolve();
  private now: State = { kind: "idle" };
  private run = 0;

  /** Fires when `state` has changed. */
  readonly onDidChange = this.changes.event;
  /** Fires when a drawing that is shown was built, or something in it is to be lit up. */
  readonly onNews = this.newsOfPreviews.event;

  constructor(private readonly output: vscode.LogOutputChannel) {
    this.tracing = new TraceChannel(output, settings().traced);
  }

  get state(): State {
    return this.now;
  }

  /** How often the server has come to run. What it was told in one run it does not know in the next. */
  get runs(): number {
    return this.run;
  }

  /** The running client. */
  get running(): LanguageClient | undefined {
    return this.client?.isRunning() ? this.client : undefined;
  }

  /** The program, if one was found. */
  get program(): string | undefined {
    return this.found;
  }

  /** Starts the server if it is not running and a drawing is open. */
  start(): Promise<void> {
    return this.inTurn(async () => {
      // What failed was said; it is tried again when it is asked for.
      if (this.client || this.now.kind === "failed" || !vscode.workspace.textDocuments.some(looksAfter)) return;
      await this.startNow();
    });
  }

  /** Ends the server and starts it again, whether drawings are open or not. */
  restart(): Promise<void> {
    return this.inTurn(() => this.restartNow());
  }

  /** Tells the server what has changed in the settings, or starts the program that they now name. */
  settingsChanged(event: vscode.ConfigurationChangeEvent): void {
    if (event.affectsConfiguration("okoshi.trace.server")) this.tracing.ask(settings().traced);
    if (event.affectsConfiguration("okoshi.path")) {
      // In turn: settings often arrive while the program of the old ones is still looked for.
      void this.inTurn(async () => {
        if (this.now.kind !== "idle") await this.restartNow();
      });
    } else if (event.affectsConfiguration("okoshi.analyse")) {
      this.running
        ?.sendNotification(DidChangeConfigurationNotification.type, configuration(settings()))
        .catch((error: unknown) => this.output.error(String(error)));
    }
  }

  /** Finds the program, and says so once if there is none. */
  async find(): Promise<string | undefined> {
    const { path } = settings();
    const places = candidates(path, {
      platform: process.platform,
      env: process.env,
      home: homedir(),
      folder: vscode.workspace.workspaceFolders?.find(({ uri }) => uri.scheme === "file")?.uri.fsPath,
    });
    this.found = await firstThatRuns(places, canRun);
    if (this.found === undefined) {
      this.become({ kind: "missing", path });
      this.output.warn(`The program ${path} was not found. Looked at: ${places.join(", ") || "no place"}`);
    }
    return this.found;
  }

  async stop(): Promise<void> {
    await this.inTurn(() => this.stopNow());
  }

  dispose(): void {
    this.changes.dispose();
    this.newsOfPreviews.dispose();
    this.tracing.dispose();
  }

  private inTurn(task: () => Promise<void>): Promise<void> {
    this.queue = this.queue.then(task).catch((error: unknown) => this.output.error(String(error)));
    return this.queue;
  }

  private become(state: State): void {
    this.now = state;
    this.changes.fire();
  }

  private async restartNow(): Promise<void> {
    this.told = false;
    this.crashes = [];
    await this.stopNow();
    await this.startNow();
  }

  private async stopNow(): Promise<void> {
    const client = this.client;
    this.client = undefined;
    // A client that never came to run, or has ended, has nothing to stop.
    await client?.dispose().catch((error: unknown) => this.output.warn(String(error)));
    if (this.now.kind === "running") this.become({ kind: "stopped" });
  }

  private async startNow(): Promise<void> {
    const command = await this.find();
    if (command === undefined) {
      this.tellMissing();
      return;
    }
    this.become({ kind: "starting" });
    const version = await askVersion(command);
    if (version === undefined) {
      this.fail(`${command} is not okoshi: it does not say its version.`);
      return;
    }
    this.output.info(`Starting ${command} lsp (okoshi ${version})`);
    const client: LanguageClient = new LanguageClient(
      "okoshi",
      "Okoshi",
      // No transport is named: the library would add `--stdio`.
      { command, args: ["lsp"] },
      {
        documentSelector: selector,
        outputChannel: this.output,
        traceOutputChannel: this.tracing,
        revealOutputChannelOn: RevealOutputChannelOn.Never,
        initializationOptions: initializationOptions(settings()),
        initializationFailedHandler: () => false,
        errorHandler: this.errorHandler(() => client),
        markdown: { isTrusted: false, supportHtml: false },
      },
    );
    client.registerFeature(pushOnly);
    client.registerFeature(ownPreview);
    client.onNotification(NEWS, (params: unknown) => {
      const read = news(params);
      if (read) this.newsOfPreviews.fire({ uri: client.protocol2CodeConverter.asUri(read.uri), messages: read.messages });
    });
    this.client = client;
    client.onDidChangeState(({ newState }) => {
      if (this.client !== client) return;
      if (newState === ClientState.Running) {
        this.run += 1;
        this.become({ kind: "running", version });
      } else if (newState === ClientState.Starting) this.become({ kind: "starting" });
      else if (this.now.kind !== "failed") this.become({ kind: "stopped" });
    });
    try {
      await client.start();
    } catch (error) {
      // The library has shown a message of its own.
      this.become({ kind: "failed", why: `${command} lsp did not start` });
      this.output.error(String(error));
    }
  }

  private errorHandler(client: () => LanguageClient): ErrorHandler {
    return {
      error: () => ({ action: ErrorAction.Continue, handled: true }),
      closed: (): CloseHandlerResult => {
        const now = Date.now();
        this.crashes = [...this.crashes.filter((then) => now - then < CRASH_WINDOW), now];
        const once = client().initializeResult !== undefined;
        if (once && this.crashes.length <= MOST_CRASHES) return { action: CloseAction.Restart, handled: true };
        if (once) this.fail("The language server ended again and again; it is left alone now.");
        return { action: CloseAction.DoNotRestart, handled: true };
      },
    };
  }

  private fail(why: string): void {
    this.become({ kind: "failed", why });
    this.output.error(why);
    void choose(vscode.window.showErrorMessage, why, {
      "Show Output": "okoshi.showOutput",
      "Restart": "okoshi.restart",
      "Open Settings": "workbench.action.openSettings",
    });
  }

  private tellMissing(): void {
    const strings = vscode.workspace.textDocuments.some((document) => looksAfter(document) && hasStrings(document.getText()));
    if (this.told || !strings) return;
    this.told = true;
    const { path } = settings();
    void choose(vscode.window.showWarningMessage, `The program ${path} was not found, so drawings are not checked.`, {
      "How to Install": "okoshi.openWalkthrough",
      "Open Settings": "workbench.action.openSettings",
    });
  }
}

/**
 * Diagnostics are sent by the server when it has them, and not fetched after each change as well: the setting
 * `okoshi.analyse` decides when that is.
 */
const pushOnly: StaticFeature = {
  fillClientCapabilities: (capabilities) => {
    delete capabilities.textDocument?.diagnostic;
    delete capabilities.workspace?.diagnostics;
  },
  initialize: () => {},
  getState: () => ({ kind: "static" }),
  clear: () => {},
};

/**
 * The command behind the server's code lens is the extension's own, which opens a panel: the library would register another
 * of that name, and could not.
 */
const ownPreview: StaticFeature = {
  fillClientCapabilities: () => {},
  preInitialize: ({ executeCommandProvider }) => {
    if (!executeCommandProvider) return;
    executeCommandProvider.commands = executeCommandProvider.commands.filter((command) => command !== "okoshi.preview");
  },
  initialize: () => {},
  getState: () => ({ kind: "static" }),
  clear: () => {},
};

type Show = (message: string, ...items: string[]) => Thenable<string | undefined>;

/** A message with buttons, each of which runs a command. */
async function choose(show: Show, message: string, buttons: Readonly<Record<string, string>>): Promise<void> {
  const chosen = await show(message, ...Object.keys(buttons));
  const command = chosen === undefined ? undefined : buttons[chosen];
  if (command === undefined) return;
  await (command === "workbench.action.openSettings"
    ? vscode.commands.executeCommand(command, "okoshi.path")
    : vscode.commands.executeCommand(command));
}

async function canRun(path: string): Promise<boolean> {
  try {
    if (!(await stat(path)).isFile()) return false;
    await access(path, constants.X_OK);
    return true;
  } catch {
    return false;
  }
}

async function askVersion(command: string): Promise<string | undefined> {
  try {
    const { stdout } = await promisify(execFile)(command, ["--version"], { timeout: VERSION_TIMEOUT, windowsHide: true });
    return versionIn(stdout);
  } catch {
    return undefined;
  }
}
