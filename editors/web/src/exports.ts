// What leaves the page as a file.

import { screenshot } from "./viewport/screenshot";
import type { Host } from "./host/host";
import type { State } from "./state";
import type { Viewer } from "./viewport/viewer";

export class Exports {
  private readonly listeners: (() => void)[] = [];
  /** What is being made, or why it could not be; empty if there is nothing to say. */
  words = "";
  private isFilming = false;

  constructor(private readonly viewer: Viewer, private readonly state: State, private readonly host: Host) {
    // What was said about one drawing says nothing about the next.
    state.on(["current"], () => this.say(""));
  }

  onWords(listener: () => void): void {
    this.listeners.push(listener);
  }

  /** Whether there are moving pictures here. */
  get films(): boolean {
    return this.host.film !== null;
  }

  async model(): Promise<void> {
    const bytes = await this.viewer.requests.file();
    if (bytes) await this.host.save(`${this.fileName()}.glb`, new Blob([bytes], { type: "model/gltf-binary" }));
  }

  async screenshot(transparent: boolean): Promise<void> {
    if (!this.viewer.model) return;
    const background = transparent ? null : getComputedStyle(document.body).backgroundColor;
    await this.host.save(`${this.fileName()}.png`, await screenshot(this.viewer, background));
  }

  /** A moving picture of the clip that is shown, or of the model that turns around once, from where the view looks. */
  async film(): Promise<void> {
    const model = this.state.drawing?.build?.model;
    if (!this.host.film || !model || this.isFilming) return;
    const { clip, clips } = this.viewer.playback.player;
    const name = clip ? `${this.fileName()}-${clip.name}` : this.fileName();
    this.isFilming = true;
    this.say(clip ? `Making a moving picture of ${clip.name}…` : "Making a moving picture…");
    try {
      const film = await this.host.film(model, clip ? clips.indexOf(clip) : null, this.viewer.view.angles());
      this.say("");
      await this.host.save(`${name.replace(/[\\/:*?"<>|]/g, "-")}.gif`, film);
    } catch (error) {
      this.say(`There is no moving picture: ${error instanceof Error ? error.message : String(error)}`);
    } finally {
      this.isFilming = false;
    }
  }

  private say(words: string): void {
    this.words = words;
    for (const listener of this.listeners) listener();
  }

  /** The drawing's name without folder and extension. */
  private fileName(): string {
    return (this.state.drawing?.name ?? "").replace(/^.*[\\/]/, "").replace(/\.svgz?$/i, "") || "model";
  }
}
