// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Canvases that follow their width and the theme, bars of colours, and lines of values over an axis.

const theme = {};
/// Reads the colours of the present theme from the style sheet.
function readTheme() {
  const style = getComputedStyle(document.documentElement);
  for (const name of ['paper', 'panel', 'ink', 'dim', 'grid', 'mark', 'warn', 'sky'])
    theme[name] = style.getPropertyValue('--' + name).trim() || '#888';
}

/// A canvas as wide as its place, of a height that follows from its width. draw(context, width, height) works
/// in CSS pixels. Panels out of sight draw when they come into sight.
class Board {
  constructor(label, heightOf, draw) {
    this.heightOf = heightOf;
    this.draw = draw;
    this.stale = true;
    this.seen = typeof IntersectionObserver === 'undefined';
    this.canvas = el('canvas', {role: 'img', 'aria-label': label, width: 10, height: 10});
    this.node = el('div', {class: 'board'}, this.canvas);
    if (!this.seen)
      new IntersectionObserver(entries => {
        this.seen = entries[entries.length - 1].isIntersecting;
        if (this.seen && this.stale) this.now();
      }, {rootMargin: '200px'}).observe(this.node);
    if (typeof ResizeObserver !== 'undefined')
      new ResizeObserver(() => requestAnimationFrame(() => {
                           if (this.node.clientWidth === this.width) return;
                           // The place is taken before anything is drawn, so that the page does not jump.
                           this.canvas.style.height = Math.round(this.heightOf(this.node.clientWidth)) + 'px';
                           this.redraw();
                         }))
          .observe(this.node);
  }
  redraw() {
    this.stale = true;
    if (this.seen && !this.asked) {
      this.asked = true;
      requestAnimationFrame(() => {
        this.asked = false;
        if (this.stale) this.now();
      });
    }
  }
  now() {
    const width = this.node.clientWidth;
    if (width < 10) return;
    this.stale = false;
    const height = Math.round(this.heightOf(width)), ratio = Math.min(window.devicePixelRatio || 1, 2);
    this.width = width;
    this.height = height;
    if (this.canvas.width !== Math.round(width * ratio) ||
        this.canvas.height !== Math.round(height * ratio)) {
      this.canvas.width = Math.round(width * ratio);
      this.canvas.height = Math.round(height * ratio);
      this.canvas.style.height = height + 'px';
    }
    const context = this.canvas.getContext('2d');
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, width, height);
    context.font = '12px system-ui, sans-serif';
    context.textBaseline = 'middle';
    this.draw(context, width, height);
  }
  /// Calls at(x, y) in CSS pixels while the pointer moves over the canvas, and away() when it leaves.
  onPointer(at, away) {
    this.canvas.addEventListener('pointermove', event => {
      const box = this.canvas.getBoundingClientRect();
      at((event.clientX - box.left) * this.width / box.width,
         (event.clientY - box.top) * this.height / box.height);
    });
    this.canvas.addEventListener('pointerleave', away);
  }
}

/// Text with a rim in the colour of the paper, so that it can be read on any picture.
function label(context, text, x, y, colour, align = 'left') {
  context.save();
  context.textAlign = align;
  context.lineJoin = 'round';
  context.lineWidth = 3;
  context.strokeStyle = theme.panel;
  context.strokeText(text, x, y);
  context.fillStyle = colour || theme.ink;
  context.fillText(text, x, y);
  context.restore();
}

/// A horizontal bar of colours with values and a unit, as an element.
function colourBar(colours, low, high, unit, logarithmic) {
  const canvas = el('canvas', {width: 256, height: 1, 'aria-hidden': 'true'});
  const context = canvas.getContext('2d'), image = context.createImageData(256, 1);
  for (let i = 0; i < 256; ++i) image.data.set([...colours(i / 255), 255], 4 * i);
  context.putImageData(image, 0, 0);
  const ticks = logarithmic ? logTicksOf(low, high) : ticksOf(low, high, 4);
  const at = x => 100 * (logarithmic ? Math.log(x / low) / Math.log(high / low) : (x - low) / (high - low));
  // Values at the ends stay within the bar.
  const placeOf = share => 'left:' + share.toFixed(2) + '%' +
      (share > 95    ? ';transform:translateX(-100%)' :
           share < 5 ? ';transform:none' :
                       '');
  const chosen = ticks.filter((x, i) => ticks.length <= 6 || i % Math.ceil(ticks.length / 6) === 0);
  return el(
      'div', {
        class: 'bar',
        role: 'img',
        'aria-label': 'colours from ' + short(low) + ' to ' + short(high) + ' ' + unit
      },
      canvas, el('div', {class: 'ticks'}, chosen.map(x => el('span', {style: placeOf(at(x))}, short(x)))),
      el('span', {class: 'unit'}, unit));
}

/// A plot of lines: {x, y, colour, name, dots}. `axes`: {x: [low, high], y: [low, high], xUnit, yUnit, mark}.
/// `mark` is a vertical line at the present moment. Returns places for the pointer.
function drawLines(context, width, height, lines, axes) {
  const box = {left: 52, top: 10, right: width - 12, bottom: height - 34};
  const [x0, x1] = axes.x, [y0, y1] = axes.y;
  const px = x => box.left + (x - x0) / (x1 - x0) * (box.right - box.left);
  const py = y => box.bottom - (y - y0) / (y1 - y0) * (box.bottom - box.top);
  context.lineWidth = 1;
  context.fillStyle = theme.dim;
  context.strokeStyle = axes.faint ? 'rgba(140,150,165,0.25)' : theme.grid;
  context.textAlign = 'center';
  for (const x of ticksOf(x0, x1, Math.max(2, (box.right - box.left) / 90))) {
    context.beginPath();
    context.moveTo(px(x), box.top);
    context.lineTo(px(x), box.bottom);
    context.stroke();
    context.fillText(short(x), px(x), box.bottom + 11);
  }
  context.fillText(axes.xUnit, (box.left + box.right) / 2, height - 8);
  context.textAlign = 'right';
  for (const y of ticksOf(y0, y1, Math.max(2, (box.bottom - box.top) / 40))) {
    context.beginPath();
    context.moveTo(box.left, py(y));
    context.lineTo(box.right, py(y));
    context.stroke();
    context.fillText(short(y), box.left - 6, py(y));
  }
  context.save();
  context.translate(10, (box.top + box.bottom) / 2);
  context.rotate(-Math.PI / 2);
  context.textAlign = 'center';
  context.fillText(axes.yUnit, 0, 0);
  context.restore();
  context.save();
  context.beginPath();
  context.rect(box.left, box.top, box.right - box.left, box.bottom - box.top);
  context.clip();
  for (const line of lines) {
    context.strokeStyle = context.fillStyle = line.colour;
    context.lineWidth = line.width || 1.6;
    context.globalAlpha = line.alpha || 1;
    context.beginPath();
    let pen = false;
    line.x.forEach((x, i) => {
      const y = line.y[i];
      if (!isNumber(y)) {
        pen = false;
        return;
      }
      if (line.stems) {
        context.moveTo(px(x), box.bottom);
        context.lineTo(px(x), py(y));
        return;
      }
      if (pen)
        context.lineTo(px(x), py(y));
      else
        context.moveTo(px(x), py(y));
      pen = true;
    });
    context.stroke();
    if (line.stems || line.x.length < 40)
      line.x.forEach((x, i) => {
        if (!isNumber(line.y[i])) return;
        context.beginPath();
        context.arc(px(x), py(line.y[i]), line.stems ? 2.5 : 2, 0, 7);
        context.fill();
      });
  }
  context.globalAlpha = 1;
  if (isNumber(axes.mark)) {
    context.strokeStyle = theme.mark;
    context.lineWidth = 1.5;
    context.beginPath();
    context.moveTo(px(axes.mark), box.top);
    context.lineTo(px(axes.mark), box.bottom);
    context.stroke();
  }
  context.restore();
  return {box, px, py, xAt: p => x0 + (p - box.left) / (box.right - box.left) * (x1 - x0)};
}
/// The extent of values with a margin; null without any.
function extentOf(lists, margin = 0.06) {
  let low = Infinity, high = -Infinity;
  for (const list of lists)
    for (const value of list)
      if (isNumber(value)) {
        low = Math.min(low, value);
        high = Math.max(high, value);
      }
  if (!(high >= low)) return null;
  const wide = high > low ? (high - low) * margin : Math.max(1e-6, Math.abs(high) * 0.05, 0.5);
  return [low - wide, high + wide];
}
