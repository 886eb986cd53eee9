// The lighting desk's page: shows what the render has so far, mixed by the faders, and sends edits of lights.

const $ = (id) => document.getElementById(id);
const canvas = $('picture'), stage = $('stage');

const desk = {faders: [], statements: [], picture: 0, restart: 0, exposure: 0, clip: false, zoom: 0, width: 1, height: 1};

async function post(path, body) {
  const reply = await fetch(path, {method: 'POST', headers: {'Content-Type': 'application/json'}, body: JSON.stringify(body)});
  if (reply.status === 422) throw new Error((await reply.json()).message);
  if (!reply.ok) throw new Error('the desk does not answer');
  return reply;
}

function element(tag, attributes = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (name in made && name !== 'list') made[name] = value;
    else made.setAttribute(name, value);
  }
  made.append(...children);
  return made;
}

// Runs at most one at a time; what is asked for meanwhile is done once more after it, with the latest.
function latestOnly(work) {
  let isRunning = false, isWanted = false;
  return async function run() {
    isWanted = true;
    if (isRunning) return;
    isRunning = true;
    try {
      while (isWanted) {
        isWanted = false;
        await work();
      }
    } finally {
      isRunning = false;
    }
  };
}

// ---- colours

const toLinear = (v) => (v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4);
const toEncoded = (v) => (v <= 0.0031308 ? 12.92 * v : 1.055 * v ** (1 / 2.4) - 0.055);
const fromHex = (hex) => [1, 3, 5].map((i) => toLinear(parseInt(hex.slice(i, i + 2), 16) / 255));
function toHex(color) {
  const largest = Math.max(1, ...color);
  return '#' + color.map((v) => Math.round(255 * toEncoded(Math.max(v, 0) / largest)).toString(16).padStart(2, '0')).join('');
}

// ---- the picture

function factorOf(fader) {
  const isSoloed = desk.faders.some((other) => other.isSolo);
  if (fader.isMuted || (isSoloed && !fader.isSolo)) return [0, 0, 0];
  const scale = 2 ** fader.stops;
  return fader.tint.map((channel) => channel * scale);
}
const factors = () => desk.faders.map(factorOf);

// When the control whose effect is not yet seen was moved, milliseconds; figures of the page itself, for its tests.
let movedAt = 0;
window.lampyrDesk = {moves: 0, timings: [], restarts: []};

const showPicture = latestOnly(async () => {
  const moved = movedAt, {moves, timings} = window.lampyrDesk;
  movedAt = 0;
  const reply = await post('picture', {factors: factors(), exposure: desk.exposure, clip: desk.clip});
  if (reply.status === 204) return;
  const [width, height, number, restart] = reply.headers.get('X-Lampyr').split(' ').map(Number);
  const pixels = new Uint8ClampedArray(await reply.arrayBuffer());
  if (canvas.width !== width || canvas.height !== height) {
    canvas.width = width;
    canvas.height = height;
    Object.assign(desk, {width, height});
    applyZoom();
  }
  canvas.getContext('2d').putImageData(new ImageData(pixels, width, height), 0, 0);
  Object.assign(desk, {picture: number, restart});
  canvas.dataset.picture = number;
  canvas.dataset.restart = restart;
  if (moved) timings.push(performance.now() - moved);
  canvas.dataset.moves = moves;
  canvas.dataset.shown = Number(canvas.dataset.shown ?? 0) + 1;
  showPixel();
});

function moved() {
  ++window.lampyrDesk.moves;
  if (!movedAt) movedAt = performance.now();
  showPicture();
}

// ---- zoom: 0 fits the picture into the room

function fittingZoom() {
  const room = Math.max(stage.clientWidth, 1) / desk.width;
  const isStacked = getComputedStyle(document.querySelector('main')).display === 'block';
  return isStacked ? room : Math.min(room, Math.max(stage.clientHeight, 1) / desk.height);
}
function applyZoom() {
  const scale = desk.zoom || fittingZoom();
  canvas.style.width = `${Math.floor(desk.width * scale)}px`;
  canvas.style.height = `${Math.floor(desk.height * scale)}px`;
  canvas.style.imageRendering = scale >= 2 ? 'pixelated' : 'auto';
}
function zoomTo(zoom, at) {
  const box = canvas.getBoundingClientRect();
  const x = at ? (at.clientX - box.left) / box.width : 0.5, y = at ? (at.clientY - box.top) / box.height : 0.5;
  desk.zoom = zoom && Math.min(Math.max(zoom, 1 / 16), 32);
  applyZoom();
  if (!at || !desk.zoom) return;
  const now = canvas.getBoundingClientRect();
  stage.scrollLeft += now.left + x * now.width - at.clientX;
  stage.scrollTop += now.top + y * now.height - at.clientY;
}
const currentZoom = () => desk.zoom || fittingZoom();
$('zoom-in').onclick = () => zoomTo(currentZoom() * 1.5);
$('zoom-out').onclick = () => zoomTo(currentZoom() / 1.5);
$('zoom-fit').onclick = () => zoomTo(0);
$('zoom-one').onclick = () => zoomTo(1 / window.devicePixelRatio);
stage.addEventListener('wheel', (event) => {
  if (!event.ctrlKey && getComputedStyle(document.querySelector('main')).display === 'block') return;
  event.preventDefault();
  zoomTo(currentZoom() * 2 ** (-event.deltaY / 300), event);
}, {passive: false});
new ResizeObserver(applyZoom).observe(stage);

// ---- a pixel's value

let pointed = null;
const digits = (v) => (v === 0 ? '0' : Math.abs(v) >= 1e4 || Math.abs(v) < 1e-3 ? v.toExponential(2) : v.toPrecision(3));
const showPixel = latestOnly(async () => {
  if (!pointed) return;
  const {x, y} = pointed;
  try {
    const {value, interval} = await (await post('pixel', {factors: factors(), x, y})).json();
    const channels = ['R', 'G', 'B'].map((name, c) => `${name} ${digits(value[c])}` + (interval ? ` ± ${digits(interval[c])}` : ''));
    const unknown = interval ? '' : ' (± unknown: faders differ)';
    $('pixel').textContent = `${x}, ${y}: ${channels.join('  ')}${unknown}`;
  } catch (error) {
    $('pixel').textContent = error.message;
  }
});
for (const kind of ['pointermove', 'pointerdown']) canvas.addEventListener(kind, (event) => {
  const box = canvas.getBoundingClientRect();
  const at = (v, size) => Math.min(Math.max(Math.floor(v * size), 0), size - 1);
  pointed = {x: at((event.clientX - box.left) / box.width, desk.width), y: at((event.clientY - box.top) / box.height, desk.height)};
  showPixel();
});

// ---- the guide of paths from what a pixel sees

function guideText({x, y}, guide) {
  const gain = `the variance of paths would be ${guide.gain?.toPrecision(2)} times less with a guide`;
  if (!guide.isLearned) return 'No guide is learned: path guiding is off, or the integrator has none';
  if (!guide.isUsed) return guide.gain === 1 ? 'Paths are not guided so far' : `Paths are not guided: ${gain}`;
  if (!guide.isGuided) return `${x}, ${y}: paths are not guided there`;
  return `${x}, ${y}: ${Math.round(100 * guide.share)} % of the paths go by this density, at most ` +
    `${digits(Math.max(...guide.densities))} per steradian; the middle is where the camera looks`;
}
const showGuide = latestOnly(async () => {
  const at = {...pointed};
  $('guide').hidden = false;
  $('guide-map').hidden = true;
  try {
    const guide = await (await post('guide', at)).json();
    $('guide-text').textContent = guideText(at, guide);
    if (!guide.isGuided) return;
    const image = new ImageData(guide.columns, guide.rows), most = Math.max(...guide.densities);
    guide.densities.forEach((density, i) => image.data.fill(255 * toEncoded(density / most), 4 * i, 4 * i + 3));
    for (let i = 3; i < image.data.length; i += 4) image.data[i] = 255;
    $('guide-map').getContext('2d').putImageData(image, 0, 0);
    $('guide-map').hidden = false;
  } catch (error) {
    $('guide-text').textContent = error.message;
  }
});
canvas.addEventListener('click', () => pointed && showGuide());

// ---- exposure and tone

const signed = (v) => (v > 0 ? '+' : v < 0 ? '−' : '') + Math.abs(v).toFixed(2);
function showExposure() {
  $('exposure-value').textContent = signed(desk.exposure);
}
$('exposure').oninput = () => {
  desk.exposure = Number($('exposure').value);
  showExposure();
  moved();
};
$('exposure').ondblclick = () => {
  $('exposure').value = 0;
  $('exposure').oninput();
};
$('tone').onchange = () => {
  desk.clip = $('tone').value === 'clip';
  moved();
};

// ---- faders

function refreshSilence() {
  for (const fader of desk.faders) fader.box.classList.toggle('silent', Math.max(...factorOf(fader)) === 0);
  const isNeutral = factors().every((factor) => factor.every((channel) => channel === 1));
  $('set').disabled = isNeutral;
  $('neutral').disabled = isNeutral && !desk.faders.some((fader) => fader.isMuted || fader.isSolo);
}
function changedFader() {
  refreshSilence();
  moved();
}

function toggle(fader, key, letter, title) {
  const button = element('button', {type: 'button', className: `toggle ${key === 'isMuted' ? 'mute' : 'solo'}`, title,
    ariaLabel: `${title}: ${fader.label}`, ariaPressed: 'false'}, letter);
  button.onclick = () => {
    fader[key] = !fader[key];
    button.ariaPressed = String(fader[key]);
    changedFader();
  };
  fader.controls.push(() => { button.ariaPressed = String(fader[key]); });
  return button;
}

function makeFader(fader) {
  Object.assign(fader, {stops: 0, tint: [1, 1, 1], isMuted: false, isSolo: false, controls: []});
  const name = element('button', {type: 'button', className: 'opens', ariaExpanded: 'false', title: fader.label}, element('span', {}, fader.label));
  const slider = element('input', {type: 'range', min: -8, max: 8, step: 0.05, value: 0, ariaLabel: `Stops of ${fader.label}`});
  const stops = element('span', {className: 'stops'}, '0.00');
  const tint = element('input', {type: 'color', value: '#ffffff', title: 'Tint', ariaLabel: `Tint of ${fader.label}`});
  slider.oninput = () => {
    fader.stops = Number(slider.value);
    stops.textContent = signed(fader.stops);
    changedFader();
  };
  slider.ondblclick = () => {
    slider.value = 0;
    slider.oninput();
  };
  tint.oninput = () => {
    const color = fromHex(tint.value), largest = Math.max(...color);
    fader.tint = largest > 0 ? color.map((channel) => channel / largest) : [0, 0, 0];
    changedFader();
  };
  fader.controls.push(() => {
    slider.value = fader.stops;
    stops.textContent = signed(fader.stops);
    tint.value = toHex(fader.tint);
  });
  const lights = element('div', {hidden: true});
  name.onclick = () => {
    lights.hidden = !lights.hidden;
    name.ariaExpanded = String(!lights.hidden);
    if (!lights.hidden) showLights(lights, fader.statements);
  };
  fader.lights = lights;
  fader.box = element('div', {className: 'fader'},
    element('div', {className: 'row'}, name, toggle(fader, 'isMuted', 'M', 'Mute'), toggle(fader, 'isSolo', 'S', 'Solo'), tint, slider, stops), lights);
  return fader.box;
}

function neutralize() {
  for (const fader of desk.faders) {
    Object.assign(fader, {stops: 0, tint: [1, 1, 1], isMuted: false, isSolo: false});
    for (const show of fader.controls) show();
  }
  changedFader();
}
$('neutral').onclick = neutralize;

// ---- parameters of lights and filters

// What "(0,180]" and the like allow; null without two finite ends.
function boundsOf(range) {
  const ends = /^[[(]([-\d.e+]+),([-\d.e+]+)[\])]$/.exec(range);
  return ends && {low: Number(ends[1]), high: Number(ends[2])};
}

const shortest = (v) => String(Number(v.toPrecision(7)));

// A row with the inputs of one parameter.
function makeParameter(statement, parameter) {
  const row = element('div', {className: 'parameter'});
  const mistake = element('p', {className: 'mistake', hidden: true, role: 'alert'});
  const values = element('span', {className: 'values'});
  const reset = element('button', {type: 'button', className: 'reset', title: 'As in the scene', ariaLabel: `Reset ${parameter.name}`}, '↺');
  let wanted = null;
  const apply = latestOnly(async () => {
    const request = wanted, asked = performance.now();
    try {
      const reply = await (await post(request.path, {statement: statement.statement, parameter: parameter.name, ...request.values})).json();
      window.lampyrDesk.restarts.push({seconds: reply.seconds, milliseconds: performance.now() - asked});
      mistake.hidden = true;
      desk.statements[statement.statement] = reply.statement;
      Object.assign(parameter, reply.statement.parameters.find((other) => other.name === parameter.name));
      if (request.path === 'reset') fill();
      markEdited();
    } catch (error) {
      mistake.textContent = error.message;
      mistake.hidden = false;
    }
  });
  const send = (path, values) => {
    wanted = {path, values};
    apply();
  };
  const markEdited = () => {
    row.classList.toggle('given', parameter.isGiven);
    row.classList.toggle('edited', parameter.isEdited);
    reset.hidden = !parameter.isEdited;
  };
  const fill = () => values.replaceChildren(...inputsFor(statement, parameter, (sent) => send('edit', sent)));
  reset.onclick = () => send('reset', {});
  fill();
  const help = [parameter.help, parameter.range && `range ${parameter.range}`, parameter.default && `default ${parameter.default}`];
  const name = element('span', {className: 'name', title: help.filter(Boolean).join('; ')});
  // Names may break behind their colons.
  for (const part of parameter.name.split(/(?<=:)/)) name.append(part, element('wbr'));
  if (parameter.unit) name.append(' ', element('span', {className: 'unit'}, parameter.unit));
  row.append(name, values, element('span', {}, reset), mistake);
  markEdited();
  return row;
}

function inputsFor(statement, parameter, send) {
  const label = `${parameter.name} of ${statement.label}`;
  switch (parameter.control) {
    case 'switch': {
      const box = element('input', {type: 'checkbox', checked: parameter.numbers[0] !== 0, ariaLabel: label});
      box.onchange = () => send({numbers: [box.checked ? 1 : 0]});
      return [box];
    }
    case 'text': {
      const field = element('input', {type: 'text', value: parameter.text, ariaLabel: label});
      field.onchange = () => send({text: field.value});
      return [field];
    }
    case 'none':
      return [element('span', {className: 'shown', title: parameter.text}, parameter.text || '—')];
    default:
      return numberInputs(parameter, label, send);
  }
}

function numberInputs(parameter, label, send) {
  const fields = parameter.numbers.map((number, i) => element('input', {type: 'number', step: parameter.control === 'integer' ? 1 : 'any',
    value: shortest(number), ariaLabel: parameter.numbers.length > 1 ? `${label}, ${i + 1}` : label}));
  // Those that are not typed stay as they are, with all their digits.
  const numbers = [...parameter.numbers];
  const sendAll = () => send({numbers});
  const take = (i) => { numbers[i] = fields[i].value === '' ? null : Number(fields[i].value); };
  fields.forEach((field, i) => {
    field.onchange = () => {
      take(i);
      sendAll();
    };
  });
  const bounds = boundsOf(parameter.range);
  if (parameter.control === 'color') {
    const swatch = element('input', {type: 'color', value: toHex(parameter.numbers), ariaLabel: label});
    swatch.onchange = () => {
      const color = fromHex(swatch.value), brightness = Math.max(1, ...numbers);
      fields.forEach((field, i) => {
        field.value = shortest(color[i] * brightness);
        take(i);
      });
      sendAll();
    };
    return [swatch, ...fields];
  }
  if (fields.length !== 1 || !bounds || parameter.control === 'integer') return fields;
  const slider = element('input', {type: 'range', min: bounds.low, max: bounds.high, step: (bounds.high - bounds.low) / 1000,
    value: parameter.numbers[0], ariaLabel: `${label}, slider`});
  slider.oninput = () => {
    fields[0].value = shortest(Number(slider.value));
    take(0);
    sendAll();
  };
  fields[0].addEventListener('input', () => { slider.value = fields[0].value; });
  return [slider, ...fields];
}

function makeLight(statement) {
  const isWorthShowing = (parameter) => parameter.control !== 'none' || (parameter.isGiven && parameter.name !== 'lightGroup');
  const rowsOf = (isCommon) => statement.parameters.filter((parameter) => parameter.isCommon === isCommon && isWorthShowing(parameter))
    .map((parameter) => makeParameter(statement, parameter));
  const own = rowsOf(false), common = rowsOf(true);
  const count = statement.lights > 1 ? ` · ${statement.lights} lights` : '';
  const box = element('div', {className: 'light'},
    element('p', {className: 'place', title: statement.help}, `${statement.label === statement.type ? '' : `${statement.label} · `}${statement.type} · ${statement.place}${count}`), ...own);
  if (common.length) box.append(element('details', {open: own.length === 0}, element('summary', {}, 'what every light has'), ...common));
  return box;
}

// Of many lights each is made when it is opened.
function makeClosedLight(index) {
  const statement = desk.statements[index];
  const box = element('details', {className: 'closed'}, element('summary', {}, `${statement.label} · ${statement.place}`));
  box.ontoggle = () => {
    if (box.open && box.children.length === 1) box.append(makeLight(desk.statements[index]));
  };
  return box;
}

function showLights(box, statements) {
  const few = 3;
  box.replaceChildren(...statements.map((index) => (statements.length > few ? makeClosedLight(index) : makeLight(desk.statements[index]))));
}

function makeFilter(statement) {
  const parameters = element('div', {hidden: true});
  const name = element('button', {type: 'button', className: 'opens', ariaExpanded: 'false'}, element('span', {}, statement.label));
  name.onclick = () => {
    parameters.hidden = !parameters.hidden;
    name.ariaExpanded = String(!parameters.hidden);
    if (!parameters.hidden) showLights(parameters, [statement.statement]);
  };
  return element('div', {className: 'filter'}, element('div', {className: 'row'}, name, element('span', {className: 'place'}, statement.place)), parameters);
}

// ---- the whole

async function loadLights() {
  const lights = await (await fetch('lights')).json();
  desk.statements = lights.statements;
  return lights;
}

$('pause').onclick = () => {
  const pauses = $('pause').ariaPressed !== 'true';
  $('pause').ariaPressed = String(pauses);
  $('pause').textContent = pauses ? 'Go on' : 'Pause';
  post('pause', {on: pauses});
};

function report(box, ...lines) {
  box.replaceChildren(...lines.map((line) => element('p', {}, line)));
  box.hidden = false;
}

$('set').onclick = async () => {
  try {
    const {notes} = await (await post('set', {factors: factors()})).json();
    neutralize();
    await loadLights();
    for (const fader of desk.faders) {
      if (!fader.lights.hidden) showLights(fader.lights, fader.statements);
    }
    if (notes.length > 0) {
      report($('kept'), ...notes);
    } else {
      $('kept').hidden = true;
    }
  } catch (error) {
    report($('kept'), error.message);
  }
};

$('keep').onclick = async () => {
  $('keep').disabled = true;
  try {
    const kept = await (await post('keep', {factors: factors()})).json();
    report($('kept'), `The scene: ${kept.scenes.at(-1)}`, ...kept.scenes.slice(0, -1).map((file) => `included by it: ${file}`),
      `The picture: ${kept.picture}`, ...kept.notes);
  } catch (error) {
    report($('kept'), error.message);
  }
  $('keep').disabled = false;
};

const percent = (v) => `${v < 1 ? (100 * v).toPrecision(2) : Math.round(100 * v)} %`;
const duration = (s) => (s < 60 ? `${s.toFixed(1)} s` : `${Math.floor(s / 60)} min ${Math.round(s % 60)} s`);

async function watch() {
  for (;;) {
    try {
      const state = await (await fetch('state')).json();
      // Of few samples only a bound is known: that of bright ones which may not have come yet.
      const isKnown = state.error !== null && state.error < 10;
      const error = isKnown ? `error ${percent(state.error)}` : 'error not known yet';
      const how = state.isPaused ? ' · paused' : state.isDone ? ' · done' : '';
      $('progress').textContent = state.samplesPerPixel ? `${state.samplesPerPixel} spp · ${duration(state.seconds)} · ${error}${how}` : 'first samples …';
      $('failure').hidden = !state.failure;
      $('failure').textContent = state.failure;
      if (state.picture !== desk.picture) showPicture();
    } catch {
      $('progress').textContent = 'the desk has ended';
    }
    await new Promise((resolve) => setTimeout(resolve, 200));
  }
}

async function start() {
  const lights = await loadLights();
  $('scene').textContent = lights.scene;
  document.title = `${lights.scene} · lampyr desk`;
  Object.assign(desk, {width: lights.width, height: lights.height, faders: lights.faders});
  canvas.width = lights.width;
  canvas.height = lights.height;
  $('faders').replaceChildren(...desk.faders.map(makeFader));
  const filters = desk.statements.filter((statement) => statement.kind === 'filter');
  $('filters').hidden = filters.length === 0;
  $('filter-list').replaceChildren(...filters.map(makeFilter));
  showExposure();
  refreshSilence();
  applyZoom();
  document.body.dataset.ready = 'yes';
  watch();
}
start();
