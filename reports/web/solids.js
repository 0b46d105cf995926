// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies of a few corners, and rods between points.
import { BufferGeometry, CylinderGeometry, Float32BufferAttribute, Mesh, Vector3 } from "three";
import { ConvexGeometry } from "three/examples/jsm/geometries/ConvexGeometry.js";

const UP = new Vector3(0, 1, 0);

/// The points without those that coincide with one before.
export function distinct(points) {
  const size = Math.max(...points.map((p) => p.distanceTo(points[0])), 0);
  return points.filter((a, i) => !points.slice(0, i).some((b) => a.distanceTo(b) <= 1e-6 * size));
}

/// The convex hull of some points: a solid, a flat plate, or nothing if they are on a line.
export function hullGeometry(points) {
  const corners = distinct(points);
  const ring = flatHull(corners);
  if (!ring) return corners.length > 3 ? new ConvexGeometry(corners) : undefined;
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new Float32BufferAttribute(ring.flatMap((p) => [p.x, p.y, p.z]), 3));
  geometry.setIndex(ring.slice(2).flatMap((_, i) => [0, i + 1, i + 2]));
  geometry.computeVertexNormals();
  return geometry;
}

/// The edges of the convex hull: pairs of points.
export function hullEdges(points) {
  const corners = distinct(points);
  const ring = flatHull(corners);
  if (ring) return ring.map((a, i) => [a, ring[(i + 1) % ring.length]]);
  if (corners.length < 4) return corners.length > 1 ? [[corners[0], corners[corners.length - 1]]] : [];
  const edges = new Map();
  for (const side of sides(corners)) {
    side.forEach((a, i) => {
      const pair = [a, side[(i + 1) % side.length]];
      edges.set(pair.map((p) => corners.indexOf(p)).sort().join(), pair);
    });
  }
  return [...edges.values()];
}

/// The sides of a solid, each a ring of corners.
function sides(corners) {
  const size = Math.max(...corners.map((p) => p.distanceTo(corners[0])));
  const found = new Map();
  const triples = corners.flatMap((a, i) =>
    corners.slice(i + 1).flatMap((b, j) => corners.slice(i + j + 2).map((c) => [a, b, c])));
  for (const [a, b, c] of triples) {
    const normal = b.clone().sub(a).cross(c.clone().sub(a));
    if (!(normal.length() > 1e-3 * size * size)) continue;
    normal.normalize();
    const heights = corners.map((p) => p.clone().sub(a).dot(normal));
    const [lowest, highest] = [Math.min(...heights), Math.max(...heights)];
    if (lowest < -1e-3 * size && highest > 1e-3 * size) continue;
    const members = corners.filter((_, i) => Math.abs(heights[i]) <= 1e-3 * size);
    found.set(members.map((p) => corners.indexOf(p)).join(), flatHull(members) ?? members);
  }
  return found.values();
}

/// Oblique lines inside a plate, as pairs of points; none in a body that is not flat.
export function hatching(points, spacing) {
  const ring = flatHull(distinct(points));
  if (!ring) return [];
  const u = ring[1].clone().sub(ring[0]).normalize();
  const normal = u.clone().cross(ring[2].clone().sub(ring[0])).normalize();
  const across = u.clone().add(normal.cross(u)).normalize(); // oblique to the first edge
  const heights = ring.map((p) => p.dot(across));
  const lines = [];
  for (let c = Math.min(...heights) + spacing / 2; c < Math.max(...heights) && lines.length < 200; c += spacing) {
    const cuts = ring.flatMap((a, i) => {
      const [b, from, to] = [ring[(i + 1) % ring.length], heights[i], heights[(i + 1) % ring.length]];
      return from < c !== to < c ? [a.clone().lerp(b, (c - from) / (to - from))] : [];
    });
    if (cuts.length === 2) lines.push(cuts);
  }
  return lines;
}

/// A cylinder of radius 1 from the origin to (0, 1, 0), which span() puts anywhere.
export const rodGeometry = (sides) => new CylinderGeometry(1, 1, 1, sides).translate(0, 0.5, 0);

/// Puts a rod of length 1 along y from a to b.
export function span(mesh, a, b, radius) {
  const along = b.clone().sub(a);
  mesh.position.copy(a);
  mesh.quaternion.setFromUnitVectors(UP, along.clone().normalize());
  mesh.scale.set(radius, Math.max(along.length(), 1e-12), radius);
}

export function rod(a, b, radius, material) {
  const mesh = new Mesh(rodGeometry(10), material);
  span(mesh, a, b, radius);
  return mesh;
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
