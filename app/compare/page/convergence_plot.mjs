// One convergence plot: error against time or samples, a curve with its intervals for each integrator.
import * as Plot from '@observablehq/plot';
import {
  formatBudget, formatInterval, formatNumber, formatSeconds, isNumber,
} from './numbers.mjs';
import {budgetTicks, logDomain, logTicks, spread, tickTexts} from './plot_scales.mjs';
import {budgetsOf, kMetrics, metricName, positive, seriesColor, seriesSymbol, snapshotsOf} from './results.mjs';

const kMargin = {top: 34, bottom: 44, left: 58};

// A plot shows the runs that were given its kind of budget, and where there are none all others by what they took.
function rowsOf(results, axis, metric) {
  let kind = axis;
  if (snapshotsOf(results, kind).length === 0) kind = axis === 'time' ? 'samples' : 'time';
  const rows = snapshotsOf(results, kind).map(({integrator, index, snapshot}) => ({
    integrator, index, snapshot, name: integrator.name,
    x: axis === 'time' ? snapshot.seconds : snapshot.samplesPerPixel,
    interval: metric === 'flip' ? snapshot.flip : positive(snapshot[metric]),
  })).filter(({x}) => isNumber(x) && x > 0);
  return {kind, rows: rows.sort((a, b) => a.x - b.x)};
}

// Without an upper bound, as after a single repeat, there is no interval to draw.
function bounds({value, low, high}) {
  return isNumber(low) && isNumber(high) ? [low, high] : [value, value];
}

function errorDomain(rows, metric, noise) {
  const resolved = rows.filter(({interval}) => interval);
  if (metric === 'flip') {
    return [0, 1.08 * Math.max(1e-3, ...resolved.map(({interval}) => bounds(interval)[1]))];
  }
  const values = resolved.flatMap(({interval}) => [interval.value, ...bounds(interval)]).filter((value) => value > 0);
  const hasUnresolved = resolved.length < rows.length;
  if (values.length === 0) values.push(noise ?? 1);
  // The reference's noise belongs into the picture unless that would squeeze what was measured.
  const fewDecades = noise !== null && Math.min(...values) / noise < 30;
  if (noise !== null && (fewDecades || hasUnresolved)) values.push(noise);
  return logDomain(values, 10);
}

function rowName({name, snapshot}) {
  return `${name}, ${formatBudget(snapshot.kind, snapshot.budget)}`;
}

function tipText(row) {
  const {snapshot} = row;
  const lines = [rowName(row)];
  for (const {key, name: metric} of kMetrics) {
    const error = snapshot[key] ? formatInterval(snapshot[key]) : 'not told apart from the reference’s noise';
    lines.push(`${metric}  ${error}`);
  }
  lines.push(`${formatSeconds(snapshot.seconds)}, ${formatNumber(snapshot.samplesPerPixel)} samples per pixel`);
  lines.push(`${formatNumber(snapshot.samplesPerSecond)} samples/s`);
  if (snapshot.relEfficiency) lines.push(`efficiency  ${formatInterval(snapshot.relEfficiency)} (relMSE)`);
  return lines.join('\n');
}

// On a line of slope −1 the product of work and error is the same everywhere. This chooses the one that keeps away from
// the points: in the widest gap between curves, or beside them all.
function guideProduct(rows) {
  const logs = rows.map(({x, interval}) => Math.log10(x) + Math.log10(interval.value)).sort((a, b) => a - b);
  let [gap, middle] = [0, 0];
  for (let i = 1; i < logs.length; i++) {
    if (logs[i] - logs[i - 1] <= gap) continue;
    gap = logs[i] - logs[i - 1];
    middle = (logs[i] + logs[i - 1]) / 2;
  }
  return 10 ** (gap > 0.5 ? middle : logs[0] - 0.3);
}

// The line along which ten times the work gives a tenth of the error.
function guideMarks(rows, xDomain, yDomain, geometry) {
  const resolved = rows.filter(({interval}) => interval);
  if (resolved.length === 0) return [];
  const product = guideProduct(resolved);
  const ends = xDomain.map((x) => ({x, y: product / x}));
  // The label follows the line, from where this enters the frame.
  const {plotWidth, plotHeight} = geometry;
  const perDecade = [plotWidth / Math.log10(xDomain[1] / xDomain[0]), plotHeight / Math.log10(yDomain[1] / yDomain[0])];
  const angle = Math.atan2(perDecade[1], perDecade[0]) * 180 / Math.PI;
  const startX = Math.max(xDomain[0], product / yDomain[1]);
  const x = startX * 10 ** (30 * Math.cos(angle * Math.PI / 180) / perDecade[0]);
  return [
    Plot.line(ends, {x: 'x', y: 'y', clip: true, stroke: 'var(--guide)', strokeWidth: 1.25, className: 'guide'}),
    Plot.text([{x, y: product / x}], {x: 'x', y: 'y', text: () => 'slope −1', rotate: angle, textAnchor: 'start',
      lineAnchor: 'bottom', dy: -4, fill: 'var(--muted)', className: 'guide-label', clip: true}),
  ];
}

function noiseMarks(noise, yDomain, name) {
  if (noise === null || noise < yDomain[0] || noise > yDomain[1]) return [];
  return [
    Plot.ruleY([noise], {stroke: 'var(--muted)', strokeDasharray: '5 4', className: 'noise'}),
    Plot.text([noise], {y: (value) => value, frameAnchor: 'left', text: () => `${name} of the reference’s own noise`,
      textAnchor: 'start', lineAnchor: 'bottom', dx: 4, dy: -7, fill: 'var(--muted)', className: 'noise-label'}),
  ];
}

function seriesMarks(series, yDomain, atBottom) {
  const {name, index, rows} = series;
  const resolved = rows.filter(({interval}) => interval);
  const open = rows.filter(({interval}) => !interval);
  const color = seriesColor(index);
  const low = ({interval}) => Math.max(yDomain[0], bounds(interval)[0]);
  const high = ({interval}) => bounds(interval)[1];
  const className = (part) => `${part} series-${index}`;
  return [
    Plot.areaY(resolved, {x: 'x', y1: low, y2: high, fill: color, fillOpacity: 0.1, className: className('band')}),
    Plot.line(resolved, {x: 'x', y: ({interval}) => interval.value, stroke: color, strokeWidth: 1.75,
      ariaLabel: () => name, className: className('curve')}),
    Plot.ruleX(resolved, {x: 'x', y1: low, y2: high, stroke: color, strokeWidth: 1.5,
      className: className('intervals')}),
    Plot.dot(resolved, {x: 'x', y: ({interval}) => interval.value, symbol: seriesSymbol(index), fill: color, r: 4.5,
      stroke: 'var(--paper)', strokeWidth: 1.25, ariaLabel: (row) => `${rowName(row)}: ${formatInterval(row.interval)}`,
      className: className('points')}),
    Plot.dot(open, {x: 'x', y: () => atBottom, symbol: seriesSymbol(index), fill: 'var(--paper)', stroke: color, r: 4,
      strokeWidth: 1.5, ariaLabel: (row) => `${rowName(row)}: not told apart from the reference’s noise`,
      className: className('unresolved')}),
    Plot.text(open, {x: 'x', y: () => atBottom, text: () => '↓', dy: 11, fill: color, className: 'unresolved-arrow'}),
  ];
}

function endLabels(seriesList, yOf, atBottom, toPixel, fromPixel, geometry) {
  const ends = seriesList.map((series) => series.rows[series.rows.length - 1]);
  const wishes = ends.map((row) => toPixel(row.interval ? yOf(row) : atBottom));
  const placed = spread(wishes, 15, kMargin.top + 4, geometry.height - kMargin.bottom - 4);
  return ends.map((row, i) => Plot.text([row], {x: 'x', y: () => fromPixel(placed[i]), text: 'name', dx: 11,
    textAnchor: 'start', fill: seriesColor(row.index), fontWeight: 600, className: 'end-label'}));
}

export function convergencePlot(results, {axis, metric, width}) {
  const {kind, rows} = rowsOf(results, axis, metric);
  if (rows.length === 0) return null;
  const isLog = metric !== 'flip';
  const name = metricName(metric);
  const noise = positive({value: results.reference[metric]})?.value ?? null;
  const longestName = Math.max(...results.integrators.map((integrator) => integrator.name.length));
  const marginRight = Math.min(110, 22 + 7.5 * longestName);
  const height = Math.round(Math.min(430, Math.max(320, 0.78 * width)));
  const geometry = {width, height, plotWidth: width - kMargin.left - marginRight,
    plotHeight: height - kMargin.top - kMargin.bottom};
  const xDomain = logDomain(rows.map(({x}) => x), 3);
  const yDomain = errorDomain(rows, metric, noise);
  const yTicks = isLog ? logTicks(yDomain, 9) : 6;
  const ownBudgets = kind === axis ? budgetTicks(budgetsOf(results, kind), kind, xDomain, geometry.plotWidth) : null;
  const xTicks = ownBudgets ?? logTicks(xDomain, Math.floor(geometry.plotWidth / 45));
  const xText = ownBudgets ? (tick) => formatBudget(kind, tick) : tickTexts(xTicks);

  const position = isLog ? Math.log10 : (value) => value;
  const [bottom, top] = yDomain.map(position);
  const toPixel = (value) => kMargin.top + geometry.plotHeight * (top - position(value)) / (top - bottom);
  const fromPixel = (pixel) => {
    const at = top - (pixel - kMargin.top) / geometry.plotHeight * (top - bottom);
    return isLog ? 10 ** at : at;
  };
  // What was not resolved stands on the line of the noise, or without one just above the axis.
  const aboveAxis = fromPixel(height - kMargin.bottom - 24);
  const atBottom = isLog && noise !== null ? Math.max(noise, yDomain[0]) : aboveAxis;
  const seriesList = results.integrators
    .map((integrator, index) => ({name: integrator.name, index, rows: rows.filter((row) => row.index === index)}))
    .filter((series) => series.rows.length > 0);
  const yOf = (row) => row.interval ? row.interval.value : atBottom;
  const against = axis === 'time' ? 'render time' : 'samples per pixel';
  const unit = ownBudgets ? '' : axis === 'time' ? ' (s)' : '';
  const plot = Plot.plot({
    width, height, marginTop: kMargin.top, marginBottom: kMargin.bottom, marginLeft: kMargin.left, marginRight,
    className: 'convergence-plot',
    ariaLabel: `${name} against ${against}`,
    ariaDescription: 'The table of all snapshots holds the same numbers.',
    style: {fontFamily: 'inherit', fontSize: '12px', color: 'var(--muted)', background: 'none', overflow: 'visible'},
    x: {type: 'log', domain: xDomain},
    y: {type: isLog ? 'log' : 'linear', domain: yDomain},
    marks: [
      Plot.gridY({ticks: yTicks, stroke: 'var(--grid)', strokeOpacity: 1}),
      Plot.gridX({ticks: xTicks, stroke: 'var(--grid)', strokeOpacity: 1}),
      // As texts: of formats, a logarithmic axis leaves some ticks out.
      Plot.axisY({ticks: yTicks, text: isLog ? tickTexts(yTicks) : formatNumber, tickSize: 0, tickPadding: 8,
        label: name, labelAnchor: 'top', labelArrow: 'none', className: 'axis-y'}),
      Plot.axisX({ticks: xTicks, text: xText, tickSize: 4, tickPadding: 6, label: `${against}${unit}`,
        labelAnchor: 'center', labelArrow: 'none', labelOffset: 40, className: 'axis-x'}),
      ...(isLog ? guideMarks(rows, xDomain, yDomain, geometry) : []),
      ...(isLog ? noiseMarks(noise, yDomain, name) : []),
      ...endLabels(seriesList, yOf, atBottom, toPixel, fromPixel, geometry),
      ...seriesList.flatMap((series) => seriesMarks(series, yDomain, atBottom)),
      Plot.tip(rows, Plot.pointer({x: 'x', y: yOf, title: tipText, maxRadius: 48, fill: 'var(--paper)',
        stroke: 'var(--rule)', pathFilter: 'none', lineHeight: 1.35, textPadding: 10, lineWidth: 40})),
    ],
  });
  plot.setAttribute('role', 'img');
  return plot;
}
