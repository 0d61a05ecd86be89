// What the counts need of a model: its nodes in the world, its extent, and copies of it in plain colours.

const JSON_CHUNK = 0x4e4f534a
const FLOAT = 5126

/** A .glb file: its JSON, and its buffer. */
export function read(file) {
  const length = file.readUInt32LE(12)
  if (file.readUInt32LE(16) !== JSON_CHUNK) throw new Error('the model does not begin with JSON')
  return { json: JSON.parse(file.toString('utf8', 20, 20 + length)), rest: file.subarray(20 + length) }
}

/** The .glb file of a model that `read` gave, changed. */
export function binary({ json, rest }) {
  const text = Buffer.from(JSON.stringify(json))
  const padded = Buffer.concat([text, Buffer.alloc(-text.length & 3, ' ')])
  const head = Buffer.alloc(20)
  head.write('glTF')
  head.writeUInt32LE(2, 4)
  head.writeUInt32LE(20 + padded.length + rest.length, 8)
  head.writeUInt32LE(padded.length, 12)
  head.writeUInt32LE(JSON_CHUNK, 16)
  return Buffer.concat([head, padded, rest])
}

/** The point [x, y, z] turned by the quaternion [x, y, z, w]. */
function turned([x, y, z], [i, j, k, w]) {
  const [u, v, n] = [j * z - k * y + w * x, k * x - i * z + w * y, i * y - j * x + w * z]
  return [x + 2 * (j * n - k * v), y + 2 * (k * u - i * n), z + 2 * (i * v - j * u)]
}

/** Calls `visit` with each node, its ancestors, and the function from its space into the world. */
function walk(json, visit) {
  const into = (index, parents, outer) => {
    const node = json.nodes[index]
    const { translation = [0, 0, 0], rotation = [0, 0, 0, 1], scale = [1, 1, 1] } = node
    const world = (point) => outer(turned(point.map((value, axis) => value * scale[axis]), rotation).map((value, axis) => value + translation[axis]))
    visit(node, parents, world)
    for (const child of node.children ?? []) into(child, [...parents, node], world)
  }
  for (const root of json.scenes[json.scene ?? 0].nodes) into(root, [], (point) => point)
}

/** The points of a primitive. */
function* positions({ json, rest }, primitive) {
  const { bufferView, byteOffset = 0, componentType, count } = json.accessors[primitive.attributes.POSITION]
  if (componentType !== FLOAT) throw new Error('positions are no floats')
  const view = json.bufferViews[bufferView]
  // The buffer begins after the chunk's head.
  const start = 8 + (view.byteOffset ?? 0) + byteOffset
  for (let index = 0; index < count; index++) {
    const at = start + index * (view.byteStride ?? 12)
    yield [rest.readFloatLE(at), rest.readFloatLE(at + 4), rest.readFloatLE(at + 8)]
  }
}

/** The width, height and depth of a model. */
export function extent(model) {
  const least = [Infinity, Infinity, Infinity]
  const most = [-Infinity, -Infinity, -Infinity]
  const { nodes, skins, meshes } = model.json
  const worlds = new Map()
  walk(model.json, (node, _, world) => worlds.set(node, world))
  for (const [node, own] of worlds) {
    // The mesh of a part that bends is in the frame of its first bone.
    const world = node.skin === undefined ? own : worlds.get(nodes[skins[node.skin].joints[0]])
    for (const primitive of meshes?.[node.mesh]?.primitives ?? []) {
      for (const point of positions(model, primitive)) {
        world(point).forEach((value, axis) => {
          least[axis] = Math.min(least[axis], value)
          most[axis] = Math.max(most[axis], value)
        })
      }
    }
  }
  return most.map((value, axis) => value - least[axis])
}

/**
 * A copy of the model in plain colours, red, green and blue from 0 to 1: that which `colour` gives for each node's name and the names
 * of its ancestors.
 */
export function painted({ json, rest }, colour) {
  const copy = structuredClone(json)
  copy.materials = []
  copy.meshes = []
  const materials = new Map()
  walk(copy, (node, parents) => {
    if (node.mesh === undefined) return
    const factor = [...colour(node.name, parents.map(({ name }) => name)), 1]
    const key = String(factor)
    if (!materials.has(key)) {
      materials.set(key, copy.materials.push({ pbrMetallicRoughness: { baseColorFactor: factor } }) - 1)
    }
    const mesh = structuredClone(json.meshes[node.mesh])
    for (const primitive of mesh.primitives) {
      delete primitive.attributes.COLOR_0
      primitive.material = materials.get(key)
    }
    node.mesh = copy.meshes.push(mesh) - 1
  })
  return { json: copy, rest }
}
