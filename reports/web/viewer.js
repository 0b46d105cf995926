// SPDX-License-Identifier: GPL-3.0-or-later
// The machine in three dimensions: base, cables, platform, load, the path and the tube around it, as in the still
// pictures (reports/page/machine_picture.h), whose first view it shares. The projection is parallel, so that the scale
// bar holds everywhere.
import {
  AmbientLight,
  BackSide,
  BoxGeometry,
  BufferGeometry,
  CatmullRomCurve3,
  ConeGeometry,
  CylinderGeometry,
  DirectionalLight,
  DoubleSide,
  EdgesGeometry,
  Float32BufferAttribute,
  Group,
  LineBasicMaterial,
  LineSegments,
  Matrix4,
  Mesh,
  MeshBasicMaterial,
  MeshLambertMaterial,
  OrthographicCamera,
  Quaternion,
  Scene,
  SphereGeometry,
  TubeGeometry,
  Vector2,
  Vector3,
  WebGLRenderer,
} from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { Line2 } from "three/examples/jsm/lines/Line2.js";
import { LineGeometry } from "three/examples/jsm/lines/LineGeometry.js";
import { LineMaterial } from "three/examples/jsm/lines/LineMaterial.js";
import { LineSegments2 } from "three/examples/jsm/lines/LineSegments2.js";
import { LineSegmentsGeometry } from "three/examples/jsm/lines/LineSegmentsGeometry.js";
import { Bodies, bodyMaterials } from "./bodies.js";
import { themed } from "./colours.js";
import { between, extent, locate, spaced, status } from "./data.js";
import { shareGestures } from "./gestures.js";
import { nearness } from "./nearness.js";
import { Overlay } from "./overlay.js";
import { distinct, hatching, hullEdges, hullGeometry, rod, rodGeometry, span } from "./solids.js";
import { element } from "./words.js";

// Sizes in units of the scene, of which everything fills a ball of radius 1.
const RADIUS = { calm: 0.0045, near: 0.0058, close: 0.0078, out: 0.0095 }; // of cables
const CASING = 0.0045; // around them
const DASHES = 11; // of a cable that is close to its limits, or out of them
const ANCHOR = 0.036;
const ARROW = 0.3;
const THINNEST_TUBE = 0.004; // a thinner one would be less than the line of the path
const FAR = 8; // of the camera
const MARGIN = { side: 0.05, above: 0.08, below: 0.1 }; // around what is shown, as shares of the picture
const ZOOM = [0.6, 30];
const GHOST_WIDTH = 1.6; // [px]

const vector = ([x, y, z]) => new Vector3(x, y, z);

/// A picture of the machine in `holder`; undefined where the browser has no WebGL.
export function makeViewer(holder, data) {
  const canvas = document.createElement("canvas");
  // The context is requested here, so that a browser without WebGL causes no error.
  const context = canvas.getContext("webgl2", { antialias: true, alpha: true });
  return context ? new Viewer(holder, data, canvas, context) : undefined;
}

class Viewer {
  constructor(holder, data, canvas, context) {
    this.data = data;
    this.holder = holder;
    this.renderer = new WebGLRenderer({ canvas, context, antialias: true, alpha: true });
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.scene = new Scene();
    this.world = new Group(); // in metres, axes of the world
    this.scene.add(this.world, new AmbientLight(0xffffff, 1.9));
    const sun = new DirectionalLight(0xffffff, 1.5);
    sun.position.set(0.5, 1, 0.8);
    this.scene.add(sun);

    this.place();
    this.materials = materials();
    this.lines = [];
    this.build();
    const hint = element("div", { class: "hint", role: "status" });
    holder.append(canvas, this.overlay.element, hint);
    this.camera = new OrthographicCamera(-1, 1, 1, -1, 0.01, 2 * FAR);
    this.controls = new OrbitControls(this.camera, canvas);
    [this.controls.minZoom, this.controls.maxZoom] = ZOOM;
    this.controls.addEventListener("change", () => this.draw());
    shareGestures(holder, canvas, this.controls, hint);
    if (this.bodies) this.nameBodies(canvas);
    new ResizeObserver(() => this.resize()).observe(holder);
    this.resetView();
    this.setTheme();
    this.show(0);
  }

  /// Turns and scales the world: `across` is to the right on the screen and `up` is up.
  place() {
    const { robot, samples, view } = this.data;
    const [across, up] = [vector(view.across), vector(view.up)];
    const turn = new Matrix4().makeBasis(across, up, across.clone().cross(up)).transpose();
    this.world.quaternion.setFromRotationMatrix(turn);
    const points = robot.base.map(vector);
    const shapes = this.data.bodies?.shapes ?? [];
    this.payloadBox = [...boxCorners(this.data.decoration.payload),
      ...shapes.filter((shape) => !shape.is_obstacle).flatMap((shape) => shape.box)];
    const count = samples.position.length;
    for (let k = 0; k < count; k += Math.max(1, Math.floor(count / 60))) points.push(...this.swept(k));
    points.push(...this.swept(count - 1), ...boxCorners(this.data.decoration.frame).map(vector));
    points.push(...this.obstaclePoints(points));
    points.push(...points.map((p) => this.foot(p)), ...this.gridLines().flat());
    const low = points.reduce((a, b) => a.clone().min(b), points[0]);
    const high = points.reduce((a, b) => a.clone().max(b), points[0]);
    const centre = low.clone().add(high).multiplyScalar(0.5);
    const radius = Math.max(...points.map((x) => x.distanceTo(centre)), 1e-12);
    this.scale = 1 / radius;
    this.world.scale.setScalar(this.scale);
    this.world.position.copy(centre).multiplyScalar(-this.scale).applyQuaternion(this.world.quaternion);
    this.world.updateMatrixWorld();
    this.points = points.map((p) => this.world.localToWorld(p));
  }

  /// What of the obstacles is next to the machine, as machine_view.cc has it: all of them may be far larger.
  obstaclePoints(points) {
    const low = points.reduce((a, b) => a.clone().min(b), points[0]);
    const high = points.reduce((a, b) => a.clone().max(b), points[0]);
    const size = high.clone().sub(low);
    const beyond = 0.25 * Math.max(size.x, size.y, size.z);
    [low, high].forEach((end, k) => end.addScalar(k === 0 ? -beyond : beyond));
    return (this.data.bodies?.shapes ?? []).filter((shape) => shape.is_obstacle).flatMap((shape) =>
      (shape.plane ?? clipped(shape.box.map(vector), low, high)).map((p) => (p.isVector3 ? p : vector(p))));
  }

  swept(k) {
    const { robot, samples, is_found: isFound } = this.data;
    const position = samples.position[k];
    if (!isFound && position !== Math.round(position)) return []; // nothing is between the waypoints
    return [...robot.platform, robot.load_point, ...this.data.weights, ...this.payloadBox]
      .map((b) => this.at(b, position));
  }

  /// A point of the platform at a place of the path, in the world.
  at(point, position) {
    const [p, q] = this.pose(position);
    return vector(point).applyQuaternion(q).add(p);
  }

  /// The point of the ground below p.
  foot(p) {
    const up = vector(this.data.view.up);
    return p.clone().addScaledVector(up, this.data.view.ground - p.dot(up));
  }

  gridLines() {
    const { view } = this.data;
    const [across, up] = [vector(view.across), vector(view.up)];
    const inward = up.clone().cross(across);
    const at = (a, b) => across.clone().multiplyScalar(a * view.step).addScaledVector(inward, b * view.step)
      .addScaledVector(up, view.ground);
    const [[left, right], [front, back]] = [view.columns, view.rows];
    const range = (from, to) => Array.from({ length: to - from + 1 }, (_, k) => from + k);
    return [...range(left, right).map((a) => [at(a, front), at(a, back)]),
      ...range(front, back).map((b) => [at(left, b), at(right, b)])];
  }

  /// Position and orientation at a place of the path.
  pose(position) {
    const { samples } = this.data;
    const [k, t] = locate(samples.position, position);
    const at = (list, i) => new Quaternion(...list.map((column) => column[i]));
    const q = at(samples.q, k);
    if (t > 0) q.slerp(at(samples.q, k + 1), t);
    return [vector(samples.p.map((column) => between(column, [k, t]))), q.normalize()];
  }

  build() {
    const { robot, is_found: isFound } = this.data;
    this.fixed();
    this.arrow = this.loadArrow();
    this.platform = this.platformBody();
    this.cables = robot.base.map(() => this.cable());
    if (this.data.bodies) {
      this.bodies = new Bodies(this.data, this.world, this.platform, this.materials.bodies, this.scale);
    }
    // Where no path was found, only its ends are known.
    for (const part of [this.arrow, this.platform, ...this.cables]) part.visible = isFound;
    this.ends();
    if (isFound) this.paths();
    this.witnesses();
    this.overlay = new Overlay(this.data, this.anchorNames(), this.marks, this.bodies?.names ?? []);
    for (const { tag } of this.overlay.cables) tag.style.display = isFound ? "" : "none";
  }

  /// Ground, posts and the base with its anchors.
  fixed() {
    const { view } = this.data;
    const metres = (size) => size / this.scale;
    const base = distinct(this.data.robot.base.map(vector));
    const lines = (pairs, material) => this.world.add(new LineSegments(
      new BufferGeometry().setFromPoints(pairs.flat()), material));
    lines(this.gridLines(), this.materials.ground);
    const up = vector(view.up);
    const height = base.reduce((sum, a) => sum + a.dot(up), 0) / base.length;
    const { samples } = this.data;
    this.showBody(this.world, this.data.decoration.frame, this.materials.shownFrame);
    if (!this.data.decoration.frame && height > vector(samples.p.map((column) => column[0])).dot(up)) {
      for (const a of base) {
        // What carries the machine is not known: it is drawn behind all that is.
        const post = rod(this.foot(a), a, metres(0.012), this.materials.post);
        const plate = new Mesh(new CylinderGeometry(metres(0.035), metres(0.035), metres(0.006), 24),
          this.materials.post);
        plate.position.copy(this.foot(a));
        plate.quaternion.setFromUnitVectors(new Vector3(0, 1, 0), up);
        post.renderOrder = plate.renderOrder = -1;
        this.world.add(post, plate);
      }
    }
    const geometry = hullGeometry(base);
    const lying = hatching(base, metres(0.045));
    if (geometry && lying.length > 0) this.world.add(new Mesh(geometry, this.materials.base));
    lines(lying, this.materials.hatch);
    for (const [a, b] of hullEdges(base)) this.world.add(rod(a, b, metres(0.011), this.materials.frame));
    for (const a of base) {
      const block = new Mesh(new BoxGeometry(metres(ANCHOR), metres(ANCHOR), metres(ANCHOR)), this.materials.anchor);
      block.position.copy(a);
      block.quaternion.copy(this.world.quaternion).invert();
      this.world.add(block);
    }
  }

  /// "A1 A2" where anchors coincide.
  anchorNames() {
    const base = this.data.robot.base.map(vector);
    const apart = Math.max(...base.map((p) => p.distanceTo(base[0])));
    return distinct(base).map((a) => ({
      name: base.flatMap((p, i) => (p.distanceTo(a) <= 1e-6 * apart ? [`A${i + 1}`] : [])).join(" "),
      at: this.world.localToWorld(a.clone()),
    }));
  }

  platformBody() {
    const corners = this.data.robot.platform.map(vector);
    const body = new Group();
    const geometry = hullGeometry(corners);
    if (geometry) body.add(new Mesh(geometry, this.materials.platform));
    for (const [a, b] of hullEdges(corners)) body.add(rod(a, b, 0.0035 / this.scale, this.materials.edge));
    for (const p of distinct(corners)) {
      const joint = new Mesh(new SphereGeometry(0.011 / this.scale, 12, 8), this.materials.edge);
      joint.position.copy(p);
      body.add(joint);
    }
    // The way from the platform to what it carries beside it.
    const middle = corners.reduce((sum, p) => sum.add(p), new Vector3()).divideScalar(corners.length);
    for (const p of [this.data.robot.load_point, ...this.data.weights].map(vector)) {
      if (middle.distanceTo(p) * this.scale > 0.02) body.add(rod(middle, p, 0.003 / this.scale, this.materials.edge));
    }
    for (const p of this.data.weights) {
      const weight = new Mesh(new SphereGeometry(0.017 / this.scale, 18, 12), this.materials.weight);
      weight.position.copy(vector(p));
      body.add(weight);
    }
    this.showBody(body, this.data.decoration.payload, this.materials.shownPayload);
    this.world.add(body);
    return body;
  }

  /// A body's name, where the pointer is on one.
  nameBodies(canvas) {
    const tag = this.overlay.pointed;
    canvas.addEventListener("pointermove", (event) => {
      const box = canvas.getBoundingClientRect();
      const [x, y] = [event.clientX - box.left, event.clientY - box.top];
      const name = this.bodies.nameAt([(2 * x) / box.width - 1, 1 - (2 * y) / box.height], this.camera);
      tag.textContent = name ? `${name} (checked)` : "";
      tag.classList.toggle("shown", Boolean(name));
      tag.style.transform = `translate(-50%, -150%) translate(${x.toFixed(0)}px, ${y.toFixed(0)}px)`;
    });
    canvas.addEventListener("pointerleave", () => tag.classList.remove("shown"));
  }

  /// A body that is only shown: see-through, with its edges.
  showBody(group, body, material) {
    if (!body) return;
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new Float32BufferAttribute(body.corners, 3));
    geometry.setIndex(body.triangles);
    const faces = geometry.toNonIndexed(); // so that each face has its own normal
    faces.computeVertexNormals();
    const mesh = new Mesh(faces, material.faces);
    const edges = new LineSegments(new EdgesGeometry(geometry, 30), material.edges);
    mesh.renderOrder = edges.renderOrder = -1;
    group.add(mesh, edges);
  }

  /// A rod with a casing, which keeps it apart from what is behind it, and gaps that are only shown near its limits.
  cable() {
    const group = new Group();
    const rods = rodGeometry(10);
    group.userData = {
      core: new Mesh(rods, new MeshBasicMaterial()),
      casing: new Mesh(rods, this.materials.casing),
      gaps: Array.from({ length: DASHES }, () => new Mesh(rods, this.materials.gap)),
    };
    group.add(group.userData.core, group.userData.casing, ...group.userData.gaps);
    this.world.add(group);
    return group;
  }

  /// Along −y of the scene, until it is turned.
  loadArrow() {
    const arrow = new Group();
    const { load } = this.materials;
    const shaft = new Mesh(new CylinderGeometry(0.009, 0.009, ARROW - 0.06, 12), load);
    shaft.position.y = -(ARROW - 0.06) / 2;
    const tip = new Mesh(new ConeGeometry(0.03, 0.09, 20), load);
    tip.position.y = -ARROW + 0.045;
    tip.rotation.x = Math.PI;
    arrow.add(shaft, tip);
    arrow.userData.pulls = [shaft, tip];
    arrow.add(new Mesh(new SphereGeometry(0.02, 16, 12), load));
    for (const part of arrow.children) part.renderOrder = 3; // in front of the platform, which would hide it
    this.scene.add(arrow);
    return arrow;
  }

  /// The platform at the start and at the goal, as dashed outlines, and the worst place on the path.
  ends() {
    const { segments, worst, is_found: isFound } = this.data;
    const corners = this.data.robot.platform.map(vector);
    this.marks = [];
    for (const [name, position] of segments > 0 ? [["S", 0], ["G", segments]] : [["S", 0]]) {
      const placed = corners.map((b) => this.at(b.toArray(), position));
      const positions = hullEdges(placed).flat().flatMap((p) => p.toArray());
      const geometry = new LineSegmentsGeometry().setPositions(positions);
      const material = new LineMaterial({
        linewidth: GHOST_WIDTH, dashed: true, dashSize: 0.028 / this.scale, gapSize: 0.02 / this.scale,
      });
      const outline = new LineSegments2(geometry, material);
      outline.computeLineDistances();
      this.world.add(outline);
      this.lines.push({ material, name: "--soft" });
      const up = vector(this.data.view.up);
      const top = placed.reduce((a, b) => (b.dot(up) > a.dot(up) ? b : a));
      this.marks.push({ name, at: this.world.localToWorld(top.clone()), kind: "end" });
    }
    if (worst === null || !isFound) return;
    const mark = new Mesh(new SphereGeometry(0.02 / this.scale, 20, 14), this.materials.worst);
    mark.position.copy(this.pose(worst)[0]);
    mark.renderOrder = 2;
    this.world.add(mark);
  }

  /// The path of the platform's origin, coloured by what is proved; that of the load point, thin; and the tube.
  paths() {
    const { samples, robot, tube_m: tube, stretches } = this.data;
    const ends = stretches.flatMap((s) => [s.from, s.to]);
    const places = [...new Set([...samples.position, ...ends])].sort((a, b) => a - b);
    const origins = places.map((p) => this.pose(p)[0]);
    const loads = places.map((p) => this.at(robot.load_point, p));
    const line = (points, name, width, dashed) => {
      const kept = points.filter((p, k) => k === 0 || p.distanceTo(points[k - 1]) > 1e-7 / this.scale);
      if (kept.length < 2) return;
      const geometry = new LineGeometry().setPositions(kept.flatMap((p) => [p.x, p.y, p.z]));
      // Drawn in front of the platform, which would hide it.
      const material = new LineMaterial({
        linewidth: width, depthTest: false, transparent: true,
        dashed, dashSize: 0.02 / this.scale, gapSize: 0.015 / this.scale,
      });
      const mesh = new Line2(geometry, material);
      mesh.computeLineDistances();
      mesh.renderOrder = 1;
      this.world.add(mesh);
      this.lines.push({ material, name });
    };
    line(loads, "--soft", 1.5, true);
    const kinds = places.map((p, k) => (k === 0 ? undefined : status(this.data, (places[k - 1] + p) / 2)));
    const styles = {
      proved: ["--proved", 3, false], open: ["--undecided", 6, true],
      violated: ["--refuted", 7, false], unknown: ["--curve", 3, true],
    };
    for (let k = 1; k < places.length; ) {
      let end = k;
      while (end + 1 < places.length && kinds[end + 1] === kinds[k]) ++end;
      line(origins.slice(k - 1, end + 1), ...styles[kinds[k]]);
      k = end + 1;
    }
    this.tubeIsThin = tube !== null && tube * this.scale < THINNEST_TUBE;
    if (tube === null || this.tubeIsThin) return;
    const kept = spaced(origins, tube / 4);
    const add = (geometry, at) => {
      const mesh = new Mesh(geometry, this.materials.tube);
      if (at) mesh.position.copy(at);
      mesh.renderOrder = 0.5; // below the path's line
      this.world.add(mesh);
    };
    if (kept.length > 1) add(new TubeGeometry(new CatmullRomCurve3(kept), Math.min(kept.length * 2, 1200), tube, 16));
    for (const end of [origins[0], origins[origins.length - 1]]) add(new SphereGeometry(tube, 24, 16), end);
  }

  /// The platform where the certificate's witness is.
  witnesses() {
    const { witness, robot } = this.data;
    for (const position of witness ? [witness.position, witness.to].filter((p) => p !== null) : []) {
      const corners = robot.platform.map((b) => this.at(b, position));
      const geometry = hullGeometry(corners);
      const { ghost } = this.materials;
      if (geometry) this.world.add(new Mesh(geometry, ghost));
      for (const [a, b] of hullEdges(corners)) this.world.add(rod(a, b, 0.004 / this.scale, ghost));
    }
  }

  show(position) {
    const { robot, samples, is_found: isFound } = this.data;
    const where = locate(samples.position, position);
    const [p, q] = this.pose(position);
    this.platform.position.copy(p);
    this.platform.quaternion.copy(q);
    this.corners = robot.platform.map((b) => vector(b).applyQuaternion(q).add(p));
    this.cables.forEach((group, i) => {
      const f = between(samples.tension[i], where);
      const range = [f - between(samples.tension_below[i], where), f + between(samples.tension_above[i], where)];
      const length = vector(robot.base[i]).distanceTo(this.corners[i]);
      const slack = 1e-6 * (robot.length[i][1] - robot.length[i][0]); // samples are rounded
      this.stretch(group, vector(robot.base[i]), this.corners[i],
        nearness(range, robot.tension[i], length, robot.length[i], slack), this.overlay.cables[i].tag, i + 1);
    });
    this.bodies?.show(where, this.corners);
    const force = this.forceAt(where);
    for (const part of this.arrow.userData.pulls) part.visible = force.length() > 0;
    const down = force.clone().normalize().applyQuaternion(this.world.quaternion);
    this.arrow.quaternion.setFromUnitVectors(new Vector3(0, -1, 0), down);
    this.scene.updateMatrixWorld();
    this.arrow.position.copy(this.world.localToWorld(vector(robot.load_point).applyQuaternion(q).add(p)));
    this.tip = isFound && force.length() > 0 ? this.arrow.position.clone().addScaledVector(down, ARROW) : undefined;
    this.draw();
  }

  /// The nominal force at a place, in the world.
  forceAt(where) {
    const { force } = this.data.samples;
    return vector(force.length > 0 ? force.map((column) => between(column, where)) : this.data.robot.force);
  }

  stretch(group, a, b, near, tag, number) {
    const { core, casing, gaps } = group.userData;
    group.userData.nearness = near;
    core.material.color.set(themed(`--${near}`));
    span(core, a, b, RADIUS[near] / this.scale);
    span(casing, a, b, (RADIUS[near] + CASING) / this.scale);
    const isDashed = near === "close" || near === "out";
    gaps.forEach((gap, k) => {
      gap.visible = isDashed;
      const at = (t) => a.clone().lerp(b, t);
      const gapLength = near === "out" ? 0.5 : 0.3;
      span(gap, at((k + 0.5) / DASHES), at((k + 0.5 + gapLength) / DASHES), (1.08 * RADIUS[near]) / this.scale);
    });
    tag.className = `cable ${near}`;
    tag.textContent = near === "out" ? `${number} !` : String(number);
  }

  setTheme() {
    const colours = {
      ground: "--ground", post: "--post", base: "--steel", hatch: "--steel", frame: "--steel", anchor: "--anchor",
      platform: "--warm", edge: "--warm-edge", weight: "--warm-dim", load: "--ink", tube: "--curve", ghost: "--mark",
      casing: "--paper", gap: "--paper", worst: "--close",
    };
    for (const [name, property] of Object.entries(colours)) this.materials[name].color.set(themed(property));
    for (const [name, property] of [["shownFrame", "--steel"], ["shownPayload", "--warm-edge"]]) {
      for (const material of Object.values(this.materials[name])) material.color.set(themed(property));
    }
    const { bodies } = this.materials;
    for (const [name, face, edge] of [["obstacle", "--obstacle", "--obstacle-edge"],
      ["carried", "--carried", "--carried-edge"], ["plane", "--obstacle", "--obstacle"]]) {
      bodies[name].faces.color.set(themed(face));
      bodies[name].edges.color.set(themed(edge));
    }
    for (const [name, property] of [["cable", "--steel"], ["link", "--ink"], ["linkCasing", "--paper"]]) {
      bodies[name].color.set(themed(property));
    }
    for (const { material, name } of this.lines) material.color.set(themed(name));
    for (const { userData: { core, nearness: near } } of this.cables) core.material.color.set(themed(`--${near}`));
    this.draw();
  }

  resetView() {
    this.look(this.data.view.azimuth, this.data.view.elevation);
  }

  /// Looks from a direction at everything: angles from the front to the right, and up [rad].
  look(azimuth, elevation) {
    const above = Math.min(elevation, Math.PI / 2 - 1e-4); // from straight above, the front is below
    const from = new Vector3(
      Math.cos(above) * Math.sin(azimuth), Math.sin(above), Math.cos(above) * Math.cos(azimuth));
    const right = new Vector3(Math.cos(azimuth), 0, -Math.sin(azimuth));
    const up = from.clone().cross(right);
    const extent = (axis) => {
      const values = this.points.map((p) => p.dot(axis));
      return [Math.min(...values), Math.max(...values)];
    };
    const [[left, rightmost], [low, high]] = [extent(right), extent(up)];
    const half = Math.max((high - low) / 2 / (1 - MARGIN.above - MARGIN.below),
      (rightmost - left) / 2 / (1 - 2 * MARGIN.side) / this.aspect());
    this.half = half;
    this.frame();
    const aside = 2 * half * (MARGIN.above - MARGIN.below) / 2; // room for names above and the scale below
    this.controls.target.set(0, 0, 0).addScaledVector(right, (left + rightmost) / 2)
      .addScaledVector(up, (low + high) / 2 + aside);
    this.camera.position.copy(this.controls.target).addScaledVector(from, FAR);
    this.camera.zoom = 1;
    this.camera.updateProjectionMatrix();
    this.controls.update();
    this.overlay.reset();
    this.draw();
  }

  aspect() {
    return Math.max(this.holder.clientWidth, 1) / Math.max(this.holder.clientHeight, 1);
  }

  frame() {
    const [x, y] = [this.half * this.aspect(), this.half];
    Object.assign(this.camera, { left: -x, right: x, top: y, bottom: -y });
    this.camera.updateProjectionMatrix();
  }

  /// Moves the camera by keys: angles [rad], and the factor by which it comes nearer.
  orbit(azimuth, elevation, zoom = 1) {
    const offset = this.camera.position.clone().sub(this.controls.target);
    const height = Math.asin(Math.min(Math.max(offset.y / offset.length(), -1), 1));
    const around = Math.atan2(offset.x, offset.z) + azimuth;
    const above = Math.min(Math.max(height + elevation, -1.5), 1.5);
    offset.set(Math.cos(above) * Math.sin(around), Math.sin(above), Math.cos(above) * Math.cos(around))
      .multiplyScalar(FAR);
    this.camera.position.copy(this.controls.target).add(offset);
    this.camera.zoom = Math.min(Math.max(this.camera.zoom / zoom, ZOOM[0]), ZOOM[1]);
    this.camera.updateProjectionMatrix();
    this.controls.update();
    this.draw();
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.holder;
    if (width === 0 || height === 0) return;
    this.renderer.setSize(width, height, false);
    for (const { material } of this.lines) material.resolution = new Vector2(width, height);
    if (this.shownAspect !== this.aspect()) this.resetView();
    this.shownAspect = this.aspect();
    this.draw();
  }

  /// Draws once, at the next frame.
  draw() {
    if (this.pending || !this.camera) return;
    this.pending = true;
    requestAnimationFrame(() => {
      this.pending = false;
      this.renderer.render(this.scene, this.camera);
      this.label();
    });
  }

  label() {
    const { clientWidth: width, clientHeight: height } = this.holder;
    const project = (p) => {
      const at = p.clone().project(this.camera);
      return [((at.x + 1) / 2) * width, ((1 - at.y) / 2) * height];
    };
    const inScene = (p) => this.world.localToWorld(p.clone());
    const screen = this.camera.quaternion.clone().invert().multiply(this.world.quaternion);
    const directions = [[1, 0, 0], [0, 1, 0], [0, 0, 1]].map((axis) => {
      const { x, y } = vector(axis).applyQuaternion(screen);
      return [x, -y];
    });
    this.overlay.update({
      project, directions, width, tip: this.tip,
      bodies: this.bodies?.names.map(({ group, at }) => group.localToWorld(at.clone())) ?? [],
      pixels: (height / (2 * this.half)) * this.camera.zoom * this.scale,
      lines: this.data.robot.base.map((a, i) => [inScene(vector(a)), inScene(this.corners[i])]),
    });
  }
}

/// The corners of the box around a body that is only shown; none where there is none.
function boxCorners(body) {
  if (!body) return [];
  const [xs, ys, zs] = [0, 1, 2].map((k) => extent(body.corners.filter((_, i) => i % 3 === k)));
  return xs.flatMap((x) => ys.flatMap((y) => zs.map((z) => [x, y, z])));
}

/// The corners of what of a box is within another one; none where they are apart.
function clipped(corners, low, high) {
  const from = corners.reduce((a, b) => a.clone().min(b), corners[0]).max(low);
  const to = corners.reduce((a, b) => a.clone().max(b), corners[0]).min(high);
  if (from.x > to.x || from.y > to.y || from.z > to.z) return [];
  return [from.x, to.x].flatMap((x) => [from.y, to.y].flatMap((y) => [from.z, to.z].map((z) => new Vector3(x, y, z))));
}

const shown = (faces, edges) => ({
  faces: new MeshLambertMaterial({ transparent: true, opacity: faces, side: DoubleSide, depthWrite: false }),
  edges: new LineBasicMaterial({ transparent: true, opacity: edges }),
});

function materials() {
  const inFront = { transparent: true, depthWrite: false, depthTest: false };
  return {
    ground: new LineBasicMaterial(),
    post: new MeshBasicMaterial({ depthWrite: false }),
    base: new MeshBasicMaterial({ transparent: true, opacity: 0.1, side: DoubleSide, depthWrite: false }),
    hatch: new LineBasicMaterial({ transparent: true, opacity: 0.5 }),
    frame: new MeshLambertMaterial(),
    anchor: new MeshLambertMaterial(),
    platform: new MeshLambertMaterial({ side: DoubleSide, polygonOffset: true, polygonOffsetFactor: 1 }),
    edge: new MeshBasicMaterial(),
    weight: new MeshLambertMaterial(),
    load: new MeshBasicMaterial({ depthTest: false, transparent: true }),
    tube: new MeshBasicMaterial({ ...inFront, opacity: 0.4 }),
    ghost: new MeshBasicMaterial({ ...inFront, opacity: 0.3, side: DoubleSide }),
    casing: new MeshBasicMaterial({ side: BackSide }),
    gap: new MeshBasicMaterial(),
    worst: new MeshBasicMaterial({ ...inFront }),
    bodies: bodyMaterials(),
    shownFrame: shown(0.16, 0.55),
    shownPayload: shown(0.3, 0.8),
  };
}
