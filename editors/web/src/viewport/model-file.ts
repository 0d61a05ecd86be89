// Reads models from binary glTF, or what changed between two of them.

import { Mesh, TextureLoader, type AnimationClip, type Group, type Object3D } from "three";
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";
import { isDelta, readDelta, type Delta } from "./delta";

export interface ModelFile {
  readonly scene: Group;
  readonly animations: readonly AnimationClip[];
  /** The nodes by their numbers in the file. */
  readonly nodes: readonly (Object3D | undefined)[];
}

/** Reads a model. Throws an error with a readable message if it is invalid. */
export async function readFile(bytes: ArrayBuffer): Promise<ModelFile> {
  const loader = new GLTFLoader();
  loader.register((parser) => {
    // Textures are read as <img> elements: the other loader fetches blobs, which the page's content security policy forbids.
    parser.textureLoader = new TextureLoader(parser.options.manager);
    return { name: "okoshi-images" };
  });
  const { scene, animations, parser } = await loader.parseAsync(bytes, "");
  const nodes: (Object3D | undefined)[] = [];
  for (const [object, { nodes: number }] of parser.associations) if (number !== undefined) nodes[number] = object as Object3D;
  return { scene, animations, nodes };
}

/** Reads what the server answered to a question for changes: those, or the whole model. */
export const readChanges = async (bytes: ArrayBuffer): Promise<ModelFile | Delta> => (isDelta(bytes) ? readDelta(bytes) : readFile(bytes));

/** The meshes of a node of a file, without those of nodes below it: the loader makes it a mesh, or a group of them. */
export const meshesAt = (node: Object3D, count = Infinity): readonly Mesh[] =>
  node instanceof Mesh ? [node] : node.children.slice(0, count).filter((child) => child instanceof Mesh);
