// Puts drawings by others into a folder: node clip_art.mjs FOLDER [OPENCLIPART]
//
// 40 emoji of two makers from npm packages, and 20 figures of the Open Clip Art Library if its folder is given; evenly spread
// samples, so that nobody chose them.
import fs from 'node:fs'
import { createRequire } from 'node:module'
import path from 'node:path'

import { drawing } from './iconify.mjs'

const [folder, openclipart] = process.argv.slice(2)
if (!folder) {
  console.error('usage: node clip_art.mjs FOLDER [OPENCLIPART]')
  process.exit(2)
}
fs.mkdirSync(folder, { recursive: true })

/** Evenly spread elements of a list. */
function sample(list, count) {
  return Array.from({ length: Math.min(count, list.length) }, (_, i) => list[Math.floor((i * list.length) / count)])
}

const shapes = /<(path|circle|ellipse|rect|polygon|polyline|line|use)\b/g

/** Whether it is a figure of several shapes without letters and photographs. */
function isFigure(text) {
  const count = (text.match(shapes) ?? []).length
  return count >= 5 && count <= 200 && text.length < 40_000 && !/<(text|image|foreignObject)\b/.test(text)
}

const load = createRequire(import.meta.url)
for (const [name, count] of [['fluent-emoji-flat', 20], ['noto', 20]]) {
  const set = load(`@iconify-json/${name}/icons.json`)
  const figures = Object.keys(set.icons).sort().filter((key) => isFigure(set.icons[key].body))
  for (const key of sample(figures, count)) {
    fs.writeFileSync(path.join(folder, `${name}-${key}.svg`), drawing(set, key))
  }
}

if (openclipart) {
  const files = fs.readdirSync(openclipart, { recursive: true }).filter((file) => file.endsWith('.svg')).sort()
  const figures = files.filter((file) => {
    const full = path.join(openclipart, file)
    return fs.statSync(full).isFile() && isFigure(fs.readFileSync(full, 'utf8'))
  })
  for (const file of sample(figures, 20)) {
    fs.copyFileSync(path.join(openclipart, file), path.join(folder, `openclipart-${path.basename(file)}`))
  }
}
console.log(`${fs.readdirSync(folder).length} drawings are in ${folder}`)
