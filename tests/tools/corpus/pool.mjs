// Does jobs in several threads. A thread runs this file as well.
import fs from 'node:fs'
import { createRequire } from 'node:module'
import path from 'node:path'
import { Worker, isMainThread, parentPort, workerData } from 'node:worker_threads'

import { build } from './build.mjs'
import { silhouette } from './silhouette.mjs'

const JOBS = { build, silhouette }

/** The results that the file `kept` has for the items, by hash, so that a run that was interrupted can be continued. */
function earlier(kept) {
  const lines = kept && fs.existsSync(kept) ? fs.readFileSync(kept, 'utf8').split('\n') : []
  const results = new Map()
  // The last line is empty, or was cut off.
  for (const line of lines.slice(0, -1)) {
    const { hash, ...result } = JSON.parse(line)
    results.set(hash, result)
  }
  return results
}

/** The results of one kind of job for each of the items, in their order. They are kept in the file `kept`, if one is named. */
export async function each(all, job, { okoshi, scratch, threads, kept }) {
  const known = earlier(kept)
  const items = all.filter(({ hash }) => !known.has(hash))
  const keeping = kept && fs.openSync(kept, 'a')
  let next = 0
  const work = (number) =>
    new Promise((resolve, reject) => {
      const own = path.join(scratch, `thread-${number}`)
      fs.mkdirSync(own, { recursive: true })
      const worker = new Worker(new URL(import.meta.url), { workerData: { job, okoshi, own, scratch } })
      const give = () => {
        const index = next++
        if (index % 1000 === 999) console.error(`${index + 1} of ${items.length}`)
        if (index < items.length) worker.postMessage({ index, item: items[index] })
        else worker.terminate().then(resolve)
      }
      worker.on('message', ({ index, result }) => {
        const { hash } = items[index]
        known.set(hash, result)
        if (keeping) fs.writeSync(keeping, `${JSON.stringify({ hash, ...result })}\n`)
        give()
      })
      worker.on('error', reject)
      give()
    })
  await Promise.all(Array.from({ length: threads }, (_, number) => work(number)))
  if (keeping) fs.closeSync(keeping)
  return all.map(({ hash }) => known.get(hash))
}

if (!isMainThread) {
  const { job, okoshi, own, scratch } = workerData
  const modules = path.join(scratch, 'npm', 'package.json')
  const load = createRequire(modules)
  const tools = { okoshi, own, modules, PNG: load('pngjs').PNG, validator: load('gltf-validator') }
  parentPort.on('message', async ({ index, item }) => {
    let result
    try {
      result = await JOBS[job](item, tools)
    } catch (error) {
      result = { failure: String(error?.message ?? error) }
    }
    parentPort.postMessage({ index, result })
  })
}
