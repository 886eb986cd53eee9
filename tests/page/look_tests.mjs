// Light and dark, narrow and printed: text can be read, and nothing sticks out.
import assert from 'node:assert/strict';
import {settle} from './browser.mjs';

const kLeastContrast = 4.5;  // of text, by the Web Content Accessibility Guidelines 2, level AA

// The text on the page with the least contrast against the paper.
function faintestText(page) {
  return page.evaluate(() => {
    const context = document.createElement('canvas').getContext('2d', {willReadFrequently: true});
    const channelsOf = (color) => {
      context.clearRect(0, 0, 1, 1);
      context.fillStyle = color;
      context.fillRect(0, 0, 1, 1);
      return [...context.getImageData(0, 0, 1, 1).data];
    };
    const luminance = (color) => {
      const [r, g, b] = channelsOf(color).map((c) => c / 255)
        .map((c) => c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4);
      return 0.2126 * r + 0.7152 * g + 0.0722 * b;
    };
    const paper = luminance(getComputedStyle(document.documentElement).backgroundColor);
    let faintest = {contrast: Infinity, text: '', paper};
    const walker = document.createTreeWalker(document.getElementById('page'), NodeFilter.SHOW_TEXT);
    for (let node = walker.nextNode(); node; node = walker.nextNode()) {
      const parent = node.parentElement;
      if (!node.textContent.trim() || parent.closest('style, script, noscript') || !parent.checkVisibility()) continue;
      const style = getComputedStyle(parent);
      const [a, b] = [luminance(parent.closest('svg') ? style.fill : style.color), paper].sort((x, y) => y - x);
      const contrast = (a + 0.05) / (b + 0.05);
      if (contrast < faintest.contrast) faintest = {contrast, text: node.textContent.trim(), paper};
    }
    return faintest;
  });
}

// How far the page can be scrolled sideways, and what sticks out at the right.
function overflow(page) {
  return page.evaluate(() => {
    const width = document.documentElement.clientWidth;
    const out = [...document.querySelectorAll('#page *')].filter((node) =>
      node.getBoundingClientRect().right > width + 1 && !node.closest('.scroll, svg') && node.checkVisibility());
    return {pixels: document.documentElement.scrollWidth - width,
      out: out.map((node) => `${node.tagName} ${node.className}`).slice(0, 5)};
  });
}

export function testLook(pageTest, results, screenshot) {
  for (const colorScheme of ['light', 'dark']) {
    pageTest(`text can be read: ${colorScheme}`, {colorScheme}, async (page) => {
      await page.locator('.reading summary').click();
      const {contrast, text, paper} = await faintestText(page);
      assert.ok(colorScheme === 'dark' ? paper < 0.05 : paper > 0.85, `the paper's luminance is ${paper}`);
      assert.ok(contrast >= kLeastContrast, `“${text}” has a contrast of ${contrast}`);
    });
  }

  for (const width of [400, 320, 768]) {
    pageTest(`nothing scrolls sideways ${width} pixels wide`, {width}, async (page) => {
      assert.deepEqual(await overflow(page), {pixels: 0, out: []});
      const plots = await page.locator('svg.convergence-plot').evaluateAll((nodes) =>
        nodes.map((node) => node.getBoundingClientRect().width));
      for (const plot of plots) assert.ok(plot > 0.4 * width - 40, `a plot of ${plot} pixels`);
    });
  }

  const onPaper = {width: 700, colorScheme: 'dark'};
  pageTest('printed, it is dark on white, unfolded, without controls', onPaper, async (page) => {
    assert.equal(await page.locator('.reading dl').isVisible(), false);
    await page.emulateMedia({media: 'print', colorScheme: 'dark'});
    await settle(page);
    const {contrast, text, paper} = await faintestText(page);
    assert.ok(paper > 0.99, `the paper's luminance is ${paper}`);
    assert.ok(contrast >= kLeastContrast, `“${text}” has a contrast of ${contrast}`);
    assert.equal(await page.locator('.reading dl').isVisible(), true);
    for (const control of ['.choices', '.swap', '.grip']) {
      for (const one of await page.locator(control).all()) assert.equal(await one.isVisible(), false, control);
    }
    assert.deepEqual(await overflow(page), {pixels: 0, out: []});
  });

  pageTest('a picture of the page', {}, async (page) => {
    if (!screenshot) return;
    await page.screenshot({path: screenshot, fullPage: true});
  });
}
