// Reads models, and what changed between two models, from binary glTF.

import { Mesh, TextureLoader, type AnimationClip, type Group, type Object3D } from "three";
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";

export interface ModelFile {
  readonly scene: Group;
  readonly animations: readonly AnimationClip[];
  /** The nodes by their numbers in the file. */
  readonly nodes: readonly (Object3D | undefined)[];
}

/** What changed between two models with the same hierarchy, by the numbers of nodes in the file. */
export interface Delta {
  /** The nodes whose own fields changed, with all of these. */
  readonly moved: readonly MovedNode[];
  /** The new meshes of nodes. */
  readonly meshes: ReadonlyMap<number, readonly Mesh[]>;
}

/** Fields of a node, as in the file. */
export interface MovedNode {
  readonly node: number;
  readonly matrix?: number[];
  readonly translation?: number[];
  readonly rotation?: number[];
  readonly scale?: number[];
  readonly extras?: Readonly<Record<string, unknown>>;
}

/** Reads a model. Throws an error with a readable message if it is invalid. */
export async function readFile(bytes: ArrayBuffer): Promise<ModelFile> {
  const { file } = await parse(bytes);
  return file;
}

/** Reads what the server answered to a question for changes: those, or the whole model. */
export async function readChanges(bytes: ArrayBuffer): Promise<ModelFile | Delta> {
  const { file, extras } = await parse(bytes);
  const okoshi = extras["okoshi"] as { readonly nodes: readonly MovedNode[] } | undefined;
  if (!okoshi) return file;
  const changed = file.nodes.flatMap((node) => (node ? [[node.userData["node"] as number, meshesAt(node)] as const] : []));
  return { moved: okoshi.nodes, meshes: new Map(changed) };
}

/** The meshes of a node of a file, without those of nodes below it: the loader makes it a mesh, or a group of them. */
export const meshesAt = (node: Object3D, count = Infinity): readonly Mesh[] =>
  node instanceof Mesh ? [node] : node.children.slice(0, count).filter((child) => child instanceof Mesh);

async function parse(bytes: ArrayBuffer): Promise<{ readonly file: ModelFile; readonly extras: Record<string, unknown> }> {
  const loader = new GLTFLoader();
  loader.register((parser) => {
    // Textures are read as <img> elements: the other loader fetches blobs, which the page's content security policy forbids.
    parser.textureLoader = new TextureLoader(parser.options.manager);
    return { name: "okoshi-images" };
  });
  const { scene, animations, parser, userData } = await loader.parseAsync(bytes, "");
  const nodes: (Object3D | undefined)[] = [];
  for (const [object, { nodes: number }] of parser.associations) if (number !== undefined) nodes[number] = object as Object3D;
  return { file: { scene, animations, nodes }, extras: userData };
}
