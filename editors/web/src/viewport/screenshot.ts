// Screenshots of the model.

import type { Viewer } from "./viewer";

/** The viewport as a PNG: on the given background, or only the model on a transparent one. */
export function screenshot(viewer: Viewer, background: string | null): Promise<Blob> {
  const { renderLoop, canvas } = viewer;
  const take = (): Promise<Blob> => {
    renderLoop.draw();
    // In the same task: the browser may clear the canvas after it.
    return new Promise((resolve, reject) => canvas.toBlob((blob) => (blob ? resolve(blob) : reject(new Error("the browser could not create the picture"))), "image/png"));
  };
  if (background === null) return viewer.bare(take);
  return renderLoop.withBackground(background, take);
}
