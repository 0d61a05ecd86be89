// Builds one drawing of the corpus, and measures it.
import { spawnSync } from 'node:child_process'
import fs from 'node:fs'
import path from 'node:path'

/** Seconds after which a build is stopped. */
const TIMEOUT = 20
/** What GNU time reports: wall-clock seconds, processor seconds, peak memory in KiB. */
const REPORT = '%e %U %S %M'
/** Larger models are not validated: the validator would need many times their size. */
const MAX_VALIDATED = 256 << 20

/** The findings that okoshi printed, by code. */
function counted(text) {
  const codes = {}
  for (const [, code] of text.matchAll(/^(?:error|warning|hint)\[([EWH]\d{3})\]: /gm)) codes[code] = (codes[code] ?? 0) + 1
  return codes
}

/** The number and the first of the validator's errors and warnings. */
async function validated(bytes, validator) {
  let report
  try {
    report = await validator.validateBytes(new Uint8Array(bytes), { maxIssues: 100 })
  } catch (error) {
    // The validator throws if the file is not glTF at all.
    return { triangles: 0, issues: 1, issue: String(error.message ?? error) }
  }
  const { numErrors, numWarnings, messages } = report.issues
  const first = messages.find(({ severity }) => severity < 2)
  return {
    triangles: report.info?.totalTriangleCount ?? 0,
    issues: numErrors + numWarnings,
    ...(first && { issue: `${first.code} ${first.pointer ?? ''}: ${first.message}` }),
  }
}

/**
 * Builds the drawing in `file` with the program `okoshi`; files are made in the folder `own`, which nobody else uses.
 *
 * The result has the exit status (124 if it was stopped), wall-clock and processor seconds, peak memory in MiB, the findings by code,
 * and the size of the model in bytes with what the validator says.
 */
export async function build({ file }, { okoshi, own, validator }) {
  const model = path.join(own, 'model.glb')
  const usage = path.join(own, 'usage')
  fs.rmSync(model, { force: true })
  const command = ['-f', REPORT, '-o', usage, 'timeout', '-k', '2', String(TIMEOUT), okoshi, 'build', '-v', file, '-o', model]
  const { status, stderr, error } = spawnSync('/usr/bin/time', command, { encoding: 'utf8', maxBuffer: 1 << 28 })
  if (error) throw error
  const [wall, user, system, memory] = fs.readFileSync(usage, 'utf8').trim().split('\n').at(-1).split(' ').map(Number)
  const result = {
    status,
    seconds: wall,
    processor: user + system,
    memory: memory / 1024,
    codes: counted(stderr),
    // From the first error on: there may be many hints before it.
    ...(status !== 0 && { said: stderr.slice(Math.max(0, stderr.search(/error\[/))).slice(0, 2000) }),
  }
  if (!fs.existsSync(model)) return result
  const { size } = fs.statSync(model)
  if (size > MAX_VALIDATED) return { ...result, size }
  return { ...result, size, ...(await validated(fs.readFileSync(model), validator)) }
}
