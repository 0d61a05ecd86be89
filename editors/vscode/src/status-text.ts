// The text of the status item. Independent of the editor.

/** The state of the server. */
export type State =
  | { readonly kind: "idle" | "starting" | "stopped" }
  | { readonly kind: "missing"; readonly path: string }
  | { readonly kind: "failed"; readonly why: string }
  | { readonly kind: "running"; readonly version: string };

/** Counts for the active drawing. */
export interface Facts {
  readonly parts: number;
  readonly errors: number;
  readonly warnings: number;
}

export interface Words {
  readonly text: string;
  readonly detail: string;
  readonly severity: "information" | "warning" | "error";
  readonly busy: boolean;
}

const count = (number: number, noun: string) => `${number} ${noun}${number === 1 ? "" : "s"}`;

/** The status item for a server and, while it runs, for the active drawing. */
export function words(state: State, facts: Facts | undefined): Words {
  const plain = { severity: "information", busy: false } as const;
  switch (state.kind) {
    case "idle":
      return { ...plain, text: "Okoshi", detail: "not started" };
    case "starting":
      return { ...plain, text: "Okoshi", detail: "starting", busy: true };
    case "stopped":
      return { ...plain, text: "Okoshi: stopped", detail: "the language server is not running", severity: "warning" };
    case "missing":
      return { ...plain, text: "Okoshi: not found", detail: `the program was not found: ${state.path}`, severity: "warning" };
    case "failed":
      return { ...plain, text: "Okoshi: failed", detail: state.why, severity: "error" };
    case "running": {
      const detail = `okoshi ${state.version}`;
      if (!facts || facts.parts + facts.errors + facts.warnings === 0) return { ...plain, text: "Okoshi", detail };
      const said = [];
      if (facts.errors > 0) said.push(count(facts.errors, "error"));
      if (facts.warnings > 0) said.push(count(facts.warnings, "warning"));
      if (said.length === 0) said.push(count(facts.parts, "part"));
      else said.push(`in ${count(facts.parts, "part")}`);
      const severity = facts.errors > 0 ? "error" : facts.warnings > 0 ? "warning" : "information";
      return { ...plain, text: `Okoshi: ${said.join(", ").replace(", in ", " in ")}`, detail, severity };
    }
  }
}
