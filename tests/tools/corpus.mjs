// Builds all drawings of some forty packages, and measures that: OKOSHI=PROGRAM SCRATCH=FOLDER node corpus.mjs [PACKAGE…]
//
// The packages are fetched by name into the folder SCRATCH, and not installed: Debian packages with apt-get, npm packages with npm.
// Every drawing is built, measured by GNU time, and every model validated; then silhouettes of 400 models are compared with resvg's
// pictures of the drawings. Of half of them the worst are listed, to be looked at; the other half is held back, and only counted.
// With MOST=N, only N drawings are built, an even sample. A run that was interrupted continues where it was.
//
// SCRATCH/corpus.json gets the results of each drawing, and docs/reliability.md the summary of a run over all packages. Exit status 1 if
// a build crashes, fails, takes more than two seconds or gives an invalid model, or if much of a silhouette is missing without a finding.
import { createHash } from 'node:crypto'
import fs from 'node:fs'
import path from 'node:path'

import { corpus, tools } from './corpus/packages.mjs'
import { each } from './corpus/pool.mjs'
import { outcome, summary, updated } from './corpus/summary.mjs'

const { OKOSHI: okoshi, SCRATCH: scratch, MOST: most } = process.env
const only = process.argv.slice(2)
if (!okoshi || !scratch) {
  console.error('usage: OKOSHI=PROGRAM SCRATCH=FOLDER node corpus.mjs [PACKAGE…]')
  process.exit(2)
}

/** How many builds run at a time. */
const THREADS = 2
/** How many silhouettes are compared whose worst are listed, and how many that are held back. */
const SILHOUETTES = 200
/** Seconds that a build may take. */
const MAX_SECONDS = 2
/** Silhouettes that overlap less must have a finding that says what is missing. */
const MIN_OVERLAP = 0.9

/** So many of the records, by turns from each package, in the order of their hashes, so that nobody chose them. */
function sample(records, count) {
  const packages = new Map()
  for (const record of records) {
    if (!packages.has(record.package)) packages.set(record.package, [])
    packages.get(record.package).push(record)
  }
  const queues = [...packages.values()]
  const taken = []
  for (let turn = 0; taken.length < count && queues.some((queue) => turn < queue.length); turn++) {
    taken.push(...queues.filter((queue) => turn < queue.length).map((queue) => queue[turn]))
  }
  return taken.slice(0, count)
}

fs.mkdirSync(scratch, { recursive: true })
const settings = { okoshi: path.resolve(okoshi), scratch: path.resolve(scratch) }
const load = tools(settings.scratch)
const { sources, files } = corpus(settings.scratch, load, only)
// They are in the order of their hashes, so these are a fair sample.
if (most !== undefined) files.length = Math.min(files.length, Number(most))
console.error(`${files.length} drawings of ${sources.length} packages`)

// Results of another version of the program are not used.
const version = createHash('sha256').update(fs.readFileSync(okoshi)).digest('hex').slice(0, 12)
const kept = (job) => path.join(settings.scratch, `${job}-${version}.jsonl`)
const results = await each(files, 'build', { ...settings, threads: THREADS, kept: kept('build') })
const records = files.map((file, index) => ({ ...file, seconds: 0, memory: 0, codes: {}, ...results[index] }))
// What seems slow is measured again alone, as other programs may have delayed it.
const slow = records.filter(({ seconds }) => seconds > MAX_SECONDS / 2)
const again = await each(slow, 'build', { ...settings, threads: 1 })
slow.forEach((record, index) => (record.seconds = Math.min(record.seconds, again[index].seconds ?? Infinity)))

// There is nothing to compare in a drawing that only holds definitions for others.
const drawn = sample(records.filter((record) => outcome(record) === 'built' && record.triangles > 0), 2 * SILHOUETTES)
const overlaps = await each(drawn, 'silhouette', { ...settings, threads: THREADS, kept: kept('silhouette') })
const compared = drawn.map((record, index) => Object.assign(record, overlaps[index]))

/** What is wrong with the result of a drawing, if anything is. */
function fault(record) {
  const { seconds, issues, issue, overlap, codes, said, failure } = record
  // A thread that could not do its job at all gives no status.
  if (record.status === undefined) return failure
  if (!['built', 'refused'].includes(outcome(record))) return `${outcome(record)}: ${said}`
  if (issues > 0) return `invalid: ${issue}`
  if (seconds > MAX_SECONDS) return `took ${seconds} s`
  if (typeof overlap === 'number' && overlap < MIN_OVERLAP && Object.keys(codes).length === 0) return `overlap ${overlap}, and nothing is said`
  return undefined
}

const bad = records.map((record) => [record, fault(record)]).filter(([, fault]) => fault !== undefined)
for (const [{ package: of, name }, fault] of bad) console.error(`${of} ${name}: ${fault}`)
fs.writeFileSync(path.join(scratch, 'corpus.json'), JSON.stringify({ sources, records }, null, 1))
const text = summary({ sources, records, listed: compared.slice(0, SILHOUETTES), heldBack: compared.slice(SILHOUETTES) })
console.log(text)
if (only.length === 0) {
  const page = path.join(import.meta.dirname, '../../docs/reliability.md')
  fs.writeFileSync(page, updated(fs.readFileSync(page, 'utf8'), text))
}
process.exit(bad.length === 0 ? 0 : 1)
