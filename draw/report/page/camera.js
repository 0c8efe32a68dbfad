// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The panels of cameras: one of its pictures, with the channel's paths, boxes and detections over it, and the
// values under the pointer.

const cameraViews = [
  ['rgb', 'picture'], ['depth', 'depth'], ['instance', 'instances'], ['semantic', 'classes'],
  ['material', 'materials'], ['flow', 'optical flow'], ['normals', 'normals'],
  ['depth_ray', 'depth along the ray'], ['luminance', 'luminance']
];
const namesOfView = {
  instance: instanceName,
  semantic: className,
  material: materialName
};

class CameraPanel {
  constructor(sensor) {
    this.sensor = sensor;
    this.views = cameraViews.filter(([key]) => sensor.records.some(record => record[key]));
    this.view = this.views.length ? this.views[0][0] : null;
    this.layers = {paths: channels().length > 0, boxes: false, detections: false};
    const first = sensor.records[0] || {}, size = this.sizeOf(first);
    this.board = new Board(
        'picture of camera ' + sensor.name, width => width * size[1] / size[0],
        (context, width, height) => this.draw(context, width, height));
    this.board.onPointer((x, y) => this.look(x, y), () => this.look(null));
    this.readout = el('p', {class: 'readout', 'aria-live': 'off'});
    this.legend = el('div', {class: 'legend'});
    const select =
        el('select', {
          'aria-label': 'what camera ' + sensor.name + ' shows',
          change: event => {
            this.view = event.target.value;
            this.update();
          }
        },
           this.views.map(([key, name]) => el('option', {value: key}, name)));
    const box = (key, text) =>
        el('label', {}, el('input', {
             type: 'checkbox',
             checked: this.layers[key],
             change: event => {
               this.layers[key] = event.target.checked;
               this.board.redraw();
             }
           }),
           text);
    const has = {
      paths: channels().length > 0 && isNumber(sensor.about.fx),
      boxes: sensor.records.some(record => record.boxes),
      detections: sequence().sensors.some(other => (other.records || []).some(r => r.detections || r.sensing))
    };
    this.node =
        el('figure', {class: 'panel camera'},
           el('figcaption', {}, el('h3', {}, sensor.name), this.age = el('span', {class: 'age'}),
              el('div', {class: 'tools'}, select, has.paths ? box('paths', 'paths') : null,
                 has.boxes ? box('boxes', 'boxes') : null,
                 has.detections ? box('detections', 'detections') : null)),
           this.board.node, this.legend, this.readout);
  }
  /// The sensor's pixels: metadata, or the extent of the first raster.
  sizeOf(record) {
    const about = this.sensor.about;
    if (isNumber(about.width) && isNumber(about.height)) return [about.width, about.height];
    const raster = cameraViews.map(([key]) => record[key]).find(Boolean);
    return raster ? [raster.w * raster.by, raster.h * raster.by] : [4, 3];
  }
  update() {
    this.record = latest(this.sensor);
    // A picture out of sight is decoded, too, so that it is there when the page is printed.
    if (this.record && this.record.rgb) imageOf(this.record.rgb.blob, () => {});
    this.age.textContent = this.record ? ageText(this.record) : 'nothing yet';
    this.board.redraw();
    this.drawLegend();
    this.look(null);
  }
  /// The scale of depth, luminance or flow over all records of the page.
  scaleOf(view) {
    this.scales = this.scales || {};
    if (!this.scales[view]) {
      const spans = this.sensor.records.map(record => record[view] && record[view].span).filter(Boolean);
      const low = Math.min(...spans.map(span => span[0])), high = Math.max(...spans.map(span => span[1]));
      const logarithmic = view !== 'flow' && high / low > 10;
      this.scales[view] = spans.length ? {low, high: Math.max(high, low * 1.001), logarithmic} :
                                         {low: 1, high: 10, logarithmic: false};
    }
    return this.scales[view];
  }
  pixels(view, raster) {
    return keptArrays.get('pixels ' + view + raster.blob, () => {
      const count = raster.w * raster.h, image = new ImageData(raster.w, raster.h), out = image.data;
      const put = (i, c) => {
        out[4 * i] = c[0];
        out[4 * i + 1] = c[1];
        out[4 * i + 2] = c[2];
        out[4 * i + 3] = 255;
      };
      if (view in namesOfView) {
        const ids = rasterOf(raster, raster.bytes, false);
        for (let i = 0; i < count; ++i) put(i, colourOfId(ids[i]));
      } else if (view === 'flow') {
        const codes = rasterOf(raster, 2, true), full = this.scaleOf('flow').high / raster.step;
        for (let i = 0; i < count; ++i)
          put(i,
              codes[i] === 0 ? [0, 0, 0] :
                               colourOfFlow((codes[i] - 32768) / full, (codes[count + i] - 32768) / full));
      } else if (view === 'normals') {
        const codes = rasterOf(raster, 1, true);
        for (let i = 0; i < count; ++i)
          put(i,
              codes[i] === 128 && codes[count + i] === 128 && codes[2 * count + i] === 128 ?
                  [48, 52, 62] :
                  [codes[i], codes[count + i], codes[2 * count + i]]);
      } else {
        const codes = rasterOf(raster, 2, true), range = this.scaleOf(view);
        const at = value => range.logarithmic ?
            Math.log(value / range.low) / Math.log(range.high / range.low) :
            (value - range.low) / (range.high - range.low);
        const colours = view === 'luminance' ? viridis : t => turbo(1 - t), seen = new Map();
        for (let i = 0; i < count; ++i) {
          let colour = seen.get(codes[i]);
          if (!colour) {
            colour = codes[i] === 0 ? [48, 52, 62] : colours(clamp(at(logValue(raster, codes[i])), 0, 1));
            seen.set(codes[i], colour);
          }
          put(i, colour);
        }
      }
      const canvas = el('canvas', {width: raster.w, height: raster.h});
      canvas.getContext('2d').putImageData(image, 0, 0);
      return canvas;
    });
  }
  draw(context, width, height) {
    const record = this.record, raster = record && this.view && record[this.view];
    if (!raster) {
      context.fillStyle = theme.dim;
      context.textAlign = 'center';
      context.fillText(record ? 'no picture' : 'no record yet', width / 2, height / 2);
      if (!record) return;
    } else if (this.view === 'rgb') {
      let image = null;
      image = imageOf(raster.blob, () => {
        if (image && this.record === record) this.board.redraw();
      });
      if (!(image.complete && image.naturalWidth > 0)) {
        context.fillStyle = theme.grid;
        context.fillRect(0, 0, width, height);
        return;
      }
      context.imageSmoothingEnabled = true;
      context.drawImage(image, 0, 0, width, height);
    } else {
      context.imageSmoothingEnabled = false;
      context.drawImage(this.pixels(this.view, raster), 0, 0, width, height);
    }
    const camera = cameraOf(this.sensor, record);
    this.drawn = [];
    if (!camera) return;
    const size = this.sizeOf(record), zoom = width / size[0];
    context.save();
    context.scale(zoom, zoom);
    if (this.layers.boxes && record.boxes) this.drawBoxes(context, record, camera, zoom);
    if (this.layers.paths) this.drawPaths(context, record, camera, zoom);
    const seen = ([x, y]) => x >= 0 && y >= 0 && x <= width && y <= height;
    const none = this.layers.paths && !this.drawn.some(seen);
    if (this.layers.detections) this.drawDetections(context, camera, zoom);
    context.restore();
    if (none) label(context, presentPaths().length ? 'no path in view' : 'no paths', 10, height - 14);
  }
  /// The depth of the picture at a pixel of the sensor; infinite for the sky and without depth.
  depthAt(record, u, v) {
    const raster = record.depth;
    if (!raster) return Infinity;
    const x = Math.floor(u / raster.by), y = Math.floor(v / raster.by);
    if (x < 0 || y < 0 || x >= raster.w || y >= raster.h) return Infinity;
    return logValue(raster, rasterOf(raster, 2, true)[y * raster.w + x]);
  }
  /// Whether something is in front of a point, by more than the rounding of depth and the size of a pixel.
  hides(record, point) { return point[2] > 1.02 * this.depthAt(record, point[0], point[1]) + 0.15; }
  drawPaths(context, record, camera, zoom) {
    const paths = presentPaths(), powers = powerScale(paths), [w, h] = this.sizeOf(record);
    for (const index of paths.map((_, i) => i).reverse()) {
      const path = paths[index], strong = index === state.path, colour = css(colourOfPath(powers, path));
      for (let leg = 0; leg + 1 < path.points.length; ++leg) {
        const points = projectLine(camera, path.points[leg], path.points[leg + 1], 4);
        this.strokeLeg(context, record, points, colour, strong ? 3.2 : 1.5, state.path >= 0 && !strong, zoom);
        for (const point of points)
          if (point && point[0] > -w && point[0] < 2 * w && point[1] > -h && point[1] < 2 * h)
            this.drawn.push([point[0] * zoom, point[1] * zoom, index]);
      }
      path.kinds.forEach((kind, i) => {
        const vertex = path.points[path.first + i], at = vertex && project(camera, vertex);
        if (!at || at[0] < 0 || at[1] < 0 || at[0] > w || at[1] > h) return;
        context.beginPath();
        context.arc(at[0], at[1], (strong ? 4.5 : 3) / zoom, 0, 7);
        context.lineWidth = 1.2 / zoom;
        context.strokeStyle = this.hides(record, at) ? colour : '#000';
        if (!this.hides(record, at)) {
          context.fillStyle = colour;
          context.fill();
        }
        context.stroke();
      });
    }
    const way = link(), chosen = channel(), ends = chosen && latest(chosen);
    if (!way || !ends) return;
    for (const [place, name] of [
             [ends.tx[way.tx], chosen.about.tx[way.tx].name],
             [ends.rx[way.rx], chosen.about.rx[way.rx].name]]) {
      // The camera's own antenna is too near to be where it seems.
      const at = place && name.split('/')[0] !== this.sensor.node && project(camera, place.slice(0, 3));
      if (!at || at[0] < 0 || at[1] < 0 || at[0] > w || at[1] > h) continue;
      context.fillStyle = '#fff';
      context.fillRect(at[0] - 3.5 / zoom, at[1] - 3.5 / zoom, 7 / zoom, 7 / zoom);
      context.save();
      context.scale(1 / zoom, 1 / zoom);
      label(context, name + (this.hides(record, at) ? ' (behind)' : ''), at[0] * zoom + 8, at[1] * zoom);
      context.restore();
    }
  }
  /// Strokes runs of visible points as they are, and runs behind something as faint dashes.
  strokeLeg(context, record, points, colour, width, faint, zoom) {
    const run = (from, to, hidden) => {
      context.beginPath();
      context.moveTo(points[from][0], points[from][1]);
      for (let i = from + 1; i <= to; ++i) context.lineTo(points[i][0], points[i][1]);
      context.setLineDash(hidden ? [3 / zoom, 5 / zoom] : []);
      context.globalAlpha = (hidden ? 0.45 : 0.95) * (faint ? 0.35 : 1);
      context.lineWidth = (hidden ? 0.8 : 1) * width / zoom;
      context.strokeStyle = colour;
      context.stroke();
    };
    let start = 0, hidden = null;
    for (let i = 0; i + 1 < points.length; ++i) {
      if (!points[i] || !points[i + 1]) {
        if (hidden !== null && i > start) run(start, i, hidden);
        hidden = null;
        start = i + 1;
        continue;
      }
      const middle = [0, 1, 2].map(c => (points[i][c] + points[i + 1][c]) / 2);
      const behind = this.hides(record, middle);
      if (hidden === null)
        start = i;
      else if (behind !== hidden) {
        run(start, i, hidden);
        start = i;
      }
      hidden = behind;
    }
    if (hidden !== null && points.length - 1 > start) run(start, points.length - 1, hidden);
    context.setLineDash([]);
    context.globalAlpha = 1;
  }
  drawBoxes(context, record, camera, zoom) {
    for (const row of textOf(record.boxes.blob)) {
      const box = {center: row.slice(6, 9), size: row.slice(9, 12), turn: row.slice(12, 16)};
      const corners = cornersOfBox(box);
      context.strokeStyle = css(colourOfId(row[0]));
      context.globalAlpha = row[5] > 0 ? 1 : 0.3;
      context.lineWidth = (row[5] > 0 ? 1.4 : 0.8) / zoom;
      for (const [a, b] of edgesOfBox) {
        const points = projectLine(camera, corners[a], corners[b], camera.lens ? 8 : 1e9).filter(Boolean);
        if (points.length < 2) continue;
        context.beginPath();
        points.forEach((p, i) => i ? context.lineTo(p[0], p[1]) : context.moveTo(p[0], p[1]));
        context.stroke();
      }
    }
    context.globalAlpha = 1;
  }
  drawDetections(context, camera, zoom) {
    const [w, h] = this.sizeOf(this.record);
    for (const detection of presentDetections()) {
      const at = project(camera, detection.at);
      if (!at || at[0] < 0 || at[1] < 0 || at[0] > w || at[1] > h) continue;
      context.beginPath();
      context.arc(at[0], at[1], 5 / zoom, 0, 7);
      context.lineWidth = 2 / zoom;
      context.strokeStyle = detection.id ? '#ff5c5c' : '#c0c4cc';
      context.stroke();
      this.drawn.push([at[0] * zoom, at[1] * zoom, detection]);
    }
  }
  look(x, y) {
    clear(this.readout);
    const record = this.record;
    if (x === null || !record) {
      this.readout.textContent = 'Move over the picture to read its values.';
      if (this.pointed) {
        this.pointed = false;
        state.path = -1;
        tell('path');
      }
      return;
    }
    const [w, h] = this.sizeOf(record), u = x / this.board.width * w, v = y / this.board.height * h;
    const at = raster => {
      const i = clamp(Math.floor(u / raster.by), 0, raster.w - 1),
            j = clamp(Math.floor(v / raster.by), 0, raster.h - 1);
      return j * raster.w + i;
    };
    const parts = ['(' + Math.floor(u) + ', ' + Math.floor(v) + ')'];
    for (const [key, text] of [['depth', ''], ['depth_ray', ' along the ray'], ['luminance', '']])
      if (record[key]) {
        const value = logValue(record[key], rasterOf(record[key], 2, true)[at(record[key])]);
        parts.push(
            Number.isFinite(value)  ? short(value) + (key === 'luminance' ? ' cd/m\u00b2' : ' m' + text) :
                key === 'luminance' ? 'dark' :
                                      'sky');
      }
    for (const key of ['instance', 'semantic', 'material'])
      if (record[key])
        parts.push(namesOfView[key](rasterOf(record[key], record[key].bytes, false)[at(record[key])]));
    if (record.flow && this.view === 'flow') {
      const codes = rasterOf(record.flow, 2, true), i = at(record.flow),
            count = record.flow.w * record.flow.h;
      parts.push(
          codes[i] === 0 ? 'out of sight in the next picture' :
                           'right ' + fixed((codes[i] - 32768) * record.flow.step, 2) + ', down ' +
                  fixed((codes[count + i] - 32768) * record.flow.step, 2) + ' px a picture');
    }
    let nearby = 8, found = null;
    for (const [px, py, what] of this.drawn || []) {
      const distance = Math.hypot(px - x, py - y);
      if (distance < nearby) [nearby, found] = [distance, what];
    }
    if (found !== null && typeof found === 'object')
      parts.push(
          'detection of ' + found.sensor + ': ' + fixed(found.range, 2) + ' m, ' + fixed(found.velocity, 2) +
          ' m/s, ' + (found.id ? instanceName(found.id) : 'false alarm'));
    const path = typeof found === 'number' ? found : -1;
    if (path >= 0) parts.push('path ' + (path + 1) + ': ' + pathText(presentPaths()[path]));
    this.readout.textContent = parts.join('  \u00b7  ');
    this.pointed = true;
    if (path !== state.path) {
      state.path = path;
      tell('path');
    }
  }
  drawLegend() {
    clear(this.legend);
    const raster = this.record && this.view && this.record[this.view];
    if (this.layers.paths && this.view === 'rgb') {
      const paths = presentPaths(), powers = powerScale(paths);
      if (paths.length && isNumber(paths[0].power))
        this.legend.append(
            colourBar(t => turbo(0.1 + 0.8 * t), powers.low, powers.high, 'dB, power of paths', false),
            el('p', {class: 'dim'},
               'Dashed: behind what the camera sees. Dots: interactions; hollow ones are hidden.'));
      return;
    }
    if (!raster || this.view === 'rgb') return;
    if (this.view in namesOfView) {
      const counts = new Map();
      for (const id of rasterOf(raster, raster.bytes, false)) counts.set(id, (counts.get(id) || 0) + 1);
      const ids = [...counts.entries()].sort((a, b) => b[1] - a[1]), shown = ids.slice(0, 14);
      this.legend.append(
          el('ul', {class: 'swatches'},
             shown.map(
                 ([id]) =>
                     el('li', {}, el('i', {style: 'background:' + css(colourOfId(id))}),
                        namesOfView[this.view](id)))));
      if (ids.length > shown.length)
        this.legend.append(
            el('p', {class: 'dim'}, 'and ' + (ids.length - shown.length) + ' more; the pointer names each.'));
    } else if (this.view === 'flow') {
      this.legend.append(
          el('p', {class: 'dim'},
             'Hue: direction (red: right). Full colour: ' + short(this.scaleOf('flow').high, 3) +
                 ' px a picture. White: no motion. Black: out of sight in the next picture.'));
    } else if (this.view === 'normals') {
      this.legend.append(el('p', {class: 'dim'}, 'East, north and up are red, green and blue.'));
    } else {
      const range = this.scaleOf(this.view), luminance = this.view === 'luminance';
      this.legend.append(colourBar(
          luminance ? viridis : t => turbo(1 - t), range.low, range.high, luminance ? 'cd/m\u00b2' : 'm',
          range.logarithmic));
    }
  }
}
