// Counts the changes that okoshi refuses on figures by others: OKOSHI=PROGRAM node refused.mjs [EVERY]
//
// People, animals and robots among the emoji of npm packages, every EVERYth of them (default: 24), get names from `okoshi annotate`, as a
// person does who presses *Name the parts for me*. Then each is given the motion that fits it, and of every fourth of these, every part is
// moved forward, coloured and renamed. What is refused is listed with the reason. The exit status is 1 if a share is beyond its limit.
import { execFileSync } from 'node:child_process'
import fs from 'node:fs'
import { createRequire } from 'node:module'
import os from 'node:os'
import path from 'node:path'

import { drawing } from './iconify.mjs'

const okoshi = process.env.OKOSHI
const every = Number(process.argv[2] ?? 24)
if (!okoshi || !(every >= 1)) {
  console.error('usage: OKOSHI=PROGRAM node refused.mjs [EVERY]')
  process.exit(2)
}

/** The most that may be refused, %: a little above what was reached. */
const MOST = { motion: 0, attribute: 4, name: 14 }
/** So many figures at least are judged, or the packages are not what they were. */
const LEAST_FIGURES = 400 / every
/** Of so many figures every part is changed once. */
const PARTS_OF = 4
const WHO = new RegExp(
  '^(man|woman|person|boy|girl|child|baby|mage|elf|fairy|genie|vampire|zombie|mer|prince|super|ninja|guard|farmer|cook|mechanic|artist|pilot|' +
    'astronaut|firefighter|police|detective|construction|student|teacher|judge|dancer|dog|cat|horse|cow|pig|sheep|goat|camel|elephant|rabbit|' +
    'robot|snowman|teddy|troll|mx-claus|santa|bear|monkey|gorilla|orangutan|llama|giraffe|zebra|deer|ox|ram|rooster|duck|penguin|t-rex|' +
    'sauropod|kangaroo)',
)
/** Figures that are not whole, and those that differ from others by the colour of the skin alone. */
const NOT = /face|head|heart|light|medium|dark/

const load = createRequire(import.meta.url)
const packages = path.join(path.dirname(load.resolve('pngjs/package.json')), '..', '@iconify-json')
const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'refused-'))
const [bare, named, changed] = ['bare', 'named', 'changed'].map((name) => path.join(folder, `${name}.svg`))
const counts = Object.fromEntries(Object.keys(MOST).map((kind) => [kind, { made: 0, refused: 0 }]))
let figures = 0

/** What okoshi prints; also if it refuses something, or leaves a drawing as it is in which it recognizes nothing. */
function run(...command) {
  try {
    return execFileSync(okoshi, command, { encoding: 'utf8', stdio: ['ignore', 'pipe', 'pipe'], maxBuffer: 1 << 28 })
  } catch (error) {
    if (error.stdout || /stays as it is/.test(error.stderr)) return error.stdout
    throw new Error(`okoshi ${command.join(' ')}: ${error.stderr ?? error}`)
  }
}

/** Makes one change in a copy of the drawing that was given names. */
function change(kind, figure, what) {
  fs.rmSync(changed, { force: true })
  const { refused } = JSON.parse(run('edit', '-q', '--json', named, '-c', JSON.stringify(what), '-o', changed))
  if (!refused && !fs.existsSync(changed)) throw new Error(`${figure}: nothing was written of ${JSON.stringify(what)}`)
  counts[kind][refused ? 'refused' : 'made']++
  if (refused) console.log(`${figure}: ${JSON.stringify(what)} is refused: ${refused.why}`)
}

/** How many parts hang on a part, directly or not. */
const below = (parts, name) => parts.filter(({ parent }) => parent === name).reduce((count, part) => count + 1 + below(parts, part.name), 0)

function judge(figure, text) {
  fs.writeFileSync(bare, text)
  fs.rmSync(named, { force: true })
  run('annotate', '-q', bare, '-o', named)
  if (!fs.existsSync(named)) return
  const parts = JSON.parse(run('inspect', '-q', '--json', named)).parts.filter(({ kind }) => kind === 'main')
  const [carrier] = parts.filter(({ parent }) => parent === null).sort((a, b) => below(parts, b.name) - below(parts, a.name))
  if (!carrier || below(parts, carrier.name) === 0) return
  change('motion', figure, { change: 'clip', part: carrier.name, clip: 0, motion: '', limited: null, held: null })
  if (figures++ % PARTS_OF > 0) return
  for (const { name } of parts) {
    change('attribute', figure, { change: 'set', part: name, attribute: 'Offset', value: '1' })
    change('attribute', figure, { change: 'set', part: name, attribute: 'Color', value: 'red' })
    change('name', figure, { change: 'name', part: name, name: 'Zorro' })
  }
}

const sets = fs.readdirSync(packages).sort()
const icons = sets.map((set) => [set, JSON.parse(fs.readFileSync(path.join(packages, set, 'icons.json'), 'utf8'))])
const keys = icons.flatMap(([set, all]) => Object.keys(all.icons).map((key) => ({ set, all, key })))
const wanted = keys.filter(({ key }) => WHO.test(key) && !NOT.test(key))
try {
  for (const { set, all, key } of wanted.filter((_, index) => index % every === 0)) judge(`${set}/${key}`, drawing(all, key))
} finally {
  fs.rmSync(folder, { recursive: true })
}
console.log(`${figures} figures of ${wanted.length}, every ${every}th`)
for (const [kind, { made, refused }] of Object.entries(counts)) {
  const share = (100 * refused) / (made + refused)
  console.log(`${kind}: ${refused} of ${made + refused} refused, ${share.toFixed(1)} %; at most ${MOST[kind]} % may be`)
  if (!(share <= MOST[kind])) process.exitCode = 1
}
if (figures < LEAST_FIGURES) {
  console.error(`at least ${Math.ceil(LEAST_FIGURES)} figures were to be judged`)
  process.exitCode = 1
}
