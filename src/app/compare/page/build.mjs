// Makes the page's template, one HTML file with style and script inside: node build.mjs OUT.html
//
// Works from whatever folder it lies in, once `npm ci` has run there.
import {build} from 'esbuild';
import {readFile, writeFile} from 'node:fs/promises';
import {dirname, join} from 'node:path';
import {fileURLToPath} from 'node:url';

const folder = dirname(fileURLToPath(import.meta.url));

async function bundle(entry) {
  const result = await build({
    entryPoints: [join(folder, entry)],
    absWorkingDir: folder,
    bundle: true,
    minify: true,
    write: false,
    format: 'iife',
    target: ['chrome109', 'firefox115', 'safari16'],
    charset: 'utf8',
    legalComments: 'none',
    logLevel: 'warning',
  });
  return result.outputFiles[0].text.trim();
}

function replaceOnce(text, placeholder, content) {
  const parts = text.split(placeholder);
  if (parts.length !== 2) throw new Error(`page.html must hold ${placeholder} once, not ${parts.length - 1} times`);
  return parts[0] + content + parts[1];  // not String.replace, to which $ in the content has a meaning
}

// What ends an inlined element, or opens what HTML reads differently in a script, must not be in its text. In
// JavaScript these can only be parts of strings, templates and regular expressions, where \u003c says the same.
function inlineScript(text) {
  return text.replace(/<(?=\/script|script|!--)/gi, '\\u003c');
}

function inlineStyle(text) {
  if (/<\/style/i.test(text)) throw new Error('the style sheet holds the end of its own element');
  return text;
}

const out = process.argv[2];
if (!out) throw new Error('usage: node build.mjs OUT.html');

const [template, style, script] = await Promise.all([
  readFile(join(folder, 'page.html'), 'utf8'), bundle('page.css'), bundle('main.mjs'),
]);
let page = replaceOnce(template, '/*PAGE-STYLE*/', inlineStyle(style));
page = replaceOnce(page, '/*PAGE-SCRIPT*/', inlineScript(script));
for (const placeholder of ['/*LAMPYR-RESULTS*/', '/*LAMPYR-PICTURES*/']) {
  if (page.split(placeholder).length !== 2) throw new Error(`the page must hold ${placeholder} exactly once`);
}
await writeFile(out, page);
