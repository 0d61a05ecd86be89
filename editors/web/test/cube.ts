// A cube of terrain, made by hand instead of compiled from a drawing.

import type { Made } from "./drawings";
import { glb } from "./glb";

export const TOP = [0, 200, 0] as const;
export const FRONT = [160, 80, 0] as const;
export const SIDE = [0, 0, 200] as const;

interface Face {
  readonly colour: readonly number[];
  readonly corners: readonly (readonly [number, number, number])[];
}

/** The faces towards the right, the top and the front, one metre long from the origin. */
const FACES: readonly Face[] = [
  { colour: TOP, corners: [[0, 1, 1], [1, 1, 1], [1, 1, 0], [0, 1, 0]] },
  { colour: FRONT, corners: [[0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]] },
  { colour: SIDE, corners: [[1, 0, 1], [1, 0, 0], [1, 1, 0], [1, 1, 1]] },
];

const linear = (byte: number): number => (byte <= 10 ? byte / 255 / 12.92 : ((byte / 255 + 0.055) / 1.055) ** 2.4);

/** A GLB with the cube on a node named `Island` that bends with the view, or does not; its materials are unlit. */
export function cube(bends: boolean): Buffer {
  const faces = FACES.length;
  const positions = Float32Array.from(FACES.flatMap(({ corners }) => corners.flat()));
  const indices = Uint16Array.of(0, 1, 2, 0, 2, 3);
  const bytes = Buffer.concat([Buffer.from(positions.buffer), Buffer.from(indices.buffer)]);
  return glb(
    {
      asset: { version: "2.0" },
      extensionsUsed: ["KHR_materials_unlit", ...(bends ? ["OKOSHI_view_dependent"] : [])],
      scene: 0,
      scenes: [{ nodes: [1] }],
      nodes: [
        { name: "Island", mesh: 0, translation: [3, 0, -2], extras: { okoshi: { element: "island" } }, ...(bends ? { extensions: { OKOSHI_view_dependent: { bend: {} } } } : {}) },
        { name: "Root", children: [0] },
      ],
      meshes: [{ primitives: FACES.map((_, at) => ({ attributes: { POSITION: at }, indices: faces, material: at })) }],
      materials: FACES.map(({ colour }) => ({ pbrMetallicRoughness: { baseColorFactor: [...colour.map(linear), 1], metallicFactor: 0 }, extensions: { KHR_materials_unlit: {} } })),
      accessors: [
        ...FACES.map(({ corners }, at) => ({
          bufferView: 0,
          byteOffset: at * 48,
          componentType: 5126,
          count: 4,
          type: "VEC3",
          min: [0, 1, 2].map((axis) => Math.min(...corners.map((corner) => corner[axis]!))),
          max: [0, 1, 2].map((axis) => Math.max(...corners.map((corner) => corner[axis]!))),
        })),
        { bufferView: 1, componentType: 5123, count: 6, type: "SCALAR" },
      ],
      bufferViews: [
        { buffer: 0, byteOffset: 0, byteLength: positions.byteLength },
        { buffer: 0, byteOffset: positions.byteLength, byteLength: indices.byteLength },
      ],
    },
    bytes,
  );
}

/** The build of a drawing with the cube. */
export function island(bends = true): Made {
  const part = { name: "Island", parent: null, kind: "main", element: "island", string: null, attributes: {}, joint: null };
  return { model: cube(bends), picture: null, build: { milliseconds: 1, stale: false, triangles: 6, findings: [], parts: [part] } };
}
