// Scores the names that `okoshi annotate` finds: OKOSHI=PROGRAM node annotate.mjs fit|held|all|more|unseen [FOLDER]
//
// The figures are the thirty emoji of sides/names.json and the sixteen drawings of ../motion/figures, to whose shapes people gave names.
// Their names are taken away, and those found are compared: of heads, trunks, limbs, tails and wheels the kind must be right, and what
// carries a shape must be what carries it with the names of people, or, where that is wrong as well, what sides/carriers.json says: all
// parents were read for it, those that were found and those that were not. The halves are decided by a hash of the figures' names; rules
// were made on the first alone. `more` scores sixteen further emoji, those of sides/more.json, whose names say after `@` what carries a shape
// where that is not what the names alone tell, and `unseen` eight of that file on which no rule was made either. With a folder, the
// annotated drawings are written there. The exit status of `all` is 1 if fewer are right than once were.
import { execFileSync } from 'node:child_process'
import crypto from 'node:crypto'
import fs from 'node:fs'
import { createRequire } from 'node:module'
import os from 'node:os'
import path from 'node:path'

import { drawing } from './iconify.mjs'
import { shapes } from './sides/names.mjs'

const [half, given] = process.argv.slice(2)
const okoshi = process.env.OKOSHI
if (!okoshi || !['fit', 'held', 'all', 'more', 'unseen'].includes(half)) {
  console.error('usage: OKOSHI=PROGRAM node annotate.mjs fit|held|all|more|unseen [FOLDER]')
  process.exit(2)
}
const folder = given ?? fs.mkdtempSync(path.join(os.tmpdir(), 'annotate-'))
fs.mkdirSync(folder, { recursive: true })
const here = import.meta.dirname
const CARRIERS = JSON.parse(fs.readFileSync(path.join(here, 'sides', 'carriers.json'), 'utf8'))
const load = createRequire(process.env.OKOSHI_PACKAGES ?? import.meta.url)

/** The least shares of names and of parents in `all`, %: a little below what was reached. */
const LEAST = [86, 90]

/** What a name means, as far as it is scored; the first that fits. */
const CLASSES = [
  ['detail', /hair|pigtail|\bear|eye|mouth|nose|hat\b|cap\b|crown|collar|button|belt|mirror|seat|fork|light|hub|horn|beak|mane/i],
  ['wheel', /wheel|tyre/i],
  ['hand', /hand(?!le)|arm\b.*\bend\b/i],
  ['arm', /arm|sleeve|wing|flipper/i],
  ['foot', /foot|feet|shoe|boot|hoo[fv]|toe|leg\b.*\bend\b/i],
  ['leg', /leg|thigh|shin|trouser/i],
  ['tail', /tail/i],
  ['head', /head|face/i],
  ['trunk', /body|hips|shirt|jacket|coat|dress\b|dungarees|chest|abdomen|thorax/i],
]
const classOf = (name) => CLASSES.find(([, words]) => words.test(name))?.[0] ?? 'detail'
const SCORED = new Set(['wheel', 'hand', 'arm', 'foot', 'leg', 'tail', 'head', 'trunk'])
/** Trousers are legs to one person and hips to another, and sleeves are arms; the abdomen of an insect is a trunk. */
const same = (truth, found) => classOf(truth) === found || (/trouser|\|/i.test(truth) && ['leg', 'trunk'].includes(found))

const firstByte = (key) => crypto.createHash('sha256').update(key).digest()[0]
const isHeld = (key) => firstByte(key) % 2 === 1
/** A third of the further emoji. */
const isUnseen = (key) => firstByte(key) < 100

/** The drawing with an id for each shape that has none. */
function numbered(text) {
  let out = ''
  let at = 0
  shapes(text).forEach(({ start, end }, index) => {
    const tag = text.slice(start, end)
    out += text.slice(at, start) + (/\sid="/.test(tag) ? tag : tag.replace(/\s|\/?>/, (end) => ` id="s${index}"${end}`))
    at = end
  })
  return out + text.slice(at)
}

const idOf = (tag) => tag.match(/\sid="([^"]*)"/)[1]

/** Each group's first shape stands for it. */
function standIn(text, id) {
  const at = text.search(new RegExp(`<g\\b[^>]*\\sid="${id}"`))
  if (at < 0) return id
  const inside = shapes(text).find(({ start }) => start > at)
  return inside ? idOf(text.slice(inside.start, inside.end)) : id
}

/** Per shape what carries it where a person says otherwise than the names tell: in the figure's own list, or in carriers.json. */
function byHand(key, truth, own = {}) {
  const ids = Object.fromEntries(truth.map(([id, name]) => [name, id]))
  const said = Object.entries({ ...CARRIERS[key], ...own })
  for (const name of said.flat()) if (!ids[name]) throw new Error(`${key} has no ${name}`)
  return Object.fromEntries(said.map(([name, carrier]) => [ids[name], new Set([ids[carrier]])]))
}

function emoji(file) {
  const sets = {}
  return JSON.parse(fs.readFileSync(path.join(here, 'sides', file))).map(({ set, key, names }) => {
    sets[set] ??= load(`@iconify-json/${set}/icons.json`)
    const text = numbered(drawing(sets[set], key))
    const all = shapes(text).map(({ start, end }) => idOf(text.slice(start, end)))
    const written = Object.entries(names).map(([name, which]) => [all[Array.isArray(which) ? which[0] : which], ...name.split('@')])
    const truth = written.map(([id, name]) => [id, name])
    const said = Object.fromEntries(written.filter(([, , carrier]) => carrier).map(([, name, carrier]) => [name, carrier]))
    return { key: `${set}/${key}`, text, truth, by: byHand(`${set}/${key}`, truth, said) }
  })
}

function motion() {
  const figures = path.join(here, '../motion/figures')
  const files = fs.readdirSync(figures).filter((file) => file.endsWith('.svg')).sort()
  return files.map((file) => {
    const read = fs.readFileSync(path.join(figures, file), 'utf8')
    const text = numbered(read.replace(/<(text|desc)\b[\s\S]*?<\/\1>/g, '').replace(/\sinkscape:label="(?!Layer)[^"]*"/g, ''))
    const lines = fs.readFileSync(path.join(figures, file.replace('.svg', '.txt')), 'utf8').trim().split('\n')
    const named = lines.map((line) => line.split(': ')).filter(([, name]) => name !== '-')
    const truth = named.map(([id, name]) => [standIn(text, id), name])
    const key = `motion/${file.slice(0, -4)}`
    return { key, text, truth, by: byHand(key, truth) }
  })
}

function run(...command) {
  return execFileSync(okoshi, command, { encoding: 'utf8', stdio: ['ignore', 'pipe', 'pipe'] })
}

/** Per shape the shapes that carry it: that of the part it belongs to, or that of the part its own hangs on. */
function carriers(file) {
  const { parts } = JSON.parse(run('inspect', '-q', '--json', file))
  const element = Object.fromEntries(parts.filter(({ kind }) => kind === 'main').map((part) => [part.name, part.element]))
  const found = {}
  for (const part of parts) (found[part.element] ??= new Set()).add(part.parent === null ? 'Root' : element[part.parent])
  return found
}

/** The drawing with the names of people. */
function labelled(text, truth) {
  const marked = text.replace('<svg', '<svg xmlns:i="http://www.inkscape.org/namespaces/inkscape"')
  return truth.reduce((text, [id, name]) => text.replace(` id="${id}"`, ` id="${id}" i:label="${name.replace('|', ' ')}"`), marked)
}

const total = { named: 0, right: 0, carried: 0, carriers: 0, wrong: 0 }
const isFurther = half === 'more' || half === 'unseen'
const figures = isFurther ? emoji('more.json') : [...emoji('names.json'), ...motion()]
const isWanted = ({ key }) => half === 'all' || (isFurther ? (half === 'unseen') === isUnseen(key) : (half === 'held') === isHeld(key))
for (const figure of figures.filter(isWanted)) {
  const file = path.join(folder, figure.key.replace('/', '-'))
  fs.writeFileSync(`${file}-bare.svg`, figure.text)
  fs.writeFileSync(`${file}-truth.svg`, labelled(figure.text, figure.truth))
  fs.rmSync(`${file}.svg`, { force: true })
  let parts = []
  try {
    parts = JSON.parse(run('annotate', `${file}-bare.svg`, '-o', `${file}.svg`, '--json')).parts
  } catch {
    fs.copyFileSync(`${file}-bare.svg`, `${file}.svg`)
  }
  const found = Object.fromEntries(parts.map(({ element, name }) => [standIn(figure.text, element), name]))
  const scored = figure.truth.filter(([, name]) => SCORED.has(classOf(name)))
  const right = scored.filter(([id, name]) => found[id] && same(name, classOf(found[id])))
  const [by, own] = [{ ...carriers(`${file}-truth.svg`), ...figure.by }, carriers(`${file}.svg`)]
  const carried = figure.truth.filter(([id]) => by[id])
  const alike = carried.filter(([id]) => own[id] && [...by[id]].some((carrier) => own[id].has(carrier)))
  const known = Object.fromEntries(figure.truth)
  const wrong = Object.entries(found).filter(([id, name]) => SCORED.has(classOf(name)) && !(known[id] && same(known[id], classOf(name))))
  total.named += scored.length
  total.right += right.length
  total.carried += alike.length
  total.carriers += carried.length
  total.wrong += wrong.length
  console.log(`${figure.key}: names ${right.length}/${scored.length}, parents ${alike.length}/${carried.length}, wrong ${wrong.length}`)
  if (half === 'fit' || half === 'more' || process.env.SHOW) {
    for (const [id, name] of scored) if (!right.some(([other]) => other === id)) console.log(`    ${id} is ${name}, not ${found[id]}`)
    for (const [id, name] of wrong) console.log(`    ${id} is ${known[id]}, but called ${name}`)
    for (const [id, name] of carried) if (!alike.some(([other]) => other === id)) console.log(`    ${id} ${name} hangs on ${[...by[id]]}, not ${[...(own[id] ?? [])]}`)
  }
}
const share = (count, all) => ((100 * count) / all).toFixed(1)
const shares = [share(total.right, total.named), share(total.carried, total.carriers)]
console.log(`names of limbs, heads, trunks, wheels: ${total.right} of ${total.named}, ${shares[0]} %; ${total.wrong} that no person gave`)
console.log(`parents: ${total.carried} of ${total.carriers}, ${shares[1]} %`)
if (half === 'all' && shares.some((reached, index) => Number(reached) < LEAST[index])) {
  console.error(`at least ${LEAST.join(' % and ')} % were wanted`)
  process.exitCode = 1
}
