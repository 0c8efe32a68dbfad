// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The data of the page, and what is shown of them: sequence, moment, channel, link, path. Panels are told by
// events of `state` and ask the functions below; nothing flows back.

const data = JSON.parse(document.getElementById('data').textContent);
const state = {
  sequence: 0,
  moment: 0,
  channel: 0,
  link: 0,
  path: -1,
  listeners: []
};
greatx.data = data;
greatx.state = state;

const sequence = () => data.sequences[state.sequence];
const moments = () => sequence().moments;
const present = () => moments()[state.moment] || [0, 0];
/// Lets every panel draw again. `what`: 'moment', 'sequence', 'channel', 'path' or 'theme'.
function tell(what) {
  for (const listener of state.listeners) listener(what);
}

/// The latest record of a sensor at the present moment, or null.
function latest(sensor) {
  const records = sensor.records || [], tick = present()[0];
  let low = 0, high = records.length;
  while (low < high) {
    const middle = low + high >> 1;
    if (records[middle].tick <= tick)
      low = middle + 1;
    else
      high = middle;
  }
  return low > 0 ? records[low - 1] : null;
}
/// " (12.3 s, 40 ms before)" if a record is older than the moment.
function ageText(record) {
  const age = present()[1] - record.time;
  return age > 1e-9 ? 'from ' + short(record.time, 6) + ' s, ' + short(1e3 * age, 3) + ' ms before' : '';
}

const sensorsOf = kind => sequence().sensors.filter(sensor => sensor.kind === kind);
const channels = () => sensorsOf('csi');
const channel = () => channels()[state.channel] || null;
/// The links of a channel, receiver by receiver.
function linksOf(sensor) {
  const links = [];
  sensor.about.rx.forEach(
      (rx, r) => sensor.about.tx.forEach(
          (tx, t) => links.push({rx: r, tx: t, name: rx.name + ' \u2190 ' + tx.name})));
  return links;
}
const link = () => channel() ? linksOf(channel())[state.link] || null : null;

const kindsOfInteraction = ['', 'reflection', 'transmission', 'diffraction', 'scattering', 'target'];
/// The paths of the chosen link at the present moment, the strongest first. Points are [x, y, z] from the
/// transmitter to the receiver; an end without a pose is left out.
function presentPaths() {
  const chosen = channel(), way = link();
  const record = chosen && latest(chosen);
  if (!record || !record.paths || !way) return [];
  const ends = [record.tx[way.tx], record.rx[way.rx]];
  return textOf(record.paths.blob).filter(row => row[0] === way.rx && row[1] === way.tx).map(row => {
    const points = [];
    if (ends[0]) points.push(ends[0].slice(0, 3));
    for (let i = 0; i + 2 < row[6].length; i += 3)
      if (row[6][i] !== null) points.push(row[6].slice(i, i + 3));
    if (ends[1]) points.push(ends[1].slice(0, 3));
    return {
      delay: row[2],
      power: row[3],
      doppler: row[4],
      kinds: row[5],
      objects: row[7],
      materials: row[8],
      departure: [row[9], row[10]],
      arrival: [row[11], row[12]],
      points,
      first: ends[0] ? 1 : 0
    };
  });
}
/// The scale of the powers of paths: the upper 40 dB.
function powerScale(paths) {
  const powers = paths.map(path => path.power).filter(isNumber);
  const top = powers.length ? Math.max(...powers) : 0;
  return {low: top - 40, high: top, at: power => isNumber(power) ? (power - top + 40) / 40 : 0};
}
const colourOfPath = (scale, path) => turbo(0.1 + 0.8 * clamp(scale.at(path.power), 0, 1));

function instanceName(id) {
  if (id === 0) return 'nothing';
  const found = data.names.instance[id];
  if (!found) return 'instance ' + id;
  return (found[0] || 'instance ' + id) + (found[1] ? ' (' + found[1] + ')' : '');
}
const className = id => data.names.semantic[id] || (id === 0 ? 'nothing' : 'class ' + id);
const materialName = id => id === 0 ? 'nothing' : data.names.material[id] || 'material ' + id;

/// World coordinates of a point from the sequence's origin.
const worldOf = p => add(p, sequence().origin);
/// The scene's boxes from the origin of the sequence: {id, kind, low, high}.
function sceneObjects() {
  const shift = sub(data.origin, sequence().origin);
  return data.objects.map(
      row =>
          ({id: row[0], kind: row[1], low: add(row.slice(2, 5), shift), high: add(row.slice(5, 8), shift)}));
}
/// The boxes that the cameras know at the present moment, each once.
function presentBoxes() {
  const found = new Map();
  for (const camera of sensorsOf('camera')) {
    const record = latest(camera);
    if (!record || !record.boxes) continue;
    for (const row of textOf(record.boxes.blob))
      if (!found.has(row[0]))
        found.set(
            row[0], {id: row[0], center: row.slice(6, 9), size: row.slice(9, 12), turn: row.slice(12, 16)});
  }
  return [...found.values()];
}
/// The detections of radars and of channels that sense, as points: {at, sensor, range, velocity, id}.
function presentDetections() {
  const found = [];
  const take = (sensor, pose, list) => {
    for (const row of list)
      if (pose && isNumber(row[0]))
        found.push({
          at: toParent(pose, row.slice(0, 3)),
          sensor: sensor.name,
          range: row[3],
          velocity: row[4],
          snr: row[7],
          id: row[10]
        });
  };
  for (const sensor of sequence().sensors) {
    const record = (sensor.kind === 'radar' || sensor.kind === 'csi') && latest(sensor);
    if (!record) continue;
    if (record.detections) take(sensor, record.pose, textOf(record.detections.blob));
    for (const part of record.sensing || [])
      if (part.detections) take(sensor, record.rx[part.rx], textOf(part.detections.blob));
  }
  return found;
}
