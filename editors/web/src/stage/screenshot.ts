// Pictures of the model.

import { Color } from "three";
import type { Viewer } from "./viewer";

/** What is on the stage as a PNG: the model by itself on nothing, or as one sees it on the given colour. */
export function screenshot(viewer: Viewer, background: string | null): Promise<Blob> {
  const { stage, canvas } = viewer;
  const take = (): Promise<Blob> => {
    stage.draw();
    // In the same turn: the browser may clear the canvas after it.
    return new Promise((resolve, reject) => canvas.toBlob((blob) => (blob ? resolve(blob) : reject(new Error("the browser made no picture"))), "image/png"));
  };
  if (background === null) return viewer.bare(take);
  stage.renderer.setClearColor(new Color(background), 1);
  try {
    return take();
  } finally {
    stage.renderer.setClearColor(0x000000, 0);
    stage.invalidate();
  }
}
