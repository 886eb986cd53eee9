// The convergence plots show the data: points, intervals and curves where the axes' ticks say that they belong.
import assert from 'node:assert/strict';
import {axisScale, readPlot} from './plot_reading.mjs';
import {readNumber} from './written_numbers.mjs';

const kNear = 1.0;  // pixels

// The rows of a plot, by integrator: those with its kind of budget, or all others where there are none.
function expectedSeries(results, axis, metric) {
  const has = (kind) => results.integrators.some(({snapshots}) => snapshots.some((snapshot) => snapshot.kind === kind));
  const kind = has(axis) ? axis : axis === 'time' ? 'samples' : 'time';
  return results.integrators.map(({name, snapshots}) => {
    const rows = snapshots.filter((snapshot) => snapshot.kind === kind)
      .map((row) => ({x: axis === 'time' ? row.seconds : row.samplesPerPixel, interval: row[metric]}))
      .sort((a, b) => a.x - b.x);
    const resolved = rows.filter(({interval}) => interval);
    return {name, rows: resolved, unresolved: rows.length - resolved.length};
  });
}

function assertNear(actual, expected, what) {
  assert.ok(Math.abs(actual - expected) <= kNear, `${what}: at ${actual}, expected at ${expected}`);
}

function assertSeries(shown, expected, xScale, yScale) {
  const {name, rows} = expected;
  assert.equal(shown.points.length, rows.length, `points of ${name}`);
  assert.equal(shown.intervals.length, rows.length, `intervals of ${name}`);
  assert.equal(shown.unresolved, expected.unresolved, `unresolved points of ${name}`);
  if (rows.length > 1) assert.equal(shown.curve.length, rows.length, `vertices of the curve of ${name}`);
  for (const [i, {x, interval}] of rows.entries()) {
    const [px, py] = shown.points[i];
    if (xScale) assertNear(px, xScale.toPixel(x), `${name}, point ${i}, x`);
    assertNear(py, yScale.toPixel(interval.value), `${name}, point ${i}, y`);
    const [ix, low, high] = shown.intervals[i];
    assertNear(ix, px, `${name}, interval ${i}, x`);
    const hasInterval = interval.low !== null && interval.high !== null;
    const [lowest, highest] = hasInterval ? [interval.low, interval.high] : [interval.value, interval.value];
    assertNear(Math.max(low, high), yScale.toPixel(lowest), `${name}, interval ${i}, low`);
    assertNear(Math.min(low, high), yScale.toPixel(highest), `${name}, interval ${i}, high`);
    if (rows.length > 1) {
      assertNear(shown.curve[i][0], px, `${name}, curve at ${i}, x`);
      assertNear(shown.curve[i][1], py, `${name}, curve at ${i}, y`);
    }
  }
  // Without the ticks too: distances are as the logarithms of the ratios.
  for (let i = 1; i < rows.length && xScale; i++) {
    const distance = shown.points[i][0] - shown.points[0][0];
    assertNear(distance, xScale.perUnit * Math.log10(rows[i].x / rows[0].x), `${name}, distance of point ${i}`);
  }
}

function assertPlot(plot, results, axis, metric) {
  const isLog = metric !== 'flip';
  const expected = expectedSeries(results, axis, metric);
  assert.ok(plot.xTicks.length >= 1, 'the horizontal axis has ticks');
  assert.ok(plot.yTicks.length >= 2, 'the vertical axis has ticks');
  assert.ok([...plot.xTicks, ...plot.yTicks].every(({text}) => text !== ''), 'each tick says what it is');
  const xScale = axisScale(plot.xTicks, 0, true);
  const yScale = axisScale(plot.yTicks, 1, isLog);
  assert.ok(yScale.perUnit < 0, 'errors grow upwards');
  assert.ok(yScale.worstTick <= kNear, `ticks of the vertical axis are off by ${yScale.worstTick}`);
  if (xScale) {
    assert.ok(xScale.perUnit > 0, 'work grows to the right');
    assert.ok(xScale.worstTick <= kNear, `ticks of the horizontal axis are off by ${xScale.worstTick}`);
  }
  for (const [i, series] of expected.entries()) {
    const shown = plot.series[i] ?? {points: [], intervals: [], curve: [], unresolved: 0};
    assertSeries(shown, series, xScale, yScale);
  }
  const labelled = expected.filter(({rows, unresolved}) => rows.length + unresolved > 0).map(({name}) => name);
  assert.deepEqual(plot.labels, labelled, 'labels at the ends of the curves');
  if (isLog && xScale && plot.guide) {
    const [[x0, y0], [x1, y1]] = plot.guide;
    const slope = ((y1 - y0) / yScale.perUnit) / ((x1 - x0) / xScale.perUnit);
    assert.ok(Math.abs(slope + 1) < 0.01, `the guide has slope ${slope}`);
  }
  if (isLog) {
    const hasUnresolved = expected.some(({unresolved}) => unresolved > 0);
    const noise = results.reference[metric];
    if (plot.noise !== null) assertNear(plot.noise, yScale.toPixel(noise), 'noise of the reference');
    else assert.ok(!(noise > 0 && hasUnresolved), 'what was not resolved needs the line of the noise');
  }
}

export function testPlots(pageTest, results) {
  for (const metric of ['relMse', 'mse', 'flip']) {
    pageTest(`convergence plots show the data: ${metric}`, {}, async (page) => {
      await page.locator(`#convergence [data-value="${metric}"]`).click();
      for (const axis of ['time', 'samples']) assertPlot(await readPlot(page, axis), results, axis, metric);
    });
  }

  pageTest('the legend names each integrator', {}, async (page) => {
    assert.deepEqual(await page.locator('.legend li').allInnerTexts(), results.integrators.map(({name}) => name));
  });

  pageTest('plots follow the width of the window', {}, async (page) => {
    const plot = page.locator('figure[data-axis="time"] svg.convergence-plot');
    const before = await plot.evaluate((svg) => svg.clientWidth);
    await page.setViewportSize({width: 1000, height: 900});
    await page.waitForFunction((wide) =>
      document.querySelector('figure[data-axis="time"] svg.convergence-plot').getAttribute('width') < wide, before);
    assertPlot(await readPlot(page, 'time'), results, 'time', 'relMse');
  });

  pageTest('hovering a point tells its numbers', {}, async (page) => {
    const expected = expectedSeries(results, 'time', 'flip');
    const index = expected.findIndex(({rows}) => rows.length > 0);
    if (index < 0) return;
    await page.locator('#convergence [data-value="flip"]').click();
    await page.locator(`figure[data-axis="time"] .points.series-${index} > *`).last().hover({force: true});
    const tip = page.locator('figure[data-axis="time"] [aria-label="tip"] text');
    await tip.waitFor({state: 'attached'});
    const text = (await tip.evaluate((node) => [...node.children].map((line) => line.textContent))).join('\n');
    assert.ok(text.includes(expected[index].name), `the tip names the integrator: ${text}`);
    const {rows} = expected[index];
    const shown = readNumber(/FLIP(.*)/.exec(text)[1]);
    const {value} = rows[rows.length - 1].interval;
    assert.ok(Math.abs(shown / value - 1) < 0.06, `the tip says ${shown}, the data ${value}`);
  });
}
