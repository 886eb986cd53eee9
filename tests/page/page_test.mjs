// The page that lampyr compare writes, as its reader meets it: node --test page_test.mjs
//
// LAMPYR_PAGE is the report.html to test, LAMPYR_SCREENSHOT where its picture goes (none without), CHROMIUM the browser
// (/usr/bin/chromium without). What is expected comes from the results and pictures that are embedded in the page, so
// that any report will do.
import {after, before, test} from 'node:test';
import assert from 'node:assert/strict';
import {readFileSync} from 'node:fs';
import {openBrowser, openPage} from './browser.mjs';
import {testLook} from './look_tests.mjs';
import {testPictures} from './picture_tests.mjs';
import {testPlots} from './plot_tests.mjs';
import {testSpectrum} from './spectrum_tests.mjs';
import {testTables} from './table_tests.mjs';

const file = process.env.LAMPYR_PAGE;
assert.ok(file, 'LAMPYR_PAGE must name the report.html to test');
const html = readFileSync(file, 'utf8');

function embedded(id) {
  const begin = `<script id="${id}" type="application/json">`;
  const from = html.indexOf(begin) + begin.length;
  return JSON.parse(html.slice(from, html.indexOf('</script>', from)));
}

let browser;
before(async () => {
  browser = await openBrowser();
});
after(() => browser?.close());

// A test with the page open in a tab of its own; whatever the browser complains about fails it.
function pageTest(name, options, body) {
  test(name, {timeout: 120000}, async (t) => {
    const {page, problems} = await openPage(browser, file, options);
    try {
      await body(page, t);
      assert.deepEqual(problems, []);
    } finally {
      await page.close();
    }
  });
}

const results = embedded('results');
const pictures = embedded('pictures');

test('the file refers to nothing outside itself', () => {
  const markup = html.replace(/<script[^>]*>[\s\S]*?<\/script>/g, '').replace(/<style>[\s\S]*?<\/style>/g, '');
  assert.doesNotMatch(markup, /\s(?:src|href)="(?!data:)/);
  assert.doesNotMatch(html, /@import|url\(\s*["']?https?:/);
});

testPlots(pageTest, results);
testSpectrum(pageTest, results);
testPictures(pageTest, results, pictures);
testTables(pageTest, results);
testLook(pageTest, results, process.env.LAMPYR_SCREENSHOT);
