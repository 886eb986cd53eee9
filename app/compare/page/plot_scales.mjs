// Domains and ticks of the plots' axes, and where labels at the ends of curves go.
import {formatBudget, formatNumber, formatPower} from './numbers.mjs';

// A domain around positive values for a logarithmic axis, at least `least` wide as a ratio.
export function logDomain(values, least) {
  const lowest = Math.log10(Math.min(...values));
  const highest = Math.log10(Math.max(...values));
  const missing = Math.max(0, Math.log10(least) - (highest - lowest)) / 2;
  const padding = missing > 0 ? missing : 0.06 * (highest - lowest);
  return [10 ** (lowest - padding), 10 ** (highest + padding)];
}

function multiplesOfPowers(domain, multiples) {
  const ticks = [];
  for (let exponent = Math.floor(Math.log10(domain[0])); exponent <= Math.log10(domain[1]); exponent++) {
    for (const multiple of multiples) {
      const tick = Number(`${multiple}e${exponent}`);
      if (tick >= domain[0] && tick <= domain[1]) ticks.push(tick);
    }
  }
  return ticks;
}

// Powers of ten, fewer of them where there are very many; 2 and 5 times these where there are few.
export function logTicks(domain, most) {
  for (const multiples of [[1, 2, 3, 4, 5, 6, 7, 8, 9], [1, 2, 5]]) {
    const ticks = multiplesOfPowers(domain, multiples);
    const decades = Math.log10(domain[1] / domain[0]);
    if (ticks.length <= most && decades < (multiples.length === 3 ? 2.3 : 0.5)) return ticks;
  }
  const powers = multiplesOfPowers(domain, [1]);
  const step = Math.ceil(powers.length / most);
  return powers.filter((tick) => Math.round(Math.log10(tick)) % step === 0);
}

// How the ticks of an axis are written: all as powers of ten where some must be.
export function tickTexts(ticks) {
  const exponentOf = (tick) => Math.round(Math.log10(tick));
  const isPower = (tick) => Math.abs(tick / 10 ** exponentOf(tick) - 1) < 1e-9;
  const asPowers = ticks.every(isPower) && ticks.some((tick) => exponentOf(tick) < -2 || exponentOf(tick) > 3);
  return (tick) => asPowers && exponentOf(tick) !== 0 ? formatPower(exponentOf(tick)) : formatNumber(tick);
}

// Budgets are the best ticks, as nothing was measured between them; only where they would touch they are not used.
export function budgetTicks(budgets, kind, domain, width) {
  const perDecade = width / Math.log10(domain[1] / domain[0]);
  for (let i = 1; i < budgets.length; i++) {
    const room = perDecade * Math.log10(budgets[i] / budgets[i - 1]);
    if (room < 6 * formatBudget(kind, budgets[i]).length + 10) return null;
  }
  return budgets.filter((budget) => budget >= domain[0] && budget <= domain[1]);
}

// Moves wished positions apart until neighbours have `gap` between them, with as little motion as a sweep to either
// side finds, and all between `lowest` and `highest` as far as there is room.
export function spread(wishes, gap, lowest, highest) {
  const order = wishes.map((_, i) => i).sort((a, b) => wishes[a] - wishes[b]);
  const placed = wishes.map((wish) => Math.min(highest, Math.max(lowest, wish)));
  const last = order[order.length - 1];
  for (let round = 0; round < 50; round++) {
    let moved = false;
    for (let k = 1; k < order.length; k++) {
      const [above, below] = [order[k - 1], order[k]];
      const missing = gap - (placed[below] - placed[above]);
      if (missing <= 1e-6) continue;
      placed[above] -= missing / 2;
      placed[below] += missing / 2;
      moved = true;
    }
    if (!moved) break;
    placed[order[0]] = Math.max(lowest, placed[order[0]]);
    placed[last] = Math.min(highest, placed[last]);
  }
  return placed;
}
