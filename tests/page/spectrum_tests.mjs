// The plot of the error over frequencies shows the data where its axes' ticks say.
import assert from 'node:assert/strict';
import {axisScale} from './plot_reading.mjs';

const kNear = 1.0;  // pixels

async function readSpectrum(page) {
  return page.locator('svg.spectrum-plot').evaluate((svg) => {
    const all = (selector) => [...svg.querySelectorAll(selector)];
    const ticks = (part) => all(`[aria-label="${part} tick label"] text`).map((text) => {
      const match = /translate\(([-\d.e]+),([-\d.e]+)\)/.exec(text.getAttribute('transform') ?? '');
      return {text: text.textContent, at: match ? [Number(match[1]), Number(match[2])] : [0, 0]};
    });
    const vertices = (d) => [...d.matchAll(/[ML]([-\d.e]+),([-\d.e]+)/g)].map((m) => [Number(m[1]), Number(m[2])]);
    const series = {};
    for (const group of all('g.spectrum-curve')) {
      const index = Number(/series-(\d+)/.exec(group.getAttribute('class'))[1]);
      series[index] = [...group.querySelectorAll('path')].flatMap((path) => vertices(path.getAttribute('d')));
    }
    return {series, xTicks: ticks('x-axis'), yTicks: ticks('y-axis'),
      labels: all('g.end-label text').map((text) => text.textContent)};
  });
}

export function testSpectrum(pageTest, results) {
  const shown = (spectrum) => spectrum.filter(({frequency, density}) => frequency > 0 && density > 0);
  const withSpectrum = results.integrators.filter(({spectrum}) => shown(spectrum).length > 0);

  pageTest('the error over frequencies', {}, async (page) => {
    assert.equal(await page.locator('#spectrum').count(), withSpectrum.length > 0 ? 1 : 0);
    if (withSpectrum.length === 0) return;
    const plot = await readSpectrum(page);
    const xScale = axisScale(plot.xTicks, 0, true);
    const yScale = axisScale(plot.yTicks, 1, true);
    assert.ok(xScale.perUnit > 0 && yScale.perUnit < 0, 'frequencies grow to the right, errors upwards');
    assert.ok(xScale.worstTick <= kNear && yScale.worstTick <= kNear, 'ticks are where they say');
    assert.deepEqual(plot.labels, withSpectrum.map(({name}) => name));
    for (const [index, {name, spectrum}] of results.integrators.entries()) {
      const rings = shown(spectrum);
      const points = plot.series[index] ?? [];
      assert.equal(points.length, rings.length, `vertices of the spectrum of ${name}`);
      for (const [i, {frequency, density}] of rings.entries()) {
        const [x, y] = points[i];
        assert.ok(Math.abs(x - xScale.toPixel(frequency)) <= kNear, `${name} at ${frequency}: x ${x}`);
        assert.ok(Math.abs(y - yScale.toPixel(density)) <= kNear, `${name} at ${frequency}: y ${y}`);
      }
    }
  });
}
