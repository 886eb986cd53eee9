// The page in a browser that is offline for all it knows, and everything that goes wrong in it.
import {mkdtempSync, rmSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {pathToFileURL} from 'node:url';
import {chromium} from 'playwright-core';
import {decodePng} from './png.mjs';

const kArguments = ['--no-sandbox', '--disable-gpu', '--disable-quic', '--no-first-run', '--disable-component-update',
  '--disable-background-networking', '--disable-sync', '--force-color-profile=srgb'];

export async function openBrowser() {
  const profile = mkdtempSync(join(tmpdir(), 'lampyr-page-'));
  const context = await chromium.launchPersistentContext(profile, {
    executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium', headless: true, args: kArguments,
    viewport: {width: 1280, height: 900},
  });
  const close = async () => {
    await context.close();
    rmSync(profile, {recursive: true, force: true});
  };
  return {context, close};
}

// Opens the page; `problems` collects what the browser has to say against it.
export async function openPage({context}, file, {width = 1280, height = 900, colorScheme = 'light'} = {}) {
  const url = pathToFileURL(file).href;
  const page = await context.newPage();
  const problems = [];
  page.on('console', (message) => problems.push(`console: ${message.type()}: ${message.text()}`));
  page.on('pageerror', (error) => problems.push(`error: ${error.message}`));
  page.on('request', (request) => {
    if (request.url() !== url && !request.url().startsWith('data:')) problems.push(`request: ${request.url()}`);
  });
  await page.setViewportSize({width, height});
  await page.emulateMedia({colorScheme});
  await page.goto(url);
  await settle(page);
  return {page, problems};
}

// Pictures are decoded after the page has loaded; what is shown says which choice it belongs to.
export async function settle(page) {
  await page.waitForFunction(() => {
    const frame = document.querySelector('.frame');
    if (!frame) return true;
    const pressed = document.querySelector('[aria-label="What is shown"] [aria-pressed="true"]');
    const mode = pressed?.dataset.value ?? 'picture';
    const sides = [...document.querySelectorAll('.sides select')].map((select) => select.value);
    return frame.dataset.shown === [mode, ...sides].join(' ');
  });
  await page.evaluate(() => new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve))));
}

export async function screenshotOf(locator) {
  return decodePng(await locator.screenshot());
}

export function colorAt({width, channels, pixels}, x, y) {
  const at = channels * (y * width + x);
  return channels === 1 ? [pixels[at], pixels[at], pixels[at]] : [...pixels.slice(at, at + 3)];
}

export function farthest(a, b) {
  return Math.max(...a.map((channel, i) => Math.abs(channel - b[i])));
}

// The share of pixels in which two screenshots differ.
export function differingShare(a, b) {
  let count = 0;
  for (let y = 0; y < a.height; y++) {
    for (let x = 0; x < a.width; x++) count += farthest(colorAt(a, x, y), colorAt(b, x, y)) > 0 ? 1 : 0;
  }
  return count / (a.width * a.height);
}

export function decodeDataUri(dataUri) {
  return decodePng(Buffer.from(dataUri.slice(dataUri.indexOf(',') + 1), 'base64'));
}
