// Switches that the browser stores until the page is shown again.

// Storage may be forbidden.
export function isRemembered(key: string): boolean {
  try {
    return localStorage.getItem(key) === "on";
  } catch {
    return false;
  }
}

export function remember(key: string, on: boolean): void {
  try {
    localStorage.setItem(key, on ? "on" : "off");
  } catch {
    // Then it is off the next time.
  }
}
