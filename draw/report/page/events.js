// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The panels of event cameras: events since the record before, summed by pixel.

class EventPanel {
  constructor(sensor) {
    this.sensor = sensor;
    const first =
        sensor.records.map(record => record.counts || record.difference).find(Boolean) || {w: 4, h: 3};
    this.board = new Board(
        'events of ' + sensor.name, width => width * first.h / first.w,
        (context, width, height) => this.draw(context, width, height));
    this.board.onPointer((x, y) => this.look(x, y), () => this.look(null));
    this.readout = el('p', {class: 'readout'});
    this.count = el('p', {class: 'dim'});
    this.node =
        el('figure', {class: 'panel'},
           el('figcaption', {}, el('h3', {}, sensor.name), this.age = el('span', {class: 'age'})),
           this.board.node,
           el('ul', {class: 'swatches'},
              el('li', {}, el('i', {style: 'background:rgb(235,45,35)'}), 'ON, brighter'),
              el('li', {}, el('i', {style: 'background:rgb(35,75,240)'}), 'OFF, darker')),
           this.count, this.readout);
  }
  update() {
    this.record = latest(this.sensor);
    this.age.textContent = this.record ? ageText(this.record) : 'nothing yet';
    const counts = this.record && this.record.counts;
    this.count.textContent =
        counts ? counts.on + ' ON and ' + counts.off + ' OFF since the record before' : '';
    this.board.redraw();
    this.look(null);
  }
  pixels(record) {
    const counts = record.counts, raster = counts || record.difference;
    return keptArrays.get('pixels ' + raster.blob, () => {
      const all = rasterOf(raster, 1, false), size = raster.w * raster.h;
      const image = new ImageData(raster.w, raster.h);
      const grey = [128, 128, 128], red = [235, 45, 35], blue = [35, 75, 240];
      for (let i = 0; i < size; ++i) {
        const on = all[i], off = counts ? all[size + i] : 0, sum = on + off;
        for (let c = 0; c < 3; ++c)
          image.data[4 * i + c] = !counts ?
              on :
              sum === 0 ?
              128 :
              grey[c] + Math.min(1, 0.4 + 0.2 * sum) * (blue[c] + on / sum * (red[c] - blue[c]) - grey[c]);
        image.data[4 * i + 3] = 255;
      }
      const canvas = el('canvas', {width: raster.w, height: raster.h});
      canvas.getContext('2d').putImageData(image, 0, 0);
      return canvas;
    });
  }
  draw(context, width, height) {
    if (!this.record || !(this.record.counts || this.record.difference)) {
      context.fillStyle = theme.dim;
      context.textAlign = 'center';
      context.fillText('no events yet', width / 2, height / 2);
      return;
    }
    context.imageSmoothingEnabled = false;
    context.drawImage(this.pixels(this.record), 0, 0, width, height);
  }
  look(x, y) {
    const counts = this.record && this.record.counts;
    if (x === null || !counts) {
      this.readout.textContent = '';
      return;
    }
    const column = clamp(Math.floor(x / this.board.width * counts.w), 0, counts.w - 1);
    const row = clamp(Math.floor(y / this.board.height * counts.h), 0, counts.h - 1);
    const all = rasterOf(counts, 1, false), i = row * counts.w + column;
    this.readout.textContent = '(' + column * counts.by + ', ' + row * counts.by + ')  \u00b7  ON ' + all[i] +
        ', OFF ' + all[counts.w * counts.h + i];
  }
}
