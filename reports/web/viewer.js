// SPDX-License-Identifier: GPL-3.0-or-later
// The robot in three dimensions: base, cables, platform, load, the path and the tube around it.
import {
  AmbientLight,
  BufferGeometry,
  CatmullRomCurve3,
  ConeGeometry,
  CylinderGeometry,
  DirectionalLight,
  DoubleSide,
  Float32BufferAttribute,
  Group,
  Mesh,
  MeshBasicMaterial,
  MeshLambertMaterial,
  PerspectiveCamera,
  Quaternion,
  Scene,
  SphereGeometry,
  TubeGeometry,
  Vector2,
  Vector3,
  WebGLRenderer,
} from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { ConvexGeometry } from "three/examples/jsm/geometries/ConvexGeometry.js";
import { Line2 } from "three/examples/jsm/lines/Line2.js";
import { LineGeometry } from "three/examples/jsm/lines/LineGeometry.js";
import { LineMaterial } from "three/examples/jsm/lines/LineMaterial.js";
import { tensionColour, themed } from "./colours.js";
import { between, locate, spaced, status } from "./data.js";
import { element } from "./words.js";

// Sizes in units of the scene, of which the robot fills a ball of radius 1.
const CABLE = 0.008;
const ANCHOR = 0.016;
const ARROW = 0.32;
const THINNEST_TUBE = 0.004; // a thinner one would be less than the line of the path
const VIEW_ANGLE = 30; // [°]
const FIRST_VIEW = { azimuth: 0.55, elevation: 0.3 }; // [rad]

const UP = new Vector3(0, 1, 0);
const vector = ([x, y, z]) => new Vector3(x, y, z);

/// A picture of the robot in `holder`; undefined where the browser has no WebGL.
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
    this.labels = element("div", { class: "labels", "aria-hidden": "true" });
    holder.append(canvas, this.labels);

    this.scene = new Scene();
    this.world = new Group(); // in metres, axes of the world
    this.scene.add(this.world, new AmbientLight(0xffffff, 1.6));
    const sun = new DirectionalLight(0xffffff, 1.8);
    sun.position.set(0.5, 1, 0.8);
    this.scene.add(sun);

    this.place();
    this.build();
    this.camera = new PerspectiveCamera(VIEW_ANGLE, 1, 0.05, 40);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enablePan = true;
    this.controls.minDistance = 0.4;
    this.controls.maxDistance = 12;
    this.controls.addEventListener("change", () => this.draw());
    new ResizeObserver(() => this.resize()).observe(holder);
    this.resetView();
    this.setTheme();
    this.show(0);
  }

  /// Turns and scales the world: the load pulls down on the screen, and everything shown fits a ball of radius 1 around
  /// the origin.
  place() {
    const { robot, samples } = this.data;
    const force = vector(robot.force);
    const down = force.length() > 0 ? force.normalize() : new Vector3(0, 0, -1);
    this.world.quaternion.setFromUnitVectors(down, UP.clone().negate());
    const points = robot.base.map(vector);
    const count = samples.position.length;
    for (let k = 0; k < count; k += Math.max(1, Math.floor(count / 60))) {
      const [p, q] = this.pose(samples.position[k]);
      for (const b of [...robot.platform, robot.load_point]) points.push(vector(b).applyQuaternion(q).add(p));
    }
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
    const { robot } = this.data;
    const metres = (size) => size / this.scale;
    this.materials = {
      base: new MeshLambertMaterial({ transparent: true, opacity: 0.16, side: DoubleSide, depthWrite: false }),
      frame: new MeshLambertMaterial(),
      platform: new MeshLambertMaterial({ side: DoubleSide, transparent: true, opacity: 0.85 }),
      load: new MeshLambertMaterial(),
      // Drawn in front of the platform, which would hide it.
      tube: new MeshBasicMaterial({ transparent: true, opacity: 0.45, depthWrite: false, depthTest: false }),
      ghost: new MeshBasicMaterial({
        transparent: true, opacity: 0.35, side: DoubleSide, depthWrite: false, depthTest: false,
      }),
      out: new MeshBasicMaterial(),
    };
    const base = robot.base.map(vector);
    this.world.add(...this.body(base, this.materials.base, this.materials.frame, metres(0.006)));
    this.anchors(base, this.world, this.materials.frame, metres(ANCHOR));

    this.platform = new Group();
    const corners = robot.platform.map(vector);
    this.platform.add(...this.body(corners, this.materials.platform, this.materials.frame, metres(0.005)));
    this.anchors(corners, this.platform, this.materials.frame, metres(ANCHOR * 0.8));
    this.world.add(this.platform);

    const rod = new CylinderGeometry(1, 1, 1, 10).translate(0, 0.5, 0);
    this.cables = robot.base.map(() => {
      const mesh = new Mesh(rod, new MeshLambertMaterial());
      // Rings mark a cable that is out of its limits, so that it can be recognised without colour.
      mesh.userData.rings = Array.from({ length: 7 }, () => new Mesh(rod, this.materials.out));
      this.world.add(mesh, ...mesh.userData.rings);
      return mesh;
    });

    // The arrow of the load points down in the scene.
    this.arrow = new Group();
    const shaft = new Mesh(new CylinderGeometry(0.008, 0.008, ARROW, 12), this.materials.load);
    shaft.position.y = -ARROW / 2;
    const tip = new Mesh(new ConeGeometry(0.03, 0.09, 16), this.materials.load);
    tip.position.y = -ARROW;
    tip.rotation.x = Math.PI;
    this.arrow.add(shaft, tip, new Mesh(new SphereGeometry(0.02, 16, 12), this.materials.load));
    this.scene.add(this.arrow);
    this.arrow.visible = vector(robot.force).length() > 0;

    this.paths();
    this.witnesses();
    this.tags = robot.base.map((_, i) => {
      const tag = element("span", {}, String(i + 1));
      this.labels.append(tag);
      return tag;
    });
  }

  /// The hull of some points: a solid, a flat plate, or only the rods between them.
  body(points, material, rodMaterial, thickness) {
    const distinct = points.filter((a, i) => !points.slice(0, i).some((b) => a.distanceTo(b) < 1e-9 / this.scale));
    const ring = flatHull(distinct);
    if (!ring && distinct.length > 3) return [new Mesh(new ConvexGeometry(distinct), material)];
    const outline = ring ?? distinct;
    const parts = [];
    outline.forEach((a, i) => {
      const b = outline[(i + 1) % outline.length];
      if (a !== b) parts.push(this.rod(a, b, thickness, rodMaterial));
    });
    if (outline.length > 2) {
      const geometry = new BufferGeometry();
      geometry.setAttribute("position", new Float32BufferAttribute(outline.flatMap((p) => [p.x, p.y, p.z]), 3));
      geometry.setIndex(outline.slice(2).flatMap((_, i) => [0, i + 1, i + 2]));
      geometry.computeVertexNormals();
      parts.push(new Mesh(geometry, material));
    }
    return parts;
  }

  rod(a, b, thickness, material) {
    const mesh = new Mesh(new CylinderGeometry(1, 1, 1, 8).translate(0, 0.5, 0), material);
    span(mesh, a, b, thickness);
    return mesh;
  }

  anchors(points, group, material, radius) {
    for (const p of points) {
      const ball = new Mesh(new SphereGeometry(radius, 12, 8), material);
      ball.position.copy(p);
      group.add(ball);
    }
  }

  /// The path of the platform's origin, coloured by what is proved; that of the load point, thin; and the tube.
  paths() {
    const { samples, robot, tube_m: tube, stretches } = this.data;
    const ends = stretches.flatMap((s) => [s.from, s.to]);
    const places = [...new Set([...samples.position, ...ends])].sort((a, b) => a - b);
    const origins = places.map((p) => this.pose(p)[0]);
    const loads = places.map((p) => {
      const [origin, q] = this.pose(p);
      return vector(robot.load_point).applyQuaternion(q).add(origin);
    });
    this.lines = [];
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
      const [p, q] = this.pose(position);
      const ghost = new Group();
      const { ghost: material } = this.materials;
      ghost.add(...this.body(robot.platform.map(vector), material, material, 0.006 / this.scale));
      ghost.position.copy(p);
      ghost.quaternion.copy(q);
      this.world.add(ghost);
    }
  }

  show(position) {
    const { robot, samples } = this.data;
    const where = locate(samples.position, position);
    const [p, q] = this.pose(position);
    this.platform.position.copy(p);
    this.platform.quaternion.copy(q);
    this.ends = robot.platform.map((b) => vector(b).applyQuaternion(q).add(p));
    this.cables.forEach((mesh, i) => {
      const f = between(samples.tension[i], where);
      const below = between(samples.tension_below[i], where);
      const above = between(samples.tension_above[i], where);
      const [lower, upper] = robot.tension[i];
      const a = vector(robot.base[i]);
      const b = this.ends[i];
      const length = a.distanceTo(b);
      const share = (x) => (x - lower) / (upper - lower);
      const [low, high] = [share(f - below), share(f + above)];
      const slack = 1e-6 * (robot.length[i][1] - robot.length[i][0]); // samples are rounded
      const out = !(low > 0 && high < 1) ||
        !(length > robot.length[i][0] - slack && length < robot.length[i][1] + slack);
      mesh.material.color.set(tensionColour(low < 1 - high ? low : high));
      span(mesh, a, b, (out ? 1.6 * CABLE : CABLE) / this.scale);
      mesh.userData.rings.forEach((ring, k) => {
        ring.visible = out;
        const at = (t) => a.clone().lerp(b, t);
        span(ring, at((k + 0.62) / 7), at((k + 0.88) / 7), (1.75 * CABLE) / this.scale);
      });
      this.tags[i].className = out ? "out" : "";
      this.tags[i].textContent = out ? `${i + 1} !` : String(i + 1);
    });
    this.scene.updateMatrixWorld();
    this.arrow.position.copy(this.world.localToWorld(vector(robot.load_point).applyQuaternion(q).add(p)));
    this.draw();
  }

  setTheme() {
    const colours = {
      base: "--base", frame: "--base", platform: "--band", load: "--ink", tube: "--curve", ghost: "--mark",
      out: "--ink",
    };
    for (const [name, property] of Object.entries(colours)) this.materials[name].color.set(themed(property));
    for (const { material, name } of this.lines) material.color.set(themed(name));
    this.draw();
  }

  resetView() {
    const { azimuth, elevation } = FIRST_VIEW;
    const from = new Vector3(
      Math.cos(elevation) * Math.sin(azimuth), Math.sin(elevation), Math.cos(elevation) * Math.cos(azimuth));
    const right = UP.clone().cross(from).normalize();
    const up = from.clone().cross(right);
    const vertical = 0.88 * Math.tan(((VIEW_ANGLE / 2) * Math.PI) / 180);
    const horizontal = vertical * this.camera.aspect;
    let distance = 0.5;
    for (const p of this.points) { // all of them are to be seen
      const needed = Math.max(Math.abs(p.dot(right)) / horizontal, Math.abs(p.dot(up)) / vertical);
      distance = Math.max(distance, p.dot(from) + needed);
    }
    this.camera.position.copy(from).multiplyScalar(distance);
    this.controls.target.set(0, 0, 0);
    this.controls.update();
    this.draw();
  }

  /// Moves the camera by keys: angles [rad], and the factor by which it comes nearer.
  orbit(azimuth, elevation, zoom = 1) {
    const offset = this.camera.position.clone().sub(this.controls.target);
    const distance = Math.min(Math.max(offset.length() * zoom, this.controls.minDistance), this.controls.maxDistance);
    const height = Math.asin(offset.y / offset.length());
    const around = Math.atan2(offset.x, offset.z) + azimuth;
    const above = Math.min(Math.max(height + elevation, -1.5), 1.5);
    offset.set(Math.cos(above) * Math.sin(around), Math.sin(above), Math.cos(above) * Math.cos(around))
      .multiplyScalar(distance);
    this.camera.position.copy(this.controls.target).add(offset);
    this.controls.update();
    this.draw();
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.holder;
    if (width === 0 || height === 0) return;
    const before = this.camera.aspect;
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.renderer.setSize(width, height, false);
    for (const { material } of this.lines) material.resolution = new Vector2(width, height);
    if (before !== this.camera.aspect) this.resetView();
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
    this.tags.forEach((tag, i) => {
      const at = this.world.localToWorld(vector(this.data.robot.base[i]).lerp(this.ends[i], 0.42)).project(this.camera);
      const [x, y] = [((at.x + 1) / 2) * width, ((1 - at.y) / 2) * height];
      tag.style.transform = `translate(-50%, -50%) translate(${x}px, ${y}px)`;
    });
  }
}

/// Puts a rod of length 1 along y from a to b.
function span(mesh, a, b, thickness) {
  const along = b.clone().sub(a);
  mesh.position.copy(a);
  mesh.quaternion.setFromUnitVectors(UP, along.clone().normalize());
  mesh.scale.set(thickness, Math.max(along.length(), 1e-12), thickness);
}

/// The convex hull of points in a plane, in order; undefined if they are not in a plane, or fewer than three.
function flatHull(points) {
  let normal = new Vector3();
  for (const a of points) {
    for (const b of points) {
      const n = a.clone().sub(points[0]).cross(b.clone().sub(points[0]));
      if (n.length() > normal.length()) normal = n;
    }
  }
  const size = Math.max(...points.map((p) => p.distanceTo(points[0])), 0);
  if (!(normal.length() > 1e-9 * size * size)) return undefined;
  normal.normalize();
  if (points.some((p) => Math.abs(p.clone().sub(points[0]).dot(normal)) > 1e-3 * size)) return undefined;
  const u = points.reduce((best, p) => (p.distanceTo(points[0]) > best.distanceTo(points[0]) ? p : best), points[0])
    .clone().sub(points[0]).normalize();
  const v = normal.clone().cross(u);
  const flat = points.map((p) => ({ p, x: p.dot(u), y: p.dot(v) })).sort((a, b) => a.x - b.x || a.y - b.y);
  const half = (list) => {
    const chain = [];
    for (const point of list) {
      const turns = () => {
        const [a, b] = chain.slice(-2);
        return (b.x - a.x) * (point.y - a.y) - (b.y - a.y) * (point.x - a.x) > 0;
      };
      while (chain.length > 1 && !turns()) chain.pop();
      chain.push(point);
    }
    return chain.slice(0, -1);
  };
  return [...half(flat), ...half([...flat].reverse())].map(({ p }) => p);
}
