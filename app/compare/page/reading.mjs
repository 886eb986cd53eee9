// How to read the page: what the measures and intervals mean.
import {element} from './dom.mjs';
import {formatNumber} from './numbers.mjs';

export function showReading(section, {confidence, repeats}) {
  const times = repeats === 1 ? 'once, with a seed' : `${repeats} times, with seeds`;
  const entries = [
    ['MSE', 'The mean over pixels and colour channels of the squared difference from the reference. Bright pixels ' +
      'decide it.'],
    ['relMSE', 'The same with each difference taken relative to the reference’s pixel (with a small floor against ' +
      'division by zero), so that dark regions count as much as bright ones. Its square root is the relative error: ' +
      'a relMSE of 0.01 is an error of 10 %.'],
    ['FLIP', 'The difference that an observer sees when flipping between picture and reference, from 0 (none) to 1. ' +
      'It knows about contrast, colour and edges, and nothing about expectation: half of it is not twice the work. ' +
      'It is measured at the exposure of the pictures here, with what is brighter than white clipped.'],
    ['Efficiency', 'One over error times seconds. For an unbiased integrator it does not depend on how long it ran: ' +
      'twice the efficiency is the same error in half the time. Stratified samples do a little better the longer they run.'],
    [`The ${formatNumber(100 * confidence)} % intervals`, `Each budget was rendered ${times} of its ` +
      'own; intervals are those of the mean over these repeats by the t distribution, on a logarithmic scale, which is ' +
      'why they reach further up than down. A single repeat has none. A ratio whose interval includes 1 shows no ' +
      'difference.'],
    ['The reference’s own noise', 'The reference was rendered too. Where its variance is known, it is subtracted from ' +
      'MSE and relMSE; what does not stand out from it is called not resolved. From FLIP it cannot be subtracted.'],
    ['Noise and bias', 'Noise averages out, bias does not. The noise is what differs between the repeats, the bias what they ' +
      'have in common, both as roots of their part of relMSE. The bias of integrators that merge photons is their blur, ' +
      'which falls with more samples. The mean against the reference compares whole pictures; the systematic part is ' +
      'the square of the bias at the largest budget.'],
    ['The reference’s own bias', 'Where all integrators without blur miss light, the reference is rendered by one that ' +
      'merges photons, within radii so small that the bias should be below the noise. It is estimated from renders at ' +
      'two radii, one half of the other. Errors below it are not resolved, and it widens intervals.'],
    ['Error over frequencies', 'The power spectrum of the error, relative to the reference as in relMSE, averaged over ' +
      'rings of equal frequency and over repeats. Its integral over all frequencies is relMSE; noise that is independent ' +
      'from pixel to pixel is a level line at relMSE. What falls to the right is correlated between pixels, such as ' +
      'light from shared photons or blur.'],
  ];
  section.append(element('details', {class: 'reading'}, element('summary', {}, 'How to read this page'),
    element('dl', {}, entries.map(([term, text]) => [element('dt', {}, term), element('dd', {}, text)]))));
}
