// The section of convergence plots: which metric, the legend, the plots against time and against samples.
import {convergencePlot} from './convergence_plot.mjs';
import {choiceRow, element, svgElement} from './dom.mjs';
import {formatNumber} from './numbers.mjs';
import {kMetrics, kSymbols, limitOf, metricName, positive, seriesColor, snapshotsOf} from './results.mjs';
import {symbolPath} from './symbols.mjs';

const kNarrow = 760;  // below this the plots stand under each other

export function legendSymbol(index) {
  return svgElement('svg', {class: 'symbol', width: 30, height: 14, viewBox: '-15 -7 30 14', 'aria-hidden': 'true'},
    svgElement('line', {x1: -14, x2: 14, stroke: seriesColor(index), 'stroke-width': 1.75}),
    svgElement('path', {d: symbolPath(kSymbols[index % kSymbols.length], 4.5), fill: seriesColor(index)}));
}

function legend(results) {
  return element('ul', {class: 'legend', 'aria-label': 'Integrators'}, results.integrators.map(({name}, index) =>
    element('li', {}, legendSymbol(index), name)));
}

function captionText(results, metric) {
  const sentences = [results.repeats === 1 ? 'Of a single repeat, there are no intervals.'
    : `Points are means over ${results.repeats} repeats, bars and bands their ` +
    `${formatNumber(100 * results.confidence)} % intervals.`];
  if (metric === 'flip') {
    sentences.push('FLIP runs from 0 to 1 and is drawn on a linear axis.');
  } else {
    const isShown = snapshotsOf(results).some(({snapshot}) => positive(snapshot[metric]));
    if (isShown) {
      sentences.push('Without bias, error falls along the grey line: ten times the work, a tenth of the error.');
    }
    const noise = positive({value: results.reference[metric]});
    if (noise) sentences.push(`The reference’s own noise is a ${metricName(metric)} of ${formatNumber(noise.value)}.`);
  }
  if (snapshotsOf(results).some(({snapshot}) => snapshot[metric] === null)) {
    sentences.push(`Hollow points with an arrow could not be told apart from the reference’s own ${limitOf(results)}.`);
  }
  return sentences.join(' ');
}

export function showConvergence(section, results) {
  let metric = kMetrics[0].key;
  const plots = element('div', {class: 'plots'});
  const caption = element('p', {class: 'caption'});
  const choices = choiceRow('Metric', kMetrics.map(({key, name}) => ({value: key, text: name})), metric, (chosen) => {
    metric = chosen;
    draw();
  });
  section.append(element('div', {class: 'bar'}, legend(results), choices), plots, caption);

  let drawnWidth = 0;
  function draw() {
    drawnWidth = plots.clientWidth;
    const width = drawnWidth < kNarrow ? drawnWidth : Math.floor((drawnWidth - 40) / 2);
    const figures = ['time', 'samples'].map((axis) => {
      const plot = convergencePlot(results, {axis, metric, width: Math.max(260, width)});
      return plot && element('figure', {'data-axis': axis},
        element('h3', {}, axis === 'time' ? 'Equal time' : 'Equal samples'), plot);
    }).filter((figure) => figure !== null);
    plots.replaceChildren(...figures);
    caption.textContent = captionText(results, metric);
  }
  // The plots' own height changes nothing: only a new width is a reason to draw.
  new ResizeObserver(() => {
    if (Math.abs(plots.clientWidth - drawnWidth) >= 1) requestAnimationFrame(draw);
  }).observe(plots);
  draw();
}
