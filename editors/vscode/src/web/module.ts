// The program as a module, in a worker that is a language server.

import * as vscode from "vscode";
import { BrowserMessageReader, BrowserMessageWriter, LanguageClient, State, type BaseLanguageClient, type LanguageClientOptions, type MessageTransports } from "vscode-languageclient/browser";
import type { Program } from "../server";
import { READ_FILE, STOPPED, type FileAnswer, type FileQuestion } from "./protocol";

/** Files that drawings link to are not read if they are larger, as the program does it, in bytes. */
const LARGEST_FILE = 256 << 20;

export class Module implements Program, vscode.Disposable {
  /** Compiled once, for every start of the server. */
  private compiled: Promise<WebAssembly.Module> | undefined;
  private readonly files = vscode.workspace.createFileSystemWatcher("**/*");

  constructor(
    /** The folder of the extension. */
    private readonly extension: vscode.Uri,
    private readonly release: string,
  ) {}

  /** Files may be anywhere: in a repository, in the browser, on a server. */
  get schemes(): readonly string[] {
    const folders = vscode.workspace.workspaceFolders ?? [];
    return [...new Set(["file", ...folders.map(({ uri }) => uri.scheme)])];
  }

  async find(): Promise<string> {
    return this.at("okoshi_web_bg.wasm").toString();
  }

  async version(): Promise<string> {
    return this.release;
  }

  client(_found: string, options: LanguageClientOptions): BaseLanguageClient {
    // Each client ends its own worker: it may stop after the next one has started.
    let worker: Worker | undefined;
    const end = (): void => worker?.terminate();
    const open = async (): Promise<MessageTransports> => {
      end();
      worker = await this.open();
      return { reader: new WorkerReader(worker), writer: new BrowserMessageWriter(worker) };
    };
    const client = new LanguageClient("okoshi", "Okoshi", open, { ...options, synchronize: { fileEvents: this.files } });
    client.onRequest(READ_FILE, readFile);
    client.onDidChangeState(({ newState }) => {
      if (newState === State.Stopped) end();
    });
    return client;
  }

  dispose(): void {
    this.files.dispose();
  }

  private async open(): Promise<Worker> {
    this.compiled ??= this.read("okoshi_web_bg.wasm").then((bytes) => WebAssembly.compile(bytes));
    // Read here, because a worker cannot be started from an address of another origin, such as that of the extension.
    const [script, compiled] = await Promise.all([this.read("server.js"), this.compiled]);
    const address = URL.createObjectURL(new Blob([script], { type: "text/javascript" }));
    const worker = new Worker(address);
    worker.postMessage(compiled);
    // The worker has begun when it answers.
    worker.addEventListener("message", () => URL.revokeObjectURL(address), { once: true });
    return worker;
  }

  private async read(name: string): Promise<Uint8Array<ArrayBuffer>> {
    return new Uint8Array(await vscode.workspace.fs.readFile(this.at(name)));
  }

  private at(name: string): vscode.Uri {
    return vscode.Uri.joinPath(this.extension, "dist", "web", name);
  }
}

/** Closes the connection when the module stops, so that the client starts it again. */
class WorkerReader extends BrowserMessageReader {
  constructor(worker: Worker) {
    super(worker);
    worker.addEventListener("message", ({ data }: MessageEvent<{ method?: unknown } | null>) => {
      if (data?.method === STOPPED) this.fireClose();
    });
    // A script that cannot be run, or that has no memory left.
    worker.addEventListener("error", () => this.fireClose());
  }
}

/** A file beside a drawing, by the address of the drawing and the path from its folder. */
async function readFile({ drawing, path }: FileQuestion): Promise<FileAnswer> {
  const uri = vscode.Uri.joinPath(vscode.Uri.parse(drawing), "..", ...path.split("/"));
  const answer = { uri: uri.toString(), bytes: null };
  if (uri.scheme === "untitled") return answer;
  try {
    const { size } = await vscode.workspace.fs.stat(uri);
    return size > LARGEST_FILE ? answer : { ...answer, bytes: new Uint8Array(await vscode.workspace.fs.readFile(uri)) };
  } catch {
    // It is not there, which the drawing's diagnostics say.
    return answer;
  }
}
