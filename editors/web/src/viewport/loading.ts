// Loads models: as a whole, or what changed since the one that is shown.

import { painted } from "../dom";
import type { Attempted, Host } from "../host/host";
import type { Build } from "../protocol";
import type { Delta } from "./delta";
import { Model, type Shading } from "./model";
import { readChanges, readFile, type ModelFile } from "./model-file";
import type { RenderLoop } from "./render-loop";

/** A model that was requested. */
export interface Wanted {
  readonly drawing: string;
  readonly connection: number;
  readonly revision: number;
  readonly address: string;
  readonly clips: Build["clips"];
  readonly originals: string | null;
  /** Asks what a change would make of this model, for a page that shows the model of an address. */
  readonly attempt?: Attempt;
  /** The address of that, once it is shown. */
  readonly attempted?: string;
}

/** Asks what a change would make of the drawing. */
export type Attempt = (shows: string) => Promise<Attempted | null>;

/** A model that was read: as a whole, or as what changed since another one. */
export type Loaded = ({ readonly model: Model; readonly bytes: ArrayBuffer } | { readonly changes: Delta; readonly since: Wanted }) & { readonly attempted?: string };

/** Whether two requests are for the same model of a drawing, whatever is tried with it. */
export const isSame = (a: Wanted, b: Wanted | null): boolean => b !== null && a.drawing === b.drawing && a.connection === b.connection && a.address === b.address;

/** What the viewer shows when a model is loaded. */
interface Shown {
  readonly model: Model | null;
  readonly shown: Wanted | null;
  readonly shading: Shading;
}

/** Loads a model. */
export async function load(wanted: Wanted, { model, shown, shading }: Shown, host: Pick<Host, "model">, renderLoop: RenderLoop): Promise<Loaded> {
  const prepare = ({ scene, animations, nodes }: ModelFile): Model => {
    const prepared = new Model(scene, animations, nodes);
    prepared.shade(shading);
    prepared.light((material) => renderLoop.reach(material));
    return prepared;
  };
  if (model && shown?.drawing === wanted.drawing && shown.connection === wanted.connection) {
    const before = shown.attempted ?? shown.address;
    const tried = wanted.attempt && (await wanted.attempt(before));
    if (tried === null) throw new Error("there is nothing to show of this change");
    const bytes = tried ? tried.bytes : await host.model(`${wanted.address}?since=${before}`);
    const changes = await readChanges(bytes);
    const about = tried ? { attempted: tried.address } : {};
    return "moved" in changes ? { changes, since: shown, ...about } : { model: prepare(changes), bytes, ...about };
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
