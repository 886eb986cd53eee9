// The results that lampyr compare put into the page, and the questions that several parts of the page ask of them.
import {formatBudget, isNumber} from './numbers.mjs';

export const kMetrics = [
  {key: 'relMse', name: 'relMSE', efficiency: 'relEfficiency'},
  {key: 'mse', name: 'MSE', efficiency: 'efficiency'},
  {key: 'flip', name: 'FLIP', efficiency: null},
];

export function metricName(key) {
  return kMetrics.find((metric) => metric.key === key)?.name ?? key;
}

export function readEmbedded(id) {
  return JSON.parse(document.getElementById(id).textContent);
}

// A colour and a shape for each integrator, so that neither has to be told from the other alone. A ninth integrator
// begins again with the first.
export const kSymbols = ['circle', 'square', 'triangle', 'diamond', 'star', 'cross', 'wye', 'hexagon'];

export function seriesColor(index) {
  return `var(--series-${index % kSymbols.length})`;
}

export function seriesSymbol(index) {
  return kSymbols[index % kSymbols.length];
}

// An {value, low, high} that a logarithmic axis can show, or null.
export function positive(interval) {
  return interval && isNumber(interval.value) && interval.value > 0 ? interval : null;
}

export function snapshotsOf(results, kind) {
  return results.integrators.flatMap((integrator, index) => integrator.snapshots
    .filter((snapshot) => kind === undefined || snapshot.kind === kind)
    .map((snapshot) => ({integrator, index, snapshot})));
}

export function budgetsOf(results, kind) {
  return [...new Set(snapshotsOf(results, kind).map(({snapshot}) => snapshot.budget))].sort((a, b) => a - b);
}

// The budget that says most about the integrators: the longest time, or without times the most samples.
export function mainBudget(results) {
  for (const kind of ['time', 'samples']) {
    const budgets = budgetsOf(results, kind);
    if (budgets.length > 0) return {kind, budget: budgets[budgets.length - 1]};
  }
  return null;
}

export function snapshotAt(integrator, kind, budget) {
  return integrator.snapshots.find((snapshot) => snapshot.kind === kind && snapshot.budget === budget) ?? null;
}

export function snapshotName(integrator, snapshot) {
  return `${integrator.name}, ${formatBudget(snapshot.kind, snapshot.budget)}`;
}

// The ratio of two integrators' efficiencies, turned round where the results hold only the other direction.
export function ratioOf(results, name, against, kind, budget, metric) {
  const matches = (ratio, a, b) => ratio.integrator === a && ratio.against === b && ratio.kind === kind &&
    ratio.budget === budget && ratio.metric === metric && isNumber(ratio.value);
  const forward = results.ratios.find((ratio) => matches(ratio, name, against));
  if (forward) return forward;
  const backward = results.ratios.find((ratio) => matches(ratio, against, name));
  if (!backward || !(backward.value > 0)) return null;
  const inverse = (value) => isNumber(value) && value > 0 ? 1 / value : null;
  return {...backward, integrator: name, against, value: inverse(backward.value),
    low: inverse(backward.high), high: inverse(backward.low)};
}

// What errors are not told apart from: a reference that merges photons has blur, too.
export function limitOf(results) {
  return results.reference.bias > 0 ? 'noise and blur' : 'noise';
}

export function includesOne(ratio) {
  return !isNumber(ratio.low) || !isNumber(ratio.high) || (ratio.low <= 1 && ratio.high >= 1);
}
