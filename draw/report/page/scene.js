// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The view in three dimensions: clouds, trajectories, boxes, paths and detections.

class SceneView {
  constructor() {
    const lidars = sensorsOf('lidar');
    this.colour = 'height';
    this.layers =
        {lidar: true, trajectories: true, objects: true, boxes: true, paths: true, detections: true};
    const has = {
      lidar: lidars.length > 0,
      trajectories: sequence().lines.length > 0,
      objects: data.objects.length > 0,
      boxes: sensorsOf('camera').some(camera => camera.records.some(record => record.boxes)),
      paths: channels().length > 0,
      detections: sequence().sensors.some(s => (s.records || []).some(r => r.detections || r.sensing))
    };
    const names = {
      lidar: 'LiDAR points',
      trajectories: 'trajectories',
      objects: 'boxes of the scene',
      boxes: 'boxes of cameras',
      paths: 'paths',
      detections: 'detections'
    };
    this.any = Object.values(has).some(Boolean);
    this.board = new Board(
        'the scene in three dimensions: drag to turn', width => clamp(0.56 * width, 260, 760),
        (context, width, height) => this.draw(context, width, height));
    this.canvas = this.board.canvas;
    this.canvas.tabIndex = 0;
    this.canvas.classList.add('turns');
    this.readout = el('p', {class: 'readout'});
    this.legend = el('div', {class: 'legend'});
    this.node =
        el('figure', {class: 'panel wide'},
           el('figcaption', {}, el('h3', {}, 'Scene'), el('div', {class: 'tools'}, this.tools(has, names))),
           this.board.node, this.legend, this.readout);
    this.follow = '';
    this.place();
    this.listen();
  }
  tools(has, names) {
    const button = (text, name, act) => el('button', {type: 'button', 'aria-label': name, click: act}, text);
    const knowIds = sensorsOf('lidar').some(lidar => lidar.records.some(record => record.instance));
    const colours = ['height', 'intensity', 'range'].concat(knowIds ? ['instance'] : []);
    const choose = change => event => {
      change(event.target.value);
      this.update();
    };
    const colour =
        el('select', {
          change: choose(value => {
            this.colour = value;
          })
        },
           colours.map(name => el('option', {value: name}, name)));
    const follow =
        el('select', {
          change: choose(value => {
            this.follow = value;
          })
        },
           el('option', {value: ''}, 'nothing'),
           sequence().lines.map((line, i) => el('option', {value: i}, line.name)));
    const layer = key =>
        el('label', {}, el('input', {
             type: 'checkbox',
             checked: true,
             change: event => {
               this.layers[key] = event.target.checked;
               this.update();
             }
           }),
           names[key]);
    return [
      has.lidar ? el('label', {}, 'colours ', colour) : null,
      Object.keys(names).filter(key => has[key]).map(layer),
      el('label', {}, 'follow ', follow),
      button('\u2212', 'farther', () => this.zoom(1.25)),
      button('+', 'nearer', () => this.zoom(0.8)),
      button(
          'top', 'from above',
          () => {
            this.elevation = 1.5707;
            this.board.redraw();
          }),
      button(
          'fit', 'first view',
          () => {
            this.place();
            this.board.redraw();
          }),
    ];
  }
  /// Looks at the middle of what moves and of the first cloud.
  place() {
    const points = [];
    for (const line of sequence().lines)
      for (let i = 0; i + 2 < line.places.length; i += 3 * Math.max(1, Math.floor(line.places.length / 300)))
        points.push(line.places.slice(i, i + 3));
    const record =
        sensorsOf('lidar').map(lidar => latest(lidar) || lidar.records[0]).find(r => r && r.points);
    if (record) {
      const cloud = cloudOf(record), reach = quantiles(cloud.ranges, [0.8])[0], at = record.pose || [0, 0, 0];
      points.push(add(at, [reach, reach, 0]), sub(at, [reach, reach, 0]));
    }
    if (!points.length) points.push([10, 10, 0], [-10, -10, 10]);
    const low = [0, 1, 2].map(c => Math.min(...points.map(p => p[c]))),
          high = [0, 1, 2].map(c => Math.max(...points.map(p => p[c])));
    this.target = [0, 1, 2].map(c => (low[c] + high[c]) / 2);
    this.distance = clamp(0.95 * length(sub(high, low)), data.objects.length ? 40 : 4, 1e6);
    this.azimuth = -2.2;
    this.elevation = 0.62;
  }
  zoom(by) {
    this.distance = clamp(this.distance * by, 0.5, 1e6);
    this.board.redraw();
  }
  pan(dx, dy) {
    const s = this.distance / (this.board.height || 400) * 1.2, {right, up} = this.axes();
    this.target = add(this.target, add(scale(right, -dx * s), scale(up, dy * s)));
    this.board.redraw();
  }
  rotate(dx, dy) {
    this.azimuth -= dx * 0.008;
    this.elevation = clamp(this.elevation + dy * 0.008, -1.5707, 1.5707);
    this.board.redraw();
  }
  listen() {
    const pointers = new Map(), canvas = this.canvas;
    canvas.addEventListener('pointerdown', event => {
      pointers.set(event.pointerId, [event.clientX, event.clientY]);
      canvas.setPointerCapture(event.pointerId);
      canvas.focus({preventScroll: true});
    });
    canvas.addEventListener('pointermove', event => {
      const before = pointers.get(event.pointerId), now = [event.clientX, event.clientY];
      if (!before) {
        this.look(event);
        return;
      }
      const others = [...pointers.entries()].filter(([id]) => id !== event.pointerId).map(([, at]) => at);
      const dx = now[0] - before[0], dy = now[1] - before[1];
      if (others.length) {
        const away = at => Math.hypot(at[0] - others[0][0], at[1] - others[0][1]) || 1;
        this.distance = clamp(this.distance * away(before) / away(now), 0.5, 1e6);
        this.pan(dx / 2, dy / 2);
      } else if (event.shiftKey || event.buttons & 6)
        this.pan(dx, dy);
      else
        this.rotate(dx, dy);
      pointers.set(event.pointerId, now);
    });
    for (const name of ['pointerup', 'pointercancel'])
      canvas.addEventListener(name, event => pointers.delete(event.pointerId));
    canvas.addEventListener('pointerleave', () => {
      this.readout.textContent = this.hint();
    });
    canvas.addEventListener('contextmenu', event => event.preventDefault());
    // The wheel scrolls the page until the view has been clicked.
    canvas.addEventListener('wheel', event => {
      if (document.activeElement !== canvas) return;
      event.preventDefault();
      this.zoom(Math.exp(clamp(event.deltaY, -100, 100) * 0.002));
    }, {passive: false});
    canvas.addEventListener('keydown', event => {
      const turns = {ArrowLeft: [-12, 0], ArrowRight: [12, 0], ArrowUp: [0, 12], ArrowDown: [
                       0, -12
                     ]}[event.key];
      if (turns)
        event.shiftKey ? this.pan(2 * turns[0], -2 * turns[1]) : this.rotate(...turns);
      else if (event.key === '+' || event.key === '=')
        this.zoom(0.85);
      else if (event.key === '-')
        this.zoom(1.18);
      else
        return;
      event.preventDefault();
      event.stopPropagation();
    });
  }
  hint() {
    return 'Drag: turn. Shift and drag, or two fingers: move. Click, then wheel; or + and \u2212: zoom. ' +
        'Arrow keys turn, too.';
  }
  axes() {
    const c = Math.cos(this.elevation), s = Math.sin(this.elevation);
    const back = [c * Math.cos(this.azimuth), c * Math.sin(this.azimuth), s];
    const right = [-Math.sin(this.azimuth), Math.cos(this.azimuth), 0];
    return {back, right, up: cross(back, right)};
  }
  update() {
    const entry = sequence().poses[state.moment];
    if (this.follow !== '' && entry && entry.poses[this.follow])
      this.target = entry.poses[this.follow].slice(0, 3);
    this.records = sensorsOf('lidar').map(latest).filter(record => record && record.points);
    clear(this.legend);
    this.spans = {};
    if (this.records.length && this.layers.lidar) {
      const first = cloudOf(sensorsOf('lidar').map(l => l.records[0]).find(r => r.points) || this.records[0]);
      const heights = Array.from({length: first.count}, (_, i) => first.places[3 * i + 2]);
      this.spans = {
        height: quantiles(heights, [0.02, 0.98]),
        range: [0, quantiles(first.ranges, [0.97])[0]],
        intensity: quantiles(first.intensities, [0.03, 0.97])
      };
      if (this.colour === 'instance')
        this.legend.append(el('p', {class: 'dim'}, 'One colour for each instance; the pointer names them.'));
      else {
        const [low, high] = this.spans[this.colour], z = this.colour === 'height' ? sequence().origin[2] : 0;
        const logarithmic = this.colour === 'intensity' && low > 0 && high / low > 10;
        this.legend.append(colourBar(
            t => turbo(0.08 + 0.84 * t), low + z, Math.max(high, low + 1e-6) + z,
            {height: 'm, height (z)', range: 'm, range', intensity: 'intensity'}[this.colour], logarithmic));
      }
    }
    this.readout.textContent = this.hint();
    this.board.redraw();
  }
  coloursOf(record, cloud) {
    const [low, high] = this.spans[this.colour] || [0, 1];
    return keptArrays.get('colours ' + this.colour + record.points.blob, () => {
      const colours = new Uint32Array(cloud.count),
            logarithmic = this.colour === 'intensity' && low > 0 && high / low > 10;
      for (let i = 0; i < cloud.count; ++i) {
        if (this.colour === 'instance') {
          colours[i] = packColour(colourOfId(cloud.instances ? cloud.instances[i] : 0));
          continue;
        }
        const value = this.colour === 'height' ? cloud.places[3 * i + 2] :
            this.colour === 'range'            ? cloud.ranges[i] :
                                                 cloud.intensities[i];
        const t = logarithmic ? Math.log(Math.max(value, low) / low) / Math.log(high / low) :
                                (value - low) / (high - low || 1);
        colours[i] = packColour(turbo(0.08 + 0.84 * clamp(t, 0, 1)));
      }
      return colours;
    });
  }
  draw(context, width, height) {
    const zoom = clamp(1500 / width, 0.5, Math.min(window.devicePixelRatio || 1, 2));
    const w = Math.round(width * zoom), h = Math.round(height * zoom);
    if (!this.raster || this.raster.width !== w || this.raster.height !== h) this.raster = new Raster(w, h);
    const raster = this.raster, {back, right, up} = this.axes(),
          eye = add(this.target, scale(back, this.distance));
    this.zoomed = zoom;
    raster.clear(packColour(colourOfCss(theme.sky)));
    const focal = 0.9 * Math.min(w, 1.6 * h), near = Math.max(0.05, this.distance * 0.002);
    const view = p => {
      const d = sub(p, eye);
      return [dot(d, right), dot(d, up), -dot(d, back)];
    };
    const pixel = v => [w / 2 + focal * v[0] / v[2], h / 2 - focal * v[1] / v[2], v[2]];
    const line = (a, b, colour, size = Math.max(1, Math.round(zoom))) => {
      let p = view(a), q = view(b);
      if (p[2] < near && q[2] < near) return;
      const cut = (inside, outside) =>
          add(inside, scale(sub(outside, inside), (inside[2] - near) / (inside[2] - outside[2])));
      if (p[2] < near) p = cut(q, p);
      if (q[2] < near) q = cut(p, q);
      raster.line(pixel(p), pixel(q), colour, size);
    };
    this.drawGround(line);
    if (this.layers.objects) this.drawObjects(line);
    if (this.layers.lidar) this.drawClouds(raster, view, focal, near, zoom);
    if (this.layers.boxes)
      for (const box of presentBoxes()) {
        const corners = cornersOfBox(box), colour = packColour(colourOfId(box.id));
        for (const [a, b] of edgesOfBox) line(corners[a], corners[b], colour, Math.round(1.4 * zoom));
      }
    if (this.layers.trajectories)
      sequence().lines.forEach((track, n) => {
        const colour = packColour(colourOfCss(colourOfSeries(n))), p = track.places;
        for (let i = 3; i + 2 < p.length; i += 3)
          line(p.slice(i - 3, i), p.slice(i, i + 3), colour, Math.round(2 * zoom));
      });
    if (this.layers.paths) {
      const paths = presentPaths(), scale_ = powerScale(paths);
      for (let i = paths.length - 1; i >= 0; --i)
        for (let k = 0; k + 1 < paths[i].points.length; ++k)
          line(
              paths[i].points[k], paths[i].points[k + 1],
              packColour(
                  state.path >= 0 && i !== state.path ? colourOfCss(theme.dim) :
                                                        colourOfPath(scale_, paths[i])),
              i === state.path ? Math.round(3 * zoom) : Math.round(zoom));
    }
    const canvas = el('canvas', {width: w, height: h});
    canvas.getContext('2d').putImageData(raster.image, 0, 0);
    context.imageSmoothingEnabled = true;
    context.drawImage(canvas, 0, 0, width, height);
    const at = p => {
      const v = view(p);
      if (v[2] < near) return null;
      const q = pixel(v);
      return [q[0] / zoom, q[1] / zoom];
    };
    this.drawMarks(context, at);
  }
  /// A grid of round steps at the height of the lowest trajectory or of the ground of the scene.
  drawGround(line) {
    const step = 10 ** Math.round(Math.log10(this.distance / 6)),
          colour = packColour(colourOfCss(theme.grid));
    const z = this.ground === undefined ? (this.ground = this.groundHeight()) : this.ground;
    const cx = Math.round(this.target[0] / step) * step, cy = Math.round(this.target[1] / step) * step;
    for (let i = -10; i <= 10; ++i) {
      line([cx + i * step, cy - 10 * step, z], [cx + i * step, cy + 10 * step, z], colour, 1);
      line([cx - 10 * step, cy + i * step, z], [cx + 10 * step, cy + i * step, z], colour, 1);
    }
    this.gridStep = step;
  }
  groundHeight() {
    const objects = sceneObjects().filter(object => object.kind === 'road' || object.kind === 'ground');
    if (objects.length)
      return Math.max(...objects.slice(0, 50).map(object => Math.min(object.high[2], object.low[2] + 1)));
    const heights = [];
    for (const line of sequence().lines)
      for (let i = 2; i < line.places.length; i += 3) heights.push(line.places[i]);
    return heights.length ? Math.min(...heights) : 0;
  }
  /// Of many objects only the buildings, so that the points stay visible between their edges.
  chooseObjects() {
    const solid = sceneObjects().filter(o => !groundKinds.has(o.kind) && o.high[2] - o.low[2] > 1.5);
    return solid.length < 60 ? solid : solid.filter(o => o.kind === 'building' || o.high[2] - o.low[2] > 15);
  }
  drawObjects(line) {
    const colour = packColour(
        colourOfCss(theme.dim).map((x, i) => Math.round(0.55 * x + 0.45 * colourOfCss(theme.sky)[i])));
    for (const object of this.objects || (this.objects = this.chooseObjects())) {
      const corners = cornersOfBox(object);
      for (const [a, b] of edgesOfBox) line(corners[a], corners[b], colour, 1);
    }
  }
  drawClouds(raster, view, focal, near, zoom) {
    const {back, right, up} = this.axes(), eye = add(this.target, scale(back, this.distance));
    this.clouds = [];
    let first = 1;
    for (const record of this.records || []) {
      const cloud = cloudOf(record), colours = this.coloursOf(record, cloud), p = cloud.places;
      for (let i = 0; i < cloud.count; ++i) {
        const x = p[3 * i] - eye[0], y = p[3 * i + 1] - eye[1], z = p[3 * i + 2] - eye[2];
        const depth = -(x * back[0] + y * back[1] + z * back[2]);
        if (depth < near) continue;
        const u = raster.width / 2 + focal * (x * right[0] + y * right[1] + z * right[2]) / depth;
        const v = raster.height / 2 - focal * (x * up[0] + y * up[1] + z * up[2]) / depth;
        raster.dot(
            Math.floor(u), Math.floor(v), depth, colours[i],
            Math.round(clamp(0.12 * focal / depth, 1.4 * zoom, 3 * zoom)), first + i);
      }
      this.clouds.push({first, cloud});
      first += cloud.count;
    }
  }
  drawMarks(context, at) {
    if (this.layers.detections)
      for (const detection of presentDetections()) {
        const p = at(detection.at);
        if (!p) continue;
        context.beginPath();
        context.arc(p[0], p[1], 5, 0, 7);
        context.lineWidth = 2;
        context.strokeStyle = detection.id ? '#ff5c5c' : theme.dim;
        context.stroke();
      }
    const entry = sequence().poses[state.moment];
    if (entry)
      entry.poses.forEach((pose, n) => {
        const p = pose && at(pose.slice(0, 3));
        if (!p || !sequence().lines[n]) return;
        context.fillStyle = colourOfSeries(n);
        context.beginPath();
        context.arc(p[0], p[1], 5, 0, 7);
        context.fill();
        label(context, sequence().lines[n].name, p[0] + 8, p[1] - 8);
      });
    const chosen = channel(), record = chosen && latest(chosen);
    for (const place of record ? [...record.tx, ...record.rx] : []) {
      const p = place && at(place.slice(0, 3));
      if (!p) continue;
      context.fillStyle = theme.ink;
      context.fillRect(p[0] - 3, p[1] - 3, 6, 6);
    }
    label(context, 'grid: ' + short(this.gridStep) + ' m', 10, this.board.height - 12, theme.dim);
  }
  look(event) {
    const box = this.canvas.getBoundingClientRect(), raster = this.raster;
    if (!raster || !this.clouds) return;
    const x = Math.floor((event.clientX - box.left) * raster.width / box.width);
    const y = Math.floor((event.clientY - box.top) * raster.height / box.height);
    let pick = 0;
    for (let d = 0; d < 4 && !pick; ++d)
      for (const [i, j] of [[0, 0], [d, 0], [-d, 0], [0, d], [0, -d]])
        if (x + i >= 0 && y + j >= 0 && x + i < raster.width && y + j < raster.height)
          pick = pick || raster.pick[(y + j) * raster.width + x + i];
    const found =
        pick && this.clouds.find(entry => pick >= entry.first && pick < entry.first + entry.cloud.count);
    if (!found) {
      this.readout.textContent = this.hint();
      return;
    }
    const i = pick - found.first, cloud = found.cloud,
          at = worldOf(Array.from(cloud.places.slice(3 * i, 3 * i + 3)));
    this.readout.textContent = 'east ' + fixed(at[0], 2) + ', north ' + fixed(at[1], 2) + ', up ' +
        fixed(at[2], 2) + ' m' +
        '  \u00b7  range ' + fixed(cloud.ranges[i], 2) + ' m  \u00b7  intensity ' +
        short(cloud.intensities[i], 3) +
        (cloud.instances ?
             '  \u00b7  ' + (cloud.instances[i] ? instanceName(cloud.instances[i]) : 'fog or rain') :
             '');
  }
}
