// Pictures of a made-up scene, a ball on a table under a lamp, with noise as strong as is asked for.
import {encodePng} from './png.mjs';

// Linear radiance at a point of the picture, u and v in heights from its centre.
function radiance(u, v) {
  const [x, y] = [u + 0.12, v - 0.08];
  const r2 = (x * x + y * y) / 0.09;
  if (r2 < 1) {
    const z = Math.sqrt(1 - r2);
    const lit = Math.max(0, (-0.5 * x - 0.62 * y) / 0.3 + 0.6 * z);
    const glint = Math.exp(-((x + 0.09) ** 2 + (y + 0.12) ** 2) / 0.0006);
    return [0.05 + 0.55 * lit + 6 * glint, 0.04 + 0.3 * lit + 5.4 * glint, 0.03 + 0.16 * lit + 4.5 * glint];
  }
  if (v > 0.16) {  // the table: shadow of the ball, and the caustic in it
    const depth = v - 0.16;
    const lamp = 0.75 / (1 + 6 * ((u + 0.25) ** 2 + (depth - 0.1) ** 2));
    const shadow = 1 - 0.85 * Math.exp(-(((x - 0.2) / 0.3) ** 2 + ((v - 0.39) / 0.08) ** 2));
    const caustic = 2.5 * Math.exp(-(((x - 0.17) / 0.07) ** 2 + ((v - 0.4) / 0.018) ** 2));
    const check = (Math.floor((u * 0.9) / (depth + 0.35) * 5 + 40) + Math.floor(1.6 / (depth + 0.18))) % 2 ? 1 : 0.7;
    const light = lamp * shadow * check + 0.02;
    return [light + caustic, 0.86 * light + 0.8 * caustic, 0.68 * light + 0.5 * caustic];
  }
  const wall = 0.3 / (1 + 3 * ((u + 0.3) ** 2 + (v + 0.35) ** 2)) + 0.01;
  return [0.8 * wall, 0.88 * wall, wall];
}

function toByte(linear) {
  const c = Math.min(1, Math.max(0, linear / (1 + 0.25 * linear)));
  return Math.round(255 * (c <= 0.0031308 ? 12.92 * c : 1.055 * c ** (1 / 2.4) - 0.055));
}

// A small generator of its own, so that a sample is the same each time it is made.
export function makeRandom(seed) {
  let state = seed >>> 0;
  return () => {
    state = (state + 0x9e3779b9) >>> 0;
    let z = state;
    z = Math.imul(z ^ (z >>> 16), 0x21f0aaad);
    z = Math.imul(z ^ (z >>> 15), 0x735a2d97);
    return ((z ^ (z >>> 15)) >>> 0) / 2 ** 32;
  };
}

function dataUri(image) {
  return `data:image/png;base64,${encodePng(image).toString('base64')}`;
}

// The tone-mapped picture, and its error by pixel in the gray levels of `scale`. `noise` is the relative error,
// `gain` the share of the light that is found.
export function samplePictures({width, height, noise, gain, seed, scale}) {
  const random = makeRandom(seed);
  const color = new Uint8Array(3 * width * height);
  const error = new Uint8Array(width * height);
  for (let i = 0; i < width * height; i++) {
    const light = radiance(((i % width) - width / 2) / height, (Math.floor(i / width) - height / 2) / height);
    const local = noise * Math.min(3, 0.25 / (light[0] + 0.1));  // dark places are noisier
    let difference = 0;
    for (let c = 0; c < 3; c++) {
      const gaussian = random() + random() + random() + random() - 2;  // of variance 1/3
      const value = Math.max(0, light[c] * gain * (1 + 1.7 * local * gaussian));
      difference += Math.abs(value - light[c]) / (light[c] + 0.01) / 3;
      color[3 * i + c] = toByte(value);
    }
    const level = 255 * Math.log(Math.max(difference, 1e-9) / scale.lowest) / Math.log(scale.highest / scale.lowest);
    error[i] = Math.round(Math.min(255, Math.max(0, level)));
  }
  return {picture: dataUri({width, height, channels: 3, pixels: color}),
    errorPicture: dataUri({width, height, channels: 1, pixels: error})};
}
