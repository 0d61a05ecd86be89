// Lights. A surface that faces the viewer has very nearly its own colour, others are a little darker; nothing is overexposed.

import {
  BackSide,
  BufferAttribute,
  Color,
  DirectionalLight,
  Group,
  HemisphereLight,
  LightProbe,
  Mesh,
  MeshBasicMaterial,
  PlaneGeometry,
  PMREMGenerator,
  Raycaster,
  Scene,
  SphereGeometry,
  SphericalHarmonics3,
  Vector3,
  type Camera,
  type MeshStandardMaterial,
  type Texture,
  type WebGLRenderer,
} from "three";

// In three.js a light of intensity π gives a matt surface that faces it exactly its own colour.
const OWN = Math.PI;
const SKY = 0.5 * OWN;
const GROUND = 0.3 * OWN;
const KEY = 0.45 * OWN;
const FILL = 0.12 * OWN;
/** The intensity of the environment. */
const SURROUNDINGS = 0.35;
/** Dielectrics that are at least this rough reflect nothing recognisable. */
const MATT = 0.8;
/** The number of directions in which the environment is sampled. */
const DIRECTIONS = 2000;

export class Lights {
  /** The lights that turn with the camera, as if a photographer carried them. */
  private readonly rig = new Group();
  private readonly room = new Room();
  /** The environment map, once a material needs it. */
  private mirrored: Texture | null = null;

  constructor(scene: Scene, private readonly renderer: WebGLRenderer) {
    scene.add(new HemisphereLight(0xffffff, new Color().setScalar(GROUND / SKY), SKY), this.rig);
    for (const one of [lamp(KEY, -0.45, 0.55, 0.85), lamp(FILL, 0.8, 0.1, 0.5)]) this.rig.add(one, one.target);
    scene.add(new LightProbe(this.room.light(), SURROUNDINGS));
  }

  /**
   * Lets smooth and metallic materials reflect the environment. Others only get its diffuse light as a light probe, because an
   * environment map costs more per pixel than all other light.
   */
  reach(material: MeshStandardMaterial): void {
    if (material.metalness === 0 && material.roughness >= MATT && material.type === "MeshStandardMaterial") return;
    material.envMap = this.mirrored ??= this.mirror();
    material.envMapIntensity = SURROUNDINGS;
    material.onBeforeCompile = withoutProbe;
  }

  /** Draws the environment map. Its shaders take long to compile: seconds without a graphics card. */
  private mirror(): Texture {
    const generator = new PMREMGenerator(this.renderer);
    const { texture } = generator.fromScene(this.room.scene, 0.03);
    generator.dispose();
    return texture;
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

/** The environment map contains the light of the probe already. */
function withoutProbe(shader: { fragmentShader: string }): void {
  shader.fragmentShader = `#undef USE_LIGHT_PROBES\n${shader.fragmentShader}`;
}

/** The brightness of the room's wall at a height from -1 to 1. */
const wall = (height: number): number => 0.35 + 0.35 * (0.5 + height / 2);

/** A grey room, lighter above, with three bright panels. */
class Room {
  readonly scene = new Scene();
  private readonly cloths: Mesh<PlaneGeometry, MeshBasicMaterial>[] = [];

  constructor() {
    const dome = new SphereGeometry(10, 32, 16);
    const heights = dome.getAttribute("position");
    const colors = new Float32Array(heights.count * 3);
    for (let i = 0; i < heights.count; i++) colors.fill(wall(heights.getY(i) / 10), i * 3, i * 3 + 3);
    dome.setAttribute("color", new BufferAttribute(colors, 3));
    this.scene.add(new Mesh(dome, new MeshBasicMaterial({ side: BackSide, vertexColors: true })));
    for (const [x, y, z, size, brightness] of [[-5, 6, 5, 5, 6], [7, 2, 3, 3, 3], [0, 4, -8, 6, 3]] as const) {
      const cloth = new Mesh(new PlaneGeometry(size, size), new MeshBasicMaterial({ color: new Color().setScalar(brightness) }));
      cloth.position.set(x, y, z);
      cloth.lookAt(0, 0, 0);
      cloth.updateMatrixWorld();
      this.cloths.push(cloth);
    }
    this.scene.add(...this.cloths);
  }

  /** The light from all directions, as spherical harmonics. */
  light(): SphericalHarmonics3 {
    const light = new SphericalHarmonics3();
    const basis = new Array<number>(9);
    const caster = new Raycaster();
    for (let i = 0; i < DIRECTIONS; i++) {
      // A spherical Fibonacci lattice: points on a spiral from pole to pole, evenly spread.
      const y = 1 - (2 * i + 1) / DIRECTIONS;
      const turn = i * Math.PI * (3 - Math.sqrt(5));
      caster.ray.direction.set(Math.cos(turn), 0, Math.sin(turn)).multiplyScalar(Math.sqrt(1 - y * y)).setY(y);
      const cloth = caster.intersectObjects(this.cloths, false)[0]?.object as (typeof this.cloths)[number] | undefined;
      const brightness = (cloth ? cloth.material.color.r : wall(y)) * ((4 * Math.PI) / DIRECTIONS);
      SphericalHarmonics3.getBasisAt(caster.ray.direction, basis);
      light.coefficients.forEach((coefficient, at) => coefficient.addScaledVector(WHITE, basis[at]! * brightness));
    }
    return light;
  }
}

const WHITE = new Vector3(1, 1, 1);
