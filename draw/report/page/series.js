// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Quantities over all ticks of the sequence, with the present moment as a line. A click goes to a moment.

class SeriesPanel {
  /// `lines`: [{name, values}] of one quantity.
  constructor(title, unit, times, lines) {
    this.title = title;
    this.unit = unit;
    this.times = times;
    this.lines = lines;
    this.board = new Board(
        title + ' over time', width => clamp(0.5 * width, 160, 240),
        (context, width, height) => this.draw(context, width, height));
    this.readout = el('p', {class: 'readout'});
    this.board.onPointer(x => this.look(x), () => {
      this.readout.textContent = this.values(this.indexAt(present()[1]));
    });
    this.board.canvas.addEventListener('click', event => {
      const box = this.board.canvas.getBoundingClientRect();
      if (this.places) goToTime(this.places.xAt((event.clientX - box.left) * this.board.width / box.width));
    });
    this.node =
        el('figure', {class: 'panel'}, el('figcaption', {}, el('h3', {}, title + (unit ? ', ' + unit : ''))),
           this.board.node,
           lines.length > 1 ?
               el('ul', {class: 'swatches'},
                  lines.slice(0, 12).map(
                      (line, i) =>
                          el('li', {}, el('i', {style: 'background:' + colourOfSeries(i)}), line.name))) :
               null,
           this.readout);
  }
  update() {
    this.board.redraw();
    this.readout.textContent = this.values(this.indexAt(present()[1]));
  }
  draw(context, width, height) {
    const extent = extentOf(this.lines.map(line => line.values));
    const last = this.times[this.times.length - 1];
    if (!extent) {
      context.fillStyle = theme.dim;
      context.textAlign = 'center';
      context.fillText('no finite value', width / 2, height / 2);
      return;
    }
    this.places = drawLines(
        context, width, height,
        this.lines.map((line, i) => ({x: this.times, y: line.values, colour: colourOfSeries(i)})), {
          x: [this.times[0], last > this.times[0] ? last : this.times[0] + 1],
          y: extent,
          xUnit: 'time, s',
          yUnit: this.unit,
          mark: present()[1]
        });
  }
  /// The last record at or before a time.
  indexAt(time) {
    let at = 0;
    this.times.forEach((t, i) => {
      if (t <= time + 1e-9) at = i;
    });
    return at;
  }
  values(i) {
    return fixed(this.times[i], 3) + ' s: ' +
        this.lines.slice(0, 6)
            .map(
                line => (this.lines.length > 1 ? line.name + ' ' : '') + short(line.values[i], 5) + ' ' +
                    this.unit)
            .join(', ');
  }
  look(x) {
    if (!this.places) return;
    const at = this.places.xAt(x);
    let nearest = 0;
    this.times.forEach((t, i) => {
      if (Math.abs(t - at) < Math.abs(this.times[nearest] - at)) nearest = i;
    });
    this.readout.textContent = this.values(nearest);
  }
}

function seriesPanels() {
  const panels = [];
  for (const part of sequence().series) {
    const sensor = sequence().sensors[part.sensor], groups = new Map();
    for (const line of part.lines) {
      const name = 'node' in line ? sequence().lines[line.node].name :
                                    (sensor.about.rx[line.rx] || {name: 'rx ' + line.rx}).name + ' \u2190 ' +
              (sensor.about.tx[line.tx] || {name: 'tx ' + line.tx}).name;
      const title = (channels().length > 1 && sensor.kind === 'csi' ? sensor.name + ': ' : '') + line.title;
      if (!groups.has(title)) groups.set(title, {unit: line.unit, lines: []});
      groups.get(title).lines.push({name, values: line.values});
    }
    for (const [title, group] of groups)
      panels.push(new SeriesPanel(title, group.unit, part.times, group.lines));
  }
  return panels;
}
