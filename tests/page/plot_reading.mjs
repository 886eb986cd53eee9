// What a convergence plot shows, in its own pixels: ticks, points, intervals, curves.
import {readNumber, readSeconds} from './written_numbers.mjs';

export async function readPlot(page, axis) {
  return page.locator(`figure[data-axis="${axis}"] svg.convergence-plot`).evaluate((svg) => {
    const shift = (node) => {
      const match = /translate\(([-\d.e]+),([-\d.e]+)\)/.exec(node.getAttribute('transform') ?? '');
      return match ? [Number(match[1]), Number(match[2])] : [0, 0];
    };
    const all = (selector) => [...svg.querySelectorAll(selector)];
    const ticks = (part) => all(`[aria-label="${part} tick label"] text`)
      .map((text) => ({text: text.textContent, at: shift(text)}));
    const index = (node) => Number(/series-(\d+)/.exec(node.getAttribute('class'))[1]);
    const vertices = (d) => [...d.matchAll(/[ML]([-\d.e]+),([-\d.e]+)/g)].map((m) => [Number(m[1]), Number(m[2])]);
    const series = {};
    const of = (node) => series[index(node)] ??= {points: [], intervals: [], curve: [], unresolved: 0};
    for (const group of all('g.points')) {
      of(group).points = [...group.children].map((mark) => mark.tagName === 'circle'
        ? [Number(mark.getAttribute('cx')), Number(mark.getAttribute('cy'))] : shift(mark));
    }
    for (const group of all('g.intervals')) {
      of(group).intervals = [...group.querySelectorAll('line')].map((line) =>
        ['x1', 'y1', 'y2'].map((name) => Number(line.getAttribute(name))));
    }
    for (const group of all('g.curve')) {
      of(group).curve = [...group.querySelectorAll('path')].flatMap((path) => vertices(path.getAttribute('d')));
    }
    for (const group of all('g.unresolved')) of(group).unresolved = group.children.length;
    const guide = svg.querySelector('g.guide path');
    const noise = svg.querySelector('g.noise line');
    return {series, xTicks: ticks('x-axis'), yTicks: ticks('y-axis'),
      labels: all('g.end-label text').map((text) => text.textContent),
      guide: guide ? vertices(guide.getAttribute('d')) : null,
      noise: noise ? Number(noise.getAttribute('y1')) : null};
  });
}

// What a pixel means, by the axis' own ticks: a function from value to pixel, or null where there is but one tick.
export function axisScale(ticks, along, isLog) {
  const read = (text) => /\s(µs|ms|s|min|h|d|years)$/u.test(text) ? readSeconds(text) : readNumber(text);
  const position = isLog ? Math.log10 : (value) => value;
  const placed = ticks.map(({text, at}) => ({value: position(read(text)), pixel: at[along]}))
    .sort((a, b) => a.value - b.value);
  if (placed.length < 2) return null;
  const [first, last] = [placed[0], placed[placed.length - 1]];
  const perUnit = (last.pixel - first.pixel) / (last.value - first.value);
  const toPixel = (value) => first.pixel + perUnit * (position(value) - first.value);
  return {perUnit, toPixel, worstTick: Math.max(...placed.map(({value, pixel}) =>
    Math.abs(first.pixel + perUnit * (value - first.value) - pixel)))};
}
