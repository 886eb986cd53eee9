// The section of pictures: what stands left and right of the divider, picture or error, zoom, readout.
import {choiceRow, element} from './dom.mjs';
import {ErrorScale} from './error_scale.mjs';
import {formatBudget, formatCount, formatInterval, formatNumber, formatSeconds, isNumber} from './numbers.mjs';
import {PictureStore} from './picture_store.mjs';
import {kZooms, PictureView} from './picture_view.mjs';
import {limitOf, mainBudget, snapshotName, snapshotsOf} from './results.mjs';

const kSides = ['left', 'right'];

// Everything that can stand at a side: {id, name, group, caption, picture, errorPicture, integrator, budget}.
function entriesOf(results, store) {
  const entries = [];
  if (store.has('reference')) {
    const {integrator, samplesPerPixel} = results.reference;
    const made = [integrator, isNumber(samplesPerPixel) ? `${formatCount(samplesPerPixel)} spp` : null].filter(Boolean);
    entries.push({id: 'reference', name: 'Reference', group: null, caption: made.join(', '), picture: 'reference',
      errorPicture: null});
  }
  for (const {integrator, snapshot} of snapshotsOf(results)) {
    if (!store.has(snapshot.picture)) continue;
    const parts = [formatSeconds(snapshot.seconds), `${formatNumber(snapshot.samplesPerPixel)} spp`,
      snapshot.relMse ? `relMSE ${formatInterval(snapshot.relMse)}`
        : `error within the reference’s own ${limitOf(results)}`];
    entries.push({id: snapshot.picture, name: snapshotName(integrator, snapshot), group: integrator.name,
      caption: parts.join(' · '), picture: snapshot.picture, integrator: integrator.name,
      budget: `${snapshot.kind} ${snapshot.budget}`, budgetText: formatBudget(snapshot.kind, snapshot.budget),
      errorPicture: store.has(snapshot.errorPicture) ? snapshot.errorPicture : null});
  }
  return entries;
}

// The first two integrators at the budget that says most; where there is only one, against the reference.
function firstPair(results, entries) {
  const main = mainBudget(results);
  const rendered = entries.filter(({integrator}) => integrator);
  const atMain = rendered.filter(({budget}) => main && budget === `${main.kind} ${main.budget}`);
  const candidates = [...atMain, ...entries.filter(({id}) => id === 'reference'), ...rendered.reverse()];
  const left = candidates[0];
  return [left, candidates.find(({id, integrator}) => id !== left.id && integrator !== left.integrator) ?? left];
}

function sideSelect(side, entries) {
  const options = (group) => entries.filter((entry) => entry.group === group)
    .map(({id, name}) => element('option', {value: id}, name));
  const groups = [...new Set(entries.map(({group}) => group))];
  return element('select', {id: `side-${side}`, 'aria-label': `Picture at the ${side}`}, groups.map((group) =>
    group === null ? options(null) : element('optgroup', {label: group}, options(group))));
}

class PictureSection {
  constructor(section, results, store, entries) {
    this.store = store;
    this.entries = entries;
    this.scale = new ErrorScale(results.errorScale);
    this.mode = 'picture';
    this.shown = [null, null];
    this.turn = 0;
    this.pair = firstPair(results, entries);
    this.build(section, results);
    this.update();
  }

  build(section, results) {
    this.selects = kSides.map((side) => sideSelect(side, this.entries));
    this.captions = kSides.map(() => element('p', {class: 'side-caption'}));
    for (const [i, select] of this.selects.entries()) {
      select.addEventListener('change', () => {
        this.pair[i] = this.entries.find(({id}) => id === select.value);
        this.update();
      });
    }
    this.view = new PictureView(results.width, results.height, {
      moved: (share) => this.dim(share),
      pointed: (pixel) => this.point(pixel),
      zoomed: (zoom) => this.zooms.show(zoom),
    });
    const modes = [{value: 'picture', text: 'Picture'}, {value: 'error', text: 'Error'}];
    this.modes = choiceRow('What is shown', modes, this.mode, (mode) => {
      this.mode = mode;
      this.update();
    });
    this.zooms = choiceRow('Zoom', [{value: 'fit', text: 'Fit'},
      ...kZooms.map((zoom) => ({value: zoom, text: `${zoom}×`, label: `${zoom} times`}))], 'fit',
    (zoom) => this.view.setZoom(zoom));
    const swap = element('button', {type: 'button', class: 'swap', 'aria-label': 'Swap left and right', onclick: () => {
      this.pair.reverse();
      this.update();
    }}, '⇄');
    const sides = kSides.map((side, i) => element('div', {class: `side ${side}`}, this.selects[i], this.captions[i]));
    this.readout = element('p', {class: 'readout'});
    this.legend = this.scale.legend();
    const hasErrors = this.entries.some(({errorPicture}) => errorPicture);
    section.append(
      element('div', {class: 'bar'}, hasErrors ? this.modes : null, this.budgetChoices(), this.zooms),
      element('div', {class: 'sides'}, sides[0], swap, sides[1]),
      this.view.frame,
      element('div', {class: 'under-view'}, this.readout, this.legend),
      element('p', {class: 'caption'}, 'Drag the divider, or move it with the arrow keys. Ctrl and the wheel zoom; ' +
        'when zoomed, drag to move. Pictures are tone-mapped; errors are measured before that, relative to the ' +
        'reference.'),
    );
    this.point(null);
  }

  // One budget for both sides, to step through the convergence.
  budgetChoices() {
    const rendered = this.entries.filter(({integrator}) => integrator);
    const budgets = [...new Map(rendered.map((entry) => [entry.budget, entry.budgetText]))];
    if (budgets.length < 2) return null;
    const choices = budgets.map(([value, text]) => ({value, text}));
    this.budgets = choiceRow('Budget of both sides', choices, null, (budget) => {
      this.pair = this.pair.map((entry) => rendered.find((other) => other.integrator === entry.integrator &&
        other.budget === budget) ?? entry);
      this.update();
    });
    return this.budgets;
  }

  // The name of the side that is wholly covered is dimmed.
  dim(share) {
    this.selects?.forEach((_, i) => {
      this.captions[i].parentElement?.classList.toggle('covered', i === 0 ? share <= 0 : share >= 1);
    });
  }

  async update() {
    const turn = ++this.turn;
    for (const [i, {id, caption, errorPicture}] of this.pair.entries()) {
      this.selects[i].value = id;
      const noError = this.mode === 'error' && !errorPicture;
      this.captions[i].textContent = noError ? `${caption}${caption ? ' · ' : ''}shown as picture` : caption;
    }
    const budgets = new Set(this.pair.filter(({integrator}) => integrator).map(({budget}) => budget));
    this.budgets?.show(budgets.size === 1 ? [...budgets][0] : null);
    this.legend.classList.toggle('idle', this.mode !== 'error');
    const load = (key) => this.store.get(key).catch(() => null);
    const sides = await Promise.all(this.pair.map(async ({picture, errorPicture}) => {
      const [shown, error] = await Promise.all([load(picture), load(errorPicture)]);
      return {shown, error};
    }));
    if (turn !== this.turn) return;  // another choice was made meanwhile
    this.shown = sides;
    this.view.setSides(...sides.map(({shown, error}) => {
      if (this.mode === 'error' && error) return this.scale.colored(error);
      return shown?.canvas ?? null;
    }));
    this.view.frame.dataset.shown = `${this.mode} ${this.pair.map(({id}) => id).join(' ')}`;
    this.point(this.pointed);
  }

  point(pixel) {
    this.pointed = pixel;
    if (!pixel || !this.shown[0]) {
      this.legend.mark([]);
      this.readout.replaceChildren(element('span', {class: 'idle'}, 'Point at the pictures to read a pixel.'));
      return;
    }
    const levels = [];
    const parts = this.shown.map(({shown, error}, i) => {
      const at = (image) => 4 * (pixel.y * image.width + pixel.x);
      const isInside = (image) => image && pixel.x < image.width && pixel.y < image.height;
      const values = [];
      levels.push(isInside(error) ? error.pixels[at(error)] : null);
      if (this.mode === 'picture' && isInside(shown)) {
        values.push([...shown.pixels.slice(at(shown), at(shown) + 3)].join(' '));
      }
      if (levels[i] !== null) values.push(`error ${this.scale.textOf(levels[i])}`);
      return element('span', {class: `value ${kSides[i]}`}, element('b', {}, this.pair[i].name), ' ',
        values.join(' · ') || '–');
    });
    this.legend.mark(this.mode === 'error' ? levels : []);
    this.readout.replaceChildren(element('span', {class: 'position'}, `${pixel.x}, ${pixel.y}`), ...parts);
  }
}

export function showPictures(section, results, pictures) {
  const store = new PictureStore(pictures);
  const entries = entriesOf(results, store);
  if (entries.length === 0) {
    section.append(element('p', {class: 'caption'}, 'No pictures were kept.'));
    return;
  }
  return new PictureSection(section, results, store, entries);
}
