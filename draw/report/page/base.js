// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Elements of the page, numbers as text, vectors, and colours. Text from the data set gets into the page by
// textContent alone, never as HTML.
'use strict';
const greatx = {};

/// Makes an element: el('p', {class: 'dim'}, 'text', child). A function becomes a listener.
function el(tag, attributes, ...children) {
  const node = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes || {})) {
    if (value === null || value === undefined || value === false) continue;
    if (typeof value === 'function')
      node.addEventListener(name, value);
    else
      node.setAttribute(name, value === true ? '' : String(value));
  }
  for (const child of children.flat(Infinity))
    if (child !== null && child !== undefined) node.append(child instanceof Node ? child : String(child));
  return node;
}
const clear = node => {
  while (node.firstChild) node.removeChild(node.firstChild);
  return node;
};
const clamp = (x, low, high) => Math.min(high, Math.max(low, x));
const isNumber = x => typeof x === 'number' && Number.isFinite(x);

/// The head of a column; those of words stand at the left.
const wordColumns = new Set(['interactions', 'objects', 'type', 'unit', 'meaning']);
const headOf = text => el('th', {scope: 'col', class: wordColumns.has(text) ? 'text' : null}, text);
/// Four significant digits at most, with a true minus.
function short(x, digits = 4) {
  if (!isNumber(x)) return '\u2013';
  if (x === 0) return '0';
  const size = Math.abs(x);
  let text = size >= 1e6 || size < 1e-3 ? x.toExponential(Math.min(2, digits - 1)) :
                                          String(parseFloat(x.toPrecision(digits)));
  return text.replace('-', '\u2212').replace('e+', 'e');
}
const fixed = (x, digits) => isNumber(x) ? x.toFixed(digits).replace('-', '\u2212') : '\u2013';
/// Bytes as people read them.
function sizeText(bytes) {
  for (const unit of ['B', 'kB', 'MB', 'GB']) {
    if (bytes < 1000 || unit === 'GB') return short(bytes, 3) + ' ' + unit;
    bytes /= 1000;
  }
  return '';
}

/// Round values within low..high, about `count` of them.
function ticksOf(low, high, count) {
  if (!(high > low)) return [];
  const rough = (high - low) / Math.max(1, count), power = Math.pow(10, Math.floor(Math.log10(rough)));
  const step = power * [1, 2, 5, 10].find(x => x * power >= rough * 0.999);
  const ticks = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; ++k)
    ticks.push(Math.abs(k * step) < 1e-12 * step ? 0 : parseFloat((k * step).toPrecision(12)));
  return ticks;
}
/// The largest of 1, 2 and 5 times a power of ten that is not above x.
function roundDown(x) {
  const power = Math.pow(10, Math.floor(Math.log10(x)));
  return power * [5, 2, 1].find(k => k * power <= x * 1.0001);
}
/// Round values of a logarithmic scale.
function logTicksOf(low, high) {
  const ticks = [];
  for (let power = Math.floor(Math.log10(low)); power <= Math.log10(high); ++power)
    for (const x of high / low > 1000 ? [1] : [1, 2, 5])
      if (x * 10 ** power >= low && x * 10 ** power <= high) ticks.push(x * 10 ** power);
  return ticks;
}

// Vectors are [x, y, z]; a pose is [x, y, z, qw, qx, qy, qz] and takes child coordinates to its parent's.
const add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
const sub = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const scale = (a, s) => [a[0] * s, a[1] * s, a[2] * s];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const length = a => Math.hypot(a[0], a[1], a[2]);
/// The rotation of a unit quaternion as the rows of a matrix.
function matrixOf(w, x, y, z) {
  return [
    [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
    [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
    [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]
  ];
}
const turn = (m, p) => [dot(m[0], p), dot(m[1], p), dot(m[2], p)];
const turnBack = (m, p) =>
    [m[0][0] * p[0] + m[1][0] * p[1] + m[2][0] * p[2], m[0][1] * p[0] + m[1][1] * p[1] + m[2][1] * p[2],
     m[0][2] * p[0] + m[1][2] * p[1] + m[2][2] * p[2]];
const poseMatrix = pose => matrixOf(pose[3], pose[4], pose[5], pose[6]);
const toParent = (pose, p) => add(turn(poseMatrix(pose), p), pose);
const toChild = (pose, p) => turnBack(poseMatrix(pose), sub(p, pose));

// Colours are [r, g, b] from 0 to 255. The polynomials are those of the contact sheet (draw/canvas).
function polynomial(c, t) {
  t = clamp(t, 0, 1);
  return [0, 1, 2].map(k => {
    let sum = 0;
    for (let i = c.length - 1; i >= 0; --i) sum = sum * t + c[i][k];
    return Math.round(255 * clamp(sum, 0, 1));
  });
}
const table = colour => Array.from({length: 256}, (_, i) => colour(i / 255));
const turboTable = table(
    t => polynomial(
        [
          [0.13572138, 0.09140261, 0.1066733], [4.6153926, 2.19418839, 12.64194608],
          [-42.66032258, 4.84296658, -60.58204836], [132.13108234, -14.18503333, 110.36276771],
          [-152.94239396, 4.27729857, -89.90310912], [59.28637943, 2.82956604, 27.34824973]
        ],
        t));
const viridisTable = table(
    t => polynomial(
        [
          [0.2777273272, 0.0054073445, 0.3340998053], [0.1050930431, 1.4046135299, 1.3845901626],
          [-0.3308618287, 0.2148475595, 0.0950951630], [-4.6342304990, -5.7991009734, -19.3324409563],
          [6.2282699363, 14.1799333668, 56.6905526007], [4.7763849977, -13.7451453777, -65.3530326334],
          [-5.4354558559, 4.6458526122, 26.3124352496]
        ],
        t));
const lookUp = (colours, t) => colours[clamp(Math.round(255 * t), 0, 255)] || colours[0];
const turbo = t => lookUp(turboTable, t), viridis = t => lookUp(viridisTable, t);
const css = c => 'rgb(' + c[0] + ',' + c[1] + ',' + c[2] + ')';

function fromHsv(hue, saturation, value) {
  return [0, 2, 4].map(at => {
    let distance = Math.abs(hue * 6 - at);
    distance = Math.min(distance, 6 - distance);
    return Math.round(255 * value * (1 - saturation * (1 - clamp(2 - distance, 0, 1))));
  });
}
const idColours = new Map();
/// Steps of the golden ratio around the hues separate successive ids.
function colourOfId(id) {
  if (id === 0) return [40, 43, 50];
  let colour = idColours.get(id);
  if (!colour) {
    colour = fromHsv(
        (id * 0.6180339887498949) % 1, 0.45 + 0.15 * (Math.floor(id / 3) % 3),
        0.95 - 0.18 * (Math.floor(id / 7) % 3));
    idColours.set(id, colour);
  }
  return colour;
}
const seriesColours =
    ['#e8871e', '#3d8fd1', '#3fa55b', '#d9517c', '#8f6fe0', '#b39b14', '#23a39a', '#a86a3d'];
const colourOfSeries = n => seriesColours[n % seriesColours.length];
/// Right is red; the hue turns with the direction, white is no motion.
function colourOfFlow(u, v) {
  const size = Math.hypot(u, v);
  const hue = (Math.atan2(v, u) / (2 * Math.PI) + 1) % 1;
  return fromHsv(hue, Math.min(size, 1), size <= 1 ? 1 : 0.8);
}
