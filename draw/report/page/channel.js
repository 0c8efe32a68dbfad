// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The channel at the present moment: |H(f)|, the delay profile, and the table of its paths.

function pathText(path) {
  if (!path) return '';
  const how = path.kinds.length ? path.kinds
                                      .map(
                                          (kind, i) => kindsOfInteraction[kind] +
                                              (path.objects[i] ? ' at ' + instanceName(path.objects[i]) : ''))
                                      .join(', ') :
                                  'line of sight';
  return (isNumber(path.power) ? fixed(path.power, 1) + ' dB, ' : '') + fixed(path.delay, 1) + ' ns, ' + how;
}

/// In place, radix 2: x[n] = sum of X[k] e^{+j 2 pi k n / N}.
function inverseTransform(re, im) {
  const n = re.length;
  for (let i = 1, j = 0; i < n; ++i) {
    let bit = n >> 1;
    for (; j & bit; bit >>= 1) j ^= bit;
    j ^= bit;
    if (i < j) {
      [re[i], re[j]] = [re[j], re[i]];
      [im[i], im[j]] = [im[j], im[i]];
    }
  }
  for (let size = 2; size <= n; size <<= 1)
    for (let k = 0; k < size / 2; ++k) {
      const c = Math.cos(2 * Math.PI * k / size), s = Math.sin(2 * Math.PI * k / size);
      for (let a = k; a < n; a += size) {
        const b = a + size / 2, x = re[b] * c - im[b] * s, y = re[b] * s + im[b] * c;
        re[b] = re[a] - x;
        im[b] = im[a] - y;
        re[a] += x;
        im[a] += y;
      }
    }
}
/// |h| in dB over delay: the inverse DFT of H under a Hann window, zero-padded to four times and more, scaled
/// so that one path of amplitude a peaks at |a|.
function delayProfile(re, im) {
  const n = re.length;
  let size = 1;
  while (size < 4 * n) size <<= 1;
  const x = new Float64Array(size), y = new Float64Array(size);
  let sum = 0;
  for (let k = 0; k < n; ++k) {
    const window = 0.5 - 0.5 * Math.cos(2 * Math.PI * (k + 0.5) / n);
    x[k] = re[k] * window;
    y[k] = im[k] * window;
    sum += window;
  }
  inverseTransform(x, y);
  return Array.from(x, (value, i) => 20 * Math.log10(Math.max(Math.hypot(value, y[i]) / sum, 1e-15)));
}
greatx.delayProfile = delayProfile;

/// The response of a link at a record: {frequency: MHz, mean: dB, pairs: [{name, re, im}]}, or null.
function responseOf(sensor, record, way) {
  const found =
      record && way && (record.links || []).find(entry => entry.rx === way.rx && entry.tx === way.tx);
  if (!found) return null;
  const codes = numbersOf(found.blob, 2, found.n), half = codes.length / 2;
  const spacing = sensor.about.subcarrier_spacing_hz || 1, first = sensor.about.first_subcarrier || 0;
  const mean = Array.from(
      numbersOf(found.mean.blob, 2, found.n),
      code => code === 0 ? null : 10 * Math.log10(logValue(found.mean, code)));
  const values = (from, at) =>
      Float64Array.from(codes.subarray(at + from, at + from + found.n), code => (code - 32768) * found.step);
  return {
    frequency: mean.map((_, k) => 1e-6 * spacing * (first + k * found.by)),
    mean,
    spacing: spacing * found.by,
    pairs: found.pairs.map((pair, i) => ({
                             name: 'port ' + pair[0] + ' \u2190 ' + pair[1],
                             re: values(i * found.n, 0),
                             im: values(i * found.n, half)
                           }))
  };
}
greatx.responseOf = responseOf;

class ChannelPanel {
  constructor() {
    this.pair = 0;
    this.select = el('select', {
      'aria-label': 'pair of ports',
      change: event => {
        this.pair = Number(event.target.value);
        this.frequency.redraw();
        this.delay.redraw();
      }
    });
    const board = (text, draw) => new Board(text, width => clamp(0.55 * width, 190, 300), draw);
    this.frequency = board('magnitude of H over frequency', (c, w, h) => this.drawFrequency(c, w, h));
    this.delay = board('delay profile', (c, w, h) => this.drawDelay(c, w, h));
    this.readouts = [el('p', {class: 'readout'}), el('p', {class: 'readout'})];
    this.facts = el('p', {class: 'facts'});
    this.frequency.onPointer(x => this.lookFrequency(x), () => {
      this.readouts[0].textContent = '';
    });
    this.delay.onPointer((x, y) => this.lookDelay(x, y), () => this.lookDelay(null));
    const responds = channels().some(sensor => sensor.records.some(record => record.links));
    this.node = el(
        'div', {class: 'grid'},
        el('figure', {class: 'panel', hidden: !responds},
           el('figcaption', {}, el('h3', {}, '|H| over frequency'), this.age = el('span', {class: 'age'}),
              el('div', {class: 'tools'}, this.select)),
           this.frequency.node,
           el('ul', {class: 'swatches'},
              el('li', {}, el('i', {style: 'background:' + colourOfSeries(0)}), 'mean power of all ports'),
              el('li', {}, el('i', {style: 'background:' + colourOfSeries(1)}), 'one pair of ports')),
           this.facts, this.readouts[0]),
        el('figure', {class: 'panel'}, el('figcaption', {}, el('h3', {}, 'Delay profile')), this.delay.node,
           el('p', {class: 'dim'},
              'Line: |h(\u03c4)| of the pair of ports, the inverse DFT of H(f) under a Hann window. ' +
                  'Stems: paths.'),
           this.readouts[1]));
  }
  update() {
    const chosen = channel(), record = chosen && latest(chosen);
    this.response = responseOf(chosen, record, link());
    this.age.textContent = record ? ageText(record) : 'nothing yet';
    const pairs = this.response ? this.response.pairs : [];
    clear(this.select)
        .append(...pairs.map((pair, i) => el('option', {value: i, selected: i === this.pair}, pair.name)));
    if (this.pair >= pairs.length) this.pair = 0;
    this.select.hidden = pairs.length < 2;
    const about = chosen ? chosen.about : {}, paths = presentPaths();
    const sum =
        paths.reduce((total, path) => total + (isNumber(path.power) ? 10 ** (path.power / 10) : 0), 0);
    this.facts.textContent = chosen ?
        [
          isNumber(about.carrier_hz) ? short(about.carrier_hz * 1e-9) + ' GHz' : null,
          isNumber(about.subcarriers) ?
              about.subcarriers + ' subcarriers of ' + short(about.subcarrier_spacing_hz * 1e-3) + ' kHz' :
              null,
          record && record.paths ? paths.length + ' paths' : null,
          sum > 0 ? 'sum of their powers ' + fixed(10 * Math.log10(sum), 1) + ' dB' : null
        ].filter(Boolean)
            .join(', ') :
        '';
    this.frequency.redraw();
    this.delay.redraw();
  }
  none(context, width, height, text) {
    context.fillStyle = theme.dim;
    context.textAlign = 'center';
    context.fillText(text, width / 2, height / 2);
  }
  drawFrequency(context, width, height) {
    const response = this.response;
    this.places = null;
    if (!response) {
      this.none(context, width, height, 'no frequency response');
      return;
    }
    const pair = response.pairs[this.pair];
    const one =
        Array.from(pair.re, (value, k) => 20 * Math.log10(Math.max(Math.hypot(value, pair.im[k]), 1e-15)));
    const extent = extentOf([response.mean, one]) || [-100, 0];
    extent[0] = Math.max(extent[0], extent[1] - 70);
    this.one = one;
    this.places = drawLines(
        context, width, height,
        [
          {x: response.frequency, y: one, colour: colourOfSeries(1)},
          {x: response.frequency, y: response.mean, colour: colourOfSeries(0), width: 2}
        ],
        {
          x: [response.frequency[0], response.frequency[response.frequency.length - 1] || 1],
          y: extent,
          xUnit: 'f \u2212 carrier, MHz',
          yUnit: 'dB'
        });
  }
  lookFrequency(x) {
    if (!this.places || !this.response) return;
    const f = this.response.frequency, at = this.places.xAt(x);
    let k = 0;
    f.forEach((value, i) => {
      if (Math.abs(value - at) < Math.abs(f[k] - at)) k = i;
    });
    this.readouts[0].textContent = fixed(f[k], 3) + ' MHz: mean ' + fixed(this.response.mean[k], 1) +
        ' dB, ' + this.response.pairs[this.pair].name + ' ' + fixed(this.one[k], 1) + ' dB';
  }
  drawDelay(context, width, height) {
    const response = this.response, paths = presentPaths();
    this.stems = [];
    this.delayPlaces = null;
    const span = response ? 1e9 / response.spacing : Infinity;
    const delayOf = path => path.delay % span;
    let profile = [], times = [];
    if (response) {
      profile = delayProfile(response.pairs[this.pair].re, response.pairs[this.pair].im);
      times = profile.map((_, i) => i / profile.length * span);
    }
    const powers = paths.filter(path => isNumber(path.power));
    const top = Math.max(...profile, ...powers.map(path => path.power), -300);
    if (top <= -300) {
      this.none(context, width, height, 'no response and no paths');
      return;
    }
    const floor = top - 60;
    let last = Math.max(0, ...powers.filter(path => path.power > floor).map(delayOf));
    profile.forEach((value, i) => {
      if (value > top - 45 && times[i] < 0.9 * span) last = Math.max(last, times[i]);
    });
    const first = powers.length ? Math.min(last, ...powers.map(delayOf)) : 0,
          wide = Math.max(last - first, 20);
    const x = [Math.max(0, first - 0.1 * wide), Math.min(span, last + 0.15 * wide)];
    const scale = powerScale(paths), lines = [];
    lines.push({x: times, y: profile, colour: colourOfSeries(1)});
    paths.forEach((path, i) => lines.push({
      x: [delayOf(path)],
      y: [path.power],
      stems: true,
      colour: css(colourOfPath(scale, path)),
      width: i === state.path ? 3.5 : 1.5,
      alpha: state.path < 0 || i === state.path ? 1 : 0.4
    }));
    this.delayPlaces = drawLines(context, width, height, lines, {
      x,
      y: [floor, top + 4],
      xUnit: 'delay, ns' + (response ? ' (repeats after ' + short(span) + ' ns)' : ''),
      yUnit: 'dB'
    });
    this.profile = profile;
    this.times = times;
    paths.forEach((path, i) => {
      if (isNumber(path.power))
        this.stems.push([this.delayPlaces.px(delayOf(path)), this.delayPlaces.py(path.power), i]);
    });
  }
  lookDelay(x, y) {
    if (x === null || !this.delayPlaces) {
      this.readouts[1].textContent = '';
      if (this.pointed) {
        this.pointed = false;
        state.path = -1;
        tell('path');
      }
      return;
    }
    let found = -1, best = 8;
    for (const [px, py, i] of this.stems) {
      const distance = Math.min(Math.hypot(px - x, py - y), y > py ? Math.abs(px - x) * 1.2 : 99);
      if (distance < best) [best, found] = [distance, i];
    }
    const at = this.delayPlaces.xAt(x);
    const k = this.times.length ? clamp(Math.round(at / (this.times[1] || 1)), 0, this.times.length - 1) : -1;
    this.readouts[1].textContent = fixed(at, 1) + ' ns' +
        (k >= 0 ? ': |h| ' + fixed(this.profile[k], 1) + ' dB' : '') +
        (found >= 0 ? '  \u00b7  path ' + (found + 1) + ': ' + pathText(presentPaths()[found]) : '');
    this.pointed = true;
    if (found !== state.path) {
      state.path = found;
      tell('path');
    }
  }
}

class PathTable {
  constructor() {
    this.body = el('tbody');
    this.title = el('h3', {}, 'Paths');
    this.more = el('p', {class: 'dim'});
    this.node =
        el('div', {class: 'panel wide'}, this.title,
           el('div', {class: 'scroll tall', tabindex: 0},
              el('table', {class: 'paths'},
                 el('thead', {},
                    el('tr', {},
                       [
                         '', 'power, dB', 'delay, ns', 'length, m', 'Doppler, Hz', 'departure az, \u00b0',
                         'arrival az, \u00b0', 'interactions', 'objects'
                       ].map(headOf))),
                 this.body)),
           this.more);
  }
  update() {
    const chosen = channel(), record = chosen && latest(chosen), paths = presentPaths(),
          scale = powerScale(paths);
    this.title.textContent = 'Paths of ' + (link() ? link().name : 'the channel');
    const all = record && record.paths ? record.paths.all : 0;
    this.more.textContent = paths.length > 150 ? 'The first 150 of ' + paths.length + ' are listed.' :
        record && record.paths                 ? all + ' paths of all links in this record.' :
                                                 'The data set has no paths.';
    clear(this.body).append(...paths.slice(0, 150).map((path, i) => {
      const choose = () => {
        if (state.path !== i) {
          state.path = i;
          tell('path');
        }
      };
      const release = () => {
        if (state.path === i) {
          state.path = -1;
          tell('path');
        }
      };
      return el(
          'tr', {tabindex: 0, pointerenter: choose, focus: choose, pointerleave: release, blur: release},
          el('td', {}, el('i', {class: 'dot', style: 'background:' + css(colourOfPath(scale, path))}), i + 1),
          el('td', {}, fixed(path.power, 1)), el('td', {}, fixed(path.delay, 2)),
          el('td', {}, fixed(path.delay * 0.299792458, 2)), el('td', {}, fixed(path.doppler, 1)),
          el('td', {}, fixed(path.departure[1], 1)), el('td', {}, fixed(path.arrival[1], 1)),
          el('td', {class: 'text'},
             path.kinds.length ? path.kinds.map(kind => kindsOfInteraction[kind]).join(', ') :
                                 'line of sight'),
          el('td', {class: 'text'},
             path.objects
                 .map(
                     (id, k) => id ? instanceName(id) +
                             (path.materials[k] ? ', ' + materialName(path.materials[k]) : '') :
                                     '')
                 .filter(Boolean)
                 .join('; ')));
    }));
  }
  highlight() {
    [...this.body.children].forEach((row, i) => row.classList.toggle('chosen', i === state.path));
  }
}
