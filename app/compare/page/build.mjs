// Makes the page's template, one HTML file with style and script inside: node build.mjs OUT.html
//
// Works from whatever folder it lies in, once `npm ci` has run there.
import {build} from 'esbuild';
import {readdir, readFile, writeFile} from 'node:fs/promises';
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
    metafile: true,
  });
  return {text: result.outputFiles[0].text.trim(), inputs: Object.keys(result.metafile.inputs)};
}

// What the page is made with asks for its notice in every copy. All packages of which a file is in the bundle, sorted.
async function licencesOf(inputs) {
  const names = inputs.map((input) => /node_modules\/((?:@[^/]+\/)?[^/]+)\//.exec(input)?.[1]).filter(Boolean);
  const notices = [...new Set(names)].sort().map(async (name) => {
    const place = join(folder, 'node_modules', name);
    const file = (await readdir(place)).find((entry) => /^licen[cs]e/i.test(entry));
    if (!file) throw new Error(`${name} has no licence that the page could show`);
    const {version} = JSON.parse(await readFile(join(place, 'package.json'), 'utf8'));
    return `${name} ${version}\n\n${(await readFile(join(place, file), 'utf8')).trim()}`;
  });
  return (await Promise.all(notices)).join('\n\n\n').replaceAll('&', '&amp;').replaceAll('<', '&lt;');
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
let page = replaceOnce(template, '/*PAGE-STYLE*/', inlineStyle(style.text));
page = replaceOnce(page, '/*PAGE-LICENCES*/', await licencesOf(script.inputs));
page = replaceOnce(page, '/*PAGE-SCRIPT*/', inlineScript(script.text));
for (const placeholder of ['/*LAMPYR-RESULTS*/', '/*LAMPYR-PICTURES*/']) {
  if (page.split(placeholder).length !== 2) throw new Error(`the page must hold ${placeholder} exactly once`);
}
await writeFile(out, page);
