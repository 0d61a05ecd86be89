// A figure of boxes that steps to the side and kicks, made by hand: limited, and in full.

import type { Made } from "./drawings";
import { glb } from "./glb";

export const FRAMES = 60;
export const FPS = 24;
/** The key of the last drawing is earlier: it is held until then. */
export const SECONDS = FRAMES / FPS;
export const LEG = [220, 0, 0] as const;
/** The omitted in-betweens around the fastest movement. */
export const OMITTED = [27, 28, 29, 30];
/** How far the figure steps to the side, in metres. */
const STEP_ASIDE = 0.6;
const LEG_LENGTH = 0.8;
const HIP = [0, 0.8, 0] as const;

type Vector = readonly [number, number, number];
interface Box {
  readonly name: string;
  readonly colour: Vector;
  readonly from: Vector;
  readonly to: Vector;
  /** Its position on its parent. */
  readonly at: Vector;
  readonly children: readonly number[];
}

const BOXES: readonly Box[] = [
  { name: "Body", colour: [40, 90, 160], from: [-0.18, 0, -0.12], to: [0.18, 0.6, 0.12], at: HIP, children: [1, 2, 3] },
  { name: "Leg", colour: LEG, from: [-0.08, -LEG_LENGTH, -0.08], to: [0.08, 0, 0.08], at: [0.1, 0, 0], children: [] },
  { name: "Stand", colour: [30, 60, 110], from: [-0.08, -LEG_LENGTH, -0.08], to: [0.08, 0, 0.08], at: [-0.1, 0, 0], children: [] },
  { name: "Head", colour: [230, 180, 90], from: [-0.13, 0, -0.13], to: [0.13, 0.3, 0.13], at: [0, 0.64, 0], children: [] },
];

/** The angle of the leg in a source frame, in radians: slowly back, quickly up, slowly down. */
export function raised(frame: number): number {
  const between = (from: number, to: number): number => {
    const t = Math.min(Math.max((frame - from) / (to - from), 0), 1);
    return t * t * (3 - 2 * t);
  };
  return -0.5 * between(0, 22) + 2.1 * between(23, 34) - 1.6 * between(36, 59);
}
export const aside = (frame: number): number => (STEP_ASIDE * frame) / (FRAMES - 1);

/** For the two joints that move, hip and foot. */
export const SSD = Array.from({ length: FRAMES }, (_, frame) => {
  if (frame === 0) return 0;
  const foot = (at: number): Vector => [aside(at) + LEG_LENGTH * Math.sin(raised(at)), -LEG_LENGTH * Math.cos(raised(at)), 0];
  const [a, b] = [foot(frame - 1), foot(frame)];
  return (a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2 + (aside(frame) - aside(frame - 1)) ** 2;
});

/** Slow frames are held up to three times; four of them longer, in place of the omitted ones. */
export const EXPOSURE: readonly (readonly [number, number])[] = (() => {
  const runs: [number, number][] = [];
  const slow = (frame: number): boolean => SSD[frame]! < 0.004;
  for (let frame = 0; frame < FRAMES; frame++) {
    const last = runs.at(-1);
    if (OMITTED.includes(frame)) continue;
    if (last && slow(frame) && last[1] < 3 && frame - last[0] < 3) last[1]++;
    else runs.push([frame, 1]);
  }
  let missing = FRAMES - runs.reduce((sum, [, frames]) => sum + frames, 0);
  for (const run of runs) if (missing > 0 && run[1] === 1 && ++run[1]) missing--;
  return runs;
})();

/** Numbers for the buffer. */
class Numbers {
  readonly views: object[] = [];
  readonly accessors: object[] = [];
  private readonly pieces: Buffer[] = [];
  private length = 0;

  add(array: Float32Array | Uint16Array, type: "SCALAR" | "VEC3" | "VEC4", bounds: object = {}): number {
    const bytes = Buffer.from(array.buffer, array.byteOffset, array.byteLength);
    const padded = Buffer.concat([bytes, Buffer.alloc((4 - (bytes.length % 4)) % 4)]);
    this.views.push({ buffer: 0, byteOffset: this.length, byteLength: bytes.length });
    this.pieces.push(padded);
    this.length += padded.length;
    const size = { SCALAR: 1, VEC3: 3, VEC4: 4 }[type];
    return this.accessors.push({ bufferView: this.views.length - 1, componentType: array instanceof Uint16Array ? 5123 : 5126, count: array.length / size, type, ...bounds }) - 1;
  }

  get bytes(): Buffer {
    return Buffer.concat(this.pieces);
  }
}

function box(numbers: Numbers, { from, to }: Box): object {
  const faces: [number, number][] = [[0, 0], [0, 1], [1, 0], [1, 1], [2, 0], [2, 1]];
  const positions: number[] = [];
  const normals: number[] = [];
  const indices: number[] = [];
  for (const [axis, side] of faces) {
    const [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
    const start = positions.length / 3;
    for (const [a, b] of [[0, 0], [1, 0], [1, 1], [0, 1]]) {
      const corner = [0, 0, 0];
      corner[axis] = side ? to[axis]! : from[axis]!;
      corner[u] = a ? to[u]! : from[u]!;
      corner[v] = b ? to[v]! : from[v]!;
      positions.push(...corner);
      const normal = [0, 0, 0];
      normal[axis] = side ? 1 : -1;
      normals.push(...normal);
    }
    indices.push(...(side ? [0, 1, 2, 0, 2, 3] : [0, 2, 1, 0, 3, 2]).map((one) => start + one));
  }
  const POSITION = numbers.add(Float32Array.from(positions), "VEC3", { min: [...from], max: [...to] });
  const NORMAL = numbers.add(Float32Array.from(normals), "VEC3");
  return { attributes: { POSITION, NORMAL }, indices: numbers.add(Uint16Array.from(indices), "SCALAR") };
}

/** A clip that shows these source frames at these of its own. */
function clip(numbers: Numbers, name: string, keys: readonly (readonly [at: number, source: number])[], held: boolean): object {
  const times = Float32Array.from(keys, ([at]) => at / FPS);
  const input = numbers.add(times, "SCALAR", { min: [times[0]], max: [times.at(-1)] });
  const turns = numbers.add(Float32Array.from(keys.flatMap(([, source]) => [0, 0, Math.sin(raised(source) / 2), Math.cos(raised(source) / 2)])), "VEC4");
  const places = numbers.add(Float32Array.from(keys.flatMap(([, source]) => [HIP[0] + aside(source), HIP[1], HIP[2]])), "VEC3");
  const interpolation = held ? "STEP" : "LINEAR";
  return {
    name,
    samplers: [{ input, output: turns, interpolation }, { input, output: places, interpolation }],
    channels: [{ sampler: 0, target: { node: 1, path: "rotation" } }, { sampler: 1, target: { node: 0, path: "translation" } }],
  };
}

const linear = (byte: number): number => (byte / 255) ** 2.2;
const full = Array.from({ length: FRAMES }, (_, frame) => [frame, frame] as const);
const drawings = EXPOSURE.map(([source], at) => [EXPOSURE.slice(0, at).reduce((sum, [, frames]) => sum + frames, 0), source] as const);
/** The closing key repeats the last drawing at the end of the clip. */
const limited = [...drawings, [FRAMES, drawings.at(-1)![1]] as const];

/** Meshes have the names of their nodes, so that three.js renames one of the two; the file of the originals has no meshes. */
function file(withMeshes: boolean, clips: (numbers: Numbers) => object[], change: (colour: Vector) => Vector = (colour) => colour): Buffer {
  const numbers = new Numbers();
  const meshes = withMeshes ? BOXES.map((one, material) => ({ name: one.name, primitives: [{ ...box(numbers, one), material }] })) : undefined;
  const animations = clips(numbers);
  const nodes = BOXES.map(({ name, at, children }, mesh) => ({ name, translation: [...at], extras: { okoshi: { element: name.toLowerCase() } }, ...(children.length > 0 ? { children } : {}), ...(meshes ? { mesh } : {}) }));
  return glb(
    {
      asset: { version: "2.0" },
      scene: 0,
      scenes: [{ nodes: [BOXES.length] }],
      nodes: [...nodes, { name: "Root", children: [0] }],
      ...(meshes ? { meshes, materials: BOXES.map(({ colour }) => ({ pbrMetallicRoughness: { baseColorFactor: [...change(colour).map(linear), 1], metallicFactor: 0, roughnessFactor: 1 } })) } : {}),
      animations,
      accessors: numbers.accessors,
      bufferViews: numbers.views,
    },
    numbers.bytes,
  );
}

export const FACTS = {
  name: "kick",
  figure: "Body",
  file: "kick.bvh",
  seconds: SECONDS,
  fps: FPS,
  frames: FRAMES,
  drawings: EXPOSURE.length,
  limited: true,
  exposure: EXPOSURE,
  omitted: OMITTED,
  // The page shows only how many there are.
  held: Array.from({ length: FRAMES - EXPOSURE.length - OMITTED.length }, (_, at) => at),
  ssd: SSD,
  ssd_step: 1,
  joints: { Body: "Hips", Leg: "RightUpLeg" },
  joint_reasons: { Body: "the word body", Leg: "drawn left, so right; lowest point near the ground" },
  unmatched: ["Head", "Stand"],
};
/** The same clip in full. */
export const FULL = { ...FACTS, name: "slowly", file: "slowly.bvh", drawings: FRAMES, limited: false, exposure: full.map(([, source]) => [source, 1] as const), omitted: [], held: [] };

const part = (name: string, parent: string | null) => ({ name, parent, kind: "main", element: name.toLowerCase(), string: null, attributes: {}, joint: null });

/** The build of the figure, with a limited clip and one that is not. */
export function kick(facts: readonly object[] = [FACTS, FULL], change?: (colour: Vector) => Vector): Made {
  const clips = (numbers: Numbers) => [clip(numbers, "kick", limited, true), clip(numbers, "slowly", full, false)];
  return {
    model: file(true, clips, change),
    originals: file(false, (numbers) => [clip(numbers, "kick", full, false), clip(numbers, "slowly", full, false)]),
    picture: null,
    build: { milliseconds: 1, stale: false, triangles: 48, findings: [], parts: [part("Body", null), ...["Leg", "Stand", "Head"].map((name) => part(name, "Body"))], clips: facts },
  };
}
