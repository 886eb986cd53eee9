// Fills the page's template with made-up results, to work on the page without rendering:
//   node sample.mjs TEMPLATE.html OUT.html [usual|single|extreme|large|sparse|once]
//
// usual has three integrators, budgets of time and samples, one integrator with a bias and one with rows that were
// not resolved; single has one integrator and one budget; extreme has values at the ends of what may come, and
// hostile names; large has pictures wider than the page; sparse lacks everything that may be lacking; once has a single
// repeat, and so no intervals.
import {readFileSync, writeFileSync} from 'node:fs';
import {makeRandom, samplePictures} from './sample_pictures.mjs';

const kScale = {lowest: 0.001, highest: 10};

const kUsual = {
  width: 512, height: 288, times: [1, 4, 16], samples: [4, 16, 64], noise: 2.4e-5, unit: 1, scene: 'scenes/lamp.pbrt',
  integrators: [
    {name: 'path', relMse: 0.21, speed: 9, floor: 0.018, gain: 0.91,
      hints: ['no path from the camera can hit the point lights behind the glass; bdpt finds their caustics']},
    {name: 'bdpt', relMse: 0.03, speed: 4, floor: 0, gain: 1, hints: []},
    {name: 'vcm', relMse: 0.0016, speed: 2.5, floor: 0, gain: 1, hints: []},
  ],
};

const kVariants = {
  usual: kUsual,
  single: {...kUsual, times: [16], samples: [], integrators: kUsual.integrators.slice(1, 2)},
  extreme: {...kUsual, unit: 1e27, scene: 'scenes/</script><b>a very long name of a scene</b>/lamp & co.pbrt',
    integrators: [...kUsual.integrators,
      {name: 'path-nothing', relMse: 1e-31, speed: 1e-9, floor: 0, gain: 1, hints: []}]},
  sparse: {...kUsual, times: []},
  once: {...kUsual, samples: []},
  large: {...kUsual, width: 1920, height: 1080, times: [4, 16], samples: []},
};

function interval(value, share) {
  return {value, low: value / (1 + share), high: value * (1 + share)};
}

function snapshotOf(variant, integrator, kind, budget, random, pictures) {
  const seconds = kind === 'time' ? budget * (1 + 0.02 * random()) : budget / integrator.speed;
  const samplesPerPixel = kind === 'samples' ? budget : budget * integrator.speed;
  // The error at 1 s, falling with the samples down to the floor.
  const relMse = integrator.relMse / (samplesPerPixel / integrator.speed) * (0.9 + 0.2 * random()) + integrator.floor;
  const isResolved = relMse > 5 * variant.noise;
  const share = 0.08 + 0.15 * random();
  const key = `${integrator.name}-${kind === 'time' ? `${budget}s` : `${budget}spp`}`;
  const made = samplePictures({width: variant.width, height: variant.height, scale: kScale, gain: integrator.gain,
    noise: Math.sqrt(relMse), seed: Math.floor(2 ** 32 * random())});
  pictures[key] = made.picture;
  pictures[`error-${key}`] = made.errorPicture;
  return {kind, budget, seconds, samplesPerPixel,
    samplesPerSecond: samplesPerPixel * variant.width * variant.height / seconds,
    mse: isResolved ? interval(0.12 * relMse * variant.unit, share) : null,
    relMse: isResolved ? interval(relMse, share) : null,
    flip: interval(Math.min(0.9, 0.3 * relMse ** 0.35), 0.04 + 0.05 * random()),
    efficiency: isResolved ? interval(1 / (0.12 * relMse * variant.unit * seconds), share) : null,
    relEfficiency: isResolved ? interval(1 / (relMse * seconds), share) : null,
    noise: rootOf(interval(relMse - integrator.floor, share)),
    bias: {...rootOf(interval(integrator.floor || 1e-6, share)), significant: integrator.floor > 0},
    picture: key, errorPicture: `error-${key}`};
}

function rootOf({value, low, high}) {
  return {value: Math.sqrt(value), low: Math.sqrt(low), high: Math.sqrt(high)};
}

// Noise that is level, and a bias at low frequencies.
function spectrumOf({relMse, floor}, width) {
  const rings = [{frequency: 0, share: 1e-6, density: relMse, low: 0, high: 2 * relMse, deviation: relMse, common: 0}];
  for (let frequency = 1 / width; frequency < 0.7; frequency *= 1.2) {
    const common = 50 * floor * Math.exp(-((frequency / 0.05) ** 2));
    const density = 0.1 * relMse + common;
    rings.push({frequency, share: density * frequency ** 2, density, low: 0.8 * density, high: 1.25 * density,
      deviation: 0.2 * density, common});
  }
  return rings;
}

function timeToError({relMse, floor}, longest) {
  return [0.1, 0.05, 0.01].map((error) => {
    if (error ** 2 <= floor) return {error, seconds: null, low: null, high: null, kind: 'never'};
    const seconds = relMse / (error ** 2 - floor);
    const kind = seconds > longest ? 'extrapolated' : 'measured';
    return {error, seconds, low: 0.85 * seconds, high: 1.2 * seconds, kind};
  });
}

function ratiosOf(integrators) {
  const ratios = [];
  for (const [i, against] of integrators.entries()) {
    for (const integrator of integrators.slice(i + 1)) {
      for (const {kind, budget, relEfficiency, efficiency} of integrator.snapshots) {
        const other = against.snapshots.find((snapshot) => snapshot.kind === kind && snapshot.budget === budget);
        const pairs = [['relMse', relEfficiency, other.relEfficiency], ['mse', efficiency, other.efficiency]];
        for (const [metric, a, b] of pairs) {
          if (a && b) ratios.push({integrator: integrator.name, against: against.name, kind, budget, metric,
            ...interval(a.value / b.value, 0.2)});
        }
      }
    }
  }
  return ratios;
}

function makeSample(variant) {
  const random = makeRandom(7);
  const pictures = {reference: samplePictures({width: variant.width, height: variant.height, noise: 0, gain: 1, seed: 1,
    scale: kScale}).picture};
  const longest = Math.max(...variant.times, 0);
  const integrators = variant.integrators.map((integrator) => {
    const bias = integrator.gain - 1;
    return {name: integrator.name, hints: integrator.hints, blurs: integrator.name === 'vcm',
      spectrum: spectrumOf(integrator, variant.width),
      meanBias: {value: bias + 0.0004, low: bias - 0.002, high: bias + 0.0021, significant: bias < -0.003},
      systematic: {value: integrator.floor || 1e-5, low: integrator.floor ? 0.9 * integrator.floor : -1e-5,
        high: integrator.floor ? 1.1 * integrator.floor : 3e-5, significant: integrator.floor > 0},
      timeToError: timeToError(integrator, longest),
      snapshots: [...variant.times.map((budget) => snapshotOf(variant, integrator, 'time', budget, random, pictures)),
        ...variant.samples.map((budget) => snapshotOf(variant, integrator, 'samples', budget, random, pictures))]};
  });
  const names = integrators.map(({name}) => name);
  const budgets = variant.times.length > 0 ? ` --budget ${variant.times.map((time) => `${time}s`)}` : '';
  const samples = variant.samples.length > 0 ? ` --spp ${variant.samples}` : '';
  return {pictures, results: {
    lampyr: '0.1.0', scene: variant.scene, sceneHash: 'ab12c94e07d3f561', width: variant.width, height: variant.height,
    maxDepth: 10, threads: 2, repeats: 5, confidence: 0.95,
    command: `lampyr compare ${variant.scene} --integrators ${names}${budgets}${samples} -o out`,
    reference: {origin: 'made', file: 'reference.exr', integrator: 'bdpt', samplesPerPixel: 4096, seconds: 805.2,
      mean: 0.31, relativeError: 0.0021, mse: 0.12 * variant.noise * variant.unit, relMse: variant.noise,
      bias: 0.0031, biasIsLimit: true, radius: 0.25},
    pilots: [
      {integrator: 'path', seconds: 2, samplesPerPixel: 40, mean: 0.3, relMse: 0.01, bias: 0, chosen: false,
        note: 'finds less light than bdpt: 94.1 % ± 0.4 %'},
      {integrator: 'bdpt', seconds: 2.04, samplesPerPixel: 18, mean: 0.319, relMse: 0.0042, bias: 0.021, chosen: true, note: ''},
    ],
    errorScale: kScale, integrators, ratios: ratiosOf(integrators),
  }};
}

// Nothing resolved, a given reference of which nothing is known, no pictures, no pilots, no ratios.
function strip({results}) {
  for (const integrator of results.integrators) {
    integrator.spectrum = [];
    integrator.meanBias = {...integrator.meanBias, low: null, high: null, significant: false};
    integrator.systematic = {value: null, low: null, high: null, significant: false};
    integrator.timeToError = integrator.timeToError.map(({error}) =>
      ({error, seconds: null, low: null, high: null, kind: 'unresolved'}));
    integrator.snapshots = integrator.snapshots.map((snapshot) => ({...snapshot, mse: null, relMse: null, flip: null,
      efficiency: null, relEfficiency: null, noise: null, bias: null, picture: null, errorPicture: null}));
  }
  const reference = {origin: 'given', file: 'kept/lamp.exr', integrator: null, samplesPerPixel: null, seconds: null,
    mean: 0.31, relativeError: null, mse: null, relMse: null, bias: null, biasIsLimit: false, radius: null};
  return {results: {...results, reference, pilots: [], ratios: []}, pictures: {}};
}

// A single repeat: intervals from 0 to infinity, which JSON does not have.
function withoutIntervals({results, pictures}) {
  const open = (value) => ({...value, low: 0, high: null});
  for (const integrator of results.integrators) {
    integrator.timeToError = integrator.timeToError.map((time) => time.kind === 'never' ? time : open(time));
    for (const snapshot of integrator.snapshots) {
      snapshot.bias = {...snapshot.bias, low: 0, high: null, significant: false};
      for (const key of ['noise', 'mse', 'relMse', 'flip', 'efficiency', 'relEfficiency']) {
        snapshot[key] &&= open(snapshot[key]);
      }
    }
  }
  return {results: {...results, repeats: 1, ratios: results.ratios.map(open)}, pictures};
}

function embed(value) {
  return JSON.stringify(value).replaceAll('<', '\\u003c');
}

function fill(template, placeholder, content) {
  const parts = template.split(placeholder);
  if (parts.length !== 2) throw new Error(`the template must hold ${placeholder} exactly once`);
  return parts.join(content);
}

const [templateFile, outFile, variantName = 'usual'] = process.argv.slice(2);
if (!outFile || !kVariants[variantName]) {
  throw new Error(`usage: node sample.mjs TEMPLATE.html OUT.html [${Object.keys(kVariants).join('|')}]`);
}
const sample = makeSample(kVariants[variantName]);
const change = {sparse: strip, once: withoutIntervals}[variantName] ?? ((unchanged) => unchanged);
const {results, pictures} = change(sample);
let page = fill(readFileSync(templateFile, 'utf8'), '/*LAMPYR-RESULTS*/', embed(results));
page = fill(page, '/*LAMPYR-PICTURES*/', embed(pictures));
writeFileSync(outFile, page);
