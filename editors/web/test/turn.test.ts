import assert from "node:assert/strict";
import { test } from "node:test";
import { AnimationClip, BufferGeometry, Float32BufferAttribute, Mesh, Object3D, Vector3, VectorKeyframeTrack } from "three";
import { axesOf, directionOf, placeOf, Turns, weightsOf, type Direction, type Views } from "../src/viewport/turn";

const close = (found: readonly number[], expected: readonly number[], what = ""): void => {
  assert.equal(found.length, expected.length, what);
  found.forEach((value, at) => assert.ok(Math.abs(value - expected[at]!) < 1e-9, `${what} ${found.join(" ")} is not ${expected.join(" ")}`));
};

test("weights are linear between views and clamped outside", () => {
  const pair: Views = { views: [[0, 0], [45, 0]], between: [[0, 1]] };
  close(weightsOf(pair, [22.5, 0]), [0.5, 0.5]);
  close(weightsOf(pair, [-30, 10]), [1, 0]);
  close(weightsOf(pair, [90, -80]), [0, 1]);
  close(weightsOf(pair, [-170, 0]), [0, 1]);
  const three: Views = { views: [[0, 0], [45, 0], [0, 30]], between: [[0, 1, 2]] };
  close(weightsOf(three, [15, 10]), [1 / 3, 1 / 3, 1 / 3]);
  close(weightsOf(three, [-20, 15]), [0.5, 0, 0.5]);
  const round: Views = { views: [[0, 0], [90, 0], [180, 0], [270, 0]], between: [[0, 1], [1, 2], [2, 3], [3, 0]] };
  close(weightsOf(round, [-45, 0]), [0.5, 0, 0, 0.5]);
  close(weightsOf(round, [-135, 5]), [0, 0, 0.5, 0.5]);
});

test("at each view a region is where it was drawn", () => {
  const views: Views = { views: [[0, 0], [45, 10]], between: [[0, 1]] };
  const places = [new Vector3(3, 2, 1), new Vector3(2.5, 2, 0.5)];
  views.views.forEach((view, index) => {
    const [right, up, towards] = axesOf(view);
    const place = places[index]!;
    close(placeOf(views, weightsOf(views, view), places).toArray(), [place.dot(right), place.dot(up), place.dot(towards) / 4]);
    close(directionOf(towards), view);
  });
});

/** A character with one region whose only corner is moved by 1 in the second view. */
function character(): { root: Object3D; node: Object3D; region: Object3D; mesh: Mesh } {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new Float32BufferAttribute([0, 0, 0], 3));
  geometry.morphAttributes["position"] = [new Float32BufferAttribute([1, 0, 0], 3)];
  const [root, node, region, mesh] = [new Object3D(), new Object3D(), new Object3D(), new Mesh(geometry)];
  node.userData["gltfExtensions"] = { OKOSHI_view_dependent: { turn: { views: [[0, 0], [90, 0]], between: [[0, 1]] } } };
  region.userData["gltfExtensions"] = { OKOSHI_view_dependent: { region: { places: [[1, 2, 0], [0, 2, -1]] } } };
  region.name = "Nose";
  root.rotation.y = Math.PI / 2;
  root.add(node);
  node.add(region);
  region.add(mesh);
  root.updateMatrixWorld(true);
  return { root, node, region, mesh };
}

test("a character faces the viewer, in whatever frame it stands", () => {
  const { root, node, region, mesh } = character();
  const turns = new Turns(root);
  assert.ok(!turns.isEmpty);
  for (const [theta, share] of [[0, 0], [45, 0.5], [90, 1], [120, 1]] as const) {
    // The root is turned by 90 degrees.
    const towards = new Vector3(Math.sin(((theta + 90) * Math.PI) / 180), 0, Math.cos(((theta + 90) * Math.PI) / 180));
    assert.ok(turns.follow(towards), `${theta}`);
    assert.ok(!turns.follow(towards), "nothing changes for the same viewer");
    close(mesh.morphTargetInfluences ?? [], [share], `${theta}`);
    close(new Vector3(0, 0, 1).transformDirection(node.matrixWorld).toArray(), towards.toArray(), `${theta}`);
    if (share === 1) close(region.position.toArray(), [1, 2, 0]);
  }
});

test("clips that only turn a character are left out, for it follows the camera", () => {
  const { root } = character();
  const track = (name: string): VectorKeyframeTrack => new VectorKeyframeTrack(`${name}.position`, [0, 1], [0, 0, 0, 1, 1, 1]);
  const [turning, walking] = [new AnimationClip("turns", 1, [track("Nose")]), new AnimationClip("walks", 1, [track("Nose"), track("Leg")])];
  assert.deepEqual(new Turns(root).others([turning, walking]), [walking]);
});

test("what is not as the format says is no character", () => {
  for (const turn of [{}, { views: [], between: [] }, { views: [[0, 0]], between: [[1]] }, { views: [[0]], between: [[0]] }, { views: [[0, 0]], between: [] }]) {
    const node = new Object3D();
    node.userData["gltfExtensions"] = { OKOSHI_view_dependent: { turn } };
    assert.ok(new Turns(node).isEmpty, JSON.stringify(turn));
  }
  const direction: Direction = [0, 0];
  close(weightsOf({ views: [direction], between: [[0]] }, [50, 5]), [1]);
});
