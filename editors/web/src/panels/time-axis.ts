// The axis of time that slider, keys and charts of a clip share: a frame has the same x coordinate in all of them.

/** Half the width of the slider's thumb in pixels: its middle is at the ends of the axis when the slider is at its ends. */
const THUMB = 8;

export class TimeAxis {
  /** How long the axis is, in seconds. */
  seconds = 0;

  /** `timeline` has the slider in its whole width. */
  constructor(private readonly timeline: HTMLElement) {}

  /** The x coordinates of the axis within a picture, in pixels. */
  within(picture: Element): { readonly left: number; readonly right: number } {
    const { left, width } = this.timeline.getBoundingClientRect();
    const from = left + THUMB - picture.getBoundingClientRect().left;
    return { left: from, right: from + Math.max(width - 2 * THUMB, 1) };
  }
}
