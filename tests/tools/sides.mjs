// Looks at figures by others from all sides: OKOSHI=PROGRAM node sides.mjs FOLDER [KEY…]
//
// Thirty emoji of two makers from npm packages, with names alone (sides/names.json): people, animals in profile, vehicles, monsters. Their
// models are drawn from five sides into the folder, whose index.html shows all pictures for people to look at. Counted are the pixels that
// are right from the front, how deep the models are, and how much of a head is hair or hat from behind. Every second drawing is held back.
// Exit status 1 if a count is beyond its limit. With keys, such as princess, it is about these alone.
import { execFileSync } from 'node:child_process'
import fs from 'node:fs'
import { createRequire } from 'node:module'
import path from 'node:path'

import { drawing } from './iconify.mjs'
import { binary, extent, painted, read } from './sides/glb.mjs'
import { covered, inBlackAndWhite } from './sides/heads.mjs'
import { named, paints } from './sides/names.mjs'
import { page, rows } from './sides/report.mjs'

const [folder, ...keys] = process.argv.slice(2)
const okoshi = process.env.OKOSHI
if (!folder || !okoshi) {
  console.error('usage: OKOSHI=PROGRAM node sides.mjs FOLDER [KEY…]')
  process.exit(2)
}
fs.mkdirSync(folder, { recursive: true })

/** The directions of the pictures to look at: degrees to the model's left. */
const YAWS = [0, 45, 90, 135, 180]
const SIZE = '320x320'
const load = createRequire(import.meta.url)
const { PNG } = load('pngjs')

/** What okoshi prints. `check` also ends with status 1 if it found something. */
function run(...command) {
  try {
    return execFileSync(okoshi, command, { encoding: 'utf8', stdio: ['ignore', 'pipe', 'pipe'] })
  } catch (error) {
    if (command[0] === 'check' && error.status === 1) return error.stdout
    throw new Error(`okoshi ${command.join(' ')}: ${error.stderr ?? error}`)
  }
}

/** Draws a model in parallel. */
function render(model, view, picture, ...more) {
  run('render', '-q', model, '--view', view, '--projection', 'orthographic', '--size', SIZE, ...more, '-o', picture)
}

/** The share of a head that is hair or a hat, from straight behind. */
function backOfHead(figure, text, model, file) {
  fs.writeFileSync(`${file}-head.glb`, binary(painted(model, inBlackAndWhite(figure))))
  const [colours, heads] = ['', '-head'].map((end) => {
    const picture = `${file}${end || '-back'}.png`
    render(`${file}${end}.glb`, '180,0', picture, '--shading', 'unlit')
    return PNG.sync.read(fs.readFileSync(picture))
  })
  fs.rmSync(`${file}-head.glb`)
  return covered(colours, heads, paints(text, figure.covers))
}

/** The drawing as a figure that walks. */
function walking(text) {
  const [left, top, width, height] = text.match(/viewBox="([^"]*)"/)[1].split(/\s+/).map(Number)
  const at = `x="${left + 0.98 * width}" y="${top + 0.99 * height}" font-size="${0.01 * height}"`
  return text.replace(/<\/svg>\s*$/, `<text ${at}>%Motion walk</text></svg>`)
}

/** How far parts come off what they hang on in a walk, as a share of the height; undefined for what has no legs. */
function comesOff(text, file) {
  fs.writeFileSync(`${file}-walk.svg`, walking(text))
  const { diagnostics } = JSON.parse(run('check', '--format', 'json', `${file}-walk.svg`)).drawings[0]
  if (diagnostics.some(({ code }) => code === 'W330')) return undefined
  run('build', '-q', `${file}-walk.svg`, '-o', `${file}-walk.glb`)
  run('render', '-q', `${file}-walk.glb`, '--strip', '6', '--view', '35,8', '--size', '200x200', '-o', `${file}-walk.png`)
  const loose = diagnostics.filter(({ code }) => code === 'W331')
  return Math.max(0, ...loose.map(({ message }) => Number(message.match(/([\d.]+) %/)[1]) / 100))
}

/** Builds and draws a figure, and counts. */
function measured(figure) {
  const { set, key, kind, head } = figure
  const name = `${set.split('-')[0]}-${key}`
  const file = path.join(folder, name)
  const text = named(drawing(load(`@iconify-json/${set}/icons.json`), key), figure.names)
  fs.writeFileSync(`${file}.svg`, text)
  run('build', '-q', `${file}.svg`, '-o', `${file}.glb`)
  const check = JSON.parse(run('check', '--look', '--format', 'json', `${file}.svg`))
  const { figures } = JSON.parse(run('inspect', '-q', '--json', `${file}.svg`))
  const model = read(fs.readFileSync(`${file}.glb`))
  for (const yaw of YAWS) render(`${file}.glb`, `${yaw},8`, `${file}-${yaw}.png`)
  const [width, height, depth] = extent(model)
  return {
    ...figure,
    name,
    front: check.drawings[0].look.right,
    wide: depth / width,
    high: depth / height,
    // A drawing without limbs is no figure: nothing of it is mirrored.
    found: figures[0]?.facing ?? 'front',
    back: head && backOfHead(figure, text, model, file),
    off: kind === 'vehicle' ? undefined : comesOff(text, file),
  }
}

const all = JSON.parse(fs.readFileSync(path.join(import.meta.dirname, 'sides/names.json'), 'utf8'))
const figures = all.map((figure, index) => ({ ...figure, isHeldBack: index % 2 === 1 }))
const chosen = figures.filter(({ key }) => keys.length === 0 || keys.includes(key)).map(measured)
fs.writeFileSync(path.join(folder, 'index.html'), page(chosen, YAWS))
const { table, wrong } = rows(chosen)
console.log(table.join('\n'))
for (const line of wrong) console.error(line)
process.exitCode = wrong.length === 0 ? 0 : 1
