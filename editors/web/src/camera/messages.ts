// Messages between the page and the program that tracks marks. Places are pixels of the picture that was sent: the middle of the top left
// pixel is (0, 0), y down, never mirrored.

/** Where a mark was seen. */
export interface Sighting {
  readonly x: number;
  readonly y: number;
  readonly radius: number;
}

export interface Mark {
  readonly name: string;
  /** As #rrggbb. */
  readonly color: string;
}

export type FromTracker =
  | { readonly type: "seen"; readonly sequence: number; readonly marks: readonly (Sighting | null)[]; readonly recorded: number }
  | { readonly type: "marks"; readonly marks: readonly Mark[] }
  /** The file, as it is saved. */
  | { readonly type: "track"; readonly file: string }
  | { readonly type: "error"; readonly message: string; readonly isFrame: boolean };

export type ToTracker =
  | { readonly type: "pick"; readonly x: number; readonly y: number }
  | { readonly type: "name"; readonly mark: number; readonly name: string }
  | { readonly type: "remove"; readonly mark: number }
  | { readonly type: "record" }
  | { readonly type: "stop" };

/** The bytes before the pixels of a frame. */
const HEADER = 16;

/** A picture as RGBA, as canvases give it. */
export interface Pixels {
  readonly width: number;
  readonly height: number;
  readonly data: ArrayLike<number>;
}

/** A frame as the program reads it: a header (sequence number, width, height, time in milliseconds; little endian), and RGB. */
export function frameMessage(sequence: number, { width, height, data }: Pixels, time: number): ArrayBuffer {
  const message = new ArrayBuffer(HEADER + 3 * width * height);
  const header = new DataView(message);
  header.setUint32(0, sequence, true);
  header.setUint16(4, width, true);
  header.setUint16(6, height, true);
  header.setFloat64(8, time, true);
  const pixels = new Uint8Array(message, HEADER);
  for (let from = 0, to = 0; to < pixels.length; from += 4, to += 3) {
    pixels[to] = data[from]!;
    pixels[to + 1] = data[from + 1]!;
    pixels[to + 2] = data[from + 2]!;
  }
  return message;
}

const object = (value: unknown): Readonly<Record<string, unknown>> => (typeof value === "object" && value !== null ? (value as Record<string, unknown>) : {});
const list = (value: unknown): readonly unknown[] => (Array.isArray(value) ? value : []);
const text = (value: unknown): string => (typeof value === "string" ? value : "");
const number = (value: unknown): number => (typeof value === "number" && Number.isFinite(value) ? value : 0);

/** Parses a message; null if it is none. */
export function readMessage(data: unknown): FromTracker | null {
  const raw = object(parse(data));
  switch (raw["type"]) {
    case "seen":
      return { type: "seen", sequence: number(raw["sequence"]), marks: list(raw["marks"]).map(readSighting), recorded: number(raw["recorded"]) };
    case "marks":
      return { type: "marks", marks: list(raw["marks"]).map(readMark) };
    case "track":
      return { type: "track", file: text(raw["file"]) };
    case "error":
      return { type: "error", message: text(raw["message"]), isFrame: raw["isFrame"] === true };
    default:
      return null;
  }
}

function parse(data: unknown): unknown {
  try {
    return typeof data === "string" ? JSON.parse(data) : null;
  } catch {
    return null;
  }
}

function readSighting(value: unknown): Sighting | null {
  if (!Array.isArray(value) || value.length !== 3) return null;
  return { x: number(value[0]), y: number(value[1]), radius: number(value[2]) };
}

function readMark(value: unknown): Mark {
  const { name, colour: color } = object(value);
  return { name: text(name), color: /^#[0-9a-f]{6}$/.test(text(color)) ? text(color) : "#808080" };
}

/** A recorded track, as the program writes it. */
export interface Track {
  /** Width and height of the pictures in pixels. */
  readonly size: readonly [number, number];
  /** The time of each frame in seconds. */
  readonly times: readonly number[];
  readonly marks: readonly TrackedMark[];
}

export interface TrackedMark extends Mark {
  readonly points: readonly (readonly [number, number])[];
  readonly isLost: readonly boolean[];
  /** The lost frames in which the mark may be in several places. */
  readonly isAmbiguous: readonly boolean[];
}

/** Parses the file of a track. */
export function readTrack(file: string): Track {
  const raw = object(parse(file));
  const times = list(raw["times"]).map(number);
  const pair = (value: unknown): [number, number] => [number(list(value)[0]), number(list(value)[1])];
  return {
    size: pair(raw["size"]),
    times,
    marks: list(raw["marks"]).map((value) => {
      const mark = object(value);
      const frames = (ranges: unknown): boolean[] => {
        const isIn = times.map(() => false);
        for (const [first, last] of list(ranges).map(pair)) isIn.fill(true, first, last + 1);
        return isIn;
      };
      const isAmbiguous = frames(mark["ambiguous"]);
      const isLost = frames(mark["lost"]).map((is, frame) => is || isAmbiguous[frame] === true);
      return { ...readMark(value), points: list(mark["points"]).map(pair), isLost, isAmbiguous };
    }),
  };
}
