// What report.json says, as cards with tables. Whatever a report lacks is left out.

function card(title, ...content) { return make('section', { class: 'card' }, title ? make('h2', {}, title) : null, content); }

function badge(text, kind) { return make('span', { class: 'badge ' + (kind || '') }, text); }

/** columns: {title, number}; rows: lists of texts or elements. */
function table(columns, rows) {
  const kind = column => column.number ? 'number' : null;
  return make('div', { class: 'scroll' }, make('table', {},
    make('thead', {}, make('tr', {}, columns.map(column => make('th', { class: kind(column), scope: 'col' }, column.title)))),
    make('tbody', {}, rows.map(row => make('tr', {}, row.map((cell, i) => make('td', { class: columns[i].kind || kind(columns[i]) }, cell)))))));
}

function tiles(entries) {
  return make('dl', { class: 'tiles' },
    entries.filter(([, value]) => value !== null && value !== '–').map(([name, value]) => make('div', {}, make('dt', {}, name), make('dd', {}, value))));
}

function folded(title, content, open) { return make('details', { open: Boolean(open) }, make('summary', {}, title), content); }

/** A key of which a narrow column may break off parts. */
const breakable = text => String(text).split(/(?<=[_.])/).flatMap((part, i) => i > 0 ? [make('wbr'), part] : [part]);

// Units of what [expect] judges.
const measureUnits = { deepest_penetration: metres, smallest_distance: metres, lowest_vertex: metres, matches: metres,
  largest_seam_gap: metres, largest_strain: percent, speed_at_end: value => withUnit(value, 'm/s'),
  rms_speed_at_end: value => withUnit(value, 'm/s'), energy_gain: value => withUnit(value, 'J') };

const measureText = (name, value) => (measureUnits[name] || (number => digits(number, 4)))(value);

function headBadges(report) {
  const status = String(report.status), atRest = isObject(report.rest) && report.rest.at_rest === true;
  const all = listOf(report.expectations), passed = all.filter(one => one.passed === true).length;
  const badges = [badge(atRest ? status + ', at rest' : status, status === 'finished' ? 'good' : status === 'stopped' ? 'warn' : 'bad')];
  if (all.length > 0) badges.push(badge(passed + ' of ' + all.length + ' expectations passed', passed === all.length ? 'good' : 'bad'));
  if (!isClean(report)) badges.push(badge('certificate not clean', 'bad'));
  else if (hasContact(report)) badges.push(badge('no crossing', 'good'));
  const warnings = listOf(report.warnings).length;
  if (warnings > 0) badges.push(badge(counted(warnings, 'warning'), 'warn'));
  return badges;
}

/** Whether there was anything that cloth could have crossed. */
function hasContact(report) {
  const { fabric, pair } = isObject(report.settings) ? report.settings : {};
  const meets = isObject(fabric) && Object.values(fabric).some(one => isObject(one) && one.self_contact === true);
  return listOf(report.obstacles).length > 0 || listOf(pair).length > 0 || meets;
}

const isClean = report => report.intersections === 0 && report.deepest_penetration === 0;

function figures(report) {
  const cpu = isNumber(report.cpu_s) && report.simulated_s > 0 ? withUnit(report.cpu_s / report.simulated_s, 's/s') : '–';
  return card('The run', tiles([
    ['Simulated', seconds(report.simulated_s)], ['Steps', whole(report.steps)], ['Rejected steps', whole(report.rejected_steps)],
    ['CPU time of steps', seconds(report.cpu_s)], ['CPU per simulated s', cpu], ['Certificates', seconds(report.certificate_s)],
    ['Whole run', seconds(report.wall_s)], ['Newton iterations', whole(report.newton_iterations)],
    ['Most contacts', whole(report.contacts_most)], ['Largest strain', percent(report.largest_strain)],
    ['Speed at end', withUnit(report.speed_at_end, 'm/s')], ['Peak memory', bytesText(report.peak_memory_bytes)],
    ['Scheme', typeof report.scheme === 'string' ? report.scheme.replace(/_/g, ' ') : null],
    ['Linear solver', typeof report.linear_solver === 'string' ? report.linear_solver : null]]));
}

/** ' at 1.5 s', ' during 1 … 2 s', or nothing where it is of the whole run. */
function whenText(one) {
  if (typeof one.at === 'number') return ' at ' + digits(one.at, 4) + ' s';
  const during = listOf(one.during);
  return during.length === 2 ? ' during ' + digits(during[0], 4) + ' … ' + digits(during[1], 4) + ' s' : '';
}

function expectations(report) {
  const all = listOf(report.expectations);
  if (all.length === 0) return card('Expectations', make('p', { class: 'quiet' }, 'The scene expects nothing.'));
  return card('Expectations', table(
    [{ title: 'measure' }, { title: 'value', number: true }, { title: 'limit', number: true }, { title: '' }],
    all.map(one => [breakable(one.measure + whenText(one)), measureText(one.measure, one.value), String(one.limit),
      one.passed === true ? badge('passed', 'good') : badge('failed', 'bad')])));
}

function certificate(data, goToFrame) {
  const report = data.report, worst = report.worst_frame, every = report.step_certificate;
  if (isClean(report) && !hasContact(report))
    return card('Certificate', make('p', { class: 'quiet' }, 'There is nothing to test against: no obstacle, and no cloth that meets cloth.'));
  const link = isNumber(worst) ? make('button', { type: 'button', class: 'link', onclick: () => goToFrame(worst) }, 'frame ' + worst) : 'none was near';
  const result = make('section', { class: 'card certificate' }, make('h2', {}, 'Certificate'),
    make('p', {}, isClean(report) ? badge('clean', 'good') : badge('not clean', 'bad'),
      ' ' + counted(data.frames.length, 'output frame') + ', tested triangle against triangle'),
    tiles([['Intersecting pairs', whole(report.intersections)], ['Deepest penetration', metres(report.deepest_penetration)],
      ['Smallest distance', isNumber(report.smallest_distance) ? metres(report.smallest_distance) : 'never near'], ['Worst frame', link]]));
  if (isObject(every))
    result.append(make('p', { class: 'quiet' }, 'Every step: ' + counted(every.states, 'state') + ', ' + counted(every.intersections, 'intersecting pair') +
      ', deepest ' + metres(every.deepest_penetration) + ', smallest distance ' + metres(every.smallest_distance) + ' at ' + seconds(every.worst_time_s)));
  const rows = data.frames.map(frame => [
    make('button', { type: 'button', class: 'link', onclick: () => goToFrame(frame.index) }, String(frame.index)), seconds(frame.time),
    frame.intersections > 0 ? badge(whole(frame.intersections), 'bad') : '0', metres(frame.deepest_penetration), metres(frame.smallest_distance)]);
  result.append(folded('Frame by frame', table([{ title: 'frame' }, { title: 'time', number: true }, { title: 'pairs', number: true },
    { title: 'deepest', number: true }, { title: 'distance', number: true }], rows)));
  return result;
}

function warnings(report) {
  const texts = listOf(report.warnings);
  return texts.length === 0 ? null : card('Warnings', make('ul', { class: 'plain' }, texts.map(text => make('li', {}, String(text)))));
}

function costs(report) {
  if (!isObject(report.stages)) return null;
  const stages = Object.entries(report.stages).filter(([, value]) => isNumber(value));
  const sum = stages.reduce((total, [, value]) => total + value, 0);
  const most = Math.max(...stages.map(([, value]) => value), 1e-12);
  const bar = value => {
    const line = make('span', { class: 'bar' });
    line.style.width = (100 * value / most).toFixed(1) + '%';
    return line;
  };
  return card('CPU time by stage', table(
    [{ title: 'stage' }, { title: 'time', number: true }, { title: 'share', number: true }, { title: '', kind: 'wide' }],
    stages.map(([name, value]) => [name, seconds(value), sum > 0 ? percent(value / sum) : '–', bar(value)])));
}

function energies(report) {
  if (!isObject(report.energy)) return null;
  const rows = Object.entries(report.energy).filter(([, value]) => isNumber(value))
    .map(([name, value]) => [name.replace(/_/g, ' '), name === 'closure' ? digits(value) : withUnit(value, 'J')]);
  return rows.length === 0 ? null : card('Energy at the end', table([{ title: 'part' }, { title: 'value', number: true }], rows));
}

function obstacles(report) {
  const all = listOf(report.obstacles).filter(isObject);
  if (all.length === 0) return null;
  const dropped = one => ['merged_vertices', 'degenerate_triangles', 'duplicate_triangles', 'unreferenced_vertices', 'internal_triangles']
    .filter(name => one[name] > 0).map(name => whole(one[name]) + ' ' + name.replace(/_/g, ' ')).join(', ') || '–';
  const force = list => listOf(list).length === 3 ? list.map(value => digits(value)).join(', ') : '–';
  return card('Obstacles', table([{ title: 'name' }, { title: 'triangles', number: true }, { title: 'force at the end, N' }, { title: 'left out of the mesh' }],
    all.map(one => [String(one.name), whole(one.triangles), force(one.contact_force), dropped(one)])));
}

function seams(report, clothNames) {
  const all = listOf(report.seams).filter(isObject);
  if (all.length === 0) return null;
  return card('Seams', table(
    [{ title: 'seam' }, { title: 'cloth' }, { title: 'stitches', number: true }, { title: 'median gap', number: true }, { title: '95 %', number: true }, { title: 'largest', number: true }],
    all.map(one => [String(one.name || '–'), [...new Set(listOf(one.cloths).map(i => clothNames[i] || String(i)))].join(', '), whole(one.stitches),
      metres(one.median_gap), metres(one.gap_of_95_percent), metres(one.largest_gap)])));
}

function fits(report) {
  if (!isObject(report.fit)) return null;
  const rows = [];
  for (const [cloth, fields] of Object.entries(report.fit))
    for (const [name, spread] of Object.entries(isObject(fields) ? fields : {})) {
      const { label, unit, scale } = fieldWord(name), value = number => isNumber(number) ? withUnit(number * scale, unit) : '–';
      rows.push([cloth, label, value(spread.smallest), value(spread.median), value(spread.of_95_percent), value(spread.largest)]);
    }
  return rows.length === 0 ? null : card('Fit at the end', table([{ title: 'cloth' }, { title: 'field' }, { title: 'smallest', number: true },
    { title: 'median', number: true }, { title: '95 %', number: true }, { title: 'largest', number: true }], rows));
}

function startRepair(report) {
  const all = listOf(report.start_repair).filter(isObject);
  return all.length === 0 ? null : card('Moved at the start, to be clear of conflict', table(
    [{ title: 'cloth' }, { title: 'off' }, { title: 'vertices', number: true }, { title: 'largest move', number: true }],
    all.map(one => [String(one.cloth), String(one.obstacle), whole(one.vertices_moved), metres(one.largest_move)])));
}

function skipped(report) {
  const all = listOf(report.skipped).filter(isObject);
  return all.length === 0 ? null : card(null, folded('Work that was left out (' + all.length + ')',
    table([{ title: 'what' }, { title: 'why' }], all.map(one => [String(one.what), String(one.why)]))));
}

/** Tables and lists of tables become rows with dotted keys, as scene files name them. */
function settingRows(value, key) {
  if (isObject(value)) return [].concat(...Object.entries(value).map(([name, part]) => settingRows(part, key ? key + '.' + name : name)));
  if (Array.isArray(value) && value.some(isObject))
    return [].concat(...value.map((part, i) => settingRows(part, key + '.' + (isObject(part) && typeof part.name === 'string' ? part.name : i))));
  const text = JSON.stringify(value);
  return [[breakable(key), text.length > 160 ? text.slice(0, 160) + ' … (' + listOf(value).length + ' entries)' : text]];
}

function settings(report) {
  if (!isObject(report.settings)) return null;
  return card(null, folded('Settings: every value used', table([{ title: 'key' }, { title: 'value' }], settingRows(report.settings, ''))));
}

function makeTables(data, goToFrame) {
  const report = data.report;
  byId('title').textContent = report.title || document.title;
  byId('scene').textContent = typeof report.scene === 'string' ? report.scene : '';
  if (typeof report.reason === 'string' && report.reason !== '')
    document.querySelector('.name').append(make('p', { class: 'reason' + (report.status === 'stopped' ? '' : ' failed') }, report.reason));
  byId('badges').append(...headBadges(report));
  byId('side').append(figures(report), expectations(report), certificate(data, goToFrame));
  const clothNames = isObject(report.settings) ? listOf(report.settings.cloth).map(cloth => cloth.name) : [];
  byId('tables').append(...[warnings(report), costs(report), energies(report), obstacles(report), seams(report, clothNames), fits(report),
    startRepair(report), skipped(report), settings(report)].filter(Boolean));
}
