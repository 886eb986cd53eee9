// Reads numbers as the page writes them, by code that shares nothing with the page's.

const kSuperscripts = '⁰¹²³⁴⁵⁶⁷⁸⁹';
const kUnits = {'µs': 1e-6, ms: 1e-3, s: 1, min: 60, h: 3600, d: 86400, years: 31557600};

// "1.2 × 10⁻³", "10⁴", "−0.5", also with a unit behind it, which is passed over.
export function readNumber(text) {
  const match = /^\s*(?:~\s*)?([−-]?[\d.]+)?(?:\s*×\s*)?(?:10([⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+))?/u.exec(text.replaceAll('\u00a0', ' '));
  if (!match || (match[1] === undefined && match[2] === undefined)) return NaN;
  // A power alone, 10⁴, is met as the digits 10 with nothing before them.
  const power = /^\s*10[⁻⁰¹²³⁴⁵⁶⁷⁸⁹]/u.test(text);
  const mantissa = power ? 1 : Number(match[1].replace('−', '-'));
  const raised = /10([⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+)/u.exec(text);
  const digits = raised ? [...raised[1]].map((c) => c === '⁻' ? '-' : kSuperscripts.indexOf(c)).join('') : '0';
  return mantissa * 10 ** Number(digits);
}

// {value, low, high} of "1.2 (1.0 to 1.5) × 10⁻³"; the power, where there is one, belongs to all three.
export function readInterval(text) {
  const clean = text.replaceAll('\u00a0', ' ').replaceAll('−', '-');
  const match = /(-?[\d.]+)[^(\d]*\((-?[\d.]+) to (-?[\d.]+)\)/.exec(clean);
  if (!match) return null;
  const raised = /10([⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+)/u.exec(clean);
  const scale = raised ? readNumber(`10${raised[1]}`) : 1;
  const [value, low, high] = match.slice(1).map((number) => Number(number) * scale);
  return {value, low, high};
}

// "2 min 5 s" in seconds.
export function readSeconds(text) {
  const clean = text.replaceAll('\u00a0', ' ').replace(/^~\s*/, '');
  let seconds = 0;
  for (const match of clean.matchAll(/([\d.]+(?: × 10[⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+)?) (µs|ms|s|min|h|d|years)(?![a-z])/gu)) {
    seconds += readNumber(match[1]) * kUnits[match[2]];
  }
  return seconds;
}
