// The language server: finds, starts, stops and restarts it, wherever it comes from.

import * as vscode from "vscode";
import {
  CloseAction,
  DidChangeConfigurationNotification,
  ErrorAction,
  RevealOutputChannelOn,
  State as ClientState,
  type BaseLanguageClient,
  type CloseHandlerResult,
  type ErrorHandler,
  type LanguageClientOptions,
  type StaticFeature,
} from "vscode-languageclient";
import { hasStrings, isDrawing, selector } from "./drawing";
import { PREVIEW_NOTIFICATION, readNotification, type Message } from "./preview/messages";
import { configuration, initializationOptions, settingsFrom, type Settings } from "./settings";
import type { State } from "./status-text";
import { TraceChannel } from "./trace";

/** How often a server that exits is restarted within `CRASH_WINDOW`. */
const MAX_CRASHES = 4;
/** In milliseconds. */
const CRASH_WINDOW = 180_000;

/** The current settings. */
export function settings(): Settings {
  const section = vscode.workspace.getConfiguration("okoshi");
  return settingsFrom((name) => section.get(name));
}

/** What a language server is started from. */
export interface Program {
  /** The schemes of the files that it can read. */
  readonly schemes: readonly string[];
  /** Looks for it. Undefined if there is none, which is logged. */
  find(): Promise<string | undefined>;
  /** Its version; undefined if what was found is not okoshi. */
  version(found: string): Promise<string | undefined>;
  /** A client that starts what was found. */
  client(found: string, options: LanguageClientOptions): BaseLanguageClient;
}

/** Messages for the page that shows a drawing. */
export interface PreviewMessages {
  readonly uri: vscode.Uri;
  readonly messages: readonly Message[];
}

/** The language server of a window. */
export class Server implements vscode.Disposable {
  private readonly changes = new vscode.EventEmitter<void>();
  private readonly previewMessages = new vscode.EventEmitter<PreviewMessages>();
  private readonly tracing: TraceChannel;
  private client: BaseLanguageClient | undefined;
  private found: string | undefined;
  private reportedMissing = false;
  private crashes: number[] = [];
  private queue: Promise<void> = Promise.resolve();
  private now: State = { kind: "idle" };
  private run = 0;

  /** Fires when `state` has changed. */
  readonly onDidChange = this.changes.event;
  /** Fires when the server has messages for a drawing's page. */
  readonly onPreviewMessages = this.previewMessages.event;

  constructor(private readonly from: Program, private readonly output: vscode.LogOutputChannel) {
    this.tracing = new TraceChannel(output, settings().traced);
  }

  /** The documents that the server handles. */
  get selector(): ReturnType<typeof selector> {
    return selector(this.from.schemes);
  }

  /** Whether a document is a drawing, which the server handles. */
  handles(document: vscode.TextDocument): boolean {
    return isDrawing(this.from.schemes, document.languageId, document.uri.scheme, document.uri.path);
  }

  get state(): State {
    return this.now;
  }

  /** Counts the starts of the server: a new process has no state of the last one. */
  get runs(): number {
    return this.run;
  }

  /** The running client. */
  get running(): BaseLanguageClient | undefined {
    return this.client?.isRunning() ? this.client : undefined;
  }

  /** The path of the program, if it was found. */
  get program(): string | undefined {
    return this.found;
  }

  /** Starts the server if it is not running and a drawing is open. */
  start(): Promise<void> {
    return this.enqueue(async () => {
      // A failure was reported already; only an explicit restart tries again.
      if (this.client || this.now.kind === "failed" || !vscode.workspace.textDocuments.some((document) => this.handles(document))) return;
      await this.startNow();
    });
  }

  /** Restarts the server, whether drawings are open or not. */
  restart(): Promise<void> {
    return this.enqueue(() => this.restartNow());
  }

  /** Passes changed settings to the server, or starts the program that they now name. */
  settingsChanged(event: vscode.ConfigurationChangeEvent): void {
    if (event.affectsConfiguration("okoshi.trace.server")) this.tracing.enable(settings().traced);
    if (event.affectsConfiguration("okoshi.path")) {
      // Queued: settings often change while the previous program is still being looked for.
      void this.enqueue(async () => {
        if (this.now.kind !== "idle") await this.restartNow();
      });
    } else if (event.affectsConfiguration("okoshi.analyse")) {
      this.running
        ?.sendNotification(DidChangeConfigurationNotification.type, configuration(settings()))
        .catch((error: unknown) => this.output.error(String(error)));
    }
  }

  /** Finds the program; reports it if there is none. */
  async find(): Promise<string | undefined> {
    this.found = await this.from.find();
    if (this.found === undefined) this.setState({ kind: "missing", path: settings().path });
    return this.found;
  }

  async stop(): Promise<void> {
    await this.enqueue(() => this.stopNow());
  }

  dispose(): void {
    this.changes.dispose();
    this.previewMessages.dispose();
    this.tracing.dispose();
  }

  private enqueue(task: () => Promise<void>): Promise<void> {
    this.queue = this.queue.then(task).catch((error: unknown) => this.output.error(String(error)));
    return this.queue;
  }

  private setState(state: State): void {
    this.now = state;
    this.changes.fire();
  }

  private async restartNow(): Promise<void> {
    this.reportedMissing = false;
    this.crashes = [];
    await this.stopNow();
    await this.startNow();
  }

  private async stopNow(): Promise<void> {
    const client = this.client;
    this.client = undefined;
    // A client that never ran, or has exited, cannot be stopped.
    await client?.dispose().catch((error: unknown) => this.output.warn(String(error)));
    if (this.now.kind === "running") this.setState({ kind: "stopped" });
  }

  private async startNow(): Promise<void> {
    const command = await this.find();
    if (command === undefined) {
      this.reportMissing();
      return;
    }
    this.setState({ kind: "starting" });
    const version = await this.from.version(command);
    if (version === undefined) {
      this.fail(`${command} is not okoshi: it does not report a version.`);
      return;
    }
    this.output.info(`Starting ${command} (okoshi ${version})`);
    const client: BaseLanguageClient = this.from.client(command, {
      documentSelector: this.selector,
      outputChannel: this.output,
      traceOutputChannel: this.tracing,
      revealOutputChannelOn: RevealOutputChannelOn.Never,
      initializationOptions: initializationOptions(settings()),
      initializationFailedHandler: () => false,
      errorHandler: this.errorHandler(() => client),
      markdown: { isTrusted: false, supportHtml: false },
    });
    client.registerFeature(pushOnly);
    client.registerFeature(ownPreview);
    client.registerFeature(ownFormatting);
    client.onNotification(PREVIEW_NOTIFICATION, (params: unknown) => {
      const read = readNotification(params);
      if (read) this.previewMessages.fire({ uri: client.protocol2CodeConverter.asUri(read.uri), messages: read.messages });
    });
    this.client = client;
    client.onDidChangeState(({ newState }) => {
      if (this.client !== client) return;
      if (newState === ClientState.Running) {
        this.run += 1;
        this.setState({ kind: "running", version });
      } else if (newState === ClientState.Starting) this.setState({ kind: "starting" });
      else if (this.now.kind !== "failed") this.setState({ kind: "stopped" });
    });
    try {
      await client.start();
    } catch (error) {
      // The library has shown a message already.
      this.setState({ kind: "failed", why: `${command} did not start` });
      this.output.error(String(error));
    }
  }

  private errorHandler(client: () => BaseLanguageClient): ErrorHandler {
    return {
      error: () => ({ action: ErrorAction.Continue, handled: true }),
      closed: (): CloseHandlerResult => {
        const now = Date.now();
        this.crashes = [...this.crashes.filter((then) => now - then < CRASH_WINDOW), now];
        const once = client().initializeResult !== undefined;
        if (once && this.crashes.length <= MAX_CRASHES) return { action: CloseAction.Restart, handled: true };
        if (once) this.fail("The language server keeps crashing and is no longer restarted.");
        return { action: CloseAction.DoNotRestart, handled: true };
      },
    };
  }

  private fail(why: string): void {
    this.setState({ kind: "failed", why });
    this.output.error(why);
    void choose(vscode.window.showErrorMessage, why, {
      "Show Output": "okoshi.showOutput",
      "Restart": "okoshi.restart",
      "Open Settings": "workbench.action.openSettings",
    });
  }

  private reportMissing(): void {
    const strings = vscode.workspace.textDocuments.some((document) => this.handles(document) && hasStrings(document.getText()));
    if (this.reportedMissing || !strings) return;
    this.reportedMissing = true;
    const { path } = settings();
    void choose(vscode.window.showWarningMessage, `The program ${path} was not found, so drawings are not checked.`, {
      "How to Install": "okoshi.openWalkthrough",
      "Open Settings": "workbench.action.openSettings",
    });
  }
}

/**
 * Disables pull diagnostics. The server publishes diagnostics, at times that the setting `okoshi.analyse` determines.
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
 * Keeps the library from registering `okoshi.preview`, the command of the server's code lens: the extension registers it itself,
 * to open a panel.
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

/** Keeps the library from registering formatting for all SVG files: `Formatting` does so for those with strings. */
const ownFormatting: StaticFeature = {
  fillClientCapabilities: () => {},
  preInitialize: (capabilities) => {
    delete capabilities.documentFormattingProvider;
    delete capabilities.documentRangeFormattingProvider;
  },
  initialize: () => {},
  getState: () => ({ kind: "static" }),
  clear: () => {},
};

type Show = (message: string, ...items: string[]) => Thenable<string | undefined>;

/** Shows a message with buttons that run commands. */
async function choose(show: Show, message: string, buttons: Readonly<Record<string, string>>): Promise<void> {
  const chosen = await show(message, ...Object.keys(buttons));
  const command = chosen === undefined ? undefined : buttons[chosen];
  if (command === undefined) return;
  await (command === "workbench.action.openSettings"
    ? vscode.commands.executeCommand(command, "okoshi.path")
    : vscode.commands.executeCommand(command));
}
