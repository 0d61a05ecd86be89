// The drawings of the corpus: fetched by the names of their packages, without links and duplicates.
import { execFileSync } from 'node:child_process'
import { createHash } from 'node:crypto'
import fs from 'node:fs'
import { createRequire } from 'node:module'
import path from 'node:path'
import { gunzipSync } from 'node:zlib'

import { drawing } from '../iconify.mjs'

/** Debian packages with drawings. */
const DEBIAN = [
  'adwaita-icon-theme', 'breeze-icon-theme', 'dia-common', 'elementary-icon-theme', 'elementary-xfce-icon-theme',
  'faenza-icon-theme', 'freecad-common', 'fritzing-parts', 'gnome-cards-data', 'gnome-chess', 'gnome-mahjongg',
  'granatier', 'inkscape-open-symbols', 'inkscape-tutorials', 'iso-flags-svg', 'kapman', 'kbounce', 'kbreakout',
  'kdegames-card-data-kf5', 'kdegames-mahjongg-data-kf5', 'kdiamond', 'kgoldrunner', 'khangman', 'kigo', 'killbots',
  'kmines', 'kolf', 'ksirk', 'ktuberling-data', 'mate-icon-theme', 'numix-icon-theme-circle', 'openboard-common',
  'openclipart-svg', 'sugar-icon-theme', 'suru-icon-theme', 'tango-icon-theme', 'tuxmath-data',
  'tuxpaint-stamps-default',
]

const FOLDER = import.meta.dirname

/** The npm packages that are tools of the run, not drawings. */
const TOOLS = ['@resvg/resvg-js', 'gltf-validator', 'pngjs']

/** Installs the npm packages in the scratch folder; returns what loads them. */
export function tools(scratch) {
  const folder = path.join(scratch, 'npm')
  fs.mkdirSync(folder, { recursive: true })
  const is = (name) => path.join(folder, name)
  const lock = fs.readFileSync(path.join(FOLDER, 'package-lock.json'), 'utf8')
  const done = is('installed.json')
  if (!fs.existsSync(done) || fs.readFileSync(done, 'utf8') !== lock) {
    for (const file of ['package.json', 'package-lock.json']) fs.copyFileSync(path.join(FOLDER, file), is(file))
    execFileSync('npm', ['ci', '--no-audit', '--no-fund'], { cwd: folder, stdio: ['ignore', 'ignore', 'inherit'] })
    fs.writeFileSync(done, lock)
  }
  return createRequire(is('package.json'))
}

/** Downloads and unpacks a Debian package without installing it; returns its folder and version. */
function debian(name, scratch) {
  const folder = path.join(scratch, 'debian')
  fs.mkdirSync(folder, { recursive: true })
  const archive = () => fs.readdirSync(folder).find((file) => file.startsWith(`${name}_`) && file.endsWith('.deb'))
  if (!archive()) execFileSync('apt-get', ['download', '-q', name], { cwd: folder, stdio: ['ignore', 'ignore', 'pipe'] })
  const deb = path.join(folder, archive())
  const tree = path.join(folder, name)
  if (!fs.existsSync(tree)) {
    execFileSync('dpkg-deb', ['-x', deb, `${tree}.partial`])
    fs.renameSync(`${tree}.partial`, tree)
  }
  const version = execFileSync('dpkg-deb', ['-f', deb, 'Version'], { encoding: 'utf8' }).trim()
  return { tree, version }
}

/** Writes the drawings of an Iconify set into a folder, each as a file. */
function iconify(name, load, scratch) {
  const folder = path.join(scratch, 'iconify', path.basename(name))
  const set = load(`${name}/icons.json`)
  fs.mkdirSync(folder, { recursive: true })
  for (const key of Object.keys(set.icons)) {
    const file = path.join(folder, `${key}.svg`)
    if (!fs.existsSync(file)) fs.writeFileSync(file, drawing(set, key))
  }
  return folder
}

/** All drawings below a folder that are files of their own, in order. */
function drawings(folder) {
  const entries = fs.readdirSync(folder, { recursive: true, withFileTypes: true })
  const files = entries.filter((entry) => entry.isFile() && /\.svgz?$/i.test(entry.name))
  return files.map((entry) => path.join(entry.parentPath ?? entry.path, entry.name)).sort()
}

/** The text of a drawing, unpacked. */
export function read(file) {
  const bytes = fs.readFileSync(file)
  return bytes[0] === 0x1f && bytes[1] === 0x8b ? gunzipSync(bytes) : bytes
}

/**
 * The packages with their versions, and their drawings: `{ package, name, file, hash }`. Each content is in the list once, in the
 * package that is named first.
 */
export function corpus(scratch, load, only) {
  const { dependencies } = JSON.parse(fs.readFileSync(path.join(FOLDER, 'package.json'), 'utf8'))
  const npm = Object.keys(dependencies).filter((name) => !TOOLS.includes(name))
  const root = path.join(scratch, 'npm', 'node_modules')
  const wanted = (name) => only.length === 0 || only.includes(name)
  const sources = [
    ...npm.filter(wanted).map((name) => ({
      name,
      version: dependencies[name],
      tree: name.startsWith('@iconify-json/') ? iconify(name, load, scratch) : path.join(root, name),
    })),
    ...DEBIAN.filter(wanted).map((name) => ({ name, ...debian(name, scratch) })),
  ]
  const seen = new Set()
  const files = []
  for (const source of sources) {
    source.found = 0
    for (const file of drawings(source.tree)) {
      source.found += 1
      const hash = createHash('sha256').update(fs.readFileSync(file)).digest('hex')
      if (seen.has(hash)) continue
      seen.add(hash)
      files.push({ package: source.name, name: path.relative(source.tree, file), file, hash })
    }
  }
  // In the order of their hashes, so that what an interrupted run has done is a fair sample.
  files.sort((a, b) => (a.hash < b.hash ? -1 : 1))
  return { sources, files }
}
