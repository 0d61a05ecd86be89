// Adds a camera that moves to a clip of a model.

import { glb } from "./glb";

type Place = readonly [number, number, number];

/** The GLB with a camera that looks along -z and films a clip: `places` are its positions, evenly spaced over so many seconds. */
export function film(model: Buffer, clip: string, yfov: number, seconds: number, places: readonly Place[]): Buffer {
  const length = model.readUInt32LE(12);
  const json = JSON.parse(model.subarray(20, 20 + length).toString("utf8")) as Record<string, unknown[]>;
  const data = model.subarray(20 + length + 8);
  const times = Float32Array.from(places, (_, at) => (at * seconds) / (places.length - 1));
  const values = Float32Array.from(places.flat());
  const [accessors, views, nodes] = [json["accessors"]!, json["bufferViews"]!, json["nodes"]!];
  views.push({ buffer: 0, byteOffset: data.length, byteLength: times.byteLength }, { buffer: 0, byteOffset: data.length + times.byteLength, byteLength: values.byteLength });
  accessors.push(
    { bufferView: views.length - 2, componentType: 5126, count: times.length, type: "SCALAR", min: [0], max: [times.at(-1)] },
    { bufferView: views.length - 1, componentType: 5126, count: times.length, type: "VEC3" },
  );
  const root = nodes.find((node) => (node as { name: string }).name === "Root") as { children: number[] };
  root.children.push(nodes.push({ name: `Camera ${clip}`, camera: 0, translation: places[0] }) - 1);
  json["cameras"] = [{ name: `Camera ${clip}`, type: "perspective", perspective: { yfov, znear: 0.01 } }];
  const filmed = json["animations"]!.find((one) => (one as { name: string }).name === clip) as { samplers: unknown[]; channels: unknown[] };
  const sampler = filmed.samplers.push({ input: accessors.length - 2, output: accessors.length - 1, interpolation: "LINEAR" }) - 1;
  filmed.channels.push({ sampler, target: { node: nodes.length - 1, path: "translation" } });
  delete json["buffers"];
  return glb(json, Buffer.concat([data, Buffer.from(times.buffer), Buffer.from(values.buffer)]));
}
