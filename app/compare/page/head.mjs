// The head of the page: scene, verdict, how the reference came about, what was set, hints.
import {element} from './dom.mjs';
import {formatCount, formatNumber, formatPercent, formatSeconds, isNumber} from './numbers.mjs';
import {verdictOf} from './verdict.mjs';

// What the merging of photons has blurred in the reference.
function blurSentence({bias, biasIsLimit, radius}) {
  if (!isNumber(bias) || !(radius > 0)) return '';
  return ` It is blurred by the merging of photons within ${formatNumber(radius)} of the usual radius at first: ` +
    `${biasIsLimit ? 'not told from noise, ' : ''}a bias of ${biasIsLimit ? 'at most ' : ''}${formatPercent(bias)}.`;
}

function referenceSentence(reference) {
  const {origin, file, integrator, samplesPerPixel, seconds, relMse, noiseIsLimit} = reference;
  const how = [];
  if (integrator) how.push(`by ${integrator}`);
  if (isNumber(samplesPerPixel)) how.push(`with ${formatCount(samplesPerPixel)} samples per pixel`);
  if (isNumber(seconds)) how.push(`in ${formatSeconds(seconds)}`);
  const begin = {made: 'The reference was rendered for this comparison',
    cached: 'The reference was rendered for an earlier comparison of this scene',
    given: `The reference, ${file}, was given`}[origin] ?? 'The reference';
  const made = how.length === 0 ? '' : origin === 'given' ? `; it was rendered ${how.join(' ')}` : ` ${how.join(' ')}`;
  const error = isNumber(relMse)
    ? ` Its own noise is a relMSE of ${noiseIsLimit ? 'at most ' : ''}${formatNumber(relMse)}, ` +
      `an error of ${formatPercent(Math.sqrt(relMse))}.`
    : ' It has no variance layers, and is taken as exact.';
  return `${begin}${made}.${error}${blurSentence(reference)}`;
}

function facts(results) {
  const entries = [
    ['Picture', `${results.width} × ${results.height} pixels`],
    ['Longest path', `${results.maxDepth} bounces`],
    ['Repeats', results.repeats === 1 ? 'none' : `${results.repeats} independent`],
    ['Intervals', formatPercent(results.confidence)],
    ['Threads', String(results.threads)],
    ['Scene hash', String(results.sceneHash).slice(0, 12)],
    ['Version', `lampyr ${results.lampyr}`],
  ];
  return element('dl', {class: 'facts'}, entries.map(([term, value]) =>
    element('div', {}, element('dt', {}, term), element('dd', {}, value))));
}

export function showHead(head, results) {
  const {sentences, flaws} = verdictOf(results);
  const hints = results.integrators.flatMap(({name, hints: texts}) =>
    (texts ?? []).map((text) => element('li', {}, element('b', {}, name), `: ${text}`)));
  const names = results.integrators.map(({name}) => name).join(', ');
  head.append(
    element('p', {class: 'overline'}, `Speed against accuracy: ${names}`),
    element('h1', {}, results.scene),
    element('p', {class: 'verdict'}, sentences.join(' ')),
  );
  for (const flaw of flaws) {
    head.append(element('p', {class: 'flaw'}, element('span', {'aria-hidden': 'true'}, '▲ '), flaw));
  }
  head.append(element('p', {class: 'reference'}, referenceSentence(results.reference)));
  if (hints.length > 0) head.append(element('ul', {class: 'hints', 'aria-label': 'Hints'}, hints));
  head.append(facts(results), element('p', {class: 'command'}, element('code', {}, results.command)));
}
