// The error over spatial frequencies: a spectrum with its spread over the repeats for each integrator.
import * as Plot from '@observablehq/plot';
import {element} from './dom.mjs';
import {isNumber} from './numbers.mjs';
import {logDomain, logTicks, spread, tickTexts} from './plot_scales.mjs';
import {seriesColor} from './results.mjs';

const kMargin = {top: 34, bottom: 44, left: 58};

// What a logarithmic plot can show: not the mean of the picture, and no density that subtracting noise has left below 0.
function ringsOf({spectrum}) {
  return (spectrum ?? []).filter(({frequency, density}) => frequency > 0 && isNumber(density) && density > 0);
}

function seriesOf(results) {
  return results.integrators.map((integrator, index) => ({name: integrator.name, index, rings: ringsOf(integrator)}))
    .filter(({rings}) => rings.length > 0);
}

function seriesMarks({name, index, rings}, yDomain) {
  const color = seriesColor(index);
  const className = (part) => `${part} series-${index}`;
  return [
    Plot.areaY(rings, {x: 'frequency', y1: ({low}) => Math.max(yDomain[0], low), y2: 'high', fill: color,
      fillOpacity: 0.12, className: className('spectrum-band')}),
    Plot.line(rings, {x: 'frequency', y: 'density', stroke: color, strokeWidth: 1.75, ariaLabel: () => name,
      className: className('spectrum-curve')}),
    Plot.line(rings.filter(({common}) => common > yDomain[0]), {x: 'frequency', y: 'common', stroke: color,
      strokeWidth: 1, strokeDasharray: '2 3', className: className('spectrum-common')}),
  ];
}

export function spectrumPlot(results, width) {
  const seriesList = seriesOf(results);
  if (seriesList.length === 0) return null;
  const longestName = Math.max(...seriesList.map(({name}) => name.length));
  const marginRight = Math.min(110, 22 + 7.5 * longestName);
  const height = Math.round(Math.min(430, Math.max(320, 0.6 * width)));
  const plotHeight = height - kMargin.top - kMargin.bottom;
  const all = seriesList.flatMap(({rings}) => rings);
  const xDomain = logDomain(all.map(({frequency}) => frequency), 3);
  const yDomain = logDomain(all.flatMap(({density, high}) => [density, Math.max(density, high)]), 10);
  const xTicks = logTicks(xDomain, Math.floor((width - kMargin.left - marginRight) / 45));
  const yTicks = logTicks(yDomain, 9);
  const [bottom, top] = yDomain.map(Math.log10);
  const toPixel = (value) => kMargin.top + plotHeight * (top - Math.log10(value)) / (top - bottom);
  const fromPixel = (pixel) => 10 ** (top - (pixel - kMargin.top) / plotHeight * (top - bottom));
  const ends = seriesList.map(({rings}) => rings[rings.length - 1]);
  const placed = spread(ends.map(({density}) => toPixel(density)), 15, kMargin.top + 4, height - kMargin.bottom - 4);
  const labels = seriesList.map(({name, index}, i) => Plot.text([ends[i]], {x: 'frequency',
    y: () => fromPixel(placed[i]), text: () => name, dx: 11, textAnchor: 'start', fill: seriesColor(index),
    fontWeight: 600, className: 'end-label'}));
  const plot = Plot.plot({
    width, height, marginTop: kMargin.top, marginBottom: kMargin.bottom, marginLeft: kMargin.left, marginRight,
    className: 'spectrum-plot', ariaLabel: 'error against frequency',
    ariaDescription: 'results.json holds the same numbers.',
    style: {fontFamily: 'inherit', fontSize: '12px', color: 'var(--muted)', background: 'none', overflow: 'visible'},
    x: {type: 'log', domain: xDomain},
    y: {type: 'log', domain: yDomain},
    marks: [
      Plot.gridY({ticks: yTicks, stroke: 'var(--grid)', strokeOpacity: 1}),
      Plot.gridX({ticks: xTicks, stroke: 'var(--grid)', strokeOpacity: 1}),
      Plot.axisY({ticks: yTicks, text: tickTexts(yTicks), tickSize: 0, tickPadding: 8,
        label: 'relMSE per unit of the frequency plane', labelAnchor: 'top', labelArrow: 'none', className: 'axis-y'}),
      Plot.axisX({ticks: xTicks, text: tickTexts(xTicks), tickSize: 4, tickPadding: 6,
        label: 'frequency (cycles per pixel)', labelAnchor: 'center', labelArrow: 'none', labelOffset: 40,
        className: 'axis-x'}),
      ...labels,
      ...seriesList.flatMap((series) => seriesMarks(series, yDomain)),
    ],
  });
  plot.setAttribute('role', 'img');
  return plot;
}

export function showSpectrum(section, results) {
  if (seriesOf(results).length === 0) {
    section.remove();
    return;
  }
  const figure = element('figure', {class: 'spectrum'});
  section.append(figure, element('p', {class: 'caption'}, 'At the largest budget. Lines are means over the repeats, ' +
    'bands hold 80 % of them; dotted is what the repeats have in common. Independent noise is level.'));
  let drawnWidth = 0;
  function draw() {
    drawnWidth = section.clientWidth;
    figure.replaceChildren(spectrumPlot(results, Math.max(260, Math.min(drawnWidth, 860))));
  }
  new ResizeObserver(() => {
    if (Math.abs(section.clientWidth - drawnWidth) >= 1) requestAnimationFrame(draw);
  }).observe(section);
  draw();
}
