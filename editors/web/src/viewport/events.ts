// What the viewer tells its listeners.

/**
 * model: another is shown, or none · display: shading, projection or mode changed · time: the clip moved · pose: a limb moved ·
 * sideBySide: the copy beside the model changed · layers: they are shown from the side, or no longer
 */
export type ViewerTopic = "model" | "display" | "time" | "pose" | "sideBySide" | "layers";

export class ViewerEvents {
  private readonly listeners = new Map<ViewerTopic, (() => void)[]>();

  on(topics: readonly ViewerTopic[], listener: () => void): void {
    for (const topic of topics) this.listeners.set(topic, [...(this.listeners.get(topic) ?? []), listener]);
  }

  notify(...topics: ViewerTopic[]): void {
    for (const topic of topics) for (const listener of this.listeners.get(topic) ?? []) listener();
  }
}
