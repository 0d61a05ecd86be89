// The extension of nodes that follow the viewer (docs/view-dependent.md).

import type { Object3D } from "three";

const EXTENSION = "OKOSHI_view_dependent";

/** How a node follows the viewer in one of the ways, if it does: the loader keeps unknown extensions. */
export function wayOf(object: Object3D, way: string): object | null {
  const extensions: unknown = object.userData["gltfExtensions"];
  if (typeof extensions !== "object" || extensions === null || !(EXTENSION in extensions)) return null;
  const ways: unknown = (extensions as Record<string, unknown>)[EXTENSION];
  if (typeof ways !== "object" || ways === null) return null;
  const found = (ways as Record<string, unknown>)[way];
  return typeof found === "object" && found !== null ? found : null;
}
