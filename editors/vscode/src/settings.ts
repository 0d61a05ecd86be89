// Validates the settings, because settings.json may contain anything. Independent of the editor.

/** The program, if no other is set. */
export const DEFAULT = "okoshi";

/** When the server checks drawings. */
export type Analyse = "onType" | "onSave";

export interface Settings {
  /** As written; `binary.ts` resolves it. */
  readonly path: string;
  readonly analyse: Analyse;
  readonly traced: boolean;
}

/** Reads the settings with `get`; values of the wrong type count as not set. */
export function settingsFrom(get: (name: string) => unknown): Settings {
  const path = get("path");
  const trace = get("trace.server");
  return {
    path: typeof path === "string" && path.trim() !== "" ? path.trim() : DEFAULT,
    analyse: get("analyse") === "onSave" ? "onSave" : "onType",
    traced: trace === "messages" || trace === "compact" || trace === "verbose",
  };
}

/** The options that the server is started with. */
export function initializationOptions({ analyse }: Settings): { analyse: Analyse; preview: true } {
  // Previews have a panel here; otherwise the server would open a browser.
  return { analyse, preview: true };
}

/** The parameters of `workspace/didChangeConfiguration`. */
export function configuration({ analyse }: Settings): { settings: { okoshi: { analyse: Analyse } } } {
  return { settings: { okoshi: { analyse } } };
}
