// The viewport's colours: of the system's light or dark mode, or of the editor's theme.

export interface Colors {
  readonly accent: string;
  readonly grid: string;
  readonly ink: string;
}

/** Applies the colours now and whenever they change; what it returns ends that. */
export function followTheme(apply: (colors: Colors) => void): () => void {
  const read = (): void => {
    // The computed colour of an element is numeric, however the style sheet or the editor wrote it.
    const probe = document.createElement("span");
    document.body.append(probe);
    const color = (name: string): string => {
      probe.style.color = `var(${name})`;
      return getComputedStyle(probe).color;
    };
    apply({ accent: color("--accent"), grid: color("--grid"), ink: color("--ink") });
    probe.remove();
  };
  const dark = matchMedia("(prefers-color-scheme: dark)");
  dark.addEventListener("change", read);
  // VS Code changes class and style of body and html with its theme. The probe is a child, so it does not trigger this.
  const observer = new MutationObserver(read);
  for (const element of [document.documentElement, document.body]) observer.observe(element, { attributes: true, attributeFilter: ["class", "style"] });
  read();
  return () => {
    dark.removeEventListener("change", read);
    observer.disconnect();
  };
}
