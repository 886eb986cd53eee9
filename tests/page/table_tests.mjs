// Head and tables hold the numbers of the results, to the digits that they are written with.
import assert from 'node:assert/strict';
import {readInterval, readNumber, readSeconds} from './written_numbers.mjs';

// The cells of a table's rows; a budget that spans several rows is in the first of them only.
async function rowsOf(page, id) {
  return page.locator(`#${id} tbody tr`).evaluateAll((rows) => rows.map((row) =>
    [...row.cells].filter((cell) => !cell.classList.contains('budget')).map((cell) => cell.textContent)));
}

function assertClose(actual, expected, what, share = 0.055) {
  assert.ok(Math.abs(actual - expected) <= share * Math.abs(expected), `${what}: ${actual}, expected ${expected}`);
}

function assertInterval(text, expected, what) {
  if (!expected) {
    assert.match(text, /not resolved/, what);
    return;
  }
  if (expected.value === null) {
    assert.equal(text, '–', what);
    return;
  }
  if (expected.low === null || expected.high === null) {
    assertClose(readNumber(text), expected.value, what, 0.006);
    return;
  }
  const shown = readInterval(text);
  assert.ok(shown, `${what}: no interval in “${text}”`);
  // All three are written with the same decimals, those of the value or, where it may be 0, of the largest: what these
  // can hold is what they must agree to.
  const largest = expected.low < 0 ? Math.max(Math.abs(expected.low), Math.abs(expected.high)) : 0;
  const unit = 0.055 * Math.max(Math.abs(expected.value), largest);
  for (const part of ['value', 'low', 'high']) {
    assert.ok(Math.abs(shown[part] - expected[part]) <= Math.max(unit, 0.055 * Math.abs(expected[part])),
      `${what}, ${part}: ${shown[part]} in “${text}”, expected ${expected[part]}`);
  }
}

function inPercent(interval) {
  return Object.fromEntries(['value', 'low', 'high'].map((part) =>
    [part, interval[part] === null ? null : 100 * interval[part]]));
}

export function testTables(pageTest, results) {
  pageTest('the head says scene, verdict, reference and hints', {}, async (page) => {
    assert.equal(await page.locator('h1').innerText(), results.scene);
    const head = (await page.locator('#head').innerText()).replaceAll('\u00a0', ' ');
    const verdict = (await page.locator('.verdict').innerText()).replaceAll('\u00a0', ' ');
    assert.ok(results.integrators.some(({name}) => verdict.includes(name)), verdict);
    for (const {name, meanBias: bias, systematic, hints} of results.integrators) {
      const flaws = await page.locator('.flaw').allInnerTexts();
      const isFlawed = bias?.significant || (systematic?.significant && systematic.value > 0);
      assert.equal(flaws.some((flaw) => flaw.replace(/^▲\s*/u, '').startsWith(`${name} `)), Boolean(isFlawed),
        `flaw of ${name}`);
      if (bias?.significant) {
        const flaw = flaws.find((text) => text.includes(`${name} `)).replaceAll('\u00a0', ' ');
        assertClose(readNumber(/is (.*) %/.exec(flaw)[1]) / 100, Math.abs(bias.value), flaw, 0.006);
        assert.match(flaw, bias.value < 0 ? /below/ : /above/);
      }
      for (const hint of hints) assert.ok(head.includes(hint), hint);
    }
    const {relMse} = results.reference;
    const noise = /Its own noise is a relMSE of (?:at most )?(.*?), an error of (.*?) %\./.exec(head);
    assert.equal(noise !== null, relMse !== null, head);
    if (noise) {
      assertClose(readNumber(noise[1]), relMse, head, 0.006);
      assertClose(readNumber(noise[2]) / 100, Math.sqrt(relMse), head, 0.06);
    }
    const {bias, biasIsLimit, radius} = results.reference;
    const blur = /a bias of (at most )?(.*?) %\./.exec(head);
    assert.equal(blur !== null, radius > 0 && bias !== null, head);
    if (blur) {
      assertClose(readNumber(blur[2]) / 100, bias, head, 0.06);
      assert.equal(Boolean(blur[1]), biasIsLimit, head);
    }
    assert.ok(head.includes(results.command));
    const longest = results.integrators[0].snapshots.filter(({kind}) => kind === 'time').map(({budget}) => budget);
    const ratio = results.ratios.find(({metric, kind, budget, low, high}) => metric === 'relMse' && kind === 'time' &&
      budget === Math.max(...longest) && low !== null && high !== null);
    if (ratio && results.integrators.length === 2 && (ratio.low > 1 || ratio.high < 1)) {
      const shown = readInterval(verdict);
      assertClose(Math.abs(Math.log(shown.value)), Math.abs(Math.log(ratio.value)), verdict, 0.06);
    }
  });

  for (const kind of ['time', 'samples']) {
    pageTest(`the table of snapshots: ${kind}`, {}, async (page) => {
      const rows = await rowsOf(page, `snapshots-${kind}`);
      const budgets = [...new Set(results.integrators.flatMap(({snapshots}) =>
        snapshots.filter((snapshot) => snapshot.kind === kind).map(({budget}) => budget)))].sort((a, b) => a - b);
      const expected = budgets.flatMap((budget) => results.integrators.flatMap(({name, snapshots}) => {
        const ofBudget = snapshots.filter((snapshot) => snapshot.kind === kind && snapshot.budget === budget);
        return ofBudget.map((snapshot) => ({name, snapshot}));
      }));
      assert.equal(rows.length, expected.length);
      for (const [i, {name, snapshot}] of expected.entries()) {
        const [integrator, outcome, rate, relMse, mse, flip, relEfficiency, efficiency] = rows[i];
        const what = `${name}, ${kind} ${snapshot.budget}`;
        assert.equal(integrator, name, what);
        if (kind === 'time') assertClose(readNumber(outcome), snapshot.samplesPerPixel, what, 0.006);
        else assertClose(readSeconds(outcome), snapshot.seconds, what, 0.01);
        assertClose(readNumber(rate), snapshot.samplesPerSecond, what, 0.006);
        assertInterval(relMse, snapshot.relMse, `${what}, relMSE`);
        assertInterval(mse, snapshot.mse, `${what}, MSE`);
        assertInterval(flip, snapshot.flip, `${what}, FLIP`);
        assertInterval(relEfficiency, snapshot.relEfficiency, `${what}, efficiency by relMSE`);
        assertInterval(efficiency, snapshot.efficiency, `${what}, efficiency by MSE`);
      }
    });
  }

  pageTest('the table of noise and bias', {}, async (page) => {
    const has = results.integrators.some(({snapshots}) => snapshots.some(({noise, bias}) => noise || bias));
    assert.equal(await page.locator('#parts').count(), has ? 1 : 0);
    if (!has) return;
    const heading = await page.locator('#parts thead').innerText();
    for (const {name, blurs} of results.integrators) {
      assert.equal(/blur: (.*)\)/.exec(heading)?.[1].split(', ').includes(name) ?? false, blurs, heading);
    }
    const expected = ['time', 'samples'].flatMap((kind) => {
      const of = ({snapshots}) => snapshots.filter((snapshot) => snapshot.kind === kind);
      const budgets = [...new Set(results.integrators.flatMap(of).map(({budget}) => budget))].sort((a, b) => a - b);
      return budgets.flatMap((budget) => results.integrators.flatMap((integrator) =>
        of(integrator).filter((snapshot) => snapshot.budget === budget)
          .map((snapshot) => ({name: integrator.name, snapshot}))));
    });
    const rows = await rowsOf(page, 'parts');
    assert.equal(rows.length, expected.length);
    for (const [i, {name, snapshot: {noise, bias, kind, budget}}] of expected.entries()) {
      const what = `${name}, ${kind} ${budget}`;
      assert.equal(rows[i][0], name, what);
      if (noise) assertInterval(rows[i][1], inPercent(noise), `${what}, noise`);
      else assert.equal(rows[i][1], '–', what);
      const text = rows[i][2].replaceAll('\u00a0', ' ');
      if (!bias) {
        assert.equal(text, '–', what);
      } else if (bias.significant) {
        assertInterval(text, inPercent(bias), `${what}, bias`);
      } else {
        assert.match(text, /^not told from 0/, what);
        const bound = /up to (.*) %/.exec(text);
        assert.equal(bound !== null, bias.high !== null, what);
        if (bound) assertClose(readNumber(bound[1]) / 100, bias.high, what, 0.006);
      }
    }
  });

  pageTest('the table of times to an error', {}, async (page) => {
    const rows = await rowsOf(page, 'time-to-error');
    for (const [i, {name, blurs, timeToError}] of results.integrators.entries()) {
      const sorted = [...timeToError].sort((a, b) => b.error - a.error);
      for (const [k, {error, kind, seconds}] of sorted.entries()) {
        const text = rows[i][k + 1];
        const what = `${name} to ${error}: “${text}”`;
        assert.ok(!blurs || kind !== 'never', what);
        assert.equal(text.startsWith('~'), kind === 'extrapolated', what);
        assert.equal(text.startsWith('never'), kind === 'never', what);
        assert.equal(text === 'not resolved', kind === 'unresolved', what);
        if (seconds !== null) assertClose(readSeconds(text.split('(')[0]), seconds, what, 0.03);
      }
    }
  });

  pageTest('the table of ratios', {}, async (page) => {
    const ratios = results.ratios.filter(({value}) => value > 0);
    const rows = ratios.length > 0 ? await rowsOf(page, 'ratios') : [];
    const budgetOf = ({kind, budget}) => `${kind} ${budget}`;
    const pairOf = (ratio) => `${budgetOf(ratio)}: ${ratio.integrator} against ${ratio.against}`;
    const expected = [...new Set(ratios.map(budgetOf))].flatMap((budget) =>
      [...new Set(ratios.filter((ratio) => budgetOf(ratio) === budget).map(pairOf))]);
    assert.equal(rows.length, expected.length);
    const metrics = ['relMse', 'mse', 'flip'].filter((metric) => ratios.some((ratio) => ratio.metric === metric));
    for (const ratio of ratios) {
      const row = rows[expected.indexOf(pairOf(ratio))];
      assert.deepEqual(row.slice(0, 2), [ratio.integrator, ratio.against], pairOf(ratio));
      const column = 2 + 2 * metrics.indexOf(ratio.metric);
      assertInterval(row[column], ratio, pairOf(ratio));
      const includesOne = ratio.high === null || !(ratio.low > 1 || ratio.high < 1);
      assert.equal(row[column + 1].includes('no difference'), includesOne, pairOf(ratio));
    }
  });

  pageTest('the table of what repeats have in common', {}, async (page) => {
    const rows = await rowsOf(page, 'systematic');
    const caption = await page.locator('#systematic .caption').innerText();
    assert.equal(caption.includes('blurred'), results.integrators.some(({blurs}) => blurs), caption);
    assert.equal(caption.includes('stay'), results.integrators.some(({blurs}) => !blurs), caption);
    for (const [i, {name, meanBias: bias, systematic}] of results.integrators.entries()) {
      assert.equal(rows[i][0], name);
      assertInterval(rows[i][1], inPercent(bias), `bias of ${name}`);
      assert.equal(rows[i][2].includes('yes'), bias.significant);
      assertInterval(rows[i][3], systematic, `systematic part of ${name}`);
      assert.equal(rows[i][4].includes('yes'), systematic.significant && systematic.value > 0);
    }
  });

  pageTest('the table of pilots', {}, async (page) => {
    const rows = results.pilots.length > 0 ? await rowsOf(page, 'pilots') : [];
    assert.equal(rows.length, results.pilots.length);
    for (const [i, {integrator, mean, relMse, bias, chosen, note}] of results.pilots.entries()) {
      assert.equal(rows[i][0], integrator);
      assertClose(readNumber(rows[i][3]), mean, `mean of ${integrator}`, 0.006);
      if (bias > 0) assertClose(readNumber(rows[i][5]) / 100, bias, `blur of ${integrator}`, 0.006);
      if (relMse !== null) assertClose(readNumber(rows[i][4]), relMse, `relMSE of ${integrator}`, 0.006);
      assert.equal(rows[i][6].includes('chosen'), chosen);
      assert.ok(rows[i][6].includes(note ?? ''));
    }
  });

  pageTest('how to read the page unfolds', {}, async (page) => {
    const definitions = page.locator('.reading dl');
    assert.equal(await definitions.isVisible(), false);
    await page.locator('.reading summary').click();
    assert.equal(await definitions.isVisible(), true);
    for (const word of ['MSE', 'relMSE', 'FLIP', 'Efficiency', 'intervals', 'Noise and bias', 'frequencies']) {
      assert.ok((await definitions.innerText()).includes(word), word);
    }
  });
}
