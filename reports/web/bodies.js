// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies that may not touch: obstacles and what is on the platform, cables as thick as they are, and between which two
// points the nearest pair is nearest.
import {
  BufferGeometry,
  CapsuleGeometry,
  DoubleSide,
  EdgesGeometry,
  Float32BufferAttribute,
  Group,
  LineBasicMaterial,
  LineSegments,
  Mesh,
  MeshBasicMaterial,
  MeshLambertMaterial,
  Raycaster,
  SphereGeometry,
  Vector2,
  Vector3,
} from "three";
import { ConvexGeometry } from "three/examples/jsm/geometries/ConvexGeometry.js";
import { distinct, hullEdges, hullGeometry, rod, rodGeometry, span } from "./solids.js";

const THINNEST_CABLE = 0.007; // a thinner one would be inside of the rod that stands for it
const DOT = 0.011;
const LINK = 0.0045;
const DIRECTIONS = 40; // around the corners of a rounded body
const GRID = 8; // lines across a half-space
const SHARP = 25; // [°] edges that are drawn

const vector = ([x, y, z]) => new Vector3(x, y, z);
const UP = new Vector3(0, 1, 0);

/// What of the data a body consists of, in metres; undefined where it is too thin to be a solid.
function solid(shape) {
  if (shape.corners) {
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new Float32BufferAttribute(shape.corners, 3));
    geometry.setIndex(shape.triangles);
    return geometry;
  }
  const points = shape.points.map(vector);
  const { radius } = shape;
  if (points.length === 1) return new SphereGeometry(radius, 40, 24).translate(...points[0].toArray());
  if (points.length === 2 && radius > 0) {
    const along = points[1].clone().sub(points[0]);
    const geometry = new CapsuleGeometry(radius, along.length(), 12, 28);
    const turn = new Mesh(geometry);
    turn.quaternion.setFromUnitVectors(UP, along.normalize());
    turn.position.copy(points[0]).add(points[1]).multiplyScalar(0.5);
    turn.updateMatrix();
    return geometry.applyMatrix4(turn.matrix);
  }
  if (!(radius > 0)) return hullGeometry(points);
  return new ConvexGeometry(distinct(points).flatMap((p) => around(p, radius)));
}

/// Points on a sphere.
function around(p, radius) {
  const golden = Math.PI * (3 - Math.sqrt(5));
  return Array.from({ length: DIRECTIONS }, (_, k) => {
    const z = 1 - (2 * k + 1) / DIRECTIONS;
    const across = Math.sqrt(1 - z * z);
    return new Vector3(across * Math.cos(golden * k), across * Math.sin(golden * k), z).multiplyScalar(radius).add(p);
  });
}

function edgesOf(shape, geometry) {
  if (!shape.corners && shape.points.length > 2 && shape.points.length <= 24 && !(shape.radius > 0)) {
    return new BufferGeometry().setFromPoints(hullEdges(shape.points.map(vector)).flat());
  }
  const isSmooth = !shape.corners && (shape.radius > 0 || shape.points.length < 3);
  return isSmooth ? undefined : new EdgesGeometry(geometry, SHARP);
}

export function bodyMaterials() {
  const see = (opacity, lines = 0.9) => ({
    faces: new MeshLambertMaterial({ transparent: true, opacity, side: DoubleSide, depthWrite: false }),
    edges: new LineBasicMaterial({ transparent: true, opacity: lines }),
  });
  const inFront = { transparent: true, depthWrite: false, depthTest: false };
  return {
    obstacle: see(0.45), carried: see(0.6), plane: see(0.16, 0.3),
    cable: new MeshLambertMaterial({ transparent: true, opacity: 0.35, depthWrite: false }),
    link: new MeshBasicMaterial(inFront), linkCasing: new MeshBasicMaterial({ ...inFront, opacity: 0.8 }),
  };
}

/// The bodies of the picture of a machine.
export class Bodies {
  /// @param world, platform groups of their axes  @param scale of the picture: its units in a metre
  constructor(data, world, platform, materials, scale) {
    Object.assign(this, { data: data.bodies, isFound: data.is_found, materials, scale });
    this.robot = data.robot;
    this.targets = []; // what answers to the pointer
    this.names = []; // of bodies, and where their names stand
    for (const shape of this.data.shapes) this.add(shape, shape.is_obstacle ? world : platform);
    this.cables = this.data.has_cables && this.isFound
      ? this.data.cable_radius.map((radius) => (radius * scale > THINNEST_CABLE ? this.cable(world) : undefined)) : [];
    this.cablesAreThin = this.data.has_cables && !this.cables.some(Boolean);
    this.link = this.data.nearest.pair.length > 0 && this.isFound ? this.makeLink(world) : undefined;
  }

  add(shape, group) {
    if (shape.plane) {
      this.addPlane(shape, group);
      return;
    }
    const { faces, edges } = this.materials[shape.is_obstacle ? "obstacle" : "carried"];
    const geometry = solid(shape);
    if (!geometry) {
      const [a, b] = shape.points.map(vector);
      if (b) group.add(rod(a, b, 0.004 / this.scale, faces));
      return;
    }
    const flat = geometry.index ? geometry.toNonIndexed() : geometry;
    if (shape.corners || !(shape.radius > 0)) flat.computeVertexNormals();
    const mesh = new Mesh(flat, faces);
    mesh.userData.name = shape.name;
    mesh.renderOrder = -0.5;
    group.add(mesh);
    this.targets.push(mesh);
    const outline = edgesOf(shape, geometry);
    if (outline) group.add(new LineSegments(outline, edges));
    flat.computeBoundingBox();
    this.names.push({ name: shape.name, group, at: flat.boundingBox.getCenter(new Vector3()),
      kind: shape.is_obstacle ? "obstacle" : "carried" });
  }

  /// The part of a plane that is next to the machine, with a grid.
  addPlane(shape, group) {
    const corners = shape.plane.map(vector);
    const [a, b, c, d] = corners;
    const geometry = new BufferGeometry().setFromPoints([a, b, c, a, c, d]);
    geometry.computeVertexNormals();
    const { faces, edges } = this.materials.plane;
    const mesh = new Mesh(geometry, faces);
    mesh.userData.name = shape.name;
    mesh.renderOrder = -2;
    const lines = [];
    for (let k = 0; k <= GRID; ++k) {
      const t = k / GRID;
      lines.push(a.clone().lerp(b, t), d.clone().lerp(c, t), a.clone().lerp(d, t), b.clone().lerp(c, t));
    }
    const grid = new LineSegments(new BufferGeometry().setFromPoints(lines), edges);
    grid.renderOrder = -2;
    group.add(mesh, grid);
    this.targets.push(mesh);
    this.names.push({ name: shape.name, group, at: a.clone().lerp(b, 0.12).lerp(d, 0.06), kind: "obstacle" });
  }

  cable(world) {
    const mesh = new Mesh(rodGeometry(20), this.materials.cable);
    mesh.renderOrder = -0.4;
    world.add(mesh);
    return mesh;
  }

  makeLink(world) {
    const { link, linkCasing } = this.materials;
    const rods = rodGeometry(8);
    const dot = new SphereGeometry(DOT / this.scale, 16, 12);
    const parts = { casing: new Mesh(rods, linkCasing), core: new Mesh(rods, link),
      ends: [new Mesh(dot, link), new Mesh(dot, link)] };
    const group = new Group();
    group.add(parts.casing, parts.core, ...parts.ends);
    [parts.casing, parts.core, ...parts.ends].forEach((part, k) => {
      part.renderOrder = 4 + k;
    });
    world.add(group);
    return parts;
  }

  /// @param where of the samples: index, and the share of the way to the next
  /// @param ends of the cables at the platform
  show([k, t], ends) {
    this.cables.forEach((mesh, i) => {
      if (!mesh) return;
      const a = vector(this.robot.base[i]);
      const along = ends[i].clone().sub(a).normalize();
      const [base, platform] = this.data.free_ends[i];
      span(mesh, a.addScaledVector(along, base), ends[i].clone().addScaledVector(along, -platform),
        this.data.cable_radius[i]);
    });
    if (!this.link) return;
    const [a, b] = nearestPoints(this.data.nearest, [k, t]).map(vector);
    const { core, casing, ends: dots } = this.link;
    dots[0].position.copy(a);
    dots[1].position.copy(b);
    span(core, a, b, LINK / this.scale);
    span(casing, a, b, (2.2 * LINK) / this.scale);
    core.visible = casing.visible = a.distanceTo(b) * this.scale > 1e-4;
  }

  /// The name of the body that the pointer is on, or undefined. @param at in the picture, from −1 to 1
  nameAt(at, camera) {
    const ray = new Raycaster();
    ray.setFromCamera(new Vector2(...at), camera);
    const hits = ray.intersectObjects(this.targets, false);
    // What is in front of a floor or a wall is meant rather than these.
    return hits[0]?.object.userData.name;
  }
}

/// The nearest points of the nearest pair at a place; between two samples with different pairs those of the nearer one.
export function nearestPoints(nearest, [k, t]) {
  const at = (columns, i) => columns.map((column) => column[i]);
  const isSame = t > 0 && nearest.pair[k] === nearest.pair[k + 1];
  if (!isSame) {
    const i = t > 0.5 ? k + 1 : k;
    return [at(nearest.first, i), at(nearest.second, i)];
  }
  return [nearest.first, nearest.second].map((columns) => columns.map((c) => c[k] + t * (c[k + 1] - c[k])));
}

/// What is said of the nearest pair at a place: its name, distance [m], clearance [m], and whether it is a cable and
/// its exit cone.
export function nearestPair({ nearest, names }, [k, t]) {
  const isSame = t > 0 && nearest.pair[k] === nearest.pair[k + 1];
  const i = !isSame && t > 0.5 ? k + 1 : k;
  const distance = isSame ? nearest.distance[k] + t * (nearest.distance[k + 1] - nearest.distance[k])
    : nearest.distance[i];
  return { name: names[nearest.pair[i]], distance, clearance: nearest.clearance[i], isCone: nearest.cone[i] === 1 };
}
