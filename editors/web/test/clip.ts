// A clip for the browser's fake camera: two coloured discs whose places are known, before a cluttered background.

import { closeSync, openSync, writeSync } from "node:fs";

export const WIDTH = 320;
export const HEIGHT = 240;
const FPS = 30;
/** The clip is repeated after so many seconds; so are the paths. */
export const PERIOD = 8;
const RADIUS = 11;

type Colour = readonly [number, number, number];
type Place = readonly [number, number];

export interface Disc {
  readonly name: string;
  readonly colour: Colour;
  /** Where its middle is after so many seconds, in pixels; the middle of the first pixel is (0, 0). */
  readonly path: (seconds: number) => Place;
}

const turn = (seconds: number, turns: number, phase = 0): number => 2 * Math.PI * ((turns * seconds) / PERIOD + phase);

/** Discs that come round after each period, at up to 35 pixels per second: a busy machine films few pictures, between which they must not jump too far. */
export const DISCS: readonly Disc[] = [
  { name: "red", colour: [205, 45, 40], path: (time) => [90 + 28 * Math.cos(turn(time, 1)), 115 + 30 * Math.sin(turn(time, 1)) + 4 * Math.sin(turn(time, 3))] },
  { name: "blue", colour: [45, 75, 210], path: (time) => [235 + 22 * Math.sin(turn(time, 1, 0.2)), 125 + 18 * Math.sin(turn(time, 2))] },
];

/** Numbers from 0 to 1 that are the same in each run. */
function random(seed: number): () => number {
  let state = seed >>> 0;
  return () => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return state / 2 ** 32;
  };
}

/** So many pixels around the middle of the picture have no patches. */
const BARE = 20;

/** A grey wall with patches of pale colours, but none in the middle. */
function background(): Float32Array {
  const pixels = new Float32Array(3 * WIDTH * HEIGHT);
  for (let y = 0; y < HEIGHT; y++) for (let x = 0; x < WIDTH; x++) pixels.fill(120 + (60 * x) / WIDTH - (30 * y) / HEIGHT, 3 * (y * WIDTH + x), 3 * (y * WIDTH + x) + 3);
  const next = random(7);
  for (let patch = 0; patch < 40; patch++) {
    const [left, top, width, height] = [WIDTH * next(), HEIGHT * next(), 10 + 30 * next(), 10 + 30 * next()].map(Math.floor) as [number, number, number, number];
    const colour = [90 + 90 * next(), 90 + 90 * next(), 90 + 90 * next()];
    const isNear = (middle: number, from: number, size: number): boolean => from - BARE < middle && middle < from + size + BARE;
    if (isNear(WIDTH / 2, left, width) && isNear(HEIGHT / 2, top, height)) continue;
    for (let y = top; y < Math.min(top + height, HEIGHT); y++) for (let x = left; x < Math.min(left + width, WIDTH); x++) pixels.set(colour, 3 * (y * WIDTH + x));
  }
  return pixels;
}

/** Writes the clip as Y4M, 4:2:0. */
export function writeClip(file: string): void {
  const out = openSync(file, "w");
  writeSync(out, `YUV4MPEG2 W${WIDTH} H${HEIGHT} F${FPS}:1 Ip A1:1 C420jpeg\n`);
  const still = background();
  const noise = random(11);
  for (let frame = 0; frame < PERIOD * FPS; frame++) {
    const pixels = still.slice();
    for (const { colour, path } of DISCS) draw(pixels, path(frame / FPS), colour);
    for (let at = 0; at < pixels.length; at++) pixels[at] = pixels[at]! + 10 * (noise() + noise() - 1);
    writeSync(out, "FRAME\n");
    writeSync(out, planes(pixels));
  }
  closeSync(out);
}

function draw(pixels: Float32Array, [middleX, middleY]: Place, colour: Colour): void {
  for (let y = Math.max(Math.floor(middleY - RADIUS - 1), 0); y <= Math.min(middleY + RADIUS + 1, HEIGHT - 1); y++) {
    for (let x = Math.max(Math.floor(middleX - RADIUS - 1), 0); x <= Math.min(middleX + RADIUS + 1, WIDTH - 1); x++) {
      const cover = Math.min(Math.max(RADIUS + 0.5 - Math.hypot(x - middleX, y - middleY), 0), 1);
      for (let channel = 0; channel < 3; channel++) {
        const at = 3 * (y * WIDTH + x) + channel;
        pixels[at] = pixels[at]! + cover * (colour[channel]! - pixels[at]!);
      }
    }
  }
}

/** The planes of Y, U and V; U and V at half the size (BT.601, video range). */
function planes(rgb: Float32Array): Uint8Array {
  const luma = WIDTH * HEIGHT;
  const half = WIDTH / 2;
  const planes = new Uint8ClampedArray((luma * 3) / 2);
  for (let pixel = 0; pixel < luma; pixel++) planes[pixel] = 16 + 0.257 * rgb[3 * pixel]! + 0.504 * rgb[3 * pixel + 1]! + 0.098 * rgb[3 * pixel + 2]!;
  for (let y = 0; y < HEIGHT / 2; y++) {
    for (let x = 0; x < half; x++) {
      const mean = [0, 1, 2].map((channel) => [0, 1, WIDTH, WIDTH + 1].reduce((sum, off) => sum + rgb[3 * (2 * y * WIDTH + 2 * x + off) + channel]!, 0) / 4) as [number, number, number];
      planes[luma + y * half + x] = 128 - 0.148 * mean[0] - 0.291 * mean[1] + 0.439 * mean[2];
      planes[luma + (luma / 4) + y * half + x] = 128 + 0.439 * mean[0] - 0.368 * mean[1] - 0.071 * mean[2];
    }
  }
  return new Uint8Array(planes.buffer);
}
