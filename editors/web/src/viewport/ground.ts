// The ground: a soft shadow under the model, and a grid that fades out.

import {
  BufferGeometry,
  Color,
  DirectionalLight,
  Float32BufferAttribute,
  Group,
  LineBasicMaterial,
  LineSegments,
  Matrix4,
  Mesh,
  PlaneGeometry,
  ShadowMaterial,
  type Box3,
  type Scene,
  Vector3,
} from "three";

/** Cells on each side of the model. */
const CELLS = 12;
/** The radius in which shadows are caught, relative to the model: with space for limbs that are turned, and for the blur. */
const ROOM = 1.1;

export class Ground {
  readonly group = new Group();
  /** The visible part. */
  private readonly plane = new Group();
  private readonly shadow = new Mesh(new PlaneGeometry(1, 1).rotateX(-Math.PI / 2), new ShadowMaterial({ opacity: 0.22, depthWrite: false }));
  private readonly grid = new LineSegments(gridLines(), new LineBasicMaterial({ vertexColors: true, transparent: true, depthWrite: false }));
  /** Straight above. It gives no light, only the shadow. */
  private readonly sun = new DirectionalLight(0xffffff, 0);

  constructor(scene: Scene) {
    this.shadow.receiveShadow = true;
    this.shadow.renderOrder = -1;
    this.grid.renderOrder = -2;
    this.sun.castShadow = true;
    this.sun.shadow.mapSize.set(256, 256);
    this.sun.shadow.radius = 3;
    this.sun.shadow.blurSamples = 8;
    // Variance shadow maps contain the shadow's receivers too: without a bias the ground would shade itself.
    this.sun.shadow.bias = -0.003;
    this.plane.matrixAutoUpdate = false;
    this.plane.add(this.grid, this.shadow);
    this.group.add(this.plane);
    this.group.visible = false;
    // Not in the group: shaders depend on the number of lights that are visible, and would be compiled anew.
    scene.add(this.group, this.sun, this.sun.target);
  }

  /** Fits the ground to a model with this bounding box. */
  fit(box: Box3): void {
    const size = box.getSize(new Vector3());
    const center = box.getCenter(new Vector3());
    const reach = Math.max(size.x, size.y, size.z, 1e-6);
    const cell = 10 ** Math.round(Math.log10(reach / 5));
    // Slightly below the feet, so that soles and ground do not flicker.
    const level = box.min.y - reach * 0.001;
    this.group.position.set(0, level, 0);
    this.grid.position.set(Math.round(center.x / cell) * cell, 0, Math.round(center.z / cell) * cell);
    this.grid.scale.setScalar(cell);
    this.shadow.position.set(center.x, 0, center.z);
    this.shadow.scale.setScalar(reach * 2 * ROOM);
    this.sun.position.set(center.x, level + size.y + reach, center.z);
    this.sun.target.position.set(center.x, level, center.z);
    const camera = this.sun.shadow.camera;
    camera.left = camera.bottom = -reach * ROOM;
    camera.right = camera.top = reach * ROOM;
    camera.near = reach * 0.01;
    camera.far = size.y + reach * 1.5;
    camera.updateProjectionMatrix();
    this.group.visible = true;
    this.bend(new Matrix4());
  }

  /** Bends the ground like the terrain above it, by a matrix in the world. */
  bend(inWorld: Matrix4): void {
    this.group.updateMatrix();
    this.plane.matrix.copy(this.group.matrix).invert().multiply(inWorld).multiply(this.group.matrix);
    this.plane.matrixWorldNeedsUpdate = true;
  }

  color(color: string): void {
    this.grid.material.color = new Color(color);
  }
}

function gridLines(): BufferGeometry {
  const points: number[] = [];
  const colors: number[] = [];
  const add = (x: number, z: number): void => {
    points.push(x, 0, z);
    const far = Math.min(1, Math.hypot(x, z) / CELLS);
    colors.push(1, 1, 1, (1 - far) ** 1.5 * 0.5);
  };
  for (let a = -CELLS; a <= CELLS; a++) {
    // Lines are cut into segments that fade out.
    for (let b = -CELLS; b < CELLS; b++) {
      add(a, b);
      add(a, b + 1);
      add(b, a);
      add(b + 1, a);
    }
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new Float32BufferAttribute(points, 3));
  geometry.setAttribute("color", new Float32BufferAttribute(colors, 4));
  return geometry;
}
