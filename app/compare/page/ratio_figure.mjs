// A ratio with its interval on a small logarithmic line with a mark at 1, beside the numbers of a table.
import {svgElement} from './dom.mjs';
import {includesOne} from './results.mjs';
import {isNumber} from './numbers.mjs';

const kWidth = 180;
const kHeight = 18;

// The figures of one table share their scale: `furthest` is the largest |log₁₀| of any bound.
export function furthestOf(ratios) {
  const logs = ratios.flatMap(({value, low, high}) => [value, low, high])
    .filter((bound) => isNumber(bound) && bound > 0).map((bound) => Math.abs(Math.log10(bound)));
  return Math.max(0.1, ...logs);
}

export function ratioFigure(ratio, furthest) {
  const place = (value) => kWidth / 2 + (kWidth / 2 - 8) * Math.log10(value) / furthest;
  const middle = kHeight / 2;
  const figure = svgElement('svg', {class: includesOne(ratio) ? 'ratio open' : 'ratio', width: kWidth, height: kHeight,
    viewBox: `0 0 ${kWidth} ${kHeight}`, 'aria-hidden': 'true'},
  svgElement('line', {class: 'ratio-axis', x1: 0, x2: kWidth, y1: middle, y2: middle}),
  svgElement('line', {class: 'ratio-one', x1: kWidth / 2, x2: kWidth / 2, y1: 1, y2: kHeight - 1}));
  if (ratio.low > 0 && ratio.high > 0) {
    figure.append(svgElement('line', {class: 'ratio-interval', x1: place(ratio.low), x2: place(ratio.high), y1: middle,
      y2: middle}));
  }
  figure.append(svgElement('circle', {class: 'ratio-value', cx: place(ratio.value), cy: middle, r: 3.25}));
  return figure;
}
