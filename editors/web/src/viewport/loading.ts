// Loads models: as a whole, or what changed since the one that is shown.

import { painted } from "../dom";
import type { Host } from "../host/host";
import type { Build } from "../protocol";
import { Model, type Shading } from "./model";
import { readChanges, readFile, type Delta, type ModelFile } from "./model-file";
import type { RenderLoop } from "./render-loop";

/** A model that was requested. */
export interface Wanted {
  readonly drawing: string;
  readonly connection: number;
  readonly revision: number;
  readonly address: string;
  readonly clips: Build["clips"];
  readonly originals: string | null;
}

/** A model that was read: as a whole, or as what changed since another one. */
export type Loaded = { readonly model: Model; readonly bytes: ArrayBuffer } | { readonly changes: Delta; readonly since: Wanted };

/** Whether two requests are for the same model. */
export const isSame = (a: Wanted, b: Wanted | null): boolean => b !== null && a.drawing === b.drawing && a.connection === b.connection && a.address === b.address;

/** What the viewer shows when a model is loaded. */
interface Shown {
  readonly model: Model | null;
  readonly shown: Wanted | null;
  readonly shading: Shading;
}

/** Loads a model. */
export async function load(wanted: Wanted, { model, shown, shading }: Shown, host: Host, renderLoop: RenderLoop): Promise<Loaded> {
  const prepare = ({ scene, animations, nodes }: ModelFile): Model => {
    const prepared = new Model(scene, animations, nodes);
    prepared.shade(shading);
    prepared.light((material) => renderLoop.reach(material));
    return prepared;
  };
  if (model && shown?.drawing === wanted.drawing && shown.connection === wanted.connection) {
    const bytes = await host.model(`${wanted.address}?since=${shown.address}`);
    const changes = await readChanges(bytes);
    return "moved" in changes ? { changes, since: shown } : { model: prepare(changes), bytes };
  }
  const bytes = await host.model(wanted.address);
  if (model) return { model: prepare(await readFile(bytes)), bytes };
  // The list of parts is seen first: the graphics context, the first model and its shaders take long.
  await painted();
  renderLoop.start();
  const first = prepare(await readFile(bytes));
  // Shaders are compiled before the model is added, so that the page does not stall; later models mostly share them.
  await renderLoop.compile(first.drawn);
  return { model: first, bytes };
}
