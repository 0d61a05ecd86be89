// Adds a clip to a model: the drawing language imports clips in one way only, which its examples do not use.

/** A GLB in which the named node's rotation has held keys: `turns` are quaternions, a quarter of a second each. */
export function animate(glb: Buffer, node: string, name: string, turns: readonly (readonly number[])[]): Buffer {
  const length = glb.readUInt32LE(12);
  const json = JSON.parse(glb.subarray(20, 20 + length).toString("utf8")) as Record<string, { name?: string; byteLength: number }[]> & { animations?: unknown[] };
  const old = glb.subarray(20 + length + 8);
  const times = Float32Array.from(turns, (_, at) => at / 4);
  const values = Float32Array.from(turns.flat());
  const bytes = Buffer.concat([old, Buffer.from(times.buffer), Buffer.from(values.buffer)]);
  const views = json["bufferViews"]! as unknown[];
  const accessors = json["accessors"]! as unknown[];
  views.push({ buffer: 0, byteOffset: old.length, byteLength: times.byteLength }, { buffer: 0, byteOffset: old.length + times.byteLength, byteLength: values.byteLength });
  accessors.push(
    { bufferView: views.length - 2, componentType: 5126, count: times.length, type: "SCALAR", min: [0], max: [times.at(-1)] },
    { bufferView: views.length - 1, componentType: 5126, count: times.length, type: "VEC4" },
  );
  json["buffers"]![0]!.byteLength = bytes.length;
  const target = { node: json["nodes"]!.findIndex((one) => one.name === node), path: "rotation" };
  json.animations = [{ name, samplers: [{ input: accessors.length - 2, output: accessors.length - 1, interpolation: "STEP" }], channels: [{ sampler: 0, target }] }];
  const text = Buffer.from(JSON.stringify(json));
  const padded = Buffer.concat([text, Buffer.alloc((4 - (text.length % 4)) % 4, " ")]);
  const head = Buffer.alloc(20);
  head.write("glTF", 0);
  head.writeUInt32LE(2, 4);
  head.writeUInt32LE(28 + padded.length + bytes.length, 8);
  head.writeUInt32LE(padded.length, 12);
  head.write("JSON", 16);
  const chunk = Buffer.alloc(8);
  chunk.writeUInt32LE(bytes.length, 0);
  chunk.write("BIN\0", 4);
  return Buffer.concat([head, padded, chunk, bytes]);
}
