// The table of what was counted, what of it is beyond the limits, and the page with all pictures.
import { EXCEPTIONS } from './exceptions.mjs'

/** What is counted: its name in the table, its limits, and the kind of figure that it is about, if not about all. */
const COUNTS = {
  front: { title: 'front', least: 0.99, most: 1 },
  wide: { title: 'depth/width', least: 0.2, most: 0.6 },
  high: { title: 'depth/height', least: 0.2, most: 0.5, kind: 'animal' },
  back: { title: 'hair behind', least: 0.8, most: 1 },
  off: { title: 'comes off', least: 0, most: 0.03 },
}

const percent = (value) => `${(100 * value).toFixed(1)} %`
const isIn = (value, [least, most]) => value >= least && value <= most

/** What is wrong with one count of a figure, or an exception that it does not need. */
function complaint(figure, count) {
  const { title, least, most, kind } = COUNTS[count]
  const value = figure[count]
  if (value === undefined || (kind && kind !== figure.kind)) return []
  const own = EXCEPTIONS[figure.name]?.[count]
  if (isIn(value, [least, most])) {
    return own ? [`${figure.name}: ${title} ${value.toFixed(3)} is within the limits; take its exception out`] : []
  }
  if (own && isIn(value, own)) return []
  const limits = own ? `${own.join(' to ')}, its exception` : `${least} to ${most}`
  return [`${figure.name}: ${title} ${value.toFixed(3)} is not within ${limits}`]
}

/** What is wrong with where a figure is found to look, or an exception that it does not need. */
function lookingWrong({ name, faces, found }) {
  const own = EXCEPTIONS[name]?.found
  if (found === (own ?? faces)) return []
  const way = found === faces ? 'as it should; take its exception out' : `not ${own ?? faces}`
  return [`${name}: it looks ${found}, ${way}`]
}

function complaints(figure) {
  return [...Object.keys(COUNTS).flatMap((count) => complaint(figure, count)), ...lookingWrong(figure)]
}

/** How many figures of a half are within the limits, without exceptions. */
function summary(figures, half) {
  if (figures.length === 0) return []
  const parts = Object.entries(COUNTS).map(([count, { title, least, most, kind }]) => {
    const values = figures.filter((figure) => !kind || figure.kind === kind).map((figure) => figure[count]).filter((value) => value !== undefined)
    const right = values.filter((value) => isIn(value, [least, most])).length
    return `${title} ${right} of ${values.length}`
  })
  const looking = figures.filter(({ faces, found }) => faces === found).length
  return [`${half}, right: ${parts.join(', ')}, looking ${looking} of ${figures.length}`]
}

/** The lines of the table, and what is wrong. */
export function rows(figures) {
  const row = (cells) => cells.map((cell, at) => (at === 0 ? cell.padEnd(32) : cell.padStart(14))).join('')
  const table = [row(['', 'half', ...Object.values(COUNTS).map(({ title }) => title), 'looks'])]
  for (const figure of figures) {
    const { name, isHeldBack, front, wide, high, back, off, found } = figure
    const excepted = (count) => (EXCEPTIONS[name]?.[count] ? '*' : '')
    table.push(row([
      name,
      isHeldBack ? 'held back' : 'seen',
      percent(front),
      wide.toFixed(2) + excepted('wide'),
      high.toFixed(2) + excepted('high'),
      back === undefined ? '' : percent(back) + excepted('back'),
      off === undefined ? '' : percent(off) + excepted('off'),
      found + excepted('found'),
    ]))
  }
  table.push('* an exception; see sides/exceptions.mjs')
  table.push(...summary(figures.filter(({ isHeldBack }) => !isHeldBack), 'Seen'))
  table.push(...summary(figures.filter(({ isHeldBack }) => isHeldBack), 'Held back'))
  return { table, wrong: figures.flatMap(complaints) }
}

/** A page with the pictures of each figure. */
export function page(figures, yaws) {
  const pictures = ({ name }) => yaws.map((yaw) => `<img src="${name}-${yaw}.png" alt="${yaw}°">`).join('')
  const walk = ({ name, off }) => (off === undefined ? '' : `<br><img src="${name}-walk.png" alt="walking">`)
  const body = figures.map((figure) => `<h2>${figure.name}</h2>\n<img src="${figure.name}.svg" width="200" alt="drawing">${pictures(figure)}${walk(figure)}`)
  return `<!DOCTYPE html><meta charset="utf-8"><title>All sides</title><style>body { background: #c8d0d8 }</style>\n${body.join('\n')}\n`
}
