// Light. A surface that faces the viewer is seen in very nearly its own colour, others a little darker; nothing is burnt out.

import {
  BackSide,
  BufferAttribute,
  Color,
  DirectionalLight,
  Group,
  HemisphereLight,
  Mesh,
  MeshBasicMaterial,
  PlaneGeometry,
  PMREMGenerator,
  Scene,
  SphereGeometry,
  type Camera,
  type WebGLRenderer,
} from "three";

// In three.js a light of intensity π gives a matt surface that faces it exactly its own colour.
const OWN = Math.PI;
const SKY = 0.5 * OWN;
const GROUND = 0.3 * OWN;
const KEY = 0.45 * OWN;
const FILL = 0.12 * OWN;
/** How much of the surroundings shows in metal and in what is smooth. */
const SURROUNDINGS = 0.35;

export class Lights {
  /** The lights that turn with the viewer, as a photographer's do who walks round a thing. */
  private readonly rig = new Group();

  constructor(scene: Scene, renderer: WebGLRenderer) {
    scene.add(new HemisphereLight(0xffffff, new Color().setScalar(GROUND / SKY), SKY), this.rig);
    for (const one of [lamp(KEY, -0.45, 0.55, 0.85), lamp(FILL, 0.8, 0.1, 0.5)]) this.rig.add(one, one.target);
    const generator = new PMREMGenerator(renderer);
    scene.environment = generator.fromScene(surroundings(), 0.03).texture;
    scene.environmentIntensity = SURROUNDINGS;
    generator.dispose();
  }

  follow(camera: Camera): void {
    this.rig.quaternion.copy(camera.quaternion);
    this.rig.updateMatrixWorld();
  }
}

function lamp(intensity: number, x: number, y: number, z: number): DirectionalLight {
  const light = new DirectionalLight(0xffffff, intensity);
  light.position.set(x, y, z);
  return light;
}

/** A grey room, lighter above, with three bright cloths: what metal mirrors. */
function surroundings(): Scene {
  const scene = new Scene();
  const dome = new SphereGeometry(10, 32, 16);
  const heights = dome.getAttribute("position");
  const colors = new Float32Array(heights.count * 3);
  for (let i = 0; i < heights.count; i++) colors.fill(0.35 + 0.35 * (0.5 + heights.getY(i) / 20), i * 3, i * 3 + 3);
  dome.setAttribute("color", new BufferAttribute(colors, 3));
  scene.add(new Mesh(dome, new MeshBasicMaterial({ side: BackSide, vertexColors: true })));
  for (const [x, y, z, size, brightness] of [[-5, 6, 5, 5, 6], [7, 2, 3, 3, 3], [0, 4, -8, 6, 3]] as const) {
    const cloth = new Mesh(new PlaneGeometry(size, size), new MeshBasicMaterial({ color: new Color().setScalar(brightness) }));
    cloth.position.set(x, y, z);
    cloth.lookAt(0, 0, 0);
    scene.add(cloth);
  }
  return scene;
}
