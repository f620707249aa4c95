// Puts the page together. Behind its address may stand what it shows first, #frame=11&colour=distance&view=back, or #test: then it
// tells on <body> what was drawn.

function noteOf(data, view) {
  const notes = [];
  if (view) {
    notes.push('Drag to turn, click and scroll to zoom, right drag to move; keys: space, arrows; with shift, arrows turn the picture.');
    notes.push('A square of the grid is ' + metres(view.gridStep) + '.');
  }
  if (data.every > 1)
    notes.push('Every ' + data.every + ordinal(data.every) + ' frame of ' + data.frames.length + ' is shown, and the last and the worst, to keep this file small.');
  if (data.rounding > 0) notes.push('Shown positions are rounded to ' + (data.rounding < 1e-4 ? withUnit(1e6 * data.rounding, 'µm', 2) : metres(data.rounding)) + '.');
  return notes.join(' ');
}

function ordinal(number) {
  const tens = number % 100;
  return tens >= 11 && tens <= 13 ? 'th' : ({ 1: 'st', 2: 'nd', 3: 'rd' })[number % 10] || 'th';
}

/** The view of the meshes; null, with a word about why, where there can be none. */
function makeView(data) {
  const without = text => {
    byId('no-view').textContent = text;
    byId('no-view').hidden = false;
    byId('canvas').remove();
    return null;
  };
  if (data.meshes.length === 0) return without('This run wrote no frames (output.frames = "none"), so there is nothing to play.');
  try {
    return new SceneView(byId('canvas'), byId('stage'), data.meshes);
  } catch (error) {
    return without('The frames cannot be drawn: this browser offers no WebGL (' + error.message + '). Diagrams and tables are complete.');
  }
}

function makeClockText(data, clock) {
  clock.listeners.push(place => {
    const frame = data.frames[data.shown[place]];
    byId('clock').replaceChildren(seconds(frame.time), make('span', {}, 'frame ' + frame.index + ' of ' + (data.frames.length - 1)));
  });
}

function foot(data, view) {
  const parts = ['Written by percale ' + String(data.report.version) + '.'];
  const cloths = data.meshes.filter(mesh => mesh.cloth), sum = name => cloths.reduce((total, mesh) => total + mesh[name], 0);
  if (cloths.length > 0) parts.push('Cloth: ' + counted(sum('vertices'), 'vertex', 'vertices') + ', ' + counted(sum('triangles'), 'triangle') + '.');
  if (data.steps.every > 1) parts.push('Each point of a diagram stands for ' + data.steps.every + ' steps, with their smallest and largest value.');
  if (data.steps.bad_steps > 0) parts.push(counted(data.steps.bad_steps, 'step') + ' ended badly (red lines in the diagrams).');
  if (data.meshes.some(mesh => mesh.fields.some(field => field.name === 'edge_change')))
    parts.push('"Edge length against frame 0" is the mean over the edges at a vertex, measured from the first output frame, not from the rest shape.');
  if (data.meshes.some(mesh => mesh.fields.some(field => field.name === 'distance' && !field.of_frames)))
    parts.push('"Distance to obstacles" was measured on the frames when this page was written.');
  if (view) parts.push('Drawn by three.js r' + THREE.REVISION + ' (MIT licence).');
  byId('foot').textContent = parts.join(' ');
}

/** For tests: whether two frames differ, whether playing moves time, and by how many pixels the page is too wide. */
function tellTests(view, clock) {
  const facts = document.body.dataset;
  facts.errors = '0';
  facts.width = String(document.documentElement.clientWidth);
  facts.overflow = String(Math.max(0, document.documentElement.scrollWidth - document.documentElement.clientWidth));
  window.addEventListener('error', () => { facts.errors = String(Number(facts.errors) + 1); });
  if (!view) {
    facts.done = 'no view';
    return;
  }
  const pixels = place => {
    clock.go(place);
    return view.pixelSum();
  };
  const last = pixels(clock.last), first = pixels(0);
  Object.assign(facts, { firstPixels: first.sum, firstCovered: first.drawn, lastPixels: last.sum, lastCovered: last.drawn, frames: clock.times.length });
  clock.speed = 4;
  clock.play();
  const wait = setInterval(() => {
    if (clock.place === 0) return;
    clearInterval(wait);
    clock.pause();
    facts.playedTo = String(clock.place);
    facts.done = 'yes';
    // A page in a frame tells whoever put it there.
    if (parent !== window) parent.postMessage({ ...facts }, '*');
  }, 20);
}

function start() {
  const data = JSON.parse(byId('data').textContent);
  const times = data.shown.length > 0 ? data.shown.map(place => data.frames[place].time) : [0];
  const clock = new Clock(times);
  const view = makeView(data);
  const goToFrame = index => {
    const place = data.frames.findIndex(frame => frame.index === index);
    if (place >= 0) clock.goToTime(data.frames[place].time);
    byId('stage').scrollIntoView({ block: 'nearest', behavior: 'smooth' });
  };
  makeTables(data, goToFrame);
  const diagrams = makeDiagrams(data.steps, clock);
  clock.listeners.push(place => { for (const diagram of diagrams) diagram.setTime(times[place]); });
  let colourBy = null;
  const asked = new URLSearchParams(location.hash.slice(1));
  if (view) {
    makeClockText(data, clock);
    makeTransport(clock);
    colourBy = makeOptions(view);
    clock.listeners.push(place => view.show(place));
    listenToKeys(clock, view);
    if (asked.get('view') in viewDirections) view.look(asked.get('view'));
  }
  byId('view-note').textContent = noteOf(data, view);
  foot(data, view);
  clock.go(clock.last);
  if (view) colourBy(asked.get('colour'));
  const frame = data.frames.findIndex(one => String(one.index) === asked.get('frame'));
  if (frame >= 0) clock.goToTime(data.frames[frame].time);
  if (asked.has('test')) tellTests(view, clock);
}

start();
