// Runs in a page of its own: a landscape in three.js with one sun and its shadows, seen from straight above.

import {
  Box3,
  BoxGeometry,
  DirectionalLight,
  FloatType,
  Mesh,
  MeshStandardMaterial,
  OrthographicCamera,
  Raycaster,
  Scene,
  Sphere,
  Vector3,
  WebGLRenderer,
  WebGLRenderTarget,
  type Intersection,
  type Material,
  type Object3D,
} from "three";
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";

/** The brightness of a material's tops that the sun reaches, and of those of a box, one number a pixel. */
export interface Tops {
  readonly name: string;
  readonly tops: readonly number[];
  readonly box: readonly number[];
}

declare global {
  interface Window {
    tops(glb: string): Promise<Tops[]>;
  }
}

/** Pixels a side. */
const SIDE = 80;
const SUN = new Vector3(0.35, 1, 0.45).normalize();
const DOWN = new Vector3(0, -1, 0);
/** Shadow maps shade what they are made of unless it is moved by this, of their depth. */
const BIAS = -5e-4;

/** The places of a pixel that are looked at, from its middle, in pixels. */
const PLACES = [[0, 0], [-0.7, -0.7], [0.7, -0.7], [-0.7, 0.7], [0.7, 0.7]] as const;

/** The meshes below an object. */
function meshes(object: Object3D): Mesh[] {
  const found: Mesh[] = [];
  object.traverse((one) => {
    if (one instanceof Mesh) found.push(one);
  });
  return found;
}

const materials = (mesh: Mesh): Material[] => [mesh.material].flat();

/** Whether a material shows its colour alone, and is lit. */
const isPlain = (material: Material): material is MeshStandardMaterial => material instanceof MeshStandardMaterial && !material.map;

/** A row of boxes beside the model, one of each material without a texture. */
function addBoxes(scene: Scene, model: Object3D): Set<Object3D> {
  const bounds = new Box3().setFromObject(model);
  const size = bounds.getSize(new Vector3());
  const side = Math.max(size.x, size.z) / 12;
  const plain = new Set(meshes(model).flatMap(materials).filter(isPlain));
  const boxes = [...plain].map((material, at) => {
    const box = new Mesh(new BoxGeometry(side, side, side), material);
    box.position.set(bounds.max.x + 2 * side, bounds.min.y + side / 2, bounds.min.z + side * (0.5 + 1.6 * at));
    return box;
  });
  scene.add(...boxes);
  return new Set(boxes);
}

/** What is met first. */
function hit(ray: Raycaster, from: Vector3, towards: Vector3, things: Object3D[]): Intersection<Mesh> | undefined {
  ray.set(from, towards);
  return ray.intersectObjects<Mesh>(things, false)[0];
}

window.tops = async (glb) => {
  const bytes = Uint8Array.from(atob(glb), (letter) => letter.charCodeAt(0));
  const { scene: model } = await new GLTFLoader().parseAsync(bytes.buffer, "");
  const scene = new Scene();
  scene.add(model);
  scene.updateMatrixWorld(true);
  const boxes = addBoxes(scene, model);
  scene.updateMatrixWorld(true);
  const things = meshes(scene);
  for (const one of things) one.castShadow = one.receiveShadow = true;
  const bounds = new Box3().setFromObject(scene);
  const { center, radius } = bounds.getBoundingSphere(new Sphere());

  const sun = new DirectionalLight(0xffffff, 3);
  sun.position.copy(center).addScaledVector(SUN, 2 * radius);
  sun.target.position.copy(center);
  sun.castShadow = true;
  sun.shadow.mapSize.set(2048, 2048);
  sun.shadow.bias = BIAS;
  Object.assign(sun.shadow.camera, { left: -radius, right: radius, top: radius, bottom: -radius, near: radius / 2, far: 4 * radius });
  scene.add(sun, sun.target);

  const half = 0.525 * Math.max(bounds.max.x - bounds.min.x, bounds.max.z - bounds.min.z);
  const camera = new OrthographicCamera(-half, half, half, -half, 0, 4 * radius);
  camera.position.set((bounds.min.x + bounds.max.x) / 2, bounds.max.y + radius, (bounds.min.z + bounds.max.z) / 2);
  camera.up.set(0, 0, -1);
  camera.lookAt(camera.position.clone().add(DOWN));
  const renderer = new WebGLRenderer();
  renderer.shadowMap.enabled = true;
  // What is drawn into a target of floats stays linear.
  const target = new WebGLRenderTarget(SIDE, SIDE, { type: FloatType });
  renderer.setRenderTarget(target);
  renderer.render(scene, camera);
  const pixels = new Float32Array(4 * SIDE * SIDE);
  renderer.readRenderTargetPixels(target, 0, 0, SIDE, SIDE, pixels);
  renderer.dispose();

  const ray = new Raycaster();
  const step = (2 * half) / SIDE;
  const found = new Map<Material, { tops: number[]; box: number[] }>();
  for (let row = 0; row < SIDE; row++) {
    for (let column = 0; column < SIDE; column++) {
      const x = camera.position.x + (column + 0.5 - SIDE / 2) * step;
      // The rows of a target begin at the bottom.
      const z = camera.position.z - (row + 0.5 - SIDE / 2) * step;
      // All of the pixel has to show the same top, and the sun has to reach it.
      const below = (a: number, b: number) => hit(ray, new Vector3(x + a * step, camera.position.y, z + b * step), DOWN, things);
      const first = below(0, 0);
      const material = first && materials(first.object)[first.face?.materialIndex ?? 0];
      if (!material || !isPlain(material)) continue;
      const isLit = ([a, b]: readonly [number, number]): boolean => {
        const one = below(a, b);
        if (one?.object !== first.object || Math.abs(one.point.y - first.point.y) > 1e-4 * radius) return false;
        const up = one.face?.normal.clone().transformDirection(one.object.matrixWorld).y ?? 0;
        return up > 0.999 && !hit(ray, one.point.clone().addScaledVector(SUN, 2e-4 * radius), SUN, things);
      };
      if (!PLACES.every(isLit)) continue;
      const at = 4 * (row * SIDE + column);
      const brightness = (pixels[at]! + pixels[at + 1]! + pixels[at + 2]!) / 3;
      let lists = found.get(material);
      if (!lists) found.set(material, (lists = { tops: [], box: [] }));
      (boxes.has(first.object) ? lists.box : lists.tops).push(brightness);
    }
  }
  return [...found].map(([{ name }, { tops, box }]) => ({ name, tops, box }));
};
