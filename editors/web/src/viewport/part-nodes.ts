// Which nodes of the model show a part, and which part a node shows.

import type { Object3D } from "three";
import type { State } from "../state";
import { elementOf, nodeName, type Model } from "./model";

export class PartNodes {
  constructor(private readonly state: State, private readonly shown: { readonly model: Model | null }) {}

  /** The name of the part of a node. */
  nameOf(node: Object3D): string {
    const element = elementOf(node);
    const part = element === null ? undefined : this.state.parts.at(element);
    return part?.name ?? nodeName(node);
  }

  nodesOf(name: string | null, model = this.shown.model): readonly Object3D[] {
    const part = name === null ? undefined : this.state.parts.carrier(name);
    if (part && model) return model.nodesOf(part);
    const node = name === null ? undefined : model?.node(name);
    return node ? [node] : [];
  }
}
