// What time is shown: buttons, slider, keys; and what of the scene is shown, and how.

/** The time that a page shows. Whoever listens is told the place among the shown frames. */
class Clock {
  constructor(times) {
    this.times = times;
    this.place = -1;
    this.speed = 1;
    this.loop = true;
    this.playing = false;
    this.listeners = [];
  }

  get last() { return this.times.length - 1; }

  go(place) {
    const wanted = Math.max(0, Math.min(this.last, place));
    if (wanted === this.place) return;
    this.place = wanted;
    this.tell();
  }

  goToTime(time) {
    const before = placeOf(this.times, time);
    const nearer = before < this.last && this.times[before + 1] - time < time - this.times[before];
    this.pause();
    this.go(before + (nearer ? 1 : 0));
  }

  step(by) {
    this.pause();
    this.go(this.place + by);
  }

  pause() {
    if (!this.playing) return;
    this.playing = false;
    this.tell();
  }

  play() {
    if (this.playing || this.last < 1) return;
    if (this.place === this.last) this.place = 0;
    this.playing = true;
    this.time = this.times[this.place];
    this.before = null;
    this.tell();
    requestAnimationFrame(now => this.advance(now));
  }

  /** Frames are shown as they are, each until the next one's time. */
  advance(now) {
    if (!this.playing) return;
    if (this.before !== null) this.time += 1e-3 * Math.min(250, now - this.before) * this.speed;
    this.before = now;
    const end = this.times[this.last];
    if (this.time > end + 0.4 * this.speed && this.loop) this.time = this.times[0];
    else if (this.time >= end && !this.loop) {
      this.go(this.last);
      this.pause();
      return;
    }
    this.go(placeOf(this.times, this.time));
    requestAnimationFrame(later => this.advance(later));
  }

  toggle() { this.playing ? this.pause() : this.play(); }
  tell() { for (const listener of this.listeners) listener(this.place); }
}

const speeds = [0.1, 0.25, 0.5, 1, 2, 4];

function makeTransport(clock) {
  const button = (text, label, action, kind) => make('button', { type: 'button', title: label, 'aria-label': label, class: kind, onclick: action }, text);
  const play = button('Play', 'Play or pause (space)', () => clock.toggle(), 'main');
  const slider = make('input', { type: 'range', min: 0, max: clock.last, step: 1, 'aria-label': 'Frame' });
  slider.addEventListener('input', () => {
    clock.pause();
    clock.go(Number(slider.value));
  });
  const speed = make('select', { 'aria-label': 'Speed' },
    speeds.map(factor => make('option', { value: factor, selected: factor === 1 }, factor + '×')));
  speed.addEventListener('change', () => { clock.speed = Number(speed.value); });
  const loop = make('input', { type: 'checkbox', checked: true });
  loop.addEventListener('change', () => { clock.loop = loop.checked; });
  clock.listeners.push(place => {
    play.textContent = clock.playing ? 'Pause' : 'Play';
    slider.value = place;
    slider.setAttribute('aria-valuetext', seconds(clock.times[place]));
  });
  byId('transport').append(play, button('‹', 'One frame back (left arrow)', () => clock.step(-1)),
    button('›', 'One frame on (right arrow)', () => clock.step(1)), slider, speed,
    make('label', { class: 'quiet' }, loop, ' loop'));
}

/** Keys that move time, and those that move the camera while the picture has the focus. */
function listenToKeys(clock, view) {
  const moves = { ArrowLeft: () => clock.step(-1), ArrowRight: () => clock.step(1), Home: () => clock.step(-clock.place),
    End: () => clock.step(clock.last), ' ': () => clock.toggle() };
  const turns = { ArrowLeft: [-0.12, 0, 1], ArrowRight: [0.12, 0, 1], ArrowUp: [0, -0.12, 1], ArrowDown: [0, 0.12, 1],
    '+': [0, 0, 0.9], '=': [0, 0, 0.9], '-': [0, 0, 1.1] };
  document.addEventListener('keydown', event => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const onPicture = event.target === byId('canvas');
    const turn = view && onPicture && (event.shiftKey || !event.key.startsWith('Arrow')) && turns[event.key];
    const taken = /^(INPUT|SELECT|TEXTAREA)$/.test(event.target.tagName) || (event.key === ' ' && /^(BUTTON|SUMMARY)$/.test(event.target.tagName));
    if (turn) view.turn(...turn);
    else if (!taken && !event.shiftKey && moves[event.key]) moves[event.key]();
    else return;
    event.preventDefault();
  });
}

/** The colours of a field, their range, and the bar that shows both. */
class Colouring {
  constructor(view, bar) {
    this.view = view;
    this.bar = bar;
    this.name = '';
  }

  /** Of all meshes and frames: what most values do not exceed. */
  wholeRange(name) {
    const fields = this.view.meshes.map(mesh => mesh.fields.get(name)).filter(Boolean);
    const low = Math.min(...fields.map(field => field.low)), high = Math.max(...fields.map(field => field.high));
    const top = Math.max(...fields.map(field => field.range.low + field.range.step * (absent - 1)));
    return this.widened(low, high > low ? high : top);
  }

  frameRange(name) {
    const all = [].concat(...this.view.meshes.filter(mesh => mesh.group.visible).map(mesh => mesh.sortedValues(name))).sort((a, b) => a - b);
    if (all.length === 0) return this.wholeRange(name);
    const at = share => all[Math.round(share * (all.length - 1))];
    return this.widened(at(0.02), at(0.98) > at(0.02) ? at(0.98) : all[all.length - 1]);
  }

  widened(low, high) {
    if (fieldWord(this.name).both) {
      const size = Math.max(Math.abs(low), Math.abs(high)) || 1e-6;
      return [-size, size];
    }
    const from = fieldWords[this.name] ? Math.min(0, low) : low;
    return [from, high > from ? high : from + (Math.abs(from) || 1)];
  }

  choose(name) {
    this.name = name;
    this.bar.hidden = name === '';
    if (name === '') this.view.paint(null);
    else this.setRange(fieldWord(name).byFrame ? this.frameRange(name) : this.wholeRange(name));
  }

  setRange([low, high]) {
    const ramp = fieldWord(this.name).both ? ramps.both : ramps.rising;
    this.range = [low, high];
    this.view.paint({ name: this.name, low, high, ramp });
    this.drawBar(ramp);
  }

  drawBar(ramp) {
    const word = fieldWord(this.name);
    const end = (index, label) => {
      const input = make('input', { type: 'number', step: 'any', 'aria-label': label, value: digits(this.range[index] * word.scale) });
      input.addEventListener('change', () => {
        const range = [...this.range];
        range[index] = Number(input.value) / word.scale;
        if (input.value !== '' && range[1] > range[0]) this.setRange(range);
        else input.value = digits(this.range[index] * word.scale);
      });
      return input;
    };
    const fit = (text, range) => make('button', { type: 'button', onclick: () => this.setRange(range()) }, text);
    const shades = make('div', { class: 'ramp' });
    shades.style.background = rampStyle(ramp);
    this.bar.replaceChildren(make('div', {}, word.label + (word.unit ? ', ' + word.unit : '')), shades,
      make('div', { class: 'ends' }, end(0, 'Least'), fit('frame', () => this.frameRange(this.name)),
        fit('run', () => this.wholeRange(this.name)), end(1, 'Most')));
  }
}

/** Returns what chooses a field to colour by, by its name. */
function makeOptions(view) {
  const names = [...new Set([].concat(...view.meshes.map(mesh => [...mesh.fields.keys()])))];
  const colouring = new Colouring(view, byId('colour-bar'));
  const choice = make('select', { id: 'colour-choice' }, make('option', { value: '' }, 'plain'),
    names.map(name => make('option', { value: name }, fieldWord(name).label)));
  choice.addEventListener('change', () => colouring.choose(choice.value));
  const tick = (text, on, action, swatch) => {
    const box = make('input', { type: 'checkbox', checked: on });
    box.addEventListener('change', () => action(box.checked));
    const mark = swatch ? make('span', { class: 'swatch' }) : null;
    if (mark) mark.style.background = swatch;
    return make('label', {}, box, mark, text);
  };
  const look = name => make('button', { type: 'button', onclick: () => view.look(name) }, name);
  byId('options').append(
    make('label', {}, 'Colour', choice),
    tick('wireframe', false, on => view.setWires(on)), tick('shadows', true, on => view.setShadows(on)),
    tick('grid', true, on => view.setGrid(on)),
    make('span', { class: 'group', role: 'group', 'aria-label': 'View from' }, Object.keys(viewDirections).map(look)),
    make('div', { class: 'meshes', role: 'group', 'aria-label': 'Shown meshes' },
      view.meshes.map(mesh => tick(mesh.name, true, on => view.setVisible(mesh, on), mesh.colour))));
  return name => {
    if (!names.includes(name)) return;
    choice.value = name;
    colouring.choose(name);
  };
}
