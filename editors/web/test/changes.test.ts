// What changed since the last save, from the real program: a model to which it is applied equals the model that is loaded as a whole.

import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { createInterface } from "node:readline";
import { test } from "node:test";
import { BatchedMesh, BufferGeometry, Color, Matrix4, Mesh, type MeshStandardMaterial } from "three";
import { WebSocket } from "ws";
import { Model, type Shading } from "../src/viewport/model";
import { readChanges, readFile } from "../src/viewport/model-file";
import { Messages, read, type Build } from "../src/protocol";
import { TEST_LIMIT } from "./closing";

const okoshi = process.env["OKOSHI"] ?? "";
const skip = !okoshi ? "there is no okoshi program; OKOSHI names one" : false;
/** So many that they are drawn in batches. */
const PARTS = 320;
const SAVES = 8;
const KINDS = ["default -9 9", "roundv", "flat", "conev -8 8 0.5"];
const COLOURS = ["#c83737", "#2a7fff", "#37c871"];

interface Drawn {
  x: number;
  width: number;
  kind: number;
  colour: number;
}

/** A pseudorandom whole number below `most`, the same in each run. */
function random(seed: number): (most: number) => number {
  return (most) => {
    seed = (Math.imul(seed, 1664525) + 1013904223) >>> 0;
    return Math.floor((seed / 2 ** 32) * most);
  };
}

function drawing(parts: readonly Drawn[]): string {
  const shapes = parts.map(({ x, width, kind, colour }, at) => {
    const [left, top] = [40 * (at % 20) + x, 40 * Math.floor(at / 20)];
    return `<rect id="e${at}" x="${left}" y="${top}" width="${width}" height="20" fill="${COLOURS[colour]}"/><text x="${left + 2}" y="${top + 10}" font-size="3">P${at}${at > 0 ? `@P${at % 5 === 0 ? 0 : at - 1}` : ""}$Shape ${KINDS[kind]}</text>`;
  });
  return `<svg xmlns="http://www.w3.org/2000/svg" width="800" height="640">\n${shapes.join("\n")}\n</svg>\n`;
}

const numbers = ({ index, attributes }: BufferGeometry): unknown => [index && [...index.array], Object.fromEntries(Object.entries(attributes).map(([name, { array }]) => [name, [...array]]))];

/** Everything that is seen of a model. */
function seen(model: Model): unknown {
  const nodes: unknown[] = [];
  model.root.traverse((object) => {
    const material = object instanceof Mesh ? (object.material as MeshStandardMaterial) : null;
    nodes.push([object.name, object.userData, object.matrixWorld.toArray(), material && [material.color.getHex(), material.roughness, material.side, material.flatShading], object instanceof Mesh && numbers(object.geometry)]);
  });
  return { nodes, box: [...model.box.min, ...model.box.max].map((one) => one.toFixed(6)), triangles: model.triangles, batches: batched(model) };
}

/** A number that differs for lists that differ. */
const hash = (list: ArrayLike<number>): number => Array.from(list).reduce((sum, one) => (Math.imul(sum, 31) + Math.round(one * 1e6)) | 0, list.length);

/** The instances in batches, by their places. */
function batched(model: Model): string[] {
  const instances = model.batches.group.children.flatMap((batch) => {
    assert.ok(batch instanceof BatchedMesh);
    return Array.from({ length: batch.maxInstanceCount }, (_, at) => at).filter((at) => isUsed(batch, at)).map((at) => {
      const { vertexStart, vertexCount, start, count } = batch.getGeometryRangeAt(batch.getGeometryIdAt(at))!;
      const positions = batch.geometry.getAttribute("position").array.slice(3 * vertexStart, 3 * (vertexStart + vertexCount));
      const corners = batch.geometry.index!.array.slice(start, start + count).map((corner) => corner - vertexStart);
      const colour = new Color();
      batch.getColorAt(at, colour);
      const matrix = new Matrix4();
      batch.getMatrixAt(at, matrix);
      return JSON.stringify([matrix.toArray(), colour.getHex(), hash(positions), hash(corners)]);
    });
  });
  return instances.sort();
}

/** Numbers of instances that were removed are used again later. */
function isUsed(batch: BatchedMesh, instance: number): boolean {
  try {
    return batch.getVisibleAt(instance);
  } catch {
    return false;
  }
}

test("changes that are applied to a model make it the new one", { skip, timeout: TEST_LIMIT }, async () => {
  const choose = random(7);
  const parts: Drawn[] = Array.from({ length: PARTS }, () => ({ x: choose(10), width: 10 + choose(20), kind: choose(4), colour: choose(3) }));
  const folder = mkdtempSync(join(tmpdir(), "okoshi-changes-"));
  const path = join(folder, "a.svg");
  writeFileSync(path, drawing(parts));
  const program = spawn(okoshi, ["preview", path, "--quiet"], { stdio: ["ignore", "pipe", "inherit"] });
  let live: WebSocket | undefined;
  try {
    const address = await new Promise<string>((found) => createInterface(program.stdout).once("line", found));
    const get = async (path: string): Promise<ArrayBuffer> => (await fetch(address + path)).arrayBuffer();
    live = new WebSocket(`${address.replace("http", "ws")}live`);
    const messages = new Messages();
    const builds: Build[] = [];
    let arrived = (): void => {};
    live.on("message", (data) => {
      const message = messages.read(JSON.parse(String(data)));
      assert.notEqual(message, "missed");
      if (message === null || message === "missed" || message.type !== "build") return;
      builds.push(message.build);
      arrived();
    });
    const nextBuild = async (): Promise<Build> => {
      while (builds.length === 0) await new Promise<void>((resolve) => (arrived = resolve));
      return builds.shift()!;
    };
    let build = await nextBuild();
    const { scene, animations, nodes } = await readFile(await get(build.model!));
    const model = new Model(scene, animations, nodes);
    assert.equal(batched(model).length, PARTS);
    let deltas = 0;
    for (let save = 0; save < SAVES; save++) {
      for (let edits = 1 + choose(4); edits > 0; edits--) {
        const at = choose(PARTS);
        const edited = parts[at]!;
        parts[at] = [{ ...edited, x: choose(10) }, { ...edited, width: 10 + choose(20) }, { ...edited, kind: choose(4) }, { ...edited, colour: choose(3) }][choose(4)]!;
      }
      // In the end all parts get more corners than there is room for in the batches.
      if (save === SAVES - 1) for (const part of parts) part.kind = 1;
      writeFileSync(path, drawing(parts));
      const before = build;
      build = await nextBuild();
      const other = new WebSocket(`${address.replace("http", "ws")}live`);
      const whole = await new Promise<Build>((found) => other.on("message", (data) => {
        const message = read(JSON.parse(String(data)));
        if (message?.type === "build") found(message.build);
      }));
      other.close();
      assert.deepEqual(build.parts, whole.parts);
      const changes = await readChanges(await get(`${build.model}?since=${before.model}`));
      assert.ok("moved" in changes);
      if (changes.moved.length + changes.meshes.size > 0) deltas++;
      // As the page does it, in any look.
      model.shade((["smooth", "flat", "wire"] satisfies Shading[])[save % 3]!);
      model.update(changes);
      model.shade("smooth");
      const fresh = await readFile(await get(build.model!));
      assert.deepEqual(seen(model), seen(new Model(fresh.scene, fresh.animations, fresh.nodes)));
    }
    assert.ok(deltas > SAVES / 2, `${deltas} saves changed something`);
  } finally {
    live?.close();
    program.kill();
    rmSync(folder, { recursive: true });
  }
});
