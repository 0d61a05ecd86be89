// The pictures of a recording, kept in the page to be shown again.

/** The most pictures that are kept: 30 seconds. As JPEG they take about 15 MB. */
const MAX_PICTURES = 1000;
const QUALITY = 0.8;

export class Pictures {
  private readonly times: number[] = [];
  private readonly blobs: Promise<Blob | null>[] = [];
  private shown = 0;

  clear(): void {
    this.times.length = this.blobs.length = 0;
  }

  /** Keeps the picture of a canvas, taken at a time in milliseconds. */
  add(canvas: HTMLCanvasElement, time: number): void {
    if (this.times.length === MAX_PICTURES) return;
    this.times.push(time);
    this.blobs.push(new Promise((resolve) => canvas.toBlob(resolve, "image/jpeg", QUALITY)));
  }

  /** Draws the picture at so many seconds after the first. */
  async show(seconds: number, canvas: HTMLCanvasElement): Promise<void> {
    const ticket = ++this.shown;
    const blob = await this.blobs[nearest(this.times, (this.times[0] ?? 0) + 1000 * seconds)];
    if (!blob) return;
    const picture = await createImageBitmap(blob);
    // A later picture may have been decoded earlier.
    if (ticket === this.shown) canvas.getContext("2d")?.drawImage(picture, 0, 0, canvas.width, canvas.height);
    picture.close();
  }
}

/** The index of the number that is nearest to another; the numbers ascend. */
export function nearest(numbers: readonly number[], wanted: number): number {
  let low = 0;
  let high = numbers.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (numbers[middle]! < wanted) low = middle + 1;
    else high = middle;
  }
  const before = numbers[low - 1];
  const behind = numbers[low];
  if (before === undefined) return 0;
  return behind === undefined || wanted - before <= behind - wanted ? low - 1 : low;
}
