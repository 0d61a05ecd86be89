// A picture of a drawing by resvg: node resvg.mjs MODULES DRAWING SIDE PICTURE.png
//
// A program of its own, because resvg ends it at some drawings. MODULES is a file beside whose node_modules resvg is, SIDE the larger side
// of the picture in pixels. Prints the size of the page in user units, and the size of the picture.
import fs from 'node:fs'
import { createRequire } from 'node:module'

import { read } from './packages.mjs'

const [modules, drawing, side, picture] = process.argv.slice(2)
const { Resvg } = createRequire(modules)('@resvg/resvg-js')

/** The drawing with a page that is shown as large as it is: the size on the screen makes no difference to models. */
function unscaled(text) {
  return text.replace(/<svg\b[^>]*>/, (tag) => (/\sviewBox\s*=/.test(tag) ? tag.replace(/\s(width|height)\s*=\s*("[^"]*"|'[^']*')/g, '') : tag))
}

/** The size of the page: resvg says it in whole units, which is too coarse for small pages. */
function size(text, { width, height }) {
  const [, box] = text.match(/<svg\b[^>]*?\sviewBox\s*=\s*["']([^"']*)["']/) ?? []
  const [, , wide, high] = (box ?? '').trim().split(/[\s,]+/).map(Number)
  return wide > 0 && high > 0 ? [wide, high] : [width, height]
}

const text = unscaled(read(drawing).toString('utf8'))
const font = { loadSystemFonts: false }
const page = size(text, new Resvg(text, { font }))
const [width, height] = page
const drawn = new Resvg(text, { font, fitTo: { mode: width > height ? 'width' : 'height', value: Number(side) } }).render()
fs.writeFileSync(picture, drawn.asPng())
console.log(JSON.stringify({ page, size: [drawn.width, drawn.height] }))
