// The drawing that the page's address names, and the browser's history.

import type { State } from "./state";

export function followAddress(state: State): void {
  const choose = (): void => {
    if (!state.known) return;
    const { list } = state;
    const only = list.length === 1 ? list[0] : undefined;
    const named = state.find(hash());
    state.show((named ?? only)?.id ?? null);
  };
  addEventListener("hashchange", choose);
  state.on("drawings", () => {
    if (!state.drawing) return choose();
    // The current drawing stays; when others appear, the address names it.
    if (state.list.length > 1 && !state.find(hash())) history.replaceState(null, "", `#${encodeURIComponent(state.drawing.id)}`);
  });
}

/** Shows all drawings. */
export function openGallery(): void {
  location.hash = "";
}

function hash(): string {
  const raw = location.hash.slice(1);
  try {
    return decodeURIComponent(raw);
  } catch {
    // A stray percent sign.
    return raw;
  }
}
