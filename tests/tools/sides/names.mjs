// Gives the shapes of a drawing names, as somebody does who opens it in a drawing program.

const SHAPE = /^(path|circle|ellipse|rect|polygon|polyline|line|use)$/
/** What is in these is not drawn where it stands. */
const HIDDEN = /^(defs|clipPath|mask|pattern|filter|linearGradient|radialGradient)$/
const INKSCAPE = 'xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape"'

/** Where the drawn shapes are in the text, in their order: those of these sets are empty elements. */
export function shapes(text) {
  const found = []
  let hidden = 0
  for (const { 0: tag, 1: close, 2: name, 3: empty, index } of text.matchAll(/<(\/?)([A-Za-z]+)\b[^>]*?(\/?)>/g)) {
    if (HIDDEN.test(name) && !empty) hidden += close ? -1 : 1
    else if (SHAPE.test(name) && !hidden && !close) found.push({ start: index, end: index + tag.length })
  }
  return found
}

/**
 * The drawing with labels: `names` has for each label the number of its shape, or of the first and the last shape of a group of
 * neighbours.
 */
export function named(text, names) {
  const all = shapes(text)
  const edits = [[text.indexOf(' '), ` ${INKSCAPE}`]]
  for (const [label, which] of Object.entries(names)) {
    const attribute = ` inkscape:label="${label}"`
    if (Array.isArray(which)) {
      const [first, last] = which
      edits.push([all[first].start, `<g${attribute}>`], [all[last].end, '</g>'])
    } else {
      const { start } = all[which]
      edits.push([start + text.slice(start).search(/\s/), attribute])
    }
  }
  edits.sort(([one], [other]) => other - one)
  return edits.reduce((result, [at, added]) => result.slice(0, at) + added + result.slice(at), text)
}

/** The numbers [red, green, blue] of a colour as these sets write it. */
function rgb(colour) {
  const digits = colour.slice(1)
  const pairs = digits.length === 3 ? [...digits].map((digit) => digit + digit) : digits.match(/../g)
  return pairs.slice(0, 3).map((pair) => parseInt(pair, 16))
}

/** The colours of a shape: its fill and stroke, and those of its gradient's stops. Without a fill it is black. */
function colours(text, { start, end }) {
  const tag = text.slice(start, end)
  const values = [...tag.matchAll(/\s(fill|stroke)="([^"]*)"/g)].map(([, name, value]) => [name, value])
  if (!values.some(([name]) => name === 'fill')) values.push(['fill', '#000'])
  return values.flatMap(([, value]) => {
    const gradient = value.match(/^url\(#(.*)\)$/)
    if (!gradient) return value.startsWith('#') ? [rgb(value)] : []
    const stops = text.slice(text.indexOf(`id="${gradient[1]}"`)).split('</')[0]
    return [...stops.matchAll(/stop-color="(#[^"]*)"/g)].map(([, stop]) => rgb(stop))
  })
}

/** The colours of hair and hats, by the numbers of their shapes, and those of all other shapes. */
export function paints(text, covers) {
  const found = { covers: [], others: [] }
  shapes(text).forEach((shape, index) => {
    found[covers.includes(index) ? 'covers' : 'others'].push(...colours(text, shape))
  })
  return found
}
