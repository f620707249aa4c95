// Diagrams of steps.csv over time, each with a line at the time that is shown.

const diagramKinds = [
  { column: 'energy', label: 'Energy', unit: 'J', scale: 1, missing: 'not measured in this run' },
  { column: 'newton', label: 'Newton iterations of a step', unit: '', scale: 1, fromZero: true },
  { column: 'linear', label: 'Linear iterations of a step', unit: '', scale: 1, fromZero: true },
  { column: 'contacts', label: 'Contacts', unit: '', scale: 1, fromZero: true },
  { column: 'dt', label: 'Step length', unit: 'ms', scale: 1000, fromZero: true },
  { column: 'smallest_distance', label: 'Smallest distance', unit: 'mm', scale: 1000, fromZero: true, missing: 'cloth never came near' },
];

const diagramSize = { height: 150, left: 48, right: 10, top: 10, bottom: 22 };

class Diagram {
  constructor(kind, steps, clock) {
    this.kind = kind;
    this.steps = steps;
    this.time = steps.time;
    const column = steps.columns[kind.column];
    const scaled = list => list.map(value => isNumber(value) ? value * kind.scale : null);
    this.least = scaled(column.least);
    this.most = column.most ? scaled(column.most) : this.least;
    this.value = make('span', { class: 'value' });
    this.svg = svg('svg', { role: 'img', 'aria-label': this.summary() });
    const head = make('div', { class: 'head' }, make('h2', {}, kind.label + (kind.unit ? ', ' + kind.unit : '')), this.value);
    this.empty = this.most.every(value => value === null);
    this.element = make('section', { class: 'card diagram' }, head,
      this.empty ? make('p', { class: 'quiet none' }, kind.missing || 'no values') : this.svg);
    if (this.empty) return;
    this.svg.addEventListener('click', event => clock.goToTime(this.timeAt(event)));
    this.svg.addEventListener('pointermove', event => this.mark(this.timeAt(event)));
    this.svg.addEventListener('pointerleave', () => this.mark(this.shown));
    new ResizeObserver(() => this.draw()).observe(this.element);
  }

  numbers() { return this.least.concat(this.most).filter(value => value !== null); }

  summary() {
    const all = this.numbers();
    if (all.length === 0) return this.kind.label + ': no values';
    const low = all.reduce((a, b) => Math.min(a, b)), high = all.reduce((a, b) => Math.max(a, b));
    return this.kind.label + ' over time, from ' + withUnit(low, this.kind.unit) + ' to ' + withUnit(high, this.kind.unit);
  }

  range() {
    const all = this.numbers();
    let low = all.reduce((a, b) => Math.min(a, b)), high = all.reduce((a, b) => Math.max(a, b));
    if (this.kind.fromZero) low = Math.min(0, low);
    if (high - low <= 1e-9 * Math.max(Math.abs(high), Math.abs(low))) high = low + (Math.abs(low) || 1);
    return [low, high + 0.06 * (high - low)];
  }

  draw() {
    const width = Math.max(160, this.svg.clientWidth), { height, left, right, top, bottom } = diagramSize;
    const [low, high] = this.range(), end = this.time[this.time.length - 1] || 1;
    this.x = time => left + (width - left - right) * time / end;
    this.y = value => height - bottom - (height - top - bottom) * (value - low) / (high - low);
    this.fromX = x => Math.max(0, Math.min(end, (x - left) / (width - left - right) * end));
    this.svg.setAttribute('viewBox', '0 0 ' + width + ' ' + height);
    this.svg.replaceChildren(...this.axes(width, low, high, end), ...this.marksOfBadSteps(), ...this.curve());
    this.cursor = svg('line', { class: 'cursor', y1: top, y2: height - bottom });
    this.point = svg('circle', { class: 'point', r: 3.5 });
    this.svg.append(this.cursor, this.point);
    this.mark(this.shown || 0);
  }

  axes(width, low, high, end) {
    const { height, left, right, bottom } = diagramSize, parts = [];
    for (const tick of niceTicks(low, high, 4)) {
      parts.push(svg('line', { class: 'grid', x1: left, x2: width - right, y1: this.y(tick), y2: this.y(tick) }));
      parts.push(svg('text', { x: left - 6, y: this.y(tick) + 4, 'text-anchor': 'end' }, digits(tick)));
    }
    for (const tick of niceTicks(0, end, width / 80)) {
      const atEnd = this.x(tick) > width - right - 14;
      parts.push(svg('text', { x: Math.min(this.x(tick), width - 2), y: height - bottom + 15, 'text-anchor': atEnd ? 'end' : 'middle' }, digits(tick) + ' s'));
    }
    return parts;
  }

  marksOfBadSteps() {
    const { height, top, bottom } = diagramSize;
    return listOf(this.steps.bad).map(time =>
      svg('line', { class: 'bad-step', x1: this.x(time), x2: this.x(time), y1: top, y2: height - bottom }));
  }

  /** A line; where each point stands for several steps, the band from their smallest to their largest value. */
  curve() {
    const place = (i, list) => this.x(this.time[i]).toFixed(1) + ' ' + this.y(list[i]).toFixed(1);
    const runs = [];
    for (let i = 0; i < this.time.length; ++i) {
      if (this.most[i] === null) continue;
      if (i === 0 || this.most[i - 1] === null) runs.push([]);
      runs[runs.length - 1].push(i);
    }
    return runs.map(run => {
      const over = run.map(i => place(i, this.most));
      if (this.least === this.most || run.length < 2)
        return svg('path', { class: 'series', d: 'M' + over.join('L') + (run.length === 1 ? 'h1' : '') });
      const under = run.map(i => place(i, this.least)).reverse();
      return svg('path', { class: 'band', d: 'M' + over.concat(under).join('L') + 'Z' });
    });
  }

  timeAt(event) { return this.fromX(event.clientX - this.svg.getBoundingClientRect().left); }

  setTime(time) {
    this.shown = time;
    if (this.cursor) this.mark(time);
  }

  /** The step that ends at a time or just before it; steps end where their time stands. */
  mark(time) {
    const near = placeOf(this.time, time + 1e-9), value = this.most[near];
    this.cursor.setAttribute('x1', this.x(time));
    this.cursor.setAttribute('x2', this.x(time));
    this.point.setAttribute('visibility', value === null ? 'hidden' : 'visible');
    if (value !== null) {
      this.point.setAttribute('cx', this.x(this.time[near]));
      this.point.setAttribute('cy', this.y(value));
    }
    this.value.textContent = seconds(this.time[near]) + ': ' + withUnit(value, this.kind.unit);
  }
}

function makeDiagrams(steps, clock) {
  if (steps.time.length === 0) return [];
  const diagrams = diagramKinds.filter(kind => steps.columns[kind.column]).map(kind => new Diagram(kind, steps, clock));
  byId('diagrams').append(...diagrams.map(diagram => diagram.element));
  return diagrams;
}
