// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Maps of power of radars and of channels that sense: over range and velocity, and over the ground as the
// beams see it, with detections and, of a channel, where its targets truly are.

/// What a radar and a link of a channel that senses have in common.
function mapSourceOf(sensor) {
  if (sensor.kind === 'radar')
    return {name: sensor.name, about: sensor.about, sensor, part: record => record, targets: []};
  return {
    name: sensor.name,
    about: sensor.about.sensing || {},
    sensor,
    targets: sensor.about.targets,
    part: record => (record.sensing || [])[Math.min(
        state.channel === channels().indexOf(sensor) ? state.link : 0, record.sensing.length - 1)]
  };
}

class MapPanel {
  /// `view`: 'range_doppler' or 'range_azimuth'.
  constructor(sensor, view) {
    this.source = mapSourceOf(sensor);
    this.view = view;
    this.whole = false;
    const title = this.source.name + (view === 'range_doppler' ? ': range and velocity' : ': from above');
    const [least, most] = this.azimuths();
    this.tall = view === 'range_doppler' ? 0.8 : most - least > 1.05 * Math.PI ? 1 : 0.55;
    this.board = new Board(
        title, width => Math.min(width, 640) * this.tall,
        (context, width, height) => this.draw(context, width, height));
    this.board.onPointer((x, y) => this.look(x, y), () => this.look(null));
    this.readout = el('p', {class: 'readout'});
    this.legend = el('div', {class: 'legend'});
    this.node =
        el('figure', {class: 'panel'},
           el('figcaption', {}, el('h3', {}, title), this.age = el('span', {class: 'age'}),
              el('div', {class: 'tools'},
                 el('label', {}, el('input', {
                      type: 'checkbox',
                      change: event => {
                        this.whole = event.target.checked;
                        this.board.redraw();
                      }
                    }),
                    'whole range'))),
           this.board.node, this.legend, this.readout);
    this.scale = this.scaleOf();
    this.legend.append(
        colourBar(viridis, this.scale.low, this.scale.high, 'dBm', false),
        el('ul', {class: 'swatches'}, el('li', {}, el('i', {class: 'ring real'}), 'detection of an object'),
           el('li', {}, el('i', {class: 'ring'}), 'of no object'),
           this.source.targets.length ?
               el('li', {}, el('i', {class: 'cross'}, '+'), 'where a target truly is') :
               null));
  }
  /// The azimuths of a map's ends, rad.
  azimuths() {
    const {azimuth_min_rad: least, azimuth_max_rad: most} = this.source.about;
    return [isNumber(least) ? least : -Math.PI / 2, isNumber(most) ? most : Math.PI / 2];
  }
  parts() {
    return this.source.sensor.records
        .map(
            record => record.sensing || this.source.sensor.kind === 'radar' ? this.source.part(record) : null)
        .filter(Boolean);
  }
  /// From 1 dB below the lowest noise to the level that a cell in a thousand exceeds; 12 to 60 dB wide.
  scaleOf() {
    const maps = this.parts().map(part => part[this.view]).filter(Boolean);
    if (!maps.length) return {low: -100, high: -40};
    const floor = Math.min(...maps.map(map => map.floor)), top = Math.max(...maps.map(map => map.top));
    return {low: Math.max(floor - 1, top - 60), high: Math.max(top, floor + 11)};
  }
  detections(part) { return part && part.detections ? textOf(part.detections.blob) : []; }
  /// The farthest range to show: 1.2 times that of the farthest detection of an object or target.
  far(map) {
    const bin = this.source.about.range_bin_m || 1, all = map.rows * bin;
    if (this.whole) return all;
    if (!this.farthest) {
      this.farthest = 0;
      for (const part of this.parts()) {
        for (const row of this.detections(part))
          if (row[10]) this.farthest = Math.max(this.farthest, row[3]);
        for (const row of part.targets || [])
          if (isNumber(row[3])) this.farthest = Math.max(this.farthest, row[0]);
      }
    }
    return this.farthest ? clamp(1.2 * this.farthest, Math.min(all, 16 * bin), all) : all;
  }
  update() {
    this.record = latest(this.source.sensor);
    this.part = this.record ? this.source.part(this.record) : null;
    this.age.textContent = this.record ? ageText(this.record) : 'nothing yet';
    this.board.redraw();
    this.look(null);
  }
  /// The power in a cell of the data set's map, dBm, and its code.
  levelAt(map, row, column) { return map.low + map.step * this.codeAt(map, row, column); }
  codeAt(map, row, column, codes = rasterOf(map, 1, false)) {
    const y = Math.min(map.h - 1, Math.floor(row / map.by[0]));
    return codes[y * map.w + Math.min(map.w - 1, Math.floor(column / map.by[1]))];
  }
  draw(context, width, height) {
    const map = this.part && this.part[this.view];
    this.marks = [];
    if (!map) {
      context.fillStyle = theme.dim;
      context.textAlign = 'center';
      context.fillText('no map yet', width / 2, height / 2);
      return;
    }
    this.view === 'range_doppler' ? this.drawDoppler(context, map, width, height) :
                                    this.drawAbove(context, map, width, height);
  }
  /// A picture of the map, point by point: cellAt(x, y) gives [row, column] or null.
  raster(context, map, left, top, width, height, cellAt) {
    const w = Math.max(1, Math.round(Math.min(width, 480))), h = Math.max(1, Math.round(w * height / width));
    const codes = rasterOf(map, 1, false), image = new ImageData(w, h), range = this.scale;
    const at = code => (map.low + map.step * code - range.low) / (range.high - range.low);
    const colours = Array.from({length: 256}, (_, code) => packColour(viridis(clamp(at(code), 0, 1))));
    const pixels = new Uint32Array(image.data.buffer);
    for (let y = 0; y < h; ++y)
      for (let x = 0; x < w; ++x) {
        const cell = cellAt((x + 0.5) / w, (y + 0.5) / h);
        if (!cell) continue;
        const code = this.codeAt(map, cell[0], cell[1], codes);
        pixels[y * w + x] = colours[code];
      }
    const canvas = el('canvas', {width: w, height: h});
    canvas.getContext('2d').putImageData(image, 0, 0);
    context.imageSmoothingEnabled = false;
    context.drawImage(canvas, left, top, width, height);
  }
  drawDoppler(context, map, width, height) {
    const about = this.source.about, bin = about.range_bin_m || 1, far = this.far(map);
    const v0 = about.velocity_min_m_s, dv = about.velocity_bin_m_s || 1,
          low = (isNumber(v0) ? v0 : 0) - dv / 2;
    const high = low + dv * map.columns, box = {left: 52, top: 8, right: width - 10, bottom: height - 34};
    this.toCell = (x, y) => {
      if (x < box.left || x >= box.right || y < box.top || y >= box.bottom) return null;
      return [
        clamp(Math.round((box.bottom - y) / (box.bottom - box.top) * far / bin), 0, map.rows - 1),
        Math.floor((x - box.left) / (box.right - box.left) * map.columns)
      ];
    };
    this.describe = cell => fixed(cell[0] * bin, 2) + ' m, ' + fixed(low + dv * (cell[1] + 0.5), 2) + ' m/s';
    this.raster(
        context, map, box.left, box.top, box.right - box.left, box.bottom - box.top,
        (s, t) => [Math.min(map.rows - 1, Math.max(0, (1 - t) * far / bin + 0.5)), s * map.columns]);
    drawLines(context, width, height, [], {
      faint: true,
      x: [low, high],
      y: [0, far],
      xUnit: 'velocity, m/s (positive: receding)',
      yUnit: 'range, m'
    });
    const px = v => box.left + (v - low) / (high - low) * (box.right - box.left);
    const py = r => box.bottom - r / far * (box.bottom - box.top);
    const span = dv * (about.symbols || map.columns), all = bin * map.rows;
    const wrap = (x, from, by) => x - by * Math.floor((x - from) / by);
    this.drawMarks(
        context, row => [px(row[4]), py(row[3])],
        target => [px(wrap(target[1], low, span)), py(wrap(target[0], 0, all))], box);
  }
  /// Forward is up; the radius is the range.
  drawAbove(context, map, width, height) {
    const about = this.source.about, bin = about.range_bin_m || 1, far = this.far(map);
    const [least, most] = this.azimuths();
    const behind = most - least > Math.PI * 1.05;
    const zoom = Math.min((width - 16) / (2 * far), (height - 24) / ((behind ? 2 : 1) * far));
    const cx = width / 2, cy = behind ? height / 2 : height - 14;
    const cellAt = (x, y) => {
      const left = (cx - x) / zoom, ahead = (cy - y) / zoom, range = Math.hypot(left, ahead);
      const azimuth = Math.atan2(left, ahead);
      if (range > far || azimuth < least || azimuth > most) return null;
      return [
        Math.min(map.rows - 1, Math.round(range / bin)),
        Math.min(map.columns - 1, Math.floor((azimuth - least) / (most - least) * (map.columns - 1) + 0.5))
      ];
    };
    this.toCell = cellAt;
    this.describe = cell => fixed(cell[0] * bin, 2) + ' m, azimuth ' +
        fixed((least + (most - least) * cell[1] / Math.max(1, map.columns - 1)) * 180 / Math.PI, 1) +
        '\u00b0 to the left';
    this.raster(context, map, 0, 0, width, height, (s, t) => cellAt(s * width, t * height));
    context.strokeStyle = 'rgba(140,150,165,0.6)';
    context.lineWidth = 1;
    const start = -Math.PI / 2 - most, end = -Math.PI / 2 - least;
    for (const range of ticksOf(0, far, 4).filter(r => r > 0)) {
      context.beginPath();
      context.arc(cx, cy, range * zoom, start, end);
      context.stroke();
      label(context, short(range) + ' m', cx + 4, cy - range * zoom + 9, theme.ink);
    }
    context.fillStyle = theme.ink;
    context.beginPath();
    context.arc(cx, cy, 4, 0, 7);
    context.fill();
    const place =
        (range, azimuth) => [cx - range * Math.sin(azimuth) * zoom, cy - range * Math.cos(azimuth) * zoom];
    this.drawMarks(
        context, row => place(row[3], row[5] || 0), target => place(target[0], target[2]),
        {left: 0, top: 0, right: width, bottom: height});
  }
  drawMarks(context, placeOf, placeOfTarget, box) {
    const inside = at => at[0] >= box.left && at[0] <= box.right && at[1] >= box.top && at[1] <= box.bottom;
    const named = new Set(), taken = [], waiting = [], movers = new Set(['vehicle', 'uav', 'person']);
    // A name is left out where another one stands; the pointer tells it.
    const nameAt = (text, x, y) => {
      const wide = context.measureText(text).width;
      if (taken.some(t => Math.abs(t[1] - y) < 14 && x < t[0] + t[2] + 4 && t[0] < x + wide + 4)) return;
      taken.push([x, y, wide]);
      label(context, text, Math.min(x, box.right - wide), y);
    };
    for (const row of this.detections(this.part)) {
      const at = placeOf(row);
      if (!inside(at)) continue;
      context.beginPath();
      context.arc(at[0], at[1], 6, 0, 7);
      context.lineWidth = 3.4;
      context.strokeStyle = 'rgba(0,0,0,0.5)';
      context.stroke();
      context.lineWidth = 1.8;
      context.strokeStyle = row[10] ? '#ff5c5c' : '#c0c4cc';
      context.stroke();
      this.marks.push([
        at[0], at[1],
        'detection: ' + fixed(row[3], 2) + ' m, ' + fixed(row[4], 2) + ' m/s, ' +
            (isNumber(row[5]) ? fixed(row[5] * 180 / Math.PI, 1) + '\u00b0, ' : '') +
            (isNumber(row[7]) ? fixed(row[7], 1) + ' dB above the noise, ' : '') +
            (row[10] ? instanceName(row[10]) : 'of no object')
      ]);
      const name = data.names.instance[row[10]];
      if (row[10] && !named.has(row[10])) {
        named.add(row[10]);
        waiting.push(
            [movers.has(name && name[1]) ? 0 : 1, name ? name[0] : String(row[10]), at[0] + 9, at[1] - 9]);
      }
    }
    (this.part.targets || []).forEach((target, i) => {
      const at = placeOfTarget(target), echo = isNumber(target[3]);
      if (!inside(at)) return;
      context.strokeStyle = echo ? '#ffffff' : '#9aa0aa';
      context.lineWidth = 2;
      for (const [dx, dy] of [[1, 0], [-1, 0], [0, 1], [0, -1]]) {
        context.beginPath();
        context.moveTo(at[0] + 4 * dx, at[1] + 4 * dy);
        context.lineTo(at[0] + 11 * dx, at[1] + 11 * dy);
        context.stroke();
      }
      nameAt(this.source.targets[i] || 'target', at[0] + 10, at[1] + 12);
      this.marks.push([
        at[0], at[1],
        'truth of ' + (this.source.targets[i] || 'target') + ': ' + fixed(target[0], 2) + ' m, ' +
            fixed(target[1], 2) + ' m/s' + (echo ? ', ' + fixed(target[3], 1) + ' dBm' : ', no echo')
      ]);
    });
    for (const [, ...name] of waiting.sort((a, b) => a[0] - b[0]).slice(0, 12)) nameAt(...name);
  }
  look(x, y) {
    const map = this.part && this.part[this.view];
    if (x === null || !map || !this.toCell) {
      this.readout.textContent = '';
      return;
    }
    const cell = this.toCell(x, y), parts = [];
    if (cell) parts.push(this.describe(cell) + ': ' + fixed(this.levelAt(map, cell[0], cell[1]), 1) + ' dBm');
    for (const [px, py, text] of this.marks)
      if (Math.hypot(px - x, py - y) < 9) parts.push(text);
    this.readout.textContent = parts.join('  \u00b7  ');
  }
}

/// A table of the detections of a radar or of the chosen link at the present moment.
class DetectionTable {
  constructor(sensor) {
    this.source = mapSourceOf(sensor);
    this.body = el('tbody');
    this.title = el('summary', {}, 'detections');
    this.node =
        el('details', {class: 'panel wide'}, this.title,
           el('div', {class: 'scroll'},
              el('table', {},
                 el('thead', {},
                    el('tr', {},
                       [
                         'object', 'range, m', 'velocity, m/s', 'azimuth, \u00b0', 'elevation, \u00b0',
                         'above noise, dB', 'power, dBm', 'RCS, dBsm'
                       ].map(headOf))),
                 this.body)));
  }
  update() {
    const record = latest(this.source.sensor), part = record ? this.source.part(record) : null;
    const rows = part && part.detections ? textOf(part.detections.blob) : [];
    this.title.textContent = this.source.name + ': ' + rows.length + ' detections' +
        (part && part.detections && part.detections.all > rows.length ? ' of ' + part.detections.all : '');
    const degrees = x => isNumber(x) ? fixed(x * 180 / Math.PI, 1) : '\u2013';
    clear(this.body).append(...rows.slice(0, 60).map(
        row => el('tr', {}, [
          row[10] ? instanceName(row[10]) : 'of no object', fixed(row[3], 2), fixed(row[4], 2),
          degrees(row[5]), degrees(row[6]), fixed(row[7], 1), fixed(row[8], 1), fixed(row[9], 1)
        ].map(text => el('td', {}, text)))));
  }
}
