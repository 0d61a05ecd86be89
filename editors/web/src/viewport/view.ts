// The camera: orbit, named views, perspective and parallel projection, framing; or a camera of the model.

import { Box3, Matrix4, OrthographicCamera, PerspectiveCamera, Spherical, Vector3 } from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { prefersReducedMotion } from "../dom";
import { cornersOf } from "./bend";

/** Degrees to the model's left and up, as for `okoshi render --view`. */
export const VIEWS = {
  threeQuarter: [30, 15],
  front: [0, 0],
  back: [180, 0],
  side: [90, 0],
  otherSide: [-90, 0],
  top: [0, 90],
  bottom: [0, -90],
  /** The view of tile maps in role-playing games: tops and fronts. */
  drawn: [0, 45],
} as const satisfies Record<string, readonly [number, number]>;
export type ViewName = keyof typeof VIEWS;

const FIELD = 30;
/** Duration of a camera movement, in milliseconds. */
const MOVE = 220;
/** The size of the picture relative to the framed model. */
const MARGIN = 1.16;
/** From exactly above or below, left and right would be undefined: cameras keep this distance from the poles, in radians. */
const POLE = 1e-4;

export class View {
  private readonly perspective = new PerspectiveCamera(FIELD, 1, 0.1, 100);
  private readonly parallel = new OrthographicCamera(-1, 1, 1, -1, 0.1, 100);
  /** Stands where a camera of the model is, while the page looks through one. */
  private readonly lens = new PerspectiveCamera();
  private readonly controls: OrbitControls;
  private readonly listeners: (() => void)[] = [];
  private readonly box = new Box3(new Vector3(-1, -1, -1), new Vector3(1, 1, 1));
  private points: (towards: Vector3) => Vector3[] = () => cornersOf(this.box);
  private aspect = 1;
  private animation = 0;
  /** The camera that the user moves. */
  private own: PerspectiveCamera | OrthographicCamera = this.perspective;
  /** The vertical field of view of the model's camera, in degrees. */
  private filmed = 0;
  /** Where it is. */
  private readonly filmedAt = new Matrix4();
  /** Whether the user's camera is being put where the model's is. */
  private joins = false;
  /** The camera of the picture. */
  camera: PerspectiveCamera | OrthographicCamera = this.own;
  /** Called when the user moves the view away from the model's camera. */
  leftFilm: () => void = () => {};

  constructor(canvas: HTMLElement) {
    this.perspective.position.set(2, 1, 3);
    this.controls = new OrbitControls(this.own, canvas);
    this.controls.zoomToCursor = true;
    this.controls.addEventListener("start", () => {
      this.stop();
      if (this.isFilmed) this.join();
    });
    this.controls.addEventListener("change", () => {
      if (this.joins) return;
      if (this.isFilmed) this.leave();
      else this.changed();
    });
  }

  onChange(listener: () => void): void {
    this.listeners.push(listener);
  }

  /** Whether the pointer turns the view. */
  set turns(on: boolean) {
    this.controls.enabled = on;
  }

  get isParallel(): boolean {
    return this.camera === this.parallel;
  }

  /** Whether the picture is that of a camera of the model. */
  get isFilmed(): boolean {
    return this.camera === this.lens;
  }

  get target(): Vector3 {
    return this.controls.target;
  }

  /**
   * The camera as text: target, position, height of the picture at the target, projection. A camera of the model: position, direction to the
   * viewer, vertical field of view in degrees, `filmed`.
   */
  describe(): string {
    if (this.isFilmed) {
      const { position, fov } = this.lens;
      return `${[...position.toArray(), ...this.towards().toArray(), fov].map((one) => Number(one.toPrecision(6))).join(" ")} filmed`;
    }
    const numbers = [...this.controls.target.toArray(), ...this.camera.position.toArray(), this.height()];
    return `${numbers.map((one) => Number(one.toPrecision(6))).join(" ")} ${this.isParallel ? "parallel" : "perspective"}`;
  }

  /** The direction from which the user's camera looks: degrees to the model's left, and up. */
  angles(): [number, number] {
    const { theta, phi } = new Spherical().setFromVector3(this.own.position.clone().sub(this.controls.target));
    return [(theta * 180) / Math.PI, 90 - (phi * 180) / Math.PI];
  }

  resize(aspect: number): void {
    this.aspect = aspect;
    this.perspective.aspect = aspect;
    const half = (this.parallel.top - this.parallel.bottom) / 2;
    this.parallel.left = -half * aspect;
    this.parallel.right = half * aspect;
    this.fitLens();
    this.changed();
  }

  /** Looks through a camera of the model where it is now; null looks through the user's own camera, which is where it was. */
  film(camera: PerspectiveCamera | null): void {
    if (!camera && !this.isFilmed) return;
    if (camera) {
      this.stop();
      camera.updateWorldMatrix(true, false);
      // A held camera is not drawn again.
      if (this.isFilmed && camera.fov === this.filmed && camera.matrixWorld.equals(this.filmedAt)) return;
      this.filmedAt.copy(camera.matrixWorld);
      camera.matrixWorld.decompose(this.lens.position, this.lens.quaternion, new Vector3());
      this.filmed = camera.fov;
      this.fitLens();
    }
    this.camera = camera ? this.lens : this.own;
    this.changed();
  }

  /** Sets the bounding box of the scene, and points around it if these depend on the view. The camera stays. */
  bound(box: Box3, points: ((towards: Vector3) => Vector3[]) | null = null): void {
    this.box.copy(box);
    this.points = points ?? (() => cornersOf(this.box));
    this.changed();
  }

  /** Moves until the whole scene is in the picture, from the current direction or a named view. */
  frame(name?: ViewName, moves = true): void {
    this.takeOver();
    const direction = name ? directionOf(VIEWS[name]) : this.direction();
    this.frameFrom(direction, this.points(direction), moves);
  }

  /** Moves until a box is in the picture, from the current direction. */
  frameBox(box: Box3): void {
    this.takeOver();
    this.frameFrom(this.direction(), cornersOf(box), true);
  }

  private frameFrom(direction: Vector3, points: readonly Vector3[], moves: boolean): void {
    const center = new Box3().setFromPoints([...points]).getCenter(new Vector3());
    this.go(direction, center, this.distanceFor(direction, center, points), moves);
  }

  /** Remembers target and distance. The returned function goes back to them, from the direction of that time. */
  rememberPlace(): () => void {
    const target = this.controls.target.clone();
    const distance = this.distance();
    return () => this.go(this.direction(), target, distance, true);
  }

  /** Remembers direction, target and distance. The returned function goes back to them. */
  remember(): () => void {
    const back = { direction: this.direction(), target: this.controls.target.clone(), distance: this.distance() };
    return () => this.go(back.direction, back.target, back.distance, true);
  }

  /** Whether the camera looks exactly from a named view. */
  isAt(name: ViewName): boolean {
    return this.direction().dot(directionOf(VIEWS[name])) > 1 - 1e-9;
  }

  /** The position of a point in the picture: fractions of its width from the left and of its height from above. Null behind the camera. */
  onScreen(place: Vector3): { readonly x: number; readonly y: number } | null {
    const at = place.clone().project(this.camera);
    return at.z > 1 ? null : { x: (at.x + 1) / 2, y: (1 - at.y) / 2 };
  }

  /** Moves target and camera alike. */
  shift(by: Vector3): void {
    if (by.lengthSq() > 0) this.place(this.direction(), this.controls.target.clone().add(by), this.distance());
  }

  /** Looks from the named view; distance and target stay. */
  look(name: ViewName): void {
    this.takeOver();
    this.go(directionOf(VIEWS[name]), this.controls.target.clone(), this.distance(), true);
  }

  /** Turns by degrees, to the right and up. */
  orbit(right: number, up: number): void {
    this.takeOver();
    this.stop();
    const at = new Spherical().setFromVector3(this.direction());
    at.theta += (right * Math.PI) / 180;
    at.phi = clamp(at.phi - (up * Math.PI) / 180, POLE, Math.PI - POLE);
    this.place(new Vector3().setFromSpherical(at), this.controls.target, this.distance());
  }

  zoom(factor: number): void {
    this.takeOver();
    this.stop();
    this.place(this.direction(), this.controls.target, this.distance() / factor);
  }

  /** Changes the projection; things at the target keep their size. */
  setParallel(parallel: boolean): void {
    if (parallel === this.isParallel) return;
    this.takeOver();
    const direction = this.direction();
    const distance = this.distance();
    this.camera = this.own = parallel ? this.parallel : this.perspective;
    this.controls.object = this.own;
    this.place(direction, this.controls.target, distance);
  }

  private direction(): Vector3 {
    const direction = this.own.position.clone().sub(this.controls.target);
    return direction.lengthSq() > 0 ? direction.normalize() : new Vector3(0, 0, 1);
  }

  /** The height of the picture at the target, in metres. */
  private height(): number {
    if (this.own === this.parallel) return (this.parallel.top - this.parallel.bottom) / this.parallel.zoom;
    return 2 * this.own.position.distanceTo(this.controls.target) * Math.tan((FIELD * Math.PI) / 360);
  }

  /** The distance at which a perspective camera shows the same height. */
  private distance(): number {
    return this.height() / (2 * Math.tan((FIELD * Math.PI) / 360));
  }

  /** The smallest distance at which all points are in the picture. */
  private distanceFor(direction: Vector3, center: Vector3, points: readonly Vector3[]): number {
    const turn = new PerspectiveCamera();
    turn.position.copy(direction);
    turn.lookAt(0, 0, 0);
    const inverse = turn.quaternion.clone().invert();
    const up = Math.tan((FIELD * Math.PI) / 360) / MARGIN;
    let distance = 1e-6;
    for (const point of points) {
      const at = point.clone().sub(center).applyQuaternion(inverse);
      distance = Math.max(distance, at.z + Math.abs(at.y) / up, at.z + Math.abs(at.x) / (up * this.aspect));
    }
    return distance;
  }

  private go(direction: Vector3, target: Vector3, distance: number, moves: boolean): void {
    this.stop();
    if (!moves || prefersReducedMotion()) return this.place(direction, target, distance);
    const from = { direction: this.direction(), target: this.controls.target.clone(), distance: this.distance() };
    const turn = turnBetween(from.direction, direction);
    const began = performance.now();
    const step = (now: number): void => {
      const t = clamp((now - began) / MOVE, 0, 1);
      const eased = 1 - (1 - t) ** 3;
      if (t === 1) {
        this.animation = 0;
        return this.place(direction, target, distance);
      }
      this.place(turn(eased), from.target.clone().lerp(target, eased), from.distance * (distance / from.distance) ** eased);
      this.animation = requestAnimationFrame(step);
    };
    this.animation = requestAnimationFrame(step);
  }

  private stop(): void {
    cancelAnimationFrame(this.animation);
    this.animation = 0;
  }

  /** Towards the viewer. */
  private towards(): Vector3 {
    return new Vector3(0, 0, 1).applyQuaternion(this.camera.quaternion);
  }

  /** Fits the framing of the model's camera into the page: what it shows in a square is in the picture, however wide or high that is. */
  private fitLens(): void {
    this.lens.aspect = this.aspect;
    const half = Math.tan((this.filmed * Math.PI) / 360) / Math.min(this.aspect, 1);
    this.lens.fov = (Math.atan(half) * 360) / Math.PI;
  }

  /** Puts the user's camera where the model's is; things in the middle of the model keep their size. */
  private join(): void {
    const { position, fov } = this.lens;
    const towards = this.towards();
    const reach = this.box.getSize(new Vector3()).length();
    const away = Math.max(position.clone().sub(this.box.getCenter(new Vector3())).dot(towards), reach * 0.02);
    const target = position.clone().addScaledVector(towards, -away);
    this.joins = true;
    this.aim(towards, target, (away * Math.tan((fov * Math.PI) / 360)) / Math.tan((FIELD * Math.PI) / 360));
    this.joins = false;
  }

  /** The user's camera takes over from the model's. */
  private takeOver(): void {
    if (!this.isFilmed) return;
    this.join();
    this.leave();
  }

  private leave(): void {
    this.camera = this.own;
    this.changed();
    this.leftFilm();
  }

  private place(direction: Vector3, target: Vector3, distance: number): void {
    this.aim(direction, target, distance);
    this.changed();
  }

  /** Places the user's camera. */
  private aim(direction: Vector3, target: Vector3, distance: number): void {
    this.controls.target.copy(target);
    this.own.position.copy(target).addScaledVector(direction, distance);
    if (this.own === this.parallel) {
      const half = distance * Math.tan((FIELD * Math.PI) / 360);
      this.parallel.top = half;
      this.parallel.bottom = -half;
      this.parallel.left = -half * this.aspect;
      this.parallel.right = half * this.aspect;
      this.parallel.zoom = 1;
    }
    this.controls.update();
  }

  /** Sets the near and far planes around the model and its ground. */
  private changed(): void {
    const reach = this.box.getSize(new Vector3()).length();
    const center = this.box.getCenter(new Vector3());
    const away = this.camera.position.distanceTo(center);
    this.camera.far = away + reach * 10;
    // The parallel camera also shows what is behind it: it may be inside a wide model. The other one's near plane is as far away as the
    // least distance from the target allows: depth is the coarser the nearer it is, and the regions of characters are close together.
    this.camera.near = this.isParallel ? -reach * 10 : Math.max((away - reach * 10) / 2, this.camera.far / 2_000);
    this.controls.minDistance = reach * 0.01;
    this.controls.maxDistance = reach * 50;
    this.camera.updateProjectionMatrix();
    this.camera.updateMatrixWorld();
    for (const listener of this.listeners) listener();
  }
}

export const clamp = (value: number, least: number, most: number): number => Math.min(Math.max(value, least), most);

/** The direction of the camera, for degrees to the model's left and up. */
export function directionOf([yaw, pitch]: readonly [number, number]): Vector3 {
  const phi = clamp(((90 - pitch) * Math.PI) / 180, POLE, Math.PI - POLE);
  return new Vector3().setFromSphericalCoords(1, phi, (yaw * Math.PI) / 180);
}

/** Interpolates directions: around the vertical axis the shorter way, never over a pole. */
function turnBetween(from: Vector3, to: Vector3): (t: number) => Vector3 {
  const a = new Spherical().setFromVector3(from);
  const b = new Spherical().setFromVector3(to);
  const around = Math.atan2(Math.sin(b.theta - a.theta), Math.cos(b.theta - a.theta));
  return (t) => new Vector3().setFromSphericalCoords(1, clamp(a.phi + (b.phi - a.phi) * t, POLE, Math.PI - POLE), a.theta + around * t);
}
