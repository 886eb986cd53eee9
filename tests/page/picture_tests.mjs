// The pictures: divider, choice, errors in false colours, readout, zoom. What is shown is read from screenshots and
// compared with the embedded PNGs, decoded by the test's own code.
import assert from 'node:assert/strict';
import {colorAt, decodeDataUri, differingShare, farthest, screenshotOf, settle} from './browser.mjs';
import {decodePng} from './png.mjs';
import {readNumber} from './written_numbers.mjs';

const kSame = 2;  // levels that colour may be off
const kChanged = 0.01;  // share of pixels: little noise, and black around it, are pictures too

function luminance([r, g, b]) {
  return 0.2126 * r + 0.7152 * g + 0.0722 * b;
}

// The choices of a side, as the page offers them: keys of pictures.
async function choicesOf(page) {
  return page.locator('#side-left option').evaluateAll((options) => options.map((option) => option.value));
}

async function choose(page, left, right) {
  await page.locator('#side-left').selectOption(left);
  await page.locator('#side-right').selectOption(right);
  await settle(page);
}

async function zoomTo(page, zoom) {
  await page.locator(`[aria-label="Zoom"] [data-value="${zoom}"]`).click();
  await settle(page);
}

async function showErrors(page) {
  await page.locator('[aria-label="What is shown"] [data-value="error"]').click();
  await settle(page);
}

async function frameBox(page) {
  await page.locator('.frame').scrollIntoViewIfNeeded();
  return page.locator('.frame').boundingBox();
}

// The window with all of the frame in it: its pixels are the screen's, wherever the frame begins.
async function windowShot(page) {
  await frameBox(page);
  return decodePng(await page.screenshot());
}

// The picture's pixel under a place in the frame, given in shares of it, as the readout tells; `at` is the same place
// in the window.
async function pointAt(page, x, y) {
  const box = await frameBox(page);
  return readAt(page, Math.round(box.x + x * box.width), Math.round(box.y + y * box.height));
}

async function readAt(page, x, y) {
  await page.mouse.move(x + 0.5, y + 0.5);
  const text = (await page.locator('.readout').innerText()).replaceAll('\u00a0', ' ');
  const match = /(\d+), (\d+)/.exec(text);
  assert.ok(match, `the readout tells a position: ${text}`);
  return {at: {x, y}, pixel: [Number(match[1]), Number(match[2])],
    values: await page.locator('.readout .value').allInnerTexts()};
}

async function dividerShare(page) {
  const box = await frameBox(page);
  const divider = await page.locator('.divider').boundingBox();
  return (divider.x + divider.width / 2 - box.x) / box.width;
}

// Two sides of which the pictures differ: the first rendered one and the reference, or what else there is.
async function pairOf(page) {
  const choices = await choicesOf(page);
  const rendered = choices.filter((key) => key !== 'reference');
  return choices.includes('reference') ? [rendered[0], 'reference'] : [rendered[0], rendered[rendered.length - 1]];
}

export function testPictures(pageTest, results, pictures) {
  if (Object.keys(pictures).length < 2) return;
  const hasErrors = Object.keys(pictures).some((key) => key.startsWith('error-'));

  pageTest('each side of the divider shows its own picture, pixel by pixel', {}, async (page) => {
    const [left, right] = await pairOf(page);
    await choose(page, left, right);
    await zoomTo(page, 2);
    const shot = await windowShot(page);
    for (const [key, xs] of [[left, [0.2, 0.3, 0.4]], [right, [0.6, 0.7, 0.8]]]) {
      const picture = decodeDataUri(pictures[key]);
      for (const x of xs) {
        for (const y of [0.3, 0.6]) {
          const {at, pixel} = await pointAt(page, x, y);
          const shown = colorAt(shot, at.x, at.y);
          const expected = colorAt(picture, ...pixel);
          assert.ok(farthest(shown, expected) <= kSame, `${key} at ${pixel}: shown ${shown}, expected ${expected}`);
        }
      }
    }
  });

  pageTest('the divider moves with the mouse, and what is shown with it', {}, async (page) => {
    await choose(page, ...await pairOf(page));
    const before = await screenshotOf(page.locator('.frame'));
    const box = await frameBox(page);
    await page.mouse.move(box.x + 0.5 * box.width, box.y + 0.4 * box.height);
    await page.mouse.down();
    await page.mouse.move(box.x + 0.4 * box.width, box.y + 0.4 * box.height, {steps: 4});
    await page.mouse.move(box.x + 0.2 * box.width, box.y + 0.4 * box.height, {steps: 4});
    await page.mouse.up();
    assert.ok(Math.abs(await dividerShare(page) - 0.2) < 0.01, 'the divider is where it was dragged');
    assert.equal(await page.locator('.divider').getAttribute('aria-valuenow'), '20');
    await settle(page);
    const after = await screenshotOf(page.locator('.frame'));
    // Only what lies between the old and the new place changes, and there much does.
    assert.ok(differingShare(cropped(before, 0.24, 0.46), cropped(after, 0.24, 0.46)) > kChanged,
      'the other picture came into view');
    assert.equal(differingShare(cropped(before, 0.6, 0.98), cropped(after, 0.6, 0.98)), 0, 'the rest stays');
  });

  pageTest('the divider moves with the keyboard, and what is shown with it', {}, async (page) => {
    const [left, right] = await pairOf(page);
    await choose(page, left, right);
    const divider = page.locator('.divider');
    assert.equal(await divider.getAttribute('role'), 'slider');
    await divider.focus();
    const before = await screenshotOf(page.locator('.frame'));
    await page.keyboard.press('ArrowLeft');
    assert.equal(await divider.getAttribute('aria-valuenow'), '49');
    for (let i = 0; i < 2; i++) await page.keyboard.press('Shift+ArrowRight');
    assert.equal(await divider.getAttribute('aria-valuenow'), '69');
    assert.match(await divider.getAttribute('aria-valuetext'), /69/);
    assert.ok(Math.abs(await dividerShare(page) - 0.69) < 0.01);
    await settle(page);
    const moved = await screenshotOf(page.locator('.frame'));
    assert.ok(differingShare(cropped(before, 0.54, 0.65), cropped(moved, 0.54, 0.65)) > kChanged,
      'the other picture came into view');
    await page.keyboard.press('Home');
    assert.equal(await divider.getAttribute('aria-valuenow'), '0');
    await zoomTo(page, 2);
    const shot = await windowShot(page);
    const {at, pixel} = await pointAt(page, 0.3, 0.5);
    assert.ok(farthest(colorAt(shot, at.x, at.y), colorAt(decodeDataUri(pictures[right]), ...pixel)) <= kSame,
      'at Home all of the right picture is seen');
  });

  pageTest('another choice shows other pictures and says so', {}, async (page) => {
    const choices = await choicesOf(page);
    const snapshots = results.integrators.flatMap((integrator) => integrator.snapshots);
    const expected = ['reference', ...snapshots.map(({picture}) => picture)].filter((key) => key in pictures);
    assert.deepEqual([...choices].sort(), [...new Set(expected)].sort(), 'reference and all snapshots can be chosen');
    const rendered = choices.filter((key) => key !== 'reference');
    await choose(page, rendered[0], choices[0] === rendered[0] ? choices[choices.length - 1] : choices[0]);
    const before = await screenshotOf(page.locator('.frame'));
    const last = rendered[rendered.length - 1];
    const next = last !== rendered[0] ? last : 'reference';
    await choose(page, next, rendered[0]);
    const after = await screenshotOf(page.locator('.frame'));
    assert.ok(differingShare(before, after) > kChanged, 'the pictures changed');
    for (const {name, snapshots} of results.integrators) {
      const snapshot = snapshots.find(({picture}) => picture === rendered[0]);
      if (!snapshot) continue;
      assert.ok((await page.locator('#side-right option:checked').innerText()).includes(name));
      const caption = (await page.locator('.side.right .side-caption').innerText()).replaceAll('\u00a0', ' ');
      const spp = readNumber(/([^·]*) spp/.exec(caption)[1]);
      assert.ok(Math.abs(spp / snapshot.samplesPerPixel - 1) < 0.01, `samples per pixel in “${caption}”`);
      assert.match(caption, snapshot.relMse ? /relMSE [\d.]+/ : /noise/);
    }
    await page.locator('.swap').click();
    assert.equal(await page.locator('#side-left').inputValue(), rendered[0]);
    assert.equal(await page.locator('#side-right').inputValue(), next);
  });

  pageTest('a budget is chosen for both sides at once', {}, async (page) => {
    const buttons = page.locator('[aria-label="Budget of both sides"] button');
    if (await buttons.count() === 0) return;
    const {snapshots} = results.integrators[0];
    await choose(page, snapshots[0].picture, snapshots[0].picture);
    await buttons.nth(1).click();
    await settle(page);
    const [kind, budget] = (await buttons.nth(1).getAttribute('data-value')).split(' ');
    const expected = snapshots.find((snapshot) => snapshot.kind === kind && snapshot.budget === Number(budget));
    for (const side of ['left', 'right']) {
      assert.equal(await page.locator(`#side-${side}`).inputValue(), expected.picture);
    }
  });

  if (hasErrors) {
    pageTest('errors are shown in colours of their own, and the readout agrees with the data', {}, async (page) => {
      const snapshot = results.integrators.flatMap(({snapshots}) => snapshots)
        .find(({errorPicture}) => errorPicture in pictures);
      const other = (await choicesOf(page)).find((key) => key !== snapshot.picture);
      await choose(page, snapshot.picture, other);
      const picture = await screenshotOf(page.locator('.frame'));
      await showErrors(page);
      const before = await screenshotOf(page.locator('.frame'));
      assert.ok(differingShare(cropped(picture, 0, 0.45), cropped(before, 0, 0.45)) > 0.9,
        'errors look unlike the picture');
      await zoomTo(page, 4);
      const shot = await windowShot(page);
      const levels = decodeDataUri(pictures[snapshot.errorPicture]);
      const {lowest, highest} = results.errorScale;
      const seen = [];
      for (const x of [0.05, 0.13, 0.21, 0.29, 0.37, 0.45]) {
        for (const y of [0.15, 0.5, 0.85]) {
          const {at, pixel, values} = await pointAt(page, x, y);
          const level = colorAt(levels, ...pixel)[0];
          const expected = lowest * (highest / lowest) ** (level / 255);
          const shown = readNumber(/error (.*) %/.exec(values[0].replaceAll('\u00a0', ' '))[1]) / 100;
          assert.ok(Math.abs(shown / expected - 1) < 0.006,
            `at ${pixel} the readout says ${shown}, the data ${expected}`);
          seen.push({level, color: colorAt(shot, at.x, at.y)});
        }
      }
      seen.sort((a, b) => a.level - b.level);
      for (let i = 1; i < seen.length; i++) {
        const step = luminance(seen[i].color) - luminance(seen[i - 1].color);
        assert.ok(seen[i].level === seen[i - 1].level ? Math.abs(step) < 1 : step > -0.5,
          `level ${seen[i].level} is as bright as ${seen[i - 1].level} or brighter`);
      }
    });

    pageTest('the legend of errors goes in steps of ten', {}, async (page) => {
      await showErrors(page);
      assert.ok(await page.locator('.scale').isVisible());
      const bar = await page.locator('.scale-bar').boundingBox();
      const ticks = await page.locator('.scale-tick').evaluateAll((nodes) => nodes.map((node) => {
        const box = node.getBoundingClientRect();
        return {text: node.textContent, x: (box.left + box.right) / 2};
      }));
      const {lowest, highest} = results.errorScale;
      assert.equal(ticks.length, Math.floor(Math.log10(highest) + 1e-6) - Math.ceil(Math.log10(lowest) - 1e-6) + 1);
      for (const {text, x} of ticks) {
        const error = readNumber(text.replace(/[≤≥]\s*/u, '')) / 100;
        const expected = bar.x + bar.width * Math.log(error / lowest) / Math.log(highest / lowest);
        assert.ok(Math.abs(x - expected) <= 1, `${text} at ${x}, expected at ${expected}`);
      }
    });
  }

  pageTest('zoom makes equal squares of pixels, and dragging moves them', {}, async (page) => {
    await choose(page, ...await pairOf(page));
    await zoomTo(page, 8);
    const {at, pixel} = await pointAt(page, 0.25, 0.5);
    const shot = await windowShot(page);
    const picture = decodeDataUri(pictures[await page.locator('#side-left').inputValue()]);
    for (let dx = -4; dx <= 4; dx++) {
      const shown = colorAt(shot, at.x + 8 * dx, at.y);
      assert.ok(farthest(shown, colorAt(picture, pixel[0] + dx, pixel[1])) <= kSame, `pixel ${dx} beside ${pixel}`);
    }
    await page.mouse.move(at.x + 0.5, at.y + 0.5);
    await page.mouse.down();
    await page.mouse.move(at.x + 64.5, at.y + 32.5, {steps: 3});
    await page.mouse.up();
    assert.match(await page.locator('.readout .position').innerText(), new RegExp(`^${pixel[0]}, ${pixel[1]}$`),
      'the pixel that was dragged is still under the pointer');
    assert.ok(Math.abs(await dividerShare(page) - 0.5) < 0.01, 'the divider stays');
    await page.locator('.frame').focus();
    await page.keyboard.press('ArrowRight');
    assert.equal((await readAt(page, at.x + 64, at.y + 32)).pixel[0], pixel[0] + 5,
      'the arrow key moves the view by 40 pixels');
  });

  pageTest('the wheel with Ctrl zooms about the pointer, and alone it scrolls', {}, async (page) => {
    await zoomTo(page, 8);
    const {at, pixel} = await pointAt(page, 0.3, 0.4);
    await page.keyboard.down('Control');
    await page.mouse.wheel(0, -100);
    await page.keyboard.up('Control');
    await page.locator('[aria-label="Zoom"] [data-value="16"][aria-pressed="true"]').waitFor();
    const again = await readAt(page, at.x, at.y);
    const moved = Math.max(...again.pixel.map((value, i) => Math.abs(value - pixel[i])));
    assert.ok(moved <= 1, `under the pointer is ${again.pixel}, and was ${pixel}`);
    const before = await page.evaluate(() => scrollY);
    await page.mouse.wheel(0, 100);
    await page.waitForFunction((y) => scrollY > y, before);
    assert.equal(await page.locator('[aria-label="Zoom"] [aria-pressed="true"]').getAttribute('data-value'), '16');
  });
}

// The columns of a screenshot between two shares of its width, without its lower part, where the divider's grip is.
function cropped({width, height, channels, pixels}, from, to) {
  const [x0, x1] = [Math.round(from * width), Math.round(to * width)];
  const rows = Math.floor(0.8 * height);
  const part = new Uint8Array(channels * (x1 - x0) * rows);
  for (let y = 0; y < rows; y++) {
    part.set(pixels.subarray(channels * (y * width + x0), channels * (y * width + x1)), channels * y * (x1 - x0));
  }
  return {width: x1 - x0, height: rows, channels, pixels: part};
}
