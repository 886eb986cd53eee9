// The meaning of an error picture's gray levels, and their colours in a perceptually uniform scale.
import {interpolateInferno} from 'd3-scale-chromatic';
import {element} from './dom.mjs';
import {formatPercent} from './numbers.mjs';

function channels(hex) {
  return [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16));
}

const kColors = Array.from({length: 256}, (_, level) => channels(interpolateInferno(level / 255)));

export class ErrorScale {
  constructor({lowest, highest}) {
    this.lowest = lowest;
    this.highest = highest;
  }

  valueOf(level) {
    return this.lowest * (this.highest / this.lowest) ** (level / 255);
  }

  textOf(level) {
    const text = formatPercent(this.valueOf(level));
    return level === 0 ? `${text} or less` : level === 255 ? `${text} or more` : text;
  }

  // Where on the scale, from 0 to 1, a relative error lies.
  positionOf(error) {
    return Math.log(error / this.lowest) / Math.log(this.highest / this.lowest);
  }

  // The picture of an error picture in false colours.
  colored({width, height, pixels}) {
    const canvas = document.createElement('canvas');
    canvas.width = width;
    canvas.height = height;
    const image = new ImageData(width, height);
    for (let i = 0; i < pixels.length; i += 4) {
      const color = kColors[pixels[i]];
      image.data[i] = color[0];
      image.data[i + 1] = color[1];
      image.data[i + 2] = color[2];
      image.data[i + 3] = 255;
    }
    canvas.getContext('2d').putImageData(image, 0, 0);
    return canvas;
  }

  // The scale with its labels; `mark` shows up to two levels on it, or none.
  legend() {
    const canvas = element('canvas', {width: 256, height: 1, class: 'scale-colors', 'aria-hidden': 'true'});
    const context = canvas.getContext('2d');
    for (const [level, [r, g, b]] of kColors.entries()) {
      context.fillStyle = `rgb(${r} ${g} ${b})`;
      context.fillRect(level, 0, 1, 1);
    }
    const ticks = [];
    const last = Math.floor(Math.log10(this.highest) + 1e-6);
    for (let exponent = Math.ceil(Math.log10(this.lowest) - 1e-6); exponent <= last; exponent++) {
      const error = 10 ** exponent;
      const at = Math.min(1, Math.max(0, this.positionOf(error)));
      const bound = at < 1e-6 ? '≤ ' : at > 1 - 1e-6 ? '≥ ' : '';
      ticks.push(element('span', {class: 'scale-tick', style: `left:${100 * at}%`}, bound + formatPercent(error)));
    }
    const marks = ['left', 'right'].map((side) => element('span', {class: `scale-mark ${side}`, hidden: true}));
    const legend = element('div', {class: 'scale', role: 'img',
      'aria-label': `Colours of relative error, from ${formatPercent(this.lowest)} or less, dark, ` +
        `to ${formatPercent(this.highest)} or more, bright, in steps of ten`},
    element('div', {class: 'scale-bar'}, canvas, marks), element('div', {class: 'scale-ticks'}, ticks));
    legend.mark = (levels) => {
      for (const [i, mark] of marks.entries()) {
        mark.hidden = levels[i] === null || levels[i] === undefined;
        if (!mark.hidden) mark.style.left = `${100 * levels[i] / 255}%`;
      }
    };
    return legend;
  }
}
