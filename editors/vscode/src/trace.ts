// The client library only traces if its output has log level Trace; this makes the setting enough.

import * as vscode from "vscode";

/** The output channel for traces: with level Trace while the setting enables them. */
export class TraceChannel implements vscode.LogOutputChannel {
  private readonly levels = new vscode.EventEmitter<vscode.LogLevel>();
  private readonly listening: vscode.Disposable;
  readonly onDidChangeLogLevel = this.levels.event;

  constructor(
    private readonly inner: vscode.LogOutputChannel,
    private enabled: boolean,
  ) {
    this.listening = inner.onDidChangeLogLevel(() => this.levels.fire(this.logLevel));
  }

  /** Applies the setting. */
  enable(enabled: boolean): void {
    this.enabled = enabled;
    this.levels.fire(this.logLevel);
  }

  get name(): string {
    return this.inner.name;
  }

  get logLevel(): vscode.LogLevel {
    return this.enabled ? vscode.LogLevel.Trace : this.inner.logLevel;
  }

  trace(message: string, ...more: unknown[]): void {
    if (this.enabled) this.inner.info(message, ...more);
    else this.inner.trace(message, ...more);
  }

  debug(message: string, ...more: unknown[]): void {
    this.inner.debug(message, ...more);
  }

  info(message: string, ...more: unknown[]): void {
    this.inner.info(message, ...more);
  }

  warn(message: string, ...more: unknown[]): void {
    this.inner.warn(message, ...more);
  }

  error(error: string | Error, ...more: unknown[]): void {
    this.inner.error(error, ...more);
  }

  append(value: string): void {
    this.inner.append(value);
  }

  appendLine(value: string): void {
    this.inner.appendLine(value);
  }

  replace(value: string): void {
    this.inner.replace(value);
  }

  clear(): void {
    this.inner.clear();
  }

  show(): void {
    this.inner.show(true);
  }

  hide(): void {
    this.inner.hide();
  }

  dispose(): void {
    this.listening.dispose();
    this.levels.dispose();
  }
}
