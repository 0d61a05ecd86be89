// Characters that turn to the viewer (docs/view-dependent.md): flat regions, each drawn in two or more views.

import { Matrix4, Mesh, Quaternion, Vector3, type AnimationClip, type Object3D } from "three";
import { wayOf } from "./extension";

/** Degrees around the upright axis and up. */
export type Direction = readonly [number, number];

export interface Views {
  readonly views: readonly Direction[];
  /** Sets of one to three views with linear weights between them. */
  readonly between: readonly (readonly number[])[];
}

const RADIANS = Math.PI / 180;
/** What depths towards the viewer are multiplied by: perspective would move the regions of a drawing apart. */
const FLATNESS = 0.25;

/** The screen's right and up, and the direction towards the viewer. */
export function axesOf([theta, phi]: Direction): [Vector3, Vector3, Vector3] {
  const [st, ct, sp, cp] = [Math.sin(theta * RADIANS), Math.cos(theta * RADIANS), Math.sin(phi * RADIANS), Math.cos(phi * RADIANS)];
  return [new Vector3(ct, 0, -st), new Vector3(-st * sp, cp, -ct * sp), new Vector3(st * cp, sp, ct * cp)];
}

/** The direction of a unit vector towards the viewer. */
export function directionOf({ x, y, z }: Vector3): Direction {
  return [Math.atan2(x, z) / RADIANS, Math.asin(Math.min(Math.max(y, -1), 1)) / RADIANS];
}

/** The weight of each view from a direction: those of the nearest place in one of the sets. */
export function weightsOf({ views, between }: Views, [theta, phi]: Direction): number[] {
  let best = Infinity;
  let found = views.map(() => 0);
  for (const set of between) {
    const all = set.map((view) => views[view] ?? ([0, 0] as const));
    const first = shortWay(all[0]![0]);
    const corners = all.map(([own, up]) => [first + shortWay(own - first), up] as const);
    for (const turns of [-360, 0, 360]) {
      const point = [theta + turns, phi] as const;
      const shares = nearest(corners, point);
      const distance = apart(blend(corners, shares), point);
      if (distance >= best) continue;
      best = distance;
      found = views.map(() => 0);
      set.forEach((view, index) => (found[view] = (found[view] ?? 0) + shares[index]!));
    }
  }
  return found;
}

/** An angle between -180 and 180 degrees. */
const shortWay = (degrees: number): number => ((((degrees + 180) % 360) + 360) % 360) - 180;

const blend = (corners: readonly Direction[], shares: readonly number[]): Direction => [
  corners.reduce((sum, corner, index) => sum + corner[0] * shares[index]!, 0),
  corners.reduce((sum, corner, index) => sum + corner[1] * shares[index]!, 0),
];

const apart = (a: Direction, b: Direction): number => (a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2;
const cross = (a: Direction, b: Direction, c: Direction): number => (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);

/** The shares of one to three corners at the point between them that is nearest to a point. */
function nearest(corners: readonly Direction[], point: Direction): number[] {
  const [a, b, c] = corners;
  if (a && b && !c) {
    const along = [b[0] - a[0], b[1] - a[1]] as const;
    const share = ((point[0] - a[0]) * along[0] + (point[1] - a[1]) * along[1]) / (along[0] ** 2 + along[1] ** 2);
    const inside = Number.isFinite(share) ? Math.min(Math.max(share, 0), 1) : 0;
    return [1 - inside, inside];
  }
  if (!a || !b || !c) return corners.map((_, index) => (index === 0 ? 1 : 0));
  const whole = cross(a, b, c);
  const shares = [cross(b, c, point) / whole, cross(c, a, point) / whole, cross(a, b, point) / whole];
  if (shares.every((share) => share >= 0)) return shares;
  const sides = [[0, 1], [1, 2], [2, 0]].map(([i, j]) => {
    const [first, second] = nearest([corners[i!]!, corners[j!]!], point);
    const all = [0, 0, 0];
    [all[i!], all[j!]] = [first!, second!];
    return all;
  });
  return sides.reduce((best, side) => (apart(blend(corners, side), point) < apart(blend(corners, best), point) ? side : best));
}

/** Where a region is on a screen that faces the viewer: right, up and towards the viewer. */
export function placeOf({ views }: Views, weights: readonly number[], places: readonly Vector3[]): Vector3 {
  const point = new Vector3();
  let depth = 0;
  const [near] = views[weights.indexOf(Math.max(...weights))] ?? [0];
  views.forEach((view, index) => {
    const place = places[index] ?? new Vector3();
    point.addScaledVector(place, weights[index]!);
    depth += weights[index]! * place.dot(axesOf(view)[2]);
  });
  const short = views.map(([theta, phi]) => [near + shortWay(theta - near), phi] as const);
  const [right, up] = axesOf(blend(short, weights));
  return new Vector3(point.dot(right), point.dot(up), FLATNESS * depth);
}

interface Region {
  readonly node: Object3D;
  readonly places: readonly Vector3[];
  readonly meshes: readonly Mesh[];
}

interface Character {
  readonly node: Object3D;
  /** How it is turned in the file. */
  readonly rest: Quaternion;
  readonly views: Views;
  readonly regions: readonly Region[];
  last: Direction | null;
}

/** The characters of a model that turn to the viewer. */
export class Turns {
  private readonly characters: Character[] = [];

  constructor(root: Object3D) {
    root.traverse((node) => {
      const views = viewsOf(node);
      if (!views) return;
      const regions = node.children.flatMap((child) => {
        const places = placesOf(child);
        if (!places) return [];
        const meshes: Mesh[] = [];
        child.traverse((below) => {
          if (!(below instanceof Mesh)) return;
          // The bounds of a mesh leave out how it is morphed.
          below.frustumCulled = false;
          meshes.push(below);
        });
        return [{ node: child, places, meshes }];
      });
      this.characters.push({ node, rest: node.quaternion.clone(), views, regions, last: null });
    });
  }

  get isEmpty(): boolean {
    return this.characters.length === 0;
  }

  /** The clips without those that turn a character, which follows the viewer. */
  others(clips: readonly AnimationClip[]): readonly AnimationClip[] {
    const turned = new Set(this.characters.flatMap(({ regions }) => regions.flatMap(({ node, meshes }) => [node, ...meshes].flatMap(({ name, uuid }) => [name, uuid]))));
    return clips.filter(({ tracks }) => tracks.length === 0 || !tracks.every(({ name }) => turned.has(name.slice(0, name.lastIndexOf(".")))));
  }

  /** Turns all characters to a viewer in a direction of the world; true if anything changed. */
  follow(towards: Vector3): boolean {
    let changed = false;
    for (const one of this.characters) {
      const { node, rest, views, regions } = one;
      node.parent?.updateWorldMatrix(true, false);
      const frame = new Matrix4().compose(node.position, rest, node.scale);
      if (node.parent) frame.premultiply(node.parent.matrixWorld);
      const direction = directionOf(towards.clone().transformDirection(frame.invert()));
      if (one.last && apart(one.last, direction) < 1e-12) continue;
      one.last = direction;
      changed = true;
      const weights = weightsOf(views, direction);
      node.quaternion.copy(rest).multiply(new Quaternion().setFromRotationMatrix(new Matrix4().makeBasis(...axesOf(direction))));
      for (const { node: region, places, meshes } of regions) {
        region.position.copy(placeOf(views, weights, places));
        for (const { morphTargetInfluences } of meshes) morphTargetInfluences?.forEach((_, index) => (morphTargetInfluences[index] = weights[index + 1] ?? 0));
      }
      node.updateMatrixWorld(true);
    }
    return changed;
  }
}

const isDirection = (value: unknown): value is Direction => Array.isArray(value) && value.length === 2 && value.every(Number.isFinite);

function viewsOf(node: Object3D): Views | null {
  const turn = wayOf(node, "turn");
  if (!turn || !("views" in turn) || !("between" in turn)) return null;
  const { views, between } = turn;
  if (!Array.isArray(views) || views.length === 0 || !views.every(isDirection) || !Array.isArray(between)) return null;
  const isSet = (set: unknown): set is number[] => Array.isArray(set) && set.length > 0 && set.length < 4 && set.every((view) => Number.isInteger(view) && view >= 0 && view < views.length);
  return between.length > 0 && between.every(isSet) ? { views, between } : null;
}

function placesOf(node: Object3D): Vector3[] | null {
  const region = wayOf(node, "region");
  if (!region || !("places" in region) || !Array.isArray(region.places)) return null;
  const isPlace = (place: unknown): place is [number, number, number] => Array.isArray(place) && place.length === 3 && place.every(Number.isFinite);
  return region.places.every(isPlace) ? region.places.map((place: [number, number, number]) => new Vector3(...place)) : null;
}
