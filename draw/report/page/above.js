// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The map from above, north up: objects of the scene, trajectories, antennas, paths and detections.

const coloursOfKinds = {
  building: [150, 150, 160],
  roof: [150, 150, 160],
  vegetation: [95, 160, 95],
  water: [90, 140, 200],
  vehicle: [200, 120, 60],
  uav: [200, 120, 60],
  road: [120, 120, 128],
  pavement: [140, 138, 132]
};

class AboveMap {
  constructor() {
    this.layers = {objects: true, paths: true, detections: true};
    this.board = new Board(
        'map from above, north up', width => clamp(0.62 * width, 260, 640),
        (context, width, height) => this.draw(context, width, height));
    this.canvas = this.board.canvas;
    this.canvas.tabIndex = 0;
    this.canvas.classList.add('turns');
    this.readout = el('p', {class: 'readout'});
    const button = (text, name, act) => el('button', {type: 'button', 'aria-label': name, click: act}, text);
    const has = {
      objects: data.objects.length > 0,
      paths: channels().length > 0,
      detections: sequence().sensors.some(s => (s.records || []).some(r => r.detections || r.sensing))
    };
    const names = {objects: 'objects of the scene', paths: 'paths', detections: 'detections'};
    this.node =
        el('figure', {class: 'panel wide'},
           el('figcaption', {}, el('h3', {}, 'From above'),
              el('div', {class: 'tools'},
                 Object.keys(names)
                     .filter(key => has[key])
                     .map(
                         key =>
                             el('label', {}, el('input', {
                                  type: 'checkbox',
                                  checked: true,
                                  change: event => {
                                    this.layers[key] = event.target.checked;
                                    this.board.redraw();
                                  }
                                }),
                                names[key])),
                 button('\u2212', 'farther', () => this.zoomBy(0.8)),
                 button('+', 'nearer', () => this.zoomBy(1.25)),
                 button(
                     'fit', 'whole map',
                     () => {
                       this.centre = null;
                       this.board.redraw();
                     }))),
           this.board.node,
           el('ul', {class: 'swatches'},
              sequence().lines.slice(0, 16).map(
                  (line, n) => el('li', {}, el('i', {style: 'background:' + colourOfSeries(n)}), line.name)),
              has.paths ? el('li', {}, el('i', {class: 'square'}), 'antenna') : null),
           this.readout);
    this.listen();
  }
  listen() {
    let from = null;
    this.canvas.addEventListener('pointerdown', event => {
      from = [event.clientX, event.clientY];
      this.canvas.setPointerCapture(event.pointerId);
      this.canvas.focus({preventScroll: true});
    });
    this.canvas.addEventListener('pointerup', () => {
      from = null;
    });
    this.canvas.addEventListener('pointermove', event => {
      if (from && this.centre) {
        this.centre = [
          this.centre[0] - (event.clientX - from[0]) / this.zoom,
          this.centre[1] + (event.clientY - from[1]) / this.zoom
        ];
        from = [event.clientX, event.clientY];
        this.board.redraw();
        return;
      }
      const box = this.canvas.getBoundingClientRect();
      this.look(
          (event.clientX - box.left) * this.board.width / box.width,
          (event.clientY - box.top) * this.board.height / box.height);
    });
    this.canvas.addEventListener('wheel', event => {
      if (document.activeElement !== this.canvas) return;
      event.preventDefault();
      this.zoomBy(Math.exp(-clamp(event.deltaY, -100, 100) * 0.002));
    }, {passive: false});
    this.canvas.addEventListener('keydown', event => {
      const move = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1]}[event.key];
      if (move && this.centre)
        this.centre = [this.centre[0] + 30 * move[0] / this.zoom, this.centre[1] + 30 * move[1] / this.zoom];
      else if (event.key === '+' || event.key === '=')
        this.zoomBy(1.2);
      else if (event.key === '-')
        this.zoomBy(0.83);
      else
        return;
      event.preventDefault();
      event.stopPropagation();
      this.board.redraw();
    });
  }
  zoomBy(by) {
    if (this.zoom) {
      this.zoom = clamp(this.zoom * by, 1e-4, 1e4);
      this.board.redraw();
    }
  }
  fit(width, height) {
    const xs = [], ys = [];
    for (const line of sequence().lines)
      for (let i = 0; i + 2 < line.places.length; i += 3) {
        xs.push(line.places[i]);
        ys.push(line.places[i + 1]);
      }
    for (const sensor of channels())
      for (const record of sensor.records.slice(0, 1))
        for (const place of [...record.tx, ...record.rx])
          if (place) {
            xs.push(place[0]);
            ys.push(place[1]);
          }
    if (!xs.length) {
      xs.push(-10, 10);
      ys.push(-10, 10);
    }
    const x = [Math.min(...xs), Math.max(...xs)], y = [Math.min(...ys), Math.max(...ys)];
    this.centre = [(x[0] + x[1]) / 2, (y[0] + y[1]) / 2];
    this.zoom =
        Math.min(width / Math.max(1.4 * (x[1] - x[0]), 30), height / Math.max(1.4 * (y[1] - y[0]), 30));
  }
  update() {
    this.board.redraw();
    this.look(null);
  }
  draw(context, width, height) {
    if (!this.centre) this.fit(width, height);
    const at = p =>
        [width / 2 + (p[0] - this.centre[0]) * this.zoom, height / 2 - (p[1] - this.centre[1]) * this.zoom];
    context.fillStyle = theme.sky;
    context.fillRect(0, 0, width, height);
    context.save();
    context.beginPath();
    context.rect(0, 0, width, height);
    context.clip();
    if (this.layers.objects) this.drawObjects(context, at);
    const paths = this.layers.paths ? presentPaths() : [], powers = powerScale(paths);
    for (let i = paths.length - 1; i >= 0; --i) {
      context.strokeStyle = css(colourOfPath(powers, paths[i]));
      context.globalAlpha = state.path >= 0 && i !== state.path ? 0.25 : 0.9;
      context.lineWidth = i === state.path ? 3 : 1.2;
      context.beginPath();
      paths[i].points.forEach((p, k) => k ? context.lineTo(...at(p)) : context.moveTo(...at(p)));
      context.stroke();
    }
    context.globalAlpha = 1;
    sequence().lines.forEach((line, n) => {
      context.strokeStyle = colourOfSeries(n);
      context.lineWidth = 2;
      context.beginPath();
      for (let i = 0; i + 2 < line.places.length; i += 3) {
        const p = at(line.places.slice(i, i + 3));
        i ? context.lineTo(...p) : context.moveTo(...p);
      }
      context.stroke();
    });
    this.drawMarks(context, at);
    context.restore();
    this.drawFrame(context, width, height);
  }
  drawObjects(context, at) {
    for (const object of this.objects ||
         (this.objects = sceneObjects()
                             .filter(o => !['ground', 'lane_marking', 'unlabeled', ''].includes(o.kind))
                             .sort((a, b) => a.low[2] - b.low[2]))) {
      const a = at(object.low), b = at(object.high), c = coloursOfKinds[object.kind] || [160, 150, 130];
      context.fillStyle =
          'rgba(' + c + ',' + (object.kind === 'road' || object.kind === 'pavement' ? 0.12 : 0.3) + ')';
      context.fillRect(a[0], b[1], b[0] - a[0], a[1] - b[1]);
      if (object.kind === 'building') {
        context.strokeStyle = 'rgba(' + c + ',0.7)';
        context.lineWidth = 1;
        context.strokeRect(a[0], b[1], b[0] - a[0], a[1] - b[1]);
      }
    }
  }
  drawMarks(context, at) {
    if (this.layers.detections)
      for (const detection of presentDetections()) {
        const p = at(detection.at);
        context.beginPath();
        context.arc(p[0], p[1], 4.5, 0, 7);
        context.lineWidth = 1.8;
        context.strokeStyle = detection.id ? '#e5484d' : theme.dim;
        context.stroke();
      }
    const entry = sequence().poses[state.moment];
    for (const [n, pose] of (entry ? entry.poses : []).entries()) {
      if (!pose || !sequence().lines[n]) continue;
      const p = at(pose), ahead = turn(poseMatrix(pose), [1, 0, 0]),
            size = Math.hypot(ahead[0], ahead[1]) || 1;
      context.fillStyle = context.strokeStyle = colourOfSeries(n);
      context.lineWidth = 2.5;
      context.beginPath();
      context.arc(p[0], p[1], 5, 0, 7);
      context.fill();
      context.beginPath();
      context.moveTo(p[0], p[1]);
      context.lineTo(p[0] + 14 * ahead[0] / size, p[1] - 14 * ahead[1] / size);
      context.stroke();
      label(context, sequence().lines[n].name, p[0] + 9, p[1] + 10);
    }
    const chosen = channel(), record = chosen && latest(chosen);
    for (const place of record ? [...record.tx, ...record.rx] : []) {
      if (!place) continue;
      const p = at(place);
      context.fillStyle = theme.ink;
      context.fillRect(p[0] - 3, p[1] - 3, 6, 6);
    }
  }
  drawFrame(context, width, height) {
    const step = roundDown(width / this.zoom * 0.25), size = step * this.zoom, x = 16, y = height - 16;
    context.fillStyle = context.strokeStyle = theme.ink;
    context.lineWidth = 2;
    context.beginPath();
    context.moveTo(x, y - 4);
    context.lineTo(x, y);
    context.lineTo(x + size, y);
    context.lineTo(x + size, y - 4);
    context.stroke();
    label(context, short(step) + ' m', x + size / 2, y - 12, theme.ink, 'center');
    const nx = width - 22, ny = 40;
    context.beginPath();
    context.moveTo(nx, ny);
    context.lineTo(nx, ny - 24);
    context.lineTo(nx - 5, ny - 16);
    context.moveTo(nx, ny - 24);
    context.lineTo(nx + 5, ny - 16);
    context.stroke();
    label(context, 'N', nx, ny + 10, theme.ink, 'center');
  }
  look(x, y) {
    if (x === null || !this.centre) {
      this.readout.textContent = 'Drag: move. Click, then wheel; or + and \u2212: zoom.';
      return;
    }
    const at = worldOf([
      this.centre[0] + (x - this.board.width / 2) / this.zoom,
      this.centre[1] - (y - this.board.height / 2) / this.zoom, 0
    ]);
    this.readout.textContent = 'east ' + fixed(at[0], 1) + ' m, north ' + fixed(at[1], 1) + ' m';
  }
}

/// Where every node is, and how fast, at the present moment.
class PoseTableView {
  constructor() {
    this.body = el('tbody');
    this.geodetic = sequence().poses.some(entry => entry && entry.geodetic);
    this.node = el(
        'div', {class: 'panel wide'}, el('h3', {}, 'Nodes'),
        el('div', {class: 'scroll'},
           el('table', {},
              el('thead', {},
                 el('tr', {},
                    ['node', 'east, m', 'north, m', 'up, m', 'heading, \u00b0']
                        .concat(this.geodetic ? ['latitude, \u00b0', 'longitude, \u00b0', 'height, m'] : [])
                        .map(headOf))),
              this.body)));
  }
  update() {
    const entry = sequence().poses[state.moment];
    clear(this.body).append(...(entry ? entry.poses : []).map((pose, n) => {
      if (!pose) return '';
      const at = worldOf(pose.slice(0, 3)), ahead = turn(poseMatrix(pose), [1, 0, 0]);
      const cells = [
        fixed(at[0], 2), fixed(at[1], 2), fixed(at[2], 2),
        fixed((450 - Math.atan2(ahead[1], ahead[0]) * 180 / Math.PI) % 360, 1)
      ];
      if (this.geodetic) {
        const place = entry.geodetic && entry.geodetic[n] || [];
        cells.push(fixed(place[0], 6), fixed(place[1], 6), fixed(place[2], 2));
      }
      return el(
          'tr', {},
          el('th', {scope: 'row'}, el('i', {class: 'dot', style: 'background:' + colourOfSeries(n)}),
             sequence().lines[n] ? sequence().lines[n].name : 'node ' + n),
          cells.map(text => el('td', {}, text)));
    }));
  }
}
