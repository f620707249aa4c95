// How numbers are written, how elements are made, how packed numbers are read.

/** An element with attributes and children; text becomes text, never markup. */
function make(tag, attributes, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes || {})) {
    if (name.startsWith('on')) element.addEventListener(name.slice(2), value);
    else if (value === true) element.setAttribute(name, '');
    else if (value !== false && value !== null && value !== undefined) element.setAttribute(name, value);
  }
  element.append(...children.flat().filter(child => child !== null && child !== undefined));
  return element;
}

function svg(tag, attributes, ...children) {
  const element = document.createElementNS('http://www.w3.org/2000/svg', tag);
  for (const [name, value] of Object.entries(attributes || {})) element.setAttribute(name, value);
  element.append(...children);
  return element;
}

const byId = id => document.getElementById(id);
const isNumber = value => typeof value === 'number' && Number.isFinite(value);
const isObject = value => value !== null && typeof value === 'object' && !Array.isArray(value);
const listOf = value => Array.isArray(value) ? value : [];

/** Three digits, or as many as asked for; a dash for what is no number. */
function digits(value, count = 3) {
  if (!isNumber(value)) return '–';
  if (value === 0) return '0';
  const size = Math.abs(value);
  if (size >= 1e6 || size < 1e-4) return value.toExponential(Math.max(0, count - 1)).replace('e+', 'e').replace(/\.?0+e/, 'e');
  const places = Math.max(0, Math.min(8, count - 1 - Math.floor(Math.log10(size))));
  const text = value.toFixed(places);
  return places > 0 ? text.replace(/\.?0+$/, '') : text;
}

const withUnit = (value, unit, count) => isNumber(value) ? digits(value, count) + (unit ? '\u00a0' + unit : '') : '–';
const seconds = value => isNumber(value) && value !== 0 && Math.abs(value) < 0.1 ? withUnit(1e3 * value, 'ms') : withUnit(value, 's');
const metres = value => isNumber(value) && value !== 0 && Math.abs(value) < 0.1 ? withUnit(1e3 * value, 'mm') : withUnit(value, 'm');
const percent = value => withUnit(100 * value, '%');
const whole = value => isNumber(value) ? Math.round(value).toLocaleString('en').replace(/,/g, '\u202f') : '–';
const bytesText = value => !isNumber(value) ? '–' : withUnit(value / 1e6, 'MB');
const counted = (count, one, many = one + 's') => whole(count) + ' ' + (count === 1 ? one : many);

/** The bytes of an element with base64; the element is then gone. */
function takeBytes(id) {
  const element = byId(id);
  const text = atob(element.textContent);
  element.remove();
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return bytes;
}

// Browsers run on machines that have the lowest byte first, as the page has.
const takeNumbers16 = id => new Uint16Array(takeBytes(id).buffer);
const takeNumbers32 = id => new Uint32Array(takeBytes(id).buffer);
const absent = 65535;

/** Where a number stands in an ascending list: the last place that is not above it, at least 0. */
function placeOf(list, value) {
  let low = 0, high = list.length - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (list[middle] <= value) low = middle;
    else high = middle - 1;
  }
  return low;
}

/** Round numbers that part a stretch into about so many pieces. */
function niceTicks(low, high, count) {
  const rough = (high - low) / Math.max(1, count);
  if (!(rough > 0)) return [low];
  const power = Math.pow(10, Math.floor(Math.log10(rough)));
  const step = [1, 2, 5, 10].map(factor => factor * power).find(size => size >= rough * 0.999);
  const ticks = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; ++i) ticks.push(i * step);
  return ticks;
}

// Colours from the least to the most, 0 ... 255.
const ramps = {
  rising: [[43, 47, 119], [42, 116, 158], [66, 170, 140], [178, 210, 84], [250, 236, 140]],
  both: [[33, 82, 163], [116, 165, 214], [240, 240, 236], [231, 146, 116], [173, 38, 38]],
};

/** The colour at 0 ... 1 of a ramp, written as three shares of one into a list. */
function rampColour(ramp, share, target, place) {
  const last = ramp.length - 1;
  const at = Math.max(0, Math.min(1, share)) * last;
  const from = Math.min(last - 1, Math.floor(at));
  for (let k = 0; k < 3; ++k) target[place + k] = (ramp[from][k] + (at - from) * (ramp[from + 1][k] - ramp[from][k])) / 255;
}

const rampStyle = ramp => 'linear-gradient(90deg,' + ramp.map(colour => 'rgb(' + colour.join(',') + ')').join(',') + ')';

// What is known of the fields that frames and pages have. `scale`: from the file's unit to the shown one; `byFrame`: of the run most
// values say little, as where cloth falls from afar.
const fieldWords = {
  strain_warp: { label: 'Strain along the warp', unit: '%', scale: 100, both: true },
  strain_weft: { label: 'Strain along the weft', unit: '%', scale: 100, both: true },
  strain_shear: { label: 'Shear', unit: 'rad', scale: 1, both: true },
  edge_change: { label: 'Edge length against frame 0', unit: '%', scale: 100, both: true },
  pressure: { label: 'Contact pressure', unit: 'Pa', scale: 1 },
  distance: { label: 'Distance to obstacles', unit: 'mm', scale: 1000, byFrame: true },
};

const fieldWord = name => fieldWords[name] || { label: name, unit: '', scale: 1 };
