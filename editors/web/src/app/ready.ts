// What the folder has ready before the module has come: the model of a first visit, and drawings to try with their pictures.

import type { Starter } from "../protocol";
import type { Shared } from "./share";

/** What is made with the folder (scripts/ready.mjs). Addresses are relative to the page's script. */
export interface Made {
  /** The drawings to try; the first one is what a first visit shows. */
  readonly starters: readonly Starter[];
  /** The addresses of the drawings by name, of those in lessons too. */
  readonly drawings: Readonly<Record<string, string>>;
  /** The address of the model of the first one. */
  readonly model: string;
  /** Whether there is a page of lessons beside this one. */
  readonly lessons: boolean;
}

/** Put here when the folder is made. */
declare const READY: Made;

const MARK = /^#begin=([a-z0-9-]+)$/;

export class Ready {
  readonly made = READY;

  /** `folder`: the address of the page's script. */
  constructor(private readonly folder: string) {}

  get starters(): readonly Starter[] {
    return this.made.starters;
  }

  /** What a first visit shows. */
  get first(): Starter {
    return this.made.starters[0]!;
  }

  /** The address of a file. */
  at(file: string): string {
    return new URL(file, this.folder).href;
  }

  /** A drawing to begin with. Rejects if there is none of this name, or if it cannot be fetched. */
  async drawing(name: string): Promise<Shared> {
    const file = Object.hasOwn(this.made.drawings, name) ? this.made.drawings[name] : undefined;
    if (file === undefined) throw new Error(`there is no drawing ${name}`);
    return { name: `${name}.svg`, bytes: new Uint8Array(await this.fetched(file)) };
  }

  async model(): Promise<ArrayBuffer> {
    return this.fetched(this.made.model);
  }

  /** Takes the name of a drawing to begin with out of the page's address, if it has one. */
  takeName(): string | null {
    const name = MARK.exec(location.hash)?.[1] ?? null;
    if (name !== null) history.replaceState(null, "", location.pathname + location.search);
    return name;
  }

  private async fetched(file: string): Promise<ArrayBuffer> {
    const response = await fetch(this.at(file));
    if (!response.ok) throw new Error(`the server has no ${file.replace(/^.*\//, "")}: it said ${response.status}`);
    return response.arrayBuffer();
  }
}
