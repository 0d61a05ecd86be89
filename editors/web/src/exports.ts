// What leaves the page as a file.

import { playerWith } from "./player/page";
import { screenshot } from "./viewport/screenshot";
import type { Host } from "./host/host";
import type { State } from "./state";
import type { Viewer } from "./viewport/viewer";

export class Exports {
  private readonly listeners: (() => void)[] = [];
  /** What is being made, or why it could not be; empty if there is nothing to say. */
  words = "";
  private isMaking = false;

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

  /** The address of other files of the drawing, without their endings; null if there are none here. */
  get files(): string | null {
    return this.host.file && (this.state.drawing?.build?.exports ?? null);
  }

  /** Whether drawings are shared by links, and models as pages, here. */
  get links(): boolean {
    return this.host.share !== null;
  }

  get pages(): boolean {
    return this.host.player !== null;
  }

  /** Shows a link to the drawing. */
  share(): void {
    if (this.state.current !== null) this.host.share?.(this.state.current);
  }

  /** A page that plays the model by itself, beginning with the clip and the view that are shown. */
  async page(): Promise<void> {
    if (!this.host.player) return;
    try {
      const [page, bytes] = await Promise.all([this.host.player(), this.viewer.requests.file()]);
      if (!bytes) return;
      const { clip } = this.viewer.playback.player;
      const shown = { name: this.fileName(), clip: clip?.name ?? null, view: this.viewer.view.angles() };
      await this.host.save(`${this.fileName()}.html`, playerWith(page, new Uint8Array(bytes), shown));
      this.say("");
    } catch (error) {
      this.say(`There is no page: ${error instanceof Error ? error.message : String(error)}`);
    }
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
    const { film } = this.host;
    if (!film || !model) return;
    const { clip, clips } = this.viewer.playback.player;
    const name = clip ? `${this.fileName()}-${clip.name}` : this.fileName();
    const shot = clip ? clips.indexOf(clip) : null;
    await this.make("moving picture", clip ? `a moving picture of ${clip.name}` : "a moving picture", `${name.replace(/[\\/:*?"<>|]/g, "-")}.gif`, () => film(model, shot, this.viewer.view.angles()));
  }

  /** The model as OBJ, with shapes only. */
  async obj(): Promise<void> {
    await this.export("OBJ file", "an OBJ file", ".obj", ".obj");
  }

  /** The figure as paper pieces to cut out. */
  async puppet(): Promise<void> {
    await this.export("puppet sheet", "a puppet sheet", ".svg", "-puppet.svg");
  }

  private async export(what: string, one: string, ending: string, saved: string): Promise<void> {
    const { file } = this.host;
    const address = this.files;
    if (file && address !== null) await this.make(what, one, this.fileName() + saved, () => file(address + ending));
  }

  /** Makes something that takes a while, one at a time, and says what is being made, or why it could not be. */
  private async make(what: string, one: string, name: string, make: () => Promise<Blob>): Promise<void> {
    if (this.isMaking) return;
    this.isMaking = true;
    this.say(`Making ${one}…`);
    try {
      const made = await make();
      this.say("");
      await this.host.save(name, made);
    } catch (error) {
      this.say(`There is no ${what}: ${error instanceof Error ? error.message : String(error)}`);
    } finally {
      this.isMaking = false;
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
