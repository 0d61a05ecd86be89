// The results of the corpus run in Markdown, for docs/reliability.md.

/** The value below which a share of the sorted numbers is. */
function quantile(sorted, share) {
  return sorted[Math.min(sorted.length - 1, Math.floor(sorted.length * share))]
}

const count = (number) => number.toLocaleString('en')
const ofDrawing = ({ package: of, name }) => `\`${name}\` of ${of}`

/** How a build ended: `built`, `refused` because of errors in the drawing, `stopped` at the timeout, or `failed` in another way. */
export function outcome({ status, size }) {
  if (status === 0 && size !== undefined) return 'built'
  if (status === 1) return 'refused'
  return status === 124 || status === 137 ? 'stopped' : 'failed'
}

/** How many drawings have each code, most frequent first. */
function byCode(records, wanted) {
  const counts = new Map()
  for (const { codes } of records) {
    for (const code of Object.keys(codes).filter(wanted)) counts.set(code, (counts.get(code) ?? 0) + 1)
  }
  return [...counts].sort(([a, m], [b, n]) => n - m || a.localeCompare(b))
}

const link = (code) => `[${code}](diagnostics.md#${code.toLowerCase()})`
const codeList = (codes) => (codes.length ? codes.map(([code, files]) => `${link(code)} ${count(files)}`).join(', ') : 'none')

/** The packages, and how their drawings were built. */
function packages(sources, records) {
  const rows = sources.map(({ name, version, found }) => {
    const own = records.filter((record) => record.package === name)
    const built = own.filter((record) => outcome(record) === 'built').length
    return `| ${name} ${version} | ${count(found)} | ${count(own.length)} | ${count(built)} |`
  })
  return ['| package | drawings in it | in this run | built |', '|---|--:|--:|--:|', ...rows].join('\n')
}

/** The builds as a whole. */
function builds(records) {
  const of = (wanted) => records.filter((record) => outcome(record) === wanted)
  const built = of('built')
  const sorted = (key) => records.map((record) => record[key]).sort((a, b) => a - b)
  const most = (key) => records.reduce((a, b) => ((b[key] ?? 0) > (a[key] ?? 0) ? b : a))
  const [seconds, memory] = [sorted('seconds'), sorted('memory')]
  const [slowest, hungriest, largest] = [most('seconds'), most('memory'), most('size')]
  const checked = built.filter(({ issues }) => issues !== undefined)
  const invalid = checked.filter(({ issues }) => issues > 0)
  const ms = (value) => (value < 1 ? `${Math.round(value * 1000)} ms` : `${value.toFixed(1)} s`)
  const mib = (value) => `${value < 10 ? value.toFixed(1) : Math.round(value)} MiB`
  const rows = [
    ['drawings', count(records.length)],
    ['built', count(built.length)],
    ['refused, by error', `${count(of('refused').length)}: ${codeList(byCode(of('refused'), (code) => code[0] === 'E'))}`],
    ['stopped after 20 s', count(of('stopped').length)],
    ['crashed or failed', count(of('failed').length)],
    ['built with warnings', codeList(byCode(built, (code) => code[0] === 'W'))],
    ['built with hints', codeList(byCode(built, (code) => code[0] === 'H'))],
    ['time', `median ${ms(quantile(seconds, 0.5))}, 99 % below ${ms(quantile(seconds, 0.99))}`],
    ['slowest', `${ms(slowest.seconds)}: ${ofDrawing(slowest)}`],
    ['peak memory', `median ${mib(quantile(memory, 0.5))}, 99 % below ${mib(quantile(memory, 0.99))}`],
    ['most memory', `${mib(hungriest.memory)}: ${ofDrawing(hungriest)}`],
    ['largest model', `${mib((largest.size ?? 0) / 2 ** 20)}, ${count(largest.triangles ?? 0)} triangles: ${ofDrawing(largest)}`],
    ['Khronos validator', `${count(checked.length)} models, ${count(invalid.length)} with errors or warnings`],
  ]
  return ['| | |', '|---|---|', ...rows.map(([name, value]) => `| ${name} | ${value} |`)].join('\n')
}

/** Those that were refused, each with the first thing that is said about it. */
function refused(records) {
  const rows = records
    .filter((record) => outcome(record) === 'refused')
    .map((record) => {
      const [, code, message] = /error\[(\w+)\]: (.*)/.exec(record.said ?? '') ?? []
      const why = message === undefined ? 'nothing was said' : `${message.replaceAll('|', '\\|')} (${link(code)})`
      return `| ${ofDrawing(record)} | ${why} |`
    })
  return rows.length ? `Refused were:\n\n| drawing | why |\n|---|---|\n${rows.join('\n')}\n\n` : ''
}

/** Silhouettes as a whole. */
function overall(compared) {
  const measured = compared.filter(({ overlap }) => typeof overlap === 'number').sort((a, b) => a.overlap - b.overlap)
  const overlaps = measured.map(({ overlap }) => overlap)
  const silent = measured.find(({ codes }) => Object.keys(codes).length === 0)
  return {
    measured,
    median: quantile(overlaps, 0.5)?.toFixed(3),
    low: count(overlaps.filter((overlap) => overlap < 0.9).length),
    left: compared.length > measured.length ? ` ${count(compared.length - measured.length)} more could not be compared.` : '',
    silent,
  }
}

/** The silhouettes of both halves, and the worst of that which is looked at. */
function silhouettes(listed, heldBack) {
  const { measured, median, low, left, silent } = overall(listed)
  const rows = measured
    .slice(0, 10)
    .map((record) => `| ${record.overlap.toFixed(3)} | ${ofDrawing(record)} | ${Object.keys(record.codes).map(link).join(', ') || 'none'} |`)
  const least = silent ? ` The lowest about which okoshi says nothing is ${silent.overlap.toFixed(3)}: ${ofDrawing(silent)}.` : ''
  const others = overall(heldBack)
  const unseen = others.measured.length
    ? `

The worst of earlier runs were looked at, and okoshi was improved by what they showed. Of ${count(others.measured.length)} others, which were held back and at which nobody
looked, the median overlap is **${others.median}**, with ${others.low} below 0.9, and the lowest about which okoshi says nothing is ${others.silent?.overlap.toFixed(3) ?? 'none'}.${others.left}`
    : ''
  return `For ${count(measured.length)} of them, evenly spread over the packages, the silhouette of the model as drawn was compared with the picture
of the drawing by resvg, without texts.${left} The median overlap (intersection over union, with pixels counted as far as they are opaque) is
**${median}**, with ${low} below 0.9.${least} The worst:

| overlap | drawing | findings |
|--:|---|---|
${rows.join('\n')}${unseen}`
}

/** The summary of a run. */
export function summary({ sources, records, listed, heldBack }) {
  return `${packages(sources, records)}\n\n${builds(records)}\n\n${refused(records)}${silhouettes(listed, heldBack)}\n`
}

/** A page with the text between its markers replaced. */
export function updated(page, text) {
  const [start, end] = ['<!-- corpus -->', '<!-- /corpus -->']
  const [head, tail] = [page.indexOf(start), page.indexOf(end)]
  if (head < 0 || tail < head) throw new Error(`the page has no markers ${start} and ${end}`)
  return `${page.slice(0, head + start.length)}\n${text}${page.slice(tail)}`
}
