// Numbers as people write them: at most three significant digits, 1.2 × 10⁻³, an interval beside its value.

const kNone = '–';
const kSpace = '\u00a0';  // a number and its unit stay on one line
const kSuperscripts = '⁰¹²³⁴⁵⁶⁷⁸⁹';

export function isNumber(value) {
  return typeof value === 'number' && Number.isFinite(value);
}

export function superscript(exponent) {
  const digits = [...String(Math.abs(exponent))].map((digit) => kSuperscripts[digit]).join('');
  return (exponent < 0 ? '⁻' : '') + digits;
}

function minus(text) {
  return text.replace('-', '−');
}

// The exponent of the leading digit, after rounding to three digits: 9.999 counts as 10.
function exponentOf(value) {
  return value === 0 ? 0 : Number(Math.abs(value).toExponential(2).split('e')[1]);
}

// Powers of ten that are written out rather than as × 10ⁿ.
function isPlain(exponent) {
  return exponent >= -2 && exponent <= 3;
}

export function formatPower(exponent) {
  return `10${superscript(exponent)}`;
}

export function formatNumber(value) {
  if (!isNumber(value)) return kNone;
  const exponent = exponentOf(value);
  if (isPlain(exponent)) return minus(String(Number(value.toPrecision(3))));
  const mantissa = Number((value / 10 ** exponent).toPrecision(3));
  return minus(`${mantissa}${kSpace}×${kSpace}${formatPower(exponent)}`);
}

// A count, such as samples per pixel: whole, as it was set, unless it is very large.
export function formatCount(value) {
  return Number.isInteger(value) && Math.abs(value) < 1e6 ? String(value) : formatNumber(value);
}

export function formatPercent(fraction) {
  return isNumber(fraction) ? `${formatNumber(100 * fraction)}${kSpace}%` : kNone;
}

// Decimals by the interval's width: a digit that the interval leaves open says nothing.
function decimalsFor(value, low, high, exponent) {
  const width = (high - low) / 10 ** exponent;
  return Math.max(0, (width < 0.15 ? 2 : 1) - (isPlain(exponent) ? exponent : 0));
}

function fixed(value, decimals) {
  const text = value.toFixed(Math.min(decimals, 20));
  const digits = text.replace(/^-?0*\.?0*/, '').replace('.', '').length;
  return minus(digits > 3 && Math.abs(value) >= 1 ? String(Number(value.toPrecision(3))) : text);
}

// {value, low, high} in the parts of "1.2 (1.0 to 1.5) × 10⁻³". `unit` goes after the value of plain numbers, and after
// the power of others.
export function intervalParts(interval, unit = '') {
  if (!interval || !isNumber(interval.value)) return {value: kNone, range: '', power: ''};
  const {value, low, high} = interval;
  if (!isNumber(low) || !isNumber(high)) return {value: formatNumber(value) + unit, range: '', power: ''};
  const size = low < 0 || value === 0 ? Math.max(Math.abs(low), Math.abs(high), Math.abs(value)) : value;
  const exponent = exponentOf(size);
  const decimals = decimalsFor(value, low, high, exponent);
  const scale = isPlain(exponent) ? 1 : 10 ** exponent;
  const [v, l, h] = [value, low, high].map((number) => fixed(number / scale, decimals));
  return {value: v + (scale === 1 ? unit : ''), range: ` (${l} to ${h})`,
    power: scale === 1 ? '' : ` ×${kSpace}${formatPower(exponent)}${unit}`};
}

export function formatInterval(interval, unit) {
  const {value, range, power} = intervalParts(interval, unit);
  return value + range + power;
}

// An interval of fractions, in per cent.
export function inPercent(interval) {
  if (!interval) return null;
  const scaled = (value) => isNumber(value) ? 100 * value : null;
  return {value: scaled(interval.value), low: scaled(interval.low), high: scaled(interval.high)};
}

export function formatSeconds(seconds) {
  if (!isNumber(seconds)) return kNone;
  if (seconds < 1e-7) return `${formatNumber(seconds)}${kSpace}s`;
  if (seconds < 1e-3) return `${formatNumber(1e6 * seconds)}${kSpace}µs`;
  if (seconds < 0.1) return `${formatNumber(1e3 * seconds)}${kSpace}ms`;
  if (seconds < 59.95) return `${formatNumber(seconds)}${kSpace}s`;
  const units = [['min', 60, 's', 1], ['h', 3600, 'min', 60], ['d', 86400, 'h', 3600]];
  for (const [large, inLarge, small, inSmall] of units) {
    const count = Math.round(seconds / inSmall);
    const perLarge = inLarge / inSmall;
    if (large !== 'd' && count >= (large === 'min' ? 3600 : 1440)) continue;
    if (count >= 1000 * perLarge) break;
    const whole = Math.floor(count / perLarge);
    const rest = count % perLarge;
    return `${whole}${kSpace}${large}${rest === 0 ? '' : ` ${rest}${kSpace}${small}`}`;
  }
  return `${formatNumber(seconds / 31557600)}${kSpace}years`;
}

// What a snapshot was given: "16 s" or "64 spp".
export function formatBudget(kind, budget) {
  return kind === 'time' ? formatSeconds(budget) : `${formatCount(budget)}${kSpace}spp`;
}
