// The tables: every snapshot, time to an error, ratios, what does not converge, pilots.
import {legendSymbol} from './convergence.mjs';
import {element} from './dom.mjs';
import {
  formatBudget, formatInterval, formatNumber, formatPercent, formatPercentInterval, formatSeconds, isNumber,
} from './numbers.mjs';
import {furthestOf, ratioFigure} from './ratio_figure.mjs';
import {budgetsOf, includesOne, kMetrics, metricName, snapshotAt} from './results.mjs';

const kUnresolved = 'not resolved';

// A table in a region that scrolls by itself, so that the page does not.
function table(id, title, columns, bodies, note) {
  const head = element('tr', {}, columns.map(({text, number}) =>
    element('th', {scope: 'col', class: number ? 'number' : null}, text)));
  return element('div', {class: 'table', id},
    element('h3', {id: `${id}-title`}, title),
    element('div', {class: 'scroll', tabindex: 0, role: 'region', 'aria-labelledby': `${id}-title`},
      element('table', {}, element('thead', {}, head), bodies)),
    note ? element('p', {class: 'caption'}, note) : null);
}

function numberCell(text, ...more) {
  return element('td', {class: 'number'}, text, ...more);
}

function integratorCell(results, name) {
  const index = results.integrators.findIndex((integrator) => integrator.name === name);
  return element('th', {scope: 'row', class: 'name'}, index >= 0 ? legendSymbol(index) : null, name);
}

function errorCell(interval) {
  return interval ? numberCell(formatInterval(interval)) : element('td', {class: 'number unresolved'}, kUnresolved);
}

function snapshotTable(results, kind) {
  const budgets = budgetsOf(results, kind);
  if (budgets.length === 0) return null;
  const columns = [{text: kind === 'time' ? 'Time' : 'Samples'}, {text: 'Integrator'},
    ...kMetrics.map(({name}) => ({text: name, number: true})), {text: 'Efficiency (relMSE)', number: true},
    {text: 'Efficiency (MSE)', number: true}, {text: 'Seconds', number: true}, {text: 'Spp', number: true},
    {text: 'Samples/s', number: true}];
  const bodies = budgets.map((budget) => {
    const rows = results.integrators.map((integrator) => ({integrator, snapshot: snapshotAt(integrator, kind, budget)}))
      .filter(({snapshot}) => snapshot !== null);
    return element('tbody', {}, rows.map(({integrator, snapshot}, i) => element('tr', {},
      i === 0 ? element('th', {scope: 'rowgroup', rowspan: rows.length, class: 'budget'}, formatBudget(kind, budget)) : null,
      integratorCell(results, integrator.name),
      kMetrics.map(({key}) => errorCell(snapshot[key])),
      errorCell(snapshot.relEfficiency), errorCell(snapshot.efficiency),
      numberCell(formatNumber(snapshot.seconds)), numberCell(formatNumber(snapshot.samplesPerPixel)),
      numberCell(formatNumber(snapshot.samplesPerSecond)))));
  });
  const someOpen = results.integrators.some(({snapshots}) => snapshots.some((snapshot) => !snapshot.relMse || !snapshot.mse));
  return table(`snapshots-${kind}`, kind === 'time' ? 'Snapshots at equal time' : 'Snapshots at equal samples', columns, bodies,
    someOpen ? `“${kUnresolved}”: the error could not be told apart from the reference’s own noise.` : null);
}

// Why an integrator does not get to an error.
function neverText(integrator) {
  const {systematic} = integrator;
  if (systematic?.significant && systematic.value > 0) {
    return `never: ${formatPercent(Math.sqrt(systematic.value))} remains with any number of samples`;
  }
  return 'never: its error did not fall with the time it was given';
}

function timeCell(integrator, entry) {
  if (!entry) return numberCell('–');
  if (entry.kind === 'never') return element('td', {class: 'number never'}, neverText(integrator));
  const range = isNumber(entry.low) && isNumber(entry.high)
    ? ` (${formatSeconds(entry.low)} to ${formatSeconds(entry.high)})` : '';
  return numberCell(`${entry.kind === 'extrapolated' ? '~ ' : ''}${formatSeconds(entry.seconds)}${range}`);
}

function timeToErrorTable(results) {
  const errors = [...new Set(results.integrators.flatMap(({timeToError}) => timeToError.map(({error}) => error)))]
    .sort((a, b) => b - a);
  if (errors.length === 0) return null;
  const rows = results.integrators.map((integrator) => element('tr', {}, integratorCell(results, integrator.name),
    errors.map((error) => timeCell(integrator, integrator.timeToError.find((entry) => entry.error === error)))));
  const kinds = results.integrators.flatMap(({timeToError}) => timeToError.map(({kind}) => kind));
  return table('time-to-error', 'Time to an error',
    [{text: 'Integrator'}, ...errors.map((error) => ({text: `to ${formatPercent(error)}`, number: true}))],
    element('tbody', {}, rows),
    'The relative error is the square root of relMSE.' + (kinds.includes('extrapolated')
      ? ' ~ marks times beyond what was rendered, extrapolated along the fitted curve.' : ''));
}

function ratioTable(results) {
  const ratios = results.ratios.filter(({value}) => isNumber(value) && value > 0);
  if (ratios.length === 0) return null;
  const furthest = furthestOf(ratios);
  const byBudget = new Map();
  for (const ratio of ratios) {
    const key = `${ratio.kind} ${ratio.budget}`;
    byBudget.set(key, [...(byBudget.get(key) ?? []), ratio]);
  }
  const bodies = [...byBudget.values()].map((group) => element('tbody', {}, group.map((ratio, i) => element('tr', {},
    i === 0 ? element('th', {scope: 'rowgroup', rowspan: group.length, class: 'budget'},
      formatBudget(ratio.kind, ratio.budget)) : null,
    integratorCell(results, ratio.integrator), element('td', {}, ratio.against), element('td', {}, metricName(ratio.metric)),
    numberCell(formatInterval(ratio, ' ×')), element('td', {class: 'figure'}, ratioFigure(ratio, furthest)),
    element('td', {}, includesOne(ratio) ? 'no difference shown' : '')))));
  return table('ratios', 'Efficiency of one over another', [{text: 'Budget'}, {text: 'Integrator'}, {text: 'Against'},
    {text: 'Metric'}, {text: 'Ratio', number: true}, {text: '⟵ worse · 1 · better ⟶'}, {text: ''}], bodies);
}

function systematicTable(results) {
  const verdict = (part) => part?.significant ? element('td', {class: 'significant'}, '▲ yes') : element('td', {}, 'not shown');
  const rows = results.integrators.map(({name, bias, systematic}) => element('tr', {}, integratorCell(results, name),
    numberCell(formatPercentInterval(bias)), verdict(bias), numberCell(formatInterval(systematic)), verdict(systematic)));
  return table('systematic', 'What more samples do not remove', [{text: 'Integrator'},
    {text: 'Mean against the reference', number: true}, {text: 'Significant'}, {text: 'Systematic relMSE', number: true},
    {text: 'Significant'}], element('tbody', {}, rows));
}

function pilotTable(results) {
  if (!results.pilots?.length) return null;
  const rows = results.pilots.map(({integrator, seconds, samplesPerPixel, mean, relMse, chosen, note}) => element('tr', {},
    integratorCell(results, integrator), numberCell(formatSeconds(seconds)), numberCell(formatNumber(samplesPerPixel)),
    numberCell(formatNumber(mean)), numberCell(formatNumber(relMse)),
    element('td', {}, [chosen ? 'chosen' : '', note ?? ''].filter(Boolean).join('; '))));
  return table('pilots', 'Pilots: which integrator makes the reference', [{text: 'Integrator'},
    {text: 'Time', number: true}, {text: 'Spp', number: true}, {text: 'Mean', number: true}, {text: 'relMSE', number: true},
    {text: 'Outcome'}], element('tbody', {}, rows));
}

export function showTables(section, results) {
  for (const part of [snapshotTable(results, 'time'), snapshotTable(results, 'samples'), timeToErrorTable(results),
    ratioTable(results), systematicTable(results), pilotTable(results)]) {
    if (part) section.append(part);
  }
}
