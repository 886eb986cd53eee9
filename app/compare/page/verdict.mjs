// The comparison in plain sentences, each of which the numbers further down carry.
import {formatBudget, formatInterval, formatPercent, isNumber} from './numbers.mjs';
import {includesOne, limitOf, mainBudget, ratioOf, snapshotAt} from './results.mjs';

function times(ratio) {
  return formatInterval(ratio, '\u00a0×');
}

function joinWords(words) {
  return words.length < 2 ? words.join('') : `${words.slice(0, -1).join(', ')} and ${words[words.length - 1]}`;
}

function singleSentence(results, integrator, snapshot, at) {
  if (!snapshot?.relMse) {
    return `At ${at}, the relMSE of ${integrator.name} cannot be told apart from the reference’s own ${limitOf(results)}.`;
  }
  return `At ${at}, ${integrator.name} has a relMSE of ${formatInterval(snapshot.relMse)}.`;
}

// What MSE shows and relMSE does not, or shows the other way round: the rows below say so, and so must the verdict.
function mseSentences(results, ratios, kind, budget) {
  return ratios.flatMap((ratio) => {
    const inMse = ratioOf(results, ratio.integrator, ratio.against, kind, budget, 'mse');
    if (inMse === null || includesOne(inMse)) return [];
    const isBetter = inMse.value > 1;
    if (isBetter && !includesOne(ratio)) return [];
    const better = isBetter ? inMse
      : ratioOf(results, ratio.against, ratio.integrator, kind, budget, 'mse');
    return [`In MSE, ${better.integrator} has ${times(better)} the efficiency of ${better.against}.`];
  });
}

function ratioSentence(results, {kind, budget}, at) {
  const measured = results.integrators
    .map((integrator) => ({integrator, efficiency: snapshotAt(integrator, kind, budget)?.relEfficiency?.value}))
    .filter(({efficiency}) => isNumber(efficiency))
    .sort((a, b) => b.efficiency - a.efficiency);
  const sentences = [];
  if (measured.length > 0) {
    const best = measured[0].integrator.name;
    const ratios = measured.slice(1)
      .map(({integrator}) => ratioOf(results, best, integrator.name, kind, budget, 'relMse'))
      .filter((ratio) => ratio !== null);
    const shown = ratios.filter((ratio) => !includesOne(ratio));
    const open = ratios.filter(includesOne);
    if (shown.length > 0) {
      const clauses = shown.map((ratio, i) =>
        `${times(ratio)} ${i === 0 ? 'the efficiency' : 'that'} of ${ratio.against}`);
      sentences.push(`At ${at}, ${best} has ${joinWords(clauses)} in relMSE.`);
    }
    for (const ratio of open) {
      const begin = shown.length > 0 ? 'Between' : `At ${at}, between`;
      sentences.push(`${begin} ${best} and ${ratio.against} no difference was shown in relMSE: the ratio of their ` +
        `efficiencies is ${times(ratio)}${isNumber(ratio.high) ? '' : ', of a single repeat and so without an interval'}.`);
    }
    sentences.push(...mseSentences(results, ratios, kind, budget));
    if (ratios.length === 0) {
      sentences.push(singleSentence(results, measured[0].integrator,
        snapshotAt(measured[0].integrator, kind, budget), at));
    }
  }
  const unresolved = results.integrators.filter((integrator) => {
    const snapshot = snapshotAt(integrator, kind, budget);
    return snapshot && !snapshot.relMse;
  });
  if (unresolved.length > 0) {
    const begin = sentences.length > 0 ? 'The relMSE' : `At ${at}, the relMSE`;
    sentences.push(`${begin} of ${joinWords(unresolved.map(({name}) => name))} cannot be told apart from the ` +
      `reference’s own ${limitOf(results)}.`);
  }
  return sentences;
}

// What keeps an integrator from reaching the reference, for ever or, where it blurs, for long.
export function flawOf(integrator) {
  const {name, meanBias: bias, systematic, blurs} = integrator;
  if (bias?.significant && isNumber(bias.value)) {
    const [finds, side] = bias.value < 0 ? ['misses light', 'below'] : ['finds too much light', 'above'];
    if (blurs) {
      return `${name} blurs: its mean is ${formatPercent(Math.abs(bias.value))} ${side} the reference; as far as that ` +
        'comes from blur, it falls slowly with more samples.';
    }
    return `${name} ${finds}: its mean is ${formatPercent(Math.abs(bias.value))} ${side} the reference.`;
  }
  if (systematic?.significant && isNumber(systematic.value) && systematic.value > 0) {
    const error = formatPercent(Math.sqrt(systematic.value));
    return blurs ? `${name} blurs: an error of ${error} is common to all repeats, and falls slowly with more samples.`
      : `${name} does not converge to the reference: an error of ${error} remains however many samples it takes.`;
  }
  return null;
}

export function verdictOf(results) {
  const main = mainBudget(results);
  if (main === null) return {sentences: ['No budget was rendered.'], flaws: []};
  const at = formatBudget(main.kind, main.budget);
  const sentences = results.integrators.length === 1
    ? [singleSentence(results, results.integrators[0], snapshotAt(results.integrators[0], main.kind, main.budget), at)]
    : ratioSentence(results, main, at);
  return {sentences, flaws: results.integrators.map(flawOf).filter((flaw) => flaw !== null)};
}
