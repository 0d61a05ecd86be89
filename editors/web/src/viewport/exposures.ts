// The exposure sheets of the model's clips, and which of them is displayed.

import type { Build } from "../protocol";
import type { Player } from "./clips";
import { ExposureSheet } from "./exposure-sheet";

export class Exposures {
  private sheets: readonly ExposureSheet[] = [];
  /** The figure whose drawings are counted, if a clip moves several. */
  private figure: string | null = null;

  constructor(private readonly player: Player) {}

  /** The clips of another build are shown. */
  take(clips: Build["clips"]): void {
    this.sheets = clips.map((facts) => new ExposureSheet(facts));
  }

  /** The model was removed. */
  clear(): void {
    this.sheets = [];
    this.figure = null;
  }

  choose(figure: string): void {
    this.figure = figure;
  }

  /** The sheets of a clip, one for each figure that it moves. */
  of(clip: { readonly name: string } | null): readonly ExposureSheet[] {
    return clip ? this.sheets.filter(({ facts }) => facts.name === clip.name) : [];
  }

  /** The sheet to display: that of the chosen figure, otherwise of one whose clip is limited. */
  get current(): ExposureSheet | null {
    const all = this.of(this.player.clip);
    return this.chosen(all) ?? all.find(({ facts }) => facts.limited) ?? all[0] ?? null;
  }

  /** The sheet of the performed clip to display: that of the chosen figure, otherwise of one that is performed; null if none is. */
  get performed(): ExposureSheet | null {
    const all = this.of(this.player.clip).filter(({ facts }) => facts.performance !== null);
    return this.chosen(all) ?? all[0] ?? null;
  }

  private chosen(sheets: readonly ExposureSheet[]): ExposureSheet | undefined {
    return sheets.find(({ facts }) => facts.figure === this.figure);
  }
}
