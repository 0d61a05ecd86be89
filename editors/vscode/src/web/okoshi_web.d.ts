/** The module that `editors/web/wasm` is built to, as the language server uses it. */
declare module "okoshi_web" {
  export default function init(options: { readonly module_or_path: WebAssembly.Module | Uint8Array<ArrayBuffer> }): Promise<unknown>;

  export class Server {
    /** Opens a text, or replaces it. Times are those of `Date.now()`. Throws a sentence, a string, if its address is none. */
    write(uri: string, version: number, text: string, now: number): void;
    /** Puts a file beside an open text, by its path from the text's folder; without bytes there is no such file. `renew` then analyses the text again. */
    put(uri: string, path: string, bytes?: Uint8Array): void;
    renew(uri: string, now: number): void;
    close(uri: string): void;
    /** The paths of the files that a text may link to, from its folder, whether they are there or not. */
    links(uri: string): string[];
    /** The diagnostics of a text, as JSON. */
    diagnostics(uri: string): string;
    /** Answers a request of the protocol. Parameters and answer are JSON: `{"result": …}` or `{"error": {"code": …, "message": …}}`. */
    request(method: string, params: string, now: number): string;
    /** The messages for the page that shows a text since the last call, as JSON. */
    news(uri: string): string[];
    /** The bytes behind an address in a message. */
    bytes(address: string): Uint8Array | undefined;
    /** A model of what a change would make of a text; nothing if the change would be refused. Parameters are JSON. */
    attempt(params: string): Uint8Array | undefined;
  }
}
