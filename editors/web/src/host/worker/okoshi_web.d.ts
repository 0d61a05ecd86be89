// The module that `editors/web/wasm` is built to, as the worker uses it.

export default function init(options: { readonly module_or_path: URL }): Promise<unknown>;

export class Studio {
  /** Puts or replaces a file, by its path relative to the project's folder. One that ends in `.svg` is a drawing, which is built; the others are what
   * drawings may link to. Times are those of `Date.now()`. Throws a sentence, a string, if a drawing is not text. */
  put(path: string, bytes: Uint8Array, now: number): void;
  remove(path: string, now: number): void;
  /** A drawing's text with the changes that were made on the page. */
  text(path: string): string | undefined;
  /** The links of a drawing as it is shown, to files that may be there or not. */
  links(path: string): string[];
  /** Offers drawings to start from while there are none. */
  offer(): void;
  /** A message of the page, as JSON. */
  receive(message: string, now: number): void;
  /** The messages for the page since the last call, as JSON. */
  messages(): string[];
  /** The bytes behind an address in a message. */
  bytes(address: string): Uint8Array | undefined;
  /** A request and its answer as JSON: `{"ok": boolean, "body": …}`. */
  change(request: string, now: number): string;
  form(request: string): string;
  ask(request: string): string;
  attempt(request: string): Tried | undefined;
}

/** A moving picture of a model in binary glTF, as GIF: of a clip, by its number, or of the model that turns around once; from a direction in degrees
 * to its left and up. Throws why there is none, a string. */
export function film(model: Uint8Array, clip: number | undefined, left: number, up: number): Uint8Array;

/** The text of a drawing with the shapes of a picture. Throws why there is none, a string, which follows the picture's name. */
export function trace(picture: Uint8Array): string;

export class Tried {
  readonly address: string;
  readonly bytes: Uint8Array;
  free(): void;
}
