// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The page: the bar of time, the sections, the keyboard, the theme.

let panels = [];
const bar = {};

/// Goes to a moment of the sequence.
function goTo(moment) {
  const wanted = clamp(moment, 0, moments().length - 1);
  if (wanted === state.moment) return;
  state.moment = wanted;
  state.path = -1;
  tell('moment');
}
/// Goes to the last moment at or before a time, or to the first.
function goToTime(time) {
  let found = 0;
  moments().forEach((moment, i) => {
    if (moment[1] <= time + 1e-9) found = i;
  });
  goTo(found);
}
greatx.goTo = goTo;

function play(on) {
  bar.playing = on;
  bar.button.textContent = on ? '\u275a\u275a' : '\u25b6';
  bar.button.setAttribute('aria-label', on ? 'pause' : 'play');
  clearTimeout(bar.timer);
  if (!on) return;
  if (state.moment === moments().length - 1) goTo(0);
  const step = () => {
    if (!bar.playing) return;
    const next = state.moment + 1;
    if (next >= moments().length) {
      play(false);
      return;
    }
    const wait = 1000 * (moments()[next][1] - moments()[next - 1][1]) / Number(bar.speed.value);
    bar.timer = setTimeout(() => {
      goTo(next);
      step();
    }, clamp(wait, 40, 2000));
  };
  step();
}

function selectOf(name, entries, chosen, change) {
  return el(
      'label', {class: 'choice'}, name + ' ',
      el('select', {change: event => change(Number(event.target.value))},
         entries.map((text, i) => el('option', {value: i, selected: i === chosen}, text))));
}
function fillChoices() {
  clear(bar.choices);
  if (data.sequences.length > 1)
    bar.choices.append(
        selectOf('sequence', data.sequences.map(s => String(s.number)), state.sequence, value => {
          play(false);
          Object.assign(state, {sequence: value, moment: 0, channel: 0, link: 0, path: -1});
          build();
        }));
  if (channels().length > 1)
    bar.choices.append(selectOf('channel', channels().map(sensor => sensor.name), state.channel, value => {
      Object.assign(state, {channel: value, link: 0, path: -1});
      fillChoices();
      tell('channel');
    }));
  if (channel() && linksOf(channel()).length > 1)
    bar.choices.append(
        selectOf('link', linksOf(channel()).slice(0, 500).map(way => way.name), state.link, value => {
          Object.assign(state, {link: value, path: -1});
          tell('channel');
        }));
}

function timeBar() {
  bar.button =
      el('button', {type: 'button', class: 'play', 'aria-label': 'play', click: () => play(!bar.playing)},
         '\u25b6');
  bar.slider = el('input', {
    type: 'range',
    min: 0,
    step: 1,
    value: 0,
    'aria-label': 'moment',
    input: event => goTo(Number(event.target.value))
  });
  bar.time = el('output', {class: 'time'});
  bar.speed =
      el('select', {'aria-label': 'speed'},
         [0.1, 0.25, 0.5, 1, 2, 5].map(x => el('option', {value: x, selected: x === 1}, x + '\u00d7')));
  bar.choices = el('span', {class: 'choices'});
  return el(
      'div', {class: 'timebar', role: 'group', 'aria-label': 'time'}, bar.button, bar.slider, bar.time,
      bar.speed, bar.choices);
}
function showTime() {
  const [tick, time] = present(), last = moments().length - 1;
  bar.slider.max = last;
  bar.slider.value = state.moment;
  bar.time.textContent =
      fixed(time, 3) + ' s \u00b7 tick ' + tick + ' \u00b7 ' + (state.moment + 1) + ' of ' + (last + 1);
  bar.slider.setAttribute('aria-valuetext', bar.time.textContent);
}

function summarySection() {
  const summary = data.summary,
        list = (title, lines, cls) => lines.length ? el('div', {class: 'panel ' + cls}, el('h3', {}, title),
                                                        el('ul', {}, lines.map(text => el('li', {}, text)))) :
                                                     null;
  return [
    el('div', {class: 'grid'},
       el('div', {class: 'panel'}, el('h3', {}, 'Data set'),
          el('dl', {}, summary.facts.map(([name, text]) => [el('dt', {}, name), el('dd', {}, text)]))),
       list('Warnings of the run', summary.warnings, 'warnings'),
       list('What this page leaves out', data.notes, 'notes')),
    el('details', {class: 'panel wide'},
       el('summary', {}, summary.sensors.length + ' sensors and their arrays'),
       summary.sensors.map(
           sensor =>
               el('div', {}, el('h4', {}, sensor.name),
                  el('p', {class: 'dim'},
                     [
                       sensor.kind, sensor.rate_hz ? sensor.rate_hz + ' Hz' : null,
                       sensor.records + ' records', sensor.bytes ? sizeText(sensor.bytes) : null
                     ].filter(Boolean)
                         .join(', ')),
                  el('div', {class: 'scroll'},
                     el('table', {},
                        el('thead', {}, el('tr', {}, ['array', 'type', 'unit', 'meaning'].map(headOf))),
                        el('tbody', {},
                           sensor.arrays.map(
                               array =>
                                   el('tr', {}, el('th', {scope: 'row'}, array[0]),
                                      array.slice(1).map(text => el('td', {class: 'text'}, text)))))))))),
    summary.effects.on.length + summary.effects.off.length ?
        el('details', {class: 'panel wide'},
           el('summary', {},
              'Effects: ' + summary.effects.on.length + ' on, ' + summary.effects.off.length + ' off'),
           el('p', {}, el('b', {}, 'on: '), summary.effects.on.join(', ')),
           el('p', {class: 'dim'}, el('b', {}, 'off: '), summary.effects.off.join(', ')),
           el('p', {class: 'dim'}, 'greatx explain says why, for the scenario below.')) :
        null,
    summary.scenario ? el('details', {class: 'panel wide'}, el('summary', {}, 'The scenario'),
                          el('pre', {tabindex: 0}, summary.scenario)) :
                       null
  ];
}

/// A section with a title, if it has anything to show.
function section(name, title, ...children) {
  const kept = children.flat().filter(Boolean);
  if (!kept.length) return null;
  bar.links.append(el('a', {href: '#' + name}, title));
  return el('section', {id: name}, el('h2', {}, title), kept);
}
const grid = (list, size = '') =>
    list.length ? el('div', {class: 'grid ' + size}, list.map(panel => panel.node)) : null;
const keep = list => {
  panels.push(...list);
  return list;
};

/// Makes all panels of the present sequence.
function build() {
  panels = [];
  // The first record of an event camera has no interval, and no events.
  state.moment = moments().length > 1 && sensorsOf('event_camera').length ? 1 : 0;
  clear(bar.links);
  clear(bar.main);
  fillChoices();
  const shown = kind => sensorsOf(kind).filter(sensor => sensor.records.length > 0);
  const cameras = keep(shown('camera').map(sensor => new CameraPanel(sensor)));
  const events = keep(shown('event_camera').map(sensor => new EventPanel(sensor)));
  const scene = new SceneView(), above = sequence().lines.length ? new AboveMap() : null;
  if (scene.any) keep([scene]);
  if (above) keep([above]);
  const maps = [], tables = [];
  for (const sensor of [...shown('radar'), ...shown('csi')]) {
    const part = record => record.sensing ? record.sensing[0] : sensor.kind === 'radar' ? record : {};
    for (const view of ['range_doppler', 'range_azimuth'])
      if (sensor.records.some(record => part(record)[view])) maps.push(new MapPanel(sensor, view));
    if (sensor.records.some(record => part(record).detections)) tables.push(new DetectionTable(sensor));
  }
  keep(maps);
  keep(tables);
  const hasChannel = channels().some(sensor => sensor.records.length > 0);
  const response = hasChannel && channels().some(sensor => sensor.records.some(r => r.links || r.paths)) ?
      new ChannelPanel() :
      null;
  const paths =
      hasChannel && channels().some(sensor => sensor.records.some(r => r.paths)) ? new PathTable() : null;
  if (response) keep([response]);
  if (paths) keep([paths]);
  bar.paths = paths;
  const plots = keep(seriesPanels()), nodes = sequence().poses.some(Boolean) ? new PoseTableView() : null;
  if (nodes) keep([nodes]);
  bar.main.append(...[section('summary', 'Summary', summarySection()),
                      section(
                          'cameras', events.length ? 'Cameras and events' : 'Cameras',
                          grid(cameras.concat(events), 'large')),
                      section('scene', 'Scene', scene.any ? scene.node : null),
                      section('above', 'Map', above && above.node, nodes && nodes.node),
                      section('radar', 'Radar and sensing', grid(maps), tables.map(table => table.node)),
                      section('channel', 'Channel', response && response.node, paths && paths.node),
                      section('time', 'Over time', grid(plots))]
                      .filter(Boolean));
  tell('sequence');
}

function setTheme(name) {
  if (name) document.documentElement.setAttribute('data-theme', name);
  readTheme();
  tell('theme');
}
function isDark() {
  const set = document.documentElement.getAttribute('data-theme');
  return set ? set === 'dark' :
               window.matchMedia && window.matchMedia('(prefers-color-scheme: dark)').matches;
}

function start() {
  const summary = data.summary;
  bar.links = el('nav', {'aria-label': 'sections'});
  bar.main = el('main');
  document.getElementById('app').append(
      el('header', {},
         el('div', {}, el('h1', {}, summary.title),
            el('p', {class: 'dim'}, 'A greatx data set' + (summary.finished ? '' : ', unfinished'))),
         el('div', {class: 'tools'},
            el('button', {type: 'button', click: () => setTheme(isDark() ? 'light' : 'dark')},
               'light / dark'),
            el('button', {type: 'button', click: () => window.print()}, 'print'))),
      bar.links, timeBar(), bar.main);
  readTheme();
  state.listeners.push(what => {
    if (what !== 'path') showTime();
    if (what === 'theme') {
      for (const panel of panels)
        if (panel.board) panel.board.redraw();
    }
    for (const panel of panels) {
      if (what !== 'path')
        panel.update();
      else if (panel instanceof CameraPanel || panel instanceof SceneView || panel instanceof AboveMap)
        panel.board.redraw();
      else if (panel instanceof ChannelPanel)
        panel.delay.redraw();
    }
    if (bar.paths && what === 'path') bar.paths.highlight();
  });
  document.addEventListener('keydown', event => {
    if (event.ctrlKey || event.altKey || event.metaKey ||
        /^(INPUT|SELECT|TEXTAREA)$/.test(event.target.tagName))
      return;
    const steps = {ArrowLeft: -1, ArrowRight: 1, PageUp: null, Home: -1e9, End: 1e9}[event.key];
    if (steps)
      goTo(state.moment + steps);
    else if (event.key === ' ' && event.target.tagName !== 'BUTTON' && event.target.tagName !== 'SUMMARY')
      play(!bar.playing);
    else
      return;
    event.preventDefault();
  });
  if (window.matchMedia) {
    const query = window.matchMedia('(prefers-color-scheme: dark)');
    if (query.addEventListener) query.addEventListener('change', () => setTheme(null));
  }
  window.addEventListener('beforeprint', () => {
    for (const panel of panels)
      for (const board of boardsOf(panel)) board.now();
  });
  build();
}
const boardsOf = panel => [panel.board, panel.frequency, panel.delay].filter(Boolean);
/// Draws everything at once, also what is out of sight: for printing and for tests.
greatx.drawAll = () => {
  for (const panel of panels)
    for (const board of boardsOf(panel)) board.now();
};
/// Whether all pictures that were asked for are there.
greatx.ready = () => [...keptImages.map.values()].every(image => image.complete);
greatx.panels = () => panels;
Object.assign(greatx, {inflate, bytesOfBase64, textOf});
window.greatx = greatx;
start();
