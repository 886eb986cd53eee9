// The tables: every snapshot, time to an error, ratios, what repeats have in common, pilots.
import {legendSymbol} from './convergence.mjs';
import {element} from './dom.mjs';
import {
  formatBudget, formatNumber, formatPercent, formatSeconds, inPercent, intervalParts, isNumber,
} from './numbers.mjs';
import {furthestOf, ratioFigure} from './ratio_figure.mjs';
import {budgetsOf, includesOne, kMetrics, limitOf, metricName, snapshotAt, snapshotsOf} from './results.mjs';

const kUnresolved = 'not resolved';

// A table in a region that scrolls by itself, so that the page does not.
function table(id, title, columns, bodies, note) {
  const head = element('tr', {}, columns.map(({text, number, figure}) =>
    element('th', {scope: 'col', class: number ? 'number' : figure ? 'figure' : null}, text)));
  return element('div', {class: 'table', id},
    element('h3', {id: `${id}-title`}, title),
    element('div', {class: 'scroll', tabindex: 0, role: 'region', 'aria-labelledby': `${id}-title`},
      element('table', {}, element('thead', {}, head), bodies)),
    note ? element('p', {class: 'caption'}, note) : null);
}

function numberCell(text, ...more) {
  return element('td', {class: 'number'}, text, ...more);
}

// The budget that the rows beside it share.
function budgetCell(kind, budget, rows) {
  return element('th', {scope: 'rowgroup', rowspan: rows, class: 'budget'}, formatBudget(kind, budget));
}

function integratorCell(results, name) {
  const index = results.integrators.findIndex((integrator) => integrator.name === name);
  return element('th', {scope: 'row', class: 'name'}, index >= 0 ? legendSymbol(index) : null, name);
}

// The interval steps back behind its value.
function intervalCell(interval, unit) {
  const {value, range, power} = intervalParts(interval, unit);
  return numberCell(value, element('span', {class: 'range'}, range), power);
}

function errorCell(interval) {
  return interval ? intervalCell(interval) : element('td', {class: 'number unresolved'}, kUnresolved);
}

function snapshotTable(results, kind) {
  const budgets = budgetsOf(results, kind);
  if (budgets.length === 0) return null;
  // What was given is the budget; the other of time and samples is what it came to.
  const outcome = kind === 'time' ? {text: 'Spp', of: ({samplesPerPixel}) => formatNumber(samplesPerPixel)}
    : {text: 'Time', of: ({seconds}) => formatSeconds(seconds)};
  const columns = [{text: kind === 'time' ? 'Time' : 'Samples'}, {text: 'Integrator'}, {...outcome, number: true},
    {text: 'Samples/s', number: true}, ...kMetrics.map(({name}) => ({text: name, number: true})),
    {text: '1/(relMSE · s)', number: true}, {text: '1/(MSE · s)', number: true}];
  const bodies = budgets.map((budget) => {
    const rows = results.integrators.map((integrator) => ({integrator, snapshot: snapshotAt(integrator, kind, budget)}))
      .filter(({snapshot}) => snapshot !== null);
    return element('tbody', {}, rows.map(({integrator, snapshot}, i) => element('tr', {},
      i === 0 ? budgetCell(kind, budget, rows.length) : null,
      integratorCell(results, integrator.name),
      numberCell(outcome.of(snapshot)), numberCell(formatNumber(snapshot.samplesPerSecond)),
      kMetrics.map(({key}) => errorCell(snapshot[key])),
      errorCell(snapshot.relEfficiency), errorCell(snapshot.efficiency))));
  });
  const someOpen = snapshotsOf(results, kind).some(({snapshot}) => kMetrics.some(({key}) => !snapshot[key]));
  const title = kind === 'time' ? 'All snapshots at equal time' : 'All snapshots at equal samples';
  // A pass is not cut short: a render may have taken longer than it was given.
  const late = kind !== 'time' ? [] : snapshotsOf(results, kind)
    .filter(({snapshot: {seconds, budget}}) => Math.abs(seconds / budget - 1) > 0.1)
    .map(({integrator, snapshot: {seconds, budget}}) =>
      `${integrator.name} took ${formatSeconds(seconds)} for ${formatSeconds(budget)}.`);
  const notes = [
    ...someOpen ? [`“${kUnresolved}”: the error could not be told apart from the reference’s own ${limitOf(results)}.`] : [],
    ...late.length > 0 ? [`Not all renders could be stopped in time: ${late.join(' ')}`] : [],
  ];
  return table(`snapshots-${kind}`, title, columns, bodies, notes.length > 0 ? notes.join(' ') : null);
}

function namesOfBlurring(results) {
  return results.integrators.filter(({blurs}) => blurs).map(({name}) => name);
}

// "bias", with the names of those that blur.
function biasHeading(results) {
  const blurring = namesOfBlurring(results);
  return blurring.length > 0 ? `Bias (with blur: ${blurring.join(', ')})` : 'Bias';
}

// An error that is not told from 0 is known by its upper bound.
function biasCell(bias) {
  if (!bias || !isNumber(bias.value)) return numberCell('–');
  if (bias.significant) return intervalCell(inPercent(bias), '\u00a0%');
  const bound = isNumber(bias.high) ? `, up to ${formatPercent(bias.high)}` : '';
  return element('td', {class: 'number unresolved'}, `not told from 0${bound}`);
}

// The relative error of every snapshot in its parts.
function partsTable(results) {
  if (!snapshotsOf(results).some(({snapshot}) => snapshot.noise || snapshot.bias)) return null;
  const bodies = ['time', 'samples'].flatMap((kind) => budgetsOf(results, kind).map((budget) => {
    const rows = results.integrators.map((integrator) => ({integrator, snapshot: snapshotAt(integrator, kind, budget)}))
      .filter(({snapshot}) => snapshot !== null);
    return element('tbody', {}, rows.map(({integrator, snapshot}, i) => element('tr', {},
      i === 0 ? budgetCell(kind, budget, rows.length) : null,
      integratorCell(results, integrator.name),
      snapshot.noise ? intervalCell(inPercent(snapshot.noise), '\u00a0%') : numberCell('–'),
      biasCell(snapshot.bias))));
  }));
  return table('parts', 'Noise and bias', [{text: 'Budget'}, {text: 'Integrator'}, {text: 'Noise', number: true},
    {text: biasHeading(results), number: true}], bodies,
  'Relative errors, whose squares add up to relMSE: noise differs between repeats, bias is common to all of them.');
}

// Why an integrator that does not blur does not get to an error.
function neverText(integrator) {
  const {systematic} = integrator;
  if (systematic?.significant && systematic.value > 0) {
    return `never: ${formatPercent(Math.sqrt(systematic.value))} remains`;
  }
  return 'never';
}

function timeCell(integrator, entry) {
  if (!entry) return numberCell('–');
  if (entry.kind === 'unresolved') return element('td', {class: 'number never'}, kUnresolved);
  if (entry.kind === 'never') return element('td', {class: 'number never'}, neverText(integrator));
  const range = isNumber(entry.low) && isNumber(entry.high)
    ? ` (${formatSeconds(entry.low)} to ${formatSeconds(entry.high)})` : '';
  return numberCell(`${entry.kind === 'extrapolated' ? '~ ' : ''}${formatSeconds(entry.seconds)}`,
    element('span', {class: 'range'}, range));
}

function timeToErrorTable(results) {
  const errors = [...new Set(results.integrators.flatMap(({timeToError}) => timeToError.map(({error}) => error)))]
    .sort((a, b) => b - a);
  if (errors.length === 0) return null;
  const rows = results.integrators.map((integrator) => element('tr', {}, integratorCell(results, integrator.name),
    errors.map((error) => timeCell(integrator, integrator.timeToError.find((entry) => entry.error === error)))));
  const kinds = results.integrators.flatMap(({timeToError}) => timeToError.map(({kind}) => kind));
  const notes = ['The relative error is the square root of relMSE.'];
  if (kinds.includes('extrapolated')) {
    const blurs = results.integrators.some((integrator) => integrator.blurs &&
      integrator.timeToError.some(({kind}) => kind === 'extrapolated'));
    notes.push('~ marks times outside what was rendered: relMSE is taken to fall as one over time' +
      `${blurs ? '; blur falls more slowly' : ''}.`);
  }
  if (kinds.includes('never')) {
    notes.push('“never”: a part of the error stays however many samples are taken.');
  }
  if (kinds.includes('unresolved')) {
    notes.push(`“${kUnresolved}”: the error was within the reference’s own ${limitOf(results)} from the beginning.`);
  }
  return table('time-to-error', 'Time to an error',
    [{text: 'Integrator'}, ...errors.map((error) => ({text: `to ${formatPercent(error)}`, number: true}))],
    element('tbody', {}, rows), notes.join(' '));
}

function ratioTable(results) {
  const ratios = results.ratios.filter(({value}) => isNumber(value) && value > 0);
  if (ratios.length === 0) return null;
  // One row for two integrators at one budget, with a column for each metric that efficiency is measured in.
  const metrics = kMetrics.map(({key}) => key).filter((key) => ratios.some(({metric}) => metric === key));
  const budgets = new Map();
  for (const ratio of ratios) {
    const rows = budgets.get(`${ratio.kind} ${ratio.budget}`) ?? new Map();
    const pair = JSON.stringify([ratio.integrator, ratio.against]);
    budgets.set(`${ratio.kind} ${ratio.budget}`, rows.set(pair, {...rows.get(pair), [ratio.metric]: ratio}));
  }
  const furthest = furthestOf(ratios);
  const metricCells = (ratio) => ratio
    ? [intervalCell(ratio, '\u00a0×'), element('td', {class: 'figure'}, ratioFigure(ratio, furthest),
      includesOne(ratio) ? element('span', {class: 'open-note'}, 'no difference shown') : null)]
    : [numberCell('–'), element('td')];
  const bodies = [...budgets.values()].map((rows) => element('tbody', {}, [...rows.values()].map((row, i) => {
    const {kind, budget, integrator, against} = Object.values(row)[0];
    return element('tr', {},
      i === 0 ? budgetCell(kind, budget, rows.size) : null,
      integratorCell(results, integrator), element('td', {}, against),
      metrics.map((metric) => metricCells(row[metric])));
  })));
  const columns = [{text: 'Budget'}, {text: 'Integrator'}, {text: 'Against'},
    ...metrics.flatMap((metric) => [{text: metricName(metric), number: true},
      {text: 'worse ← 1 → better', figure: true}])];
  return table('ratios', 'Efficiency of one over another', columns, bodies,
    'The lines are logarithmic, with a mark at 1. Hollow points: the interval includes 1 or is not known, no ' +
      'difference was shown.');
}

function systematicTable(results) {
  const verdict = (isShown) => isShown ? element('td', {class: 'significant'}, '▲ yes')
    : element('td', {}, 'not shown');
  const rows = results.integrators.map(({name, meanBias: bias, systematic}) => element('tr', {}, integratorCell(results, name),
    intervalCell(inPercent(bias), '\u00a0%'), verdict(bias?.significant), intervalCell(systematic),
    verdict(systematic?.significant && systematic.value > 0)));
  // Blur falls, if slowly; all else stays.
  const blurring = namesOfBlurring(results);
  const note = blurring.length === 0 ? 'It stays however many samples are taken.'
    : blurring.length === results.integrators.length ? 'What is blurred falls slowly with more samples.'
      : `What is blurred (by ${blurring.join(', ')}) falls slowly with more samples; all else stays.`;
  return table('systematic', 'What all repeats have in common', [{text: 'Integrator'},
    {text: 'Mean against the reference', number: true}, {text: 'Significant'},
    {text: 'Systematic relMSE', number: true}, {text: 'Significant'}], element('tbody', {}, rows), note);
}

function pilotTable(results) {
  if (!results.pilots?.length) return null;
  const rows = results.pilots.map((pilot) => element('tr', {}, integratorCell(results, pilot.integrator),
    numberCell(formatSeconds(pilot.seconds)), numberCell(formatNumber(pilot.samplesPerPixel)),
    numberCell(formatNumber(pilot.mean)), numberCell(formatNumber(pilot.relMse)),
    numberCell(formatPercent(pilot.bias)),
    element('td', {}, [pilot.chosen ? 'chosen' : '', pilot.note ?? ''].filter(Boolean).join('; '))));
  return table('pilots', 'Pilots: which integrator makes the reference', [{text: 'Integrator'},
    ...['Time', 'Spp', 'Mean', 'relMSE', 'Blur'].map((text) => ({text, number: true})), {text: 'Outcome'}],
  element('tbody', {}, rows));
}

export function showTables(section, results) {
  for (const part of [snapshotTable(results, 'time'), snapshotTable(results, 'samples'), partsTable(results), timeToErrorTable(results),
    ratioTable(results), systematicTable(results), pilotTable(results)]) {
    if (part) section.append(part);
  }
}
