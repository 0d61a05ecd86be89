// Whether a panel was open when the page was last shown: the browser stores it.

// Storage may be forbidden.
export function wasOpen(key: string): boolean {
  try {
    return localStorage.getItem(key) === "open";
  } catch {
    return false;
  }
}

export function rememberOpen(key: string, open: boolean): void {
  try {
    localStorage.setItem(key, open ? "open" : "closed");
  } catch {
    // Then the panel is closed the next time.
  }
}
