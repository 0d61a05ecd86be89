// Handles of the selected part, over the model: arrows for how thick it is and how near, and its joint. For the pointer; the form
// has the same for the keyboard.

import { Box3, Mesh, Vector3, type Object3D } from "three";
import { fill, h, svg } from "../dom";
import type { State } from "../state";
import { isOverlay } from "../viewport/model";
import type { Viewer } from "../viewport/viewer";
import { fieldDraft } from "./draft";
import type { Editing } from "./editing";
import type { Change, Field, NumberControl, PartForm, PlaceForm, Variant } from "./messages";
import { digits, flagsOf, saying, withValue } from "./values";

type Point = readonly [x: number, y: number];
type Kind = "front" | "back" | "offset" | "joint";

/** Length of an arrow in pixels, and where its handle is: beyond its shaft. */
const ARROW = 34;
/** Below this many pixels for the whole depth of the model, a movement in depth cannot be seen, nor made. */
const SEEN = 24;
/** A joint this near to a point with a word snaps to it, in pixels. */
const SNAP = 12;
/** Corners of a mesh that are looked at to find where its faces are. */
const MAX_CORNERS = 4000;

const TITLES: Readonly<Record<Kind, string>> = {
  front: "Front: drag to make it thicker. Alt: this side alone",
  back: "Back: drag to make it thicker. Alt: this side alone",
  offset: "Offset: drag towards you or away",
  joint: "Joint: drag to where the part turns",
};

/** What a drag would make of a field, with the words for it. */
interface Dragged {
  readonly field: Field;
  readonly value: string;
  readonly label: string;
}

const dragged = (field: Field, label: string): Dragged => ({ field, value: field.value ?? "", label });

interface Handle {
  readonly kind: Kind;
  /** Where it is taken hold of. */
  readonly at: Point;
  /** Where its arrow begins. */
  readonly from: Point;
  /** What it makes of a movement of the pointer since it was taken hold of, in pixels; fine movements are smaller. */
  readonly drag: (moved: Point, event: { readonly altKey: boolean; readonly shiftKey: boolean }) => Dragged | null;
}

export class Handles {
  readonly element = h("div", { class: "handles", hidden: true, attributes: { "aria-hidden": "true" } });
  private readonly picture = svg("svg", { class: "handles-picture" });
  private readonly label = h("div", { class: "handle-label", hidden: true });
  private readonly pictures = new Map<Kind, SVGGElement>();
  private form: PartForm | null = null;
  /** The handles as they are drawn. */
  private all: readonly Handle[] = [];
  private drawn = "";
  private press: { readonly handle: Handle; readonly form: PartForm; readonly id: number; readonly at: Point; now: Dragged | null } | null = null;

  constructor(private readonly viewer: Viewer, private readonly editing: Editing, state: State) {
    fill(this.element, this.picture, this.label);
    viewer.renderLoop.beforeFrame(() => this.draw());
    editing.listen(["mode", "picking"], () => this.ask());
    state.on(["selection", "current", "hidden"], () => {
      this.stop();
      this.ask();
    });
    viewer.on(["model", "display"], () => this.ask());
    addEventListener("pointermove", (event) => this.move(event));
    addEventListener("pointerup", (event) => this.up(event));
    addEventListener("pointercancel", () => this.giveUp());
    addEventListener("keydown", (event) => {
      if (event.key !== "Escape" || !this.press) return;
      event.preventDefault();
      event.stopPropagation();
      this.giveUp();
    }, { capture: true });
  }

  /** The form of the selected part, or none. */
  show(form: PartForm | null): void {
    this.form = form;
    this.ask();
  }

  private ask(): void {
    this.drawn = "";
    this.viewer.renderLoop.ask();
  }

  /** Draws the handles where the part is in the next frame. */
  private draw(): boolean {
    const { form, viewer, editing, press } = this;
    const handles = editing.isOn && !editing.isPicking && form?.place && !viewer.view.isFilmed && !viewer.hidden.has(form.part) ? this.handles(form, form.place) : [];
    const all = press ? handles.filter(({ kind }) => kind === press.handle.kind) : handles;
    this.element.hidden = all.length === 0;
    const drawn = all.map(({ kind, at, from }) => [kind, ...at, ...from].map((one) => (typeof one === "number" ? one.toFixed(1) : one)).join(" ")).join();
    if (drawn === this.drawn) return false;
    this.drawn = drawn;
    this.all = all;
    const shown = all.map((handle) => this.place(handle));
    for (const old of [...this.picture.children]) if (!shown.some((one) => one === old)) old.remove();
    for (const one of shown) if (one.parentNode !== this.picture) this.picture.append(one);
    return false;
  }

  /** Puts the picture of a handle where it belongs. It stays the same element, which keeps a finger that is on it. */
  private place({ kind, at: [x, y], from: [left, top] }: Handle): SVGGElement {
    const shown = this.pictures.get(kind) ?? this.drawnFor(kind);
    const [dx, dy] = kind === "joint" ? [0, 0] : unit([x - left, y - top]);
    const tip = (side: 1 | -1, px: number, py: number): string => `M${px - side * dx * 9 - dy * 5} ${py - side * dy * 9 + dx * 5}L${px} ${py}L${px - side * dx * 9 + dy * 5} ${py - side * dy * 9 - dx * 5}`;
    const shape = kind === "joint" ? `M${x - 8} ${y}H${x + 8}M${x} ${y - 8}V${y + 8}` : `M${left} ${top}L${x} ${y}${tip(1, x, y)}${kind === "offset" ? tip(-1, left, top) : ""}`;
    const [gripX, gripY] = kind === "offset" ? [(x + left) / 2, (y + top) / 2] : [x - dx * 6, y - dy * 6];
    for (const path of shown.querySelectorAll("path")) path.setAttribute("d", shape);
    for (const circle of shown.querySelectorAll("circle")) {
      circle.setAttribute("cx", String(circle.classList.contains("handle-ring") ? x : gripX));
      circle.setAttribute("cy", String(circle.classList.contains("handle-ring") ? y : gripY));
    }
    return shown;
  }

  private drawnFor(kind: Kind): SVGGElement {
    const title = svg("title", {});
    title.textContent = TITLES[kind];
    const group = svg("g", { class: `handle handle-${kind}`, "data-handle": kind });
    group.append(title, svg("path", { class: "handle-halo" }), svg("path", { class: "handle-line" }));
    if (kind === "joint") group.append(svg("circle", { class: "handle-ring", r: 6 }));
    group.append(svg("circle", { class: "handle-grip", r: 14 }));
    group.addEventListener("pointerdown", (event) => this.down(event, kind));
    this.pictures.set(kind, group);
    return group;
  }

  /** All handles of a part, as it is in the model now. */
  private handles(form: PartForm, place: PlaceForm): Handle[] {
    const node = this.viewer.parts.nodesOf(form.part)[0];
    const model = this.viewer.model;
    if (!node || !model) return [];
    node.updateWorldMatrix(true, false);
    const seen = (point: Vector3): Point | null => {
      const at = this.viewer.view.onScreen(point);
      const { clientWidth, clientHeight } = this.viewer.canvas;
      return at && [at.x * clientWidth, at.y * clientHeight];
    };
    const way = (direction: readonly number[]): Vector3 => new Vector3(direction[0], direction[1], direction[2]).transformDirection(node.matrixWorld).multiplyScalar(place.meters);
    const joint = new Vector3().setFromMatrixPosition(node.matrixWorld);
    const box = boxOf(node, model.meshesOf(node));
    const reach = model.box.getSize(new Vector3()).length() / place.meters;
    const all: Handle[] = [];
    const shown = (point: Vector3, direction: Vector3): { readonly at: Point; readonly perUnit: Point } | null => {
      const step = reach / 20;
      const [at, ahead] = [seen(point), seen(point.clone().addScaledVector(direction, step))];
      return at && ahead && { at, perUnit: [(ahead[0] - at[0]) / step, (ahead[1] - at[1]) / step] };
    };
    const front = way(place.front);
    if (!box.isEmpty()) {
      const axis = new Vector3(...place.front);
      const middle = box.getCenter(new Vector3());
      const half = box.getSize(new Vector3()).dot(new Vector3(Math.abs(axis.x), Math.abs(axis.y), Math.abs(axis.z))) / 2;
      const inWorld = (local: Vector3): Vector3 => local.applyMatrix4(node.matrixWorld);
      for (const [kind, side] of [["front", 1], ["back", -1]] as const) {
        const found = shown(inWorld(middle.clone().addScaledVector(axis, side * half)), front);
        const depths = this.depths(form, kind, half / place.meters);
        if (!found || !depths || far(found.perUnit) * reach < SEEN) continue;
        const [ux, uy] = unit(found.perUnit);
        const from: Point = [found.at[0] + side * ux * 4, found.at[1] + side * uy * 4];
        all.push({ kind, from, at: [from[0] + side * ux * ARROW, from[1] + side * uy * ARROW], drag: (moved, event) => depths(along(moved, found.perUnit) * (event.shiftKey ? 0.1 : 1), event.altKey) });
      }
      const offset = form.fields.find(({ attribute }) => attribute === "Offset");
      const side = new Vector3(...place.up).multiplyScalar(box.getSize(new Vector3()).dot(new Vector3(...place.up.map(Math.abs) as [number, number, number])) / 2);
      const found = shown(inWorld(middle.clone().add(side)), front);
      const moves = offset && this.offset(offset);
      if (found && moves && far(found.perUnit) * reach >= SEEN) {
        const [ux, uy] = unit(found.perUnit);
        const [x, y] = found.at;
        all.push({ kind: "offset", from: [x - (ux * ARROW) / 2, y - (uy * ARROW) / 2 - 14], at: [x + (ux * ARROW) / 2, y + (uy * ARROW) / 2 - 14], drag: (moved, event) => moves(along(moved, found.perUnit) * (event.shiftKey ? 0.1 : 1)) });
      }
    }
    const [right, up] = [shown(joint, way(place.right)), shown(joint, way(place.up))];
    const origin = form.fields.find(({ attribute }) => attribute === "Origin");
    if (right && up && origin && form.parent !== null) {
      const [a, b] = [right.perUnit, up.perUnit];
      const area = a[0] * b[1] - a[1] * b[0];
      // Seen from the side, a point of the drawing's plane cannot be told from others.
      if (Math.abs(area) > 0.2 * far(a) * far(b)) {
        const drag: Handle["drag"] = ([mx, my], { shiftKey }) => {
          const fine = shiftKey ? 0.1 : 1;
          const [across, high] = [((mx * b[1] - my * b[0]) / area) * fine, ((a[0] * my - a[1] * mx) / area) * fine];
          const at: Point = [place.joint[0] + across, place.joint[1] - high];
          const near = place.points.find(({ at: [x, y] }) => far([(x - at[0]) * a[0] - (y - at[1]) * b[0], (x - at[0]) * a[1] - (y - at[1]) * b[1]]) < SNAP);
          const says = (value: string, label: string): Dragged => dragged({ ...origin, value, from: "own" }, `joint: ${label}`);
          if (near) return says(near.word, near.word);
          const step = 1 / Math.max(far(a), 1e-6);
          const [x, y] = at.map((one) => digits(one, Math.min(step, 1)));
          return says(`${x} ${y}`, `${x}, ${y}`);
        };
        all.push({ kind: "joint", at: right.at, from: right.at, drag });
      }
    }
    return all;
  }

  /** What a movement in depth makes of the back and the front, which are so far from the middle between them; null for kinds that have none. */
  private depths(form: PartForm, kind: "front" | "back", half: number): ((by: number, alone: boolean) => Dragged | null) | null {
    const shape = form.fields.find(({ attribute }) => attribute === "Shape");
    const chosen = shape?.chosen ?? -1;
    const variant = shape?.variants[chosen];
    if (!shape || !variant) return null;
    const moves = (by: number, alone: boolean) => ({ back: kind === "back" ? by : alone ? 0 : -by, front: kind === "front" ? by : alone ? 0 : -by });
    const says = (values: string[], label: string): Dragged => dragged(saying(shape, chosen, values, flagsOf(shape)), label);
    /** Two arguments, of which the first is smaller: it is not turned inside out. */
    const two = (back: Depth, low: string, front: Depth, high: string, unit: string): Dragged | null => {
      if (Number(low) >= Number(high)) return null;
      const both = { ...variant, arguments: variant.arguments.map((argument, at) => (at === back.at ? { ...argument, value: low } : argument)) };
      return says(withValue(both, front.at, high), `back ${low}${unit} · front ${high}${unit}`);
    };
    const height = depthOf(variant, "h");
    if (height) {
      // It comes out as far on either side.
      return (by) => {
        const high = digits(Math.max((variant.arguments[height.at]?.value === null ? half : height.now) + (kind === "front" ? by : -by), height.takes.step), height.takes.step);
        return says(withValue(variant, height.at, high), `to both sides ${high}`);
      };
    }
    const [z0, z1] = [depthOf(variant, "z0"), depthOf(variant, "z1")];
    if (z0 && z1) {
      return (by, alone) => {
        const { back, front } = moves(by, alone);
        return two(z0, digits(z0.now + back, z0.takes.step), z1, digits(z1.now + front, z1.takes.step), "");
      };
    }
    // Of a rounding, angles say how much of it is kept.
    const [a0, a1] = [depthOf(variant, "a0"), depthOf(variant, "a1")];
    if (!a0 || !a1) return null;
    const radius = (2 * half) / (sine(a1.now) - sine(a0.now));
    if (!(radius > 0)) return null;
    const angle = ({ now, takes }: Depth, by: number): string => (by === 0 ? String(now) : digits(degrees(sine(now) + by / radius), Math.max(takes.step, 1)));
    return (by, alone) => {
      const { back, front } = moves(by, alone);
      return two(a0, angle(a0, back), a1, angle(a1, front), "°");
    };
  }

  private offset(field: Field): ((by: number) => Dragged) | null {
    const variant = field.variants[0];
    const takes = variant?.arguments[0]?.takes;
    if (!variant || takes?.type !== "number") return null;
    const now = Number(variant.arguments[0]?.value ?? takes.start ?? 0);
    return (by) => {
      const value = digits(now + by, takes.step);
      return dragged(saying(field, 0, [value], flagsOf(field)), `offset ${value}`);
    };
  }

  private down(event: PointerEvent, kind: Kind): void {
    const handle = this.all.find((one) => one.kind === kind);
    if (event.button !== 0 || !this.form || !handle || this.press) return;
    event.preventDefault();
    event.stopPropagation();
    this.press = { handle, form: this.form, id: event.pointerId, at: [event.clientX, event.clientY], now: null };
    this.viewer.view.turns = false;
    this.element.dataset["drags"] = handle.kind;
    this.ask();
  }

  private move(event: PointerEvent): void {
    const { press } = this;
    if (!press || event.pointerId !== press.id) return;
    const dragged = press.handle.drag([event.clientX - press.at[0], event.clientY - press.at[1]], event);
    if (!dragged || dragged.value === press.now?.value) return;
    press.now = dragged;
    const { left, top } = this.viewer.canvas.getBoundingClientRect();
    this.label.hidden = false;
    this.label.textContent = dragged.label;
    const { offsetWidth } = this.label;
    this.label.style.transform = `translate(${Math.min(event.clientX - left + 16, this.viewer.canvas.clientWidth - offsetWidth - 6)}px, ${Math.max(event.clientY - top - 34, 6)}px)`;
    this.editing.attempt(press.form, setting(press.form, dragged));
  }

  private up(event: PointerEvent): void {
    const { press } = this;
    if (!press || event.pointerId !== press.id) return;
    const { now, form } = press;
    this.stop();
    if (!now) return;
    fieldDraft(form, now.field).say(now.field);
    void this.editing.make(form, setting(form, now));
  }

  private giveUp(): void {
    if (!this.press) return;
    this.stop();
    this.editing.giveUp();
  }

  private stop(): void {
    if (!this.press) return;
    this.press = null;
    this.viewer.view.turns = true;
    this.label.hidden = true;
    delete this.element.dataset["drags"];
    this.ask();
  }
}

const setting = (form: PartForm, { field, value }: Dragged): Change => ({ change: "set", part: form.part, attribute: field.attribute, value });

const sine = (degrees: number): number => Math.sin((degrees * Math.PI) / 180);
const degrees = (sine: number): number => (Math.asin(Math.min(Math.max(sine, -1), 1)) * 180) / Math.PI;

/** An argument that says how far a part reaches, as it is. */
interface Depth {
  readonly at: number;
  readonly now: number;
  readonly takes: NumberControl;
}

/** The number of an argument as it is, written or not. */
function depthOf(variant: Variant, name: string): Depth | null {
  const at = variant.arguments.findIndex((argument) => argument.name === name);
  const argument = variant.arguments[at];
  if (!argument || argument.takes.type !== "number") return null;
  const now = argument.value === null ? argument.takes.start : Number(argument.value);
  return now === null || !Number.isFinite(now) ? null : { at, now, takes: argument.takes };
}

/** The bounds of a node's own meshes in its frame, without those of parts that hang on it. */
function boxOf(node: Object3D, meshes: readonly Mesh[]): Box3 {
  const box = new Box3();
  const inverse = node.matrixWorld.clone().invert();
  const corner = new Vector3();
  for (const mesh of meshes) {
    if (isOverlay(mesh)) continue;
    const { count } = mesh.geometry.getAttribute("position");
    const every = Math.max(Math.ceil(count / MAX_CORNERS), 1);
    for (let at = 0; at < count; at += every) box.expandByPoint(mesh.getVertexPosition(at, corner).applyMatrix4(mesh.matrixWorld).applyMatrix4(inverse));
  }
  return box;
}

const far = ([x, y]: Point): number => Math.hypot(x, y);

function unit(point: Point): Point {
  const length = far(point);
  return length > 0 ? [point[0] / length, point[1] / length] : [0, -1];
}

/** How many units along a direction a movement goes; `perUnit` is one of them, in pixels. */
const along = ([x, y]: Point, perUnit: Point): number => (x * perUnit[0] + y * perUnit[1]) / far(perUnit) ** 2;
