// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Where a camera sees a point (docs/camera.md, docs/film.md): from the world by the camera's pose into the
// sensor's frame (x forward, y left, z up), into optical axes (x right, y down, z forward), through
// Brown-Conrady distortion in OpenCV's order, to pixels. Pixel i reaches from i to i + 1.

/// A camera at a record, or null without a pose or intrinsics.
function cameraOf(sensor, record) {
  const about = sensor.about;
  if (!record || !record.pose || !isNumber(about.fx) || !isNumber(about.cx)) return null;
  const lens = about.distortion || null;
  return {
    matrix: poseMatrix(record.pose),
    place: record.pose.slice(0, 3),
    fx: about.fx,
    fy: about.fy,
    cx: about.cx,
    cy: about.cy,
    width: about.width,
    height: about.height,
    lens,
    fold: lens ? foldRadius(lens) : Infinity
  };
}
/// The undistorted radius up to which the radial part grows: beyond it the formula folds back.
function foldRadius([k1, k2, , , k3]) {
  for (let r = 0.002; r < 20; r += 0.002) {
    const s = r * r;
    if (1 + 3 * k1 * s + 5 * k2 * s * s + 7 * k3 * s * s * s <= 0) return r;
  }
  return Infinity;
}
function toOptical(camera, world) {
  const p = turnBack(camera.matrix, sub(world, camera.place));
  return [-p[1], -p[2], p[0]];
}
/// The pixel of a point in optical axes in front of the camera, or null where the lens folds.
function pixelOf(camera, p) {
  let x = p[0] / p[2], y = p[1] / p[2];
  if (camera.lens) {
    const [k1, k2, p1, p2, k3] = camera.lens, s = x * x + y * y;
    if (s > camera.fold * camera.fold) return null;
    const radial = 1 + s * (k1 + s * (k2 + s * k3));
    [x, y] = [
      x * radial + 2 * p1 * x * y + p2 * (s + 2 * x * x), y * radial + p1 * (s + 2 * y * y) + 2 * p2 * x * y
    ];
  }
  return [camera.cx + camera.fx * x, camera.cy + camera.fy * y];
}
/// The pixel of a point of the world, with its depth: [u, v, z], or null if it is not in front.
function project(camera, world) {
  const p = toOptical(camera, world);
  const at = p[2] > nearest ? pixelOf(camera, p) : null;
  return at && [at[0], at[1], p[2]];
}
const nearest = 0.05;  // metres
greatx.project = (sensor, record, world) => project(cameraOf(sensor, record), world);

/// The picture of the line from a to b (world): points [u, v, z] about `step` pixels apart. They are even in
/// the pinhole picture, in which 1 / z grows evenly along a line. Parts behind the camera are cut off.
function projectLine(camera, a, b, step) {
  let p = toOptical(camera, a), q = toOptical(camera, b);
  if (p[2] <= nearest && q[2] <= nearest) return [];
  const cut = (inside, outside) => {
    const t = (inside[2] - nearest * 1.001) / (inside[2] - outside[2]);
    return add(inside, scale(sub(outside, inside), t));
  };
  if (p[2] <= nearest) p = cut(q, p);
  if (q[2] <= nearest) q = cut(p, q);
  const pixels = Math.hypot(camera.fx * (p[0] / p[2] - q[0] / q[2]), camera.fy * (p[1] / p[2] - q[1] / q[2]));
  const parts = Math.round(clamp(pixels / step, 1, 600)), points = [];
  for (let i = 0; i <= parts; ++i) {
    const s = i / parts, z = 1 / ((1 - s) / p[2] + s / q[2]);
    const at =
        [((1 - s) * p[0] / p[2] + s * q[0] / q[2]) * z, ((1 - s) * p[1] / p[2] + s * q[1] / q[2]) * z, z];
    const pixel = pixelOf(camera, at);
    points.push(pixel ? [pixel[0], pixel[1], z] : null);
  }
  return points;
}
/// The twelve edges of a box, as pairs of its corners (bit 0: x, bit 1: y, bit 2: z).
const edgesOfBox =
    [[0, 1], [2, 3], [4, 5], [6, 7], [0, 2], [1, 3], [4, 6], [5, 7], [0, 4], [1, 5], [2, 6], [3, 7]];
function cornersOfBox(box) {
  if (box.low)
    return Array.from({length: 8}, (_, i) => [0, 1, 2].map(c => (i >> c & 1 ? box.high : box.low)[c]));
  const m = matrixOf(...box.turn);
  return Array.from(
      {length: 8},
      (_, i) => add(box.center, turn(m, [0, 1, 2].map(c => (i >> c & 1 ? 0.5 : -0.5) * box.size[c]))));
}
