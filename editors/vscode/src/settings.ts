// The settings, checked: people write anything into settings.json. Knows nothing of the editor.

/** When the server checks drawings. */
export type Analyse = "onType" | "onSave";

export interface Settings {
  /** As written; `binary.ts` makes paths of it. */
  readonly path: string;
  readonly analyse: Analyse;
  readonly traced: boolean;
}

/** Settings from whatever `get` finds under their names; what is of the wrong kind counts as not set. */
export function settingsFrom(get: (name: string) => unknown): Settings {
  const path = get("path");
  const trace = get("trace.server");
  return {
    path: typeof path === "string" && path.trim() !== "" ? path.trim() : "okoshi",
    analyse: get("analyse") === "onSave" ? "onSave" : "onType",
    traced: trace === "messages" || trace === "compact" || trace === "verbose",
  };
}

/** What the server is started with. */
export function initializationOptions({ analyse }: Settings): { analyse: Analyse; preview: true } {
  // Previews have a panel here; without this, the server would open a browser.
  return { analyse, preview: true };
}

/** What `workspace/didChangeConfiguration` carries. */
export function configuration({ analyse }: Settings): { settings: { okoshi: { analyse: Analyse } } } {
  return { settings: { okoshi: { analyse } } };
}
