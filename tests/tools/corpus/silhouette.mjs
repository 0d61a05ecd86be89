// Compares the silhouette of a model, seen from the front, with that of its drawing.
import { spawnSync } from 'node:child_process'
import fs from 'node:fs'
import path from 'node:path'

/** The larger side of the pictures, pixels. */
const SIDE = 400
/** Milliseconds after which a program that draws a picture is stopped. */
const TIMEOUT = 60_000

/**
 * The intersection of two silhouettes over their union, from 0 to 1. A pixel counts as far as it is opaque, so borders and
 * transparent areas need no threshold. `null` if both pictures are empty.
 */
export function overlap(a, b) {
  const [width, height] = [Math.max(a.width, b.width), Math.max(a.height, b.height)]
  const alpha = ({ width, height, data }, x, y) => (x < width && y < height ? data[4 * (y * width + x) + 3] : 0)
  let both = 0
  let either = 0
  for (let y = 0; y < height; y++) {
    for (let x = 0; x < width; x++) {
      const [one, other] = [alpha(a, x, y), alpha(b, x, y)]
      both += Math.min(one, other)
      either += Math.max(one, other)
    }
  }
  return either === 0 ? null : both / either
}

/** How far the silhouettes overlap, `{ overlap }`, or why they cannot be compared, `{ failure }`. */
export function silhouette({ file }, { okoshi, own, modules, PNG }) {
  const [drawn, shown] = ['drawn.png', 'shown.png'].map((name) => path.join(own, name))
  for (const picture of [drawn, shown]) fs.rmSync(picture, { force: true })
  const run = (program, ...command) => spawnSync(program, command, { encoding: 'utf8', timeout: TIMEOUT })
  const by = path.join(import.meta.dirname, 'resvg.mjs')
  const resvg = run(process.execPath, by, modules, file, String(SIDE), drawn)
  if (resvg.status !== 0) return { failure: `resvg does not draw it: ${resvg.stderr.trim().split('\n').slice(0, 2).join(' ')}` }
  const { page, size } = JSON.parse(resvg.stdout)
  const larger = page[0] > page[1] ? 0 : 1
  const { status, stderr } = run(okoshi, 'render', '-q', file, '--as-drawn', '--scale', String(size[larger] / page[larger]), '-o', shown)
  if (status !== 0) return { failure: stderr.trim() }
  const [a, b] = [drawn, shown].map((picture) => PNG.sync.read(fs.readFileSync(picture)))
  if (Math.abs(a.width - b.width) > 1 || Math.abs(a.height - b.height) > 1) {
    return { failure: `the page is ${b.width} × ${b.height}, for resvg ${a.width} × ${a.height}` }
  }
  return { overlap: overlap(a, b) }
}
