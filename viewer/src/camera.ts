// Where the viewer stands at the start: a direction that spreads the shape on the screen, and a distance at which all of it is just in sight.

import { PerspectiveCamera, Vector3 } from 'three';

/** Moves the camera along its viewing direction (and the target sideways) so that every point is inside the picture with a margin. Returns the new target. */
export function frame(camera: PerspectiveCamera, points: Float32Array[], direction: Vector3, up: Vector3, margin = 1.08): Vector3 {
  const back = direction.clone().normalize();
  const right = new Vector3().crossVectors(up, back);
  if (right.lengthSq() < 1e-12) right.crossVectors(new Vector3(0, 1, 0), back);
  if (right.lengthSq() < 1e-12) right.crossVectors(new Vector3(1, 0, 0), back);
  right.normalize();
  const top = new Vector3().crossVectors(back, right);
  const tanV = Math.tan((camera.fov * Math.PI) / 360) / margin;
  const tanH = tanV * camera.aspect;
  const all = points.filter((p) => p.length > 0);
  // A point (a, b, c) in the basis (right, top, back) is in sight of a camera at (x, y, z) when |a - x| <= tanH (z - c), |b - y| <= tanV (z - c):
  // four support numbers for each direction give the closest camera.
  const s = { r: -Infinity, l: -Infinity, t: -Infinity, b: -Infinity, near: -Infinity, far: Infinity };
  for (const p of all) {
    for (let i = 0; i < p.length; i += 3) {
      const a = p[i] * right.x + p[i + 1] * right.y + p[i + 2] * right.z;
      const b = p[i] * top.x + p[i + 1] * top.y + p[i + 2] * top.z;
      const c = p[i] * back.x + p[i + 1] * back.y + p[i + 2] * back.z;
      s.r = Math.max(s.r, a + tanH * c);
      s.l = Math.max(s.l, -a + tanH * c);
      s.t = Math.max(s.t, b + tanV * c);
      s.b = Math.max(s.b, -b + tanV * c);
      s.near = Math.max(s.near, c);
      s.far = Math.min(s.far, c);
    }
  }
  if (!Number.isFinite(s.r)) Object.assign(s, { r: 1, l: 1, t: 1, b: 1, near: 1, far: -1 });
  const x = (s.r - s.l) / 2, y = (s.t - s.b) / 2;
  const z = Math.max((s.r + s.l) / (2 * tanH), (s.t + s.b) / (2 * tanV), s.near + 1e-6);
  const middle = (s.near + s.far) / 2;
  const place = (depth: number) => right.clone().multiplyScalar(x).addScaledVector(top, y).addScaledVector(back, depth);
  const target = place(middle);
  const size = Math.max(1e-12, s.near - s.far, (s.r + s.l) / 2, (s.t + s.b) / 2);
  camera.position.copy(place(Math.max(z, middle + 1e-3 * size)));
  camera.up.copy(Math.abs(up.clone().normalize().dot(back)) > 0.999 ? top : up);
  camera.near = Math.max(1e-4 * size, 0.02 * camera.position.distanceTo(target));
  camera.far = camera.position.distanceTo(target) + 50 * size;
  camera.lookAt(target);
  camera.updateProjectionMatrix();
  return target;
}

/** Among views from above on all sides, the one in which the points cover the largest area (determinant of their projected covariance). */
export function goodDirection(x: Float32Array, up: Vector3): Vector3 {
  const n = x.length / 3;
  const stride = Math.max(1, Math.floor(n / 4000));
  const mean = [0, 0, 0];
  let count = 0;
  for (let i = 0; i < n; i += stride, ++count) for (let k = 0; k < 3; ++k) mean[k] += x[3 * i + k];
  const c = [0, 0, 0, 0, 0, 0];
  for (let i = 0; i < n; i += stride) {
    const d = [0, 1, 2].map((k) => x[3 * i + k] - mean[k] / Math.max(1, count));
    [d[0] * d[0], d[1] * d[1], d[2] * d[2], d[0] * d[1], d[0] * d[2], d[1] * d[2]].forEach((v, k) => (c[k] += v));
  }
  const quadratic = (a: Vector3, b: Vector3) =>
    a.x * (c[0] * b.x + c[3] * b.y + c[4] * b.z) + a.y * (c[3] * b.x + c[1] * b.y + c[5] * b.z) + a.z * (c[4] * b.x + c[5] * b.y + c[2] * b.z);
  const e = Math.abs(up.z) > 0.5 ? new Vector3(1, 0, 0) : new Vector3(0, 0, 1);
  const f = new Vector3().crossVectors(up, e);
  let best = new Vector3(), most = -1;
  for (const azimuth of [-60, -35, -120, -145, 35, 60, 120, 145]) {
    const a = (azimuth * Math.PI) / 180, h = (26 * Math.PI) / 180;
    const d = e.clone().multiplyScalar(Math.cos(a) * Math.cos(h)).addScaledVector(f, Math.sin(a) * Math.cos(h)).addScaledVector(up, Math.sin(h));
    const right = new Vector3().crossVectors(up, d).normalize();
    const top = new Vector3().crossVectors(d, right);
    const area = quadratic(right, right) * quadratic(top, top) - quadratic(right, top) ** 2;
    if (area > 1.02 * most) (most = area), (best = d);
  }
  return best;
}
