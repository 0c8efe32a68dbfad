// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// A small renderer in plain JavaScript with a depth buffer, which draws points and lines, so that the page
// looks the same in every browser and needs no GPU. 100,000 points take some milliseconds.

/// Pixels with a depth buffer; `pick` holds for each pixel which point it shows (0: none).
class Raster {
  constructor(width, height) {
    this.width = width;
    this.height = height;
    this.image = new ImageData(width, height);
    this.pixels = new Uint32Array(this.image.data.buffer);
    this.depth = new Float32Array(width * height);
    this.pick = new Uint32Array(width * height);
  }
  clear(colour) {
    this.pixels.fill(colour);
    this.depth.fill(Infinity);
    this.pick.fill(0);
  }
  dot(x, y, z, colour, size, pick) {
    const x0 = Math.max(0, x), x1 = Math.min(this.width, x + size), y1 = Math.min(this.height, y + size);
    for (let j = Math.max(0, y); j < y1; ++j)
      for (let i = j * this.width + x0, end = j * this.width + x1; i < end; ++i)
        if (z < this.depth[i]) {
          this.depth[i] = z;
          this.pixels[i] = colour;
          this.pick[i] = pick;
        }
  }
  /// A line between points [x, y, z] of the picture, cut off at its rim. Depth is even in 1 / z.
  line(a, b, colour, size) {
    let t0 = 0, t1 = 1;
    for (const [from, by, low, high] of [
             [a[0], b[0] - a[0], -size, this.width], [a[1], b[1] - a[1], -size, this.height]]) {
      if (by === 0) {
        if (from < low || from > high) return;
        continue;
      }
      const enter = ((by > 0 ? low : high) - from) / by, leave = ((by > 0 ? high : low) - from) / by;
      t0 = Math.max(t0, enter);
      t1 = Math.min(t1, leave);
    }
    if (t0 >= t1) return;
    const steps = Math.ceil((t1 - t0) * Math.max(Math.abs(b[0] - a[0]), Math.abs(b[1] - a[1]))) || 1;
    for (let i = 0; i <= steps; ++i) {
      const t = t0 + (t1 - t0) * i / steps, z = 1 / ((1 - t) / a[2] + t / b[2]);
      this.dot(
          Math.floor(a[0] + t * (b[0] - a[0])), Math.floor(a[1] + t * (b[1] - a[1])), z * 0.999, colour, size,
          0);
    }
  }
}
const packColour = c => (255 << 24 | c[2] << 16 | c[1] << 8 | c[0]) >>> 0;
function colourOfCss(text) {
  const context = el('canvas', {width: 1, height: 1}).getContext('2d');
  context.fillStyle = text;
  context.fillRect(0, 0, 1, 1);
  return [...context.getImageData(0, 0, 1, 1).data.slice(0, 3)];
}

/// The points of a LiDAR's record from the sequence's origin, and what colours them.
function cloudOf(record) {
  return keptArrays.get('cloud ' + record.points.blob, () => {
    const count = record.points.count, codes = new Int16Array(numbersOf(record.points.blob, 2, count).buffer);
    const pose = record.pose || [0, 0, 0, 1, 0, 0, 0], m = poseMatrix(pose), step = record.points.step;
    const places = new Float32Array(3 * count), ranges = new Float32Array(count);
    for (let i = 0; i < count; ++i) {
      const p = [codes[i] * step, codes[count + i] * step, codes[2 * count + i] * step], at = turn(m, p);
      ranges[i] = length(p);
      for (let c = 0; c < 3; ++c) places[3 * i + c] = at[c] + pose[c];
    }
    const levels = numbersOf(record.intensity.blob, 2, 0);
    const intensities = Float32Array.from(levels, code => code === 0 ? 0 : logValue(record.intensity, code));
    return {
      count,
      places,
      ranges,
      intensities,
      instances: record.instance ? numbersOf(record.instance.blob, 4, 0) : null
    };
  });
}
greatx.cloudOf = cloudOf;
function quantiles(values, shares) {
  const sorted = Float32Array.from(values).filter(Number.isFinite).sort();
  return shares.map(share => sorted.length ? sorted[Math.floor(share * (sorted.length - 1))] : 0);
}
const groundKinds = new Set(['ground', 'road', 'pavement', 'lane_marking', 'unlabeled', 'water', '']);
