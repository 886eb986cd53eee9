#!/usr/bin/env python3
"""Makes docs/speed-and-accuracy.md: runs `lampyr compare` on the scenes of scenes/ and tabulates the results.

    scripts/speed_and_accuracy.py                               all scenes: two hours of two cores
    scripts/speed_and_accuracy.py --scenes pool,lamp --budget 1s,4s
                                                                tables of these scenes, on the terminal

Comparisons run in parallel, each with a single thread, so that seconds are of one core. Reports that are in the work
folder already, by the same binary, of the same files and settings, are not made again; each has a report.html to view.
"""
import argparse
import concurrent.futures
import hashlib
import json
import math
import os
import pathlib
import random
import re
import statistics
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
PEER = ROOT / '../shared/data/peer'
LAMPYR = ROOT / 'build/release/lampyr'
PAGE = ROOT / 'docs/speed-and-accuracy.md'

INTEGRATORS = ['path', 'bdpt', 'light', 'sppm', 'vcm', 'auto']
PEER_SCENES = ['area-box', 'mixed-lights', 'sky-spheres', 'lights600', 'glass-caustic', 'spot-lens', 'pool',
               'mirror-box', 'spectral-ball', 'media-fog', 'media-glass']
RESAMPLINGS = 2000


# --- running ---------------------------------------------------------------------------------------------------------

def hash_of_files(folders):
    """Hash of the names and contents of all files in these folders."""
    total = hashlib.sha256()
    for folder in folders:
        for file in sorted(file for file in folder.rglob('*') if file.is_file()):
            total.update(f'{file.relative_to(folder)} {hashlib.sha256(file.read_bytes()).hexdigest()}\n'.encode())
    return total.hexdigest()


class Job:
    """The comparison of one scene. `table`: own or peer."""

    def __init__(self, table, scene, options, work):
        self.table = table
        self.scene = scene
        self.file = (ROOT / 'scenes' if table == 'own' else PEER) / f'{scene}.pbrt'
        self.folder = work / (scene if table == 'own' else f'peer-{scene}')
        self.integrators = INTEGRATORS
        self.options = options

    def command(self, integrators):
        shown = self.file.relative_to(ROOT) if self.table == 'own' else pathlib.Path(os.path.relpath(self.file, ROOT))
        return [str(LAMPYR.relative_to(ROOT)), 'compare', str(shown), '--integrators', ','.join(integrators),
                *self.options, '-o', str(self.folder)]

    def key(self):
        """The inputs of the report: binary, scene, the files that scenes read, and settings. All files that any scene of
        the table may read count, which is simpler than finding those of one scene."""
        binary = hashlib.sha256(LAMPYR.read_bytes()).hexdigest()
        scene = hashlib.sha256(self.file.read_bytes()).hexdigest()
        folders = [ROOT / 'scenes/data', ROOT / 'scenes/profiles'] if self.table == 'own' else [PEER]
        return ' '.join([binary, scene, hash_of_files(folders), ','.join(self.integrators), *self.options])

    def refused(self, message):
        """The integrator that cannot render the scene, by the message of the command; None: another error."""
        match = re.search(r'--integrators: (\S+): ', message)
        return match.group(1) if match and match.group(1) in self.integrators else None

    def run(self):
        results, kept = self.folder / 'results.json', self.folder / 'key.txt'
        key = self.key()
        if results.exists() and kept.exists() and kept.read_text() == key:
            return json.loads(results.read_text())
        # Results of an interrupted attempt, or of another binary, must not be taken for those of the old key.
        kept.unlink(missing_ok=True)
        integrators = list(self.integrators)
        while True:
            done = subprocess.run(self.command(integrators), cwd=ROOT, capture_output=True, text=True)
            if done.returncode == 0:
                break
            refused = self.refused(done.stderr)
            if refused not in integrators:
                raise RuntimeError(f'{self.scene}: {done.stderr.strip()}')
            integrators.remove(refused)
        if self.key() == key:  # nothing was built or edited meanwhile
            kept.write_text(key)
        return json.loads(results.read_text())


def run_all(jobs, parallel):
    """The results of each job that succeeded, in order, and the errors of the others."""
    results, failures = {}, {}
    with concurrent.futures.ThreadPoolExecutor(parallel) as pool:
        futures = {pool.submit(job.run): job for job in jobs}
        for count, future in enumerate(concurrent.futures.as_completed(futures), 1):
            job = futures[future]
            try:
                results[job] = future.result()
                print(f'[{count}/{len(jobs)}] {job.table} {job.scene}', file=sys.stderr, flush=True)
            except (RuntimeError, OSError, ValueError) as error:
                failures[job] = str(error)
                print(f'[{count}/{len(jobs)}] {job.table} {job.scene}: FAILED\n{error}', file=sys.stderr, flush=True)
    return {job: results[job] for job in jobs if job in results}, failures


# --- numbers ---------------------------------------------------------------------------------------------------------

def digits(value):
    """Two significant digits, no exponent."""
    if value == 0:
        return '0'
    if value >= 10:
        return f'{float(f"{value:.2g}"):.0f}'
    return f'{value:.2g}' if value >= 1e-3 else f'{value:.1e}'


def percent(value):
    return f'{digits(100 * value)} %'


def times(value, low, high):
    bounds = f'{digits(low)} to {digits(high)}' if math.isfinite(high) else f'{digits(low)} or more'
    return f'{digits(value)} × ({bounds})'


def duration(seconds):
    if seconds < 120:
        return f'{digits(seconds)} s'
    return f'{digits(seconds / 60)} min' if seconds < 7200 else f'{digits(seconds / 3600)} h'


def named(results, name):
    return next((i for i in results['integrators'] if i['name'] == name), None)


def last(integrator):
    return integrator['snapshots'][-1]


def has_mean_bias(integrator):
    """True if its picture is significantly too dark or too bright. With few seeds a bias of a third is hardly ever significant
    at p < 0.01: one larger than a twentieth counts if its 95 % interval excludes 0."""
    bias = integrator['meanBias']
    is_large = abs(bias['value']) > 0.05 and bias['low'] * bias['high'] > 0
    return bias['significant'] or is_large


def converges(integrator):
    """True if its picture has no significant bias. Integrators that merge photons are consistent: their bias, which is part
    of their error, falls with more samples."""
    if integrator['blurs']:
        return True
    systematic = integrator['systematic']
    return not has_mean_bias(integrator) and not (systematic['significant'] and systematic['value'] > 0)


def is_measured(integrator, budget=-1):
    return integrator is not None and integrator['snapshots'][budget]['relMse'] is not None


def costs(integrator, budget=-1):
    """relMSE · seconds of every repeat, at a budget, by default the last."""
    return [run['relMse'] * run['seconds'] for run in integrator['snapshots'][budget]['runs']]


def efficiency(results, name):
    integrator = named(results, name)
    return 1 / statistics.fmean(costs(integrator)) if is_measured(integrator) else None


def best_fixed(results):
    """The fixed integrator with the highest efficiency of those that converge, None if there is none."""
    names = [i['name'] for i in results['integrators']
             if i['name'] != 'auto' and converges(i) and is_measured(i) and statistics.fmean(costs(i)) > 0]
    return max(names, key=lambda name: efficiency(results, name), default=None)


# --- intervals -------------------------------------------------------------------------------------------------------

def resampled(values, generator):
    return [generator.choice(values) for _ in values]


def interval_of(samples):
    ordered = sorted(samples)
    at = lambda share: ordered[min(len(ordered) - 1, max(0, round(share * (len(ordered) - 1))))]
    return at(0.025), at(0.975)


def ratio(results, name, against, budget=-1):
    """The efficiency of one over that of another in a scene, with its 95 % interval by the bootstrap over the repeats:
    (value, low, high), None if it was not measured or one of them does not converge."""
    own, other = named(results, name), named(results, against)
    if not (is_measured(own, budget) and is_measured(other, budget) and converges(own) and converges(other)):
        return None
    a, b = costs(own, budget), costs(other, budget)
    if statistics.fmean(a) <= 0 or statistics.fmean(b) <= 0:
        return None
    generator = random.Random(1)
    samples = []
    for _ in range(RESAMPLINGS):
        x, y = statistics.fmean(resampled(a, generator)), statistics.fmean(resampled(b, generator))
        if x > 0 and y > 0:
            samples.append(y / x)
    low, high = interval_of(samples)
    return statistics.fmean(b) / statistics.fmean(a), low, high


def ratio_of_run(results, name, against, generator):
    """The same of resampled repeats."""
    a = statistics.fmean(resampled(costs(named(results, name)), generator))
    b = statistics.fmean(resampled(costs(named(results, against)), generator))
    return b / a if a > 0 and b > 0 else None


def geometric_mean(all_results, name, against):
    """The geometric mean over scenes of the ratio of efficiencies, with its 95 % interval by the bootstrap over scenes
    and, in each, over repeats. `against`: a name, or a function of the results. Returns (value, low, high, scenes), or
    None without a scene."""
    pairs = []
    for results in all_results:
        other = against(results) if callable(against) else against
        value = other and ratio(results, name, other)
        if value:
            pairs.append((results, other, value[0]))
    if not pairs:
        return None
    mean = lambda ratios: math.exp(statistics.fmean(math.log(one) for one in ratios))
    generator = random.Random(2)
    samples = []
    for _ in range(RESAMPLINGS):
        drawn = (ratio_of_run(results, name, other, generator) for results, other, _ in resampled(pairs, generator))
        ratios = [one for one in drawn if one]
        if ratios:
            samples.append(mean(ratios))
    return mean(value for _, _, value in pairs), *interval_of(samples), len(pairs)


# --- tables ----------------------------------------------------------------------------------------------------------

def table(columns, rows):
    return ['| ' + ' | '.join(columns) + ' |', '|' + '---|' * len(columns),
            *('| ' + ' | '.join(row) + ' |' for row in rows)]


def mark(integrator):
    return '' if converges(integrator) else ' †'


def error_cell(integrator):
    if integrator is None:
        return 'refused'
    if not is_measured(integrator):
        return "within the reference's error" + mark(integrator)
    relative = percent(last(integrator)['relMse']['value'] ** 0.5)
    return f'{relative} ({digits(last(integrator)["samplesPerPixel"])} spp){mark(integrator)}'


def error_table(rows, integrators):
    return table(['scene', *integrators],
                 [[scene, *(error_cell(named(results, name)) for name in integrators)] for scene, results in rows])


def efficiency_cell(results, name, best):
    integrator = named(results, name)
    if integrator is None:
        return 'refused'
    if not converges(integrator):
        return '†'
    if name == best:
        return '**1**'
    value = ratio(results, name, best) if best else None
    return times(*value) if value else '–'


def efficiency_table(rows, integrators):
    cells = []
    for scene, results in rows:
        best = best_fixed(results)
        cells.append([scene, best or 'none', *(efficiency_cell(results, name, best) for name in integrators)])
    return table(['scene', 'best fixed', *integrators], cells)


def time_cell(integrator, error):
    if integrator is None:
        return 'refused'
    for entry in integrator['timeToError']:
        if abs(entry['error'] - error) < 1e-9:
            if entry['kind'] in ('never', 'unresolved'):
                return entry['kind']
            return ('~' if entry['kind'] == 'extrapolated' else '') + duration(entry['seconds'])
    return ''


def time_table(rows, integrators, error):
    return table(['scene', *integrators],
                 [[scene, *(time_cell(named(results, name), error) for name in integrators)]
                  for scene, results in rows])


def missing_notes(integrator):
    name, notes = integrator['name'], []
    if has_mean_bias(integrator):
        bias = integrator['meanBias']['value']
        so_far = ' so far' if integrator['blurs'] else ''
        notes.append(f'{name} is {percent(abs(bias))} too {"dark" if bias < 0 else "bright"}{so_far}')
    systematic = integrator['systematic']
    if systematic['significant'] and systematic['value'] > 0:
        error = percent(systematic['value'] ** 0.5)
        notes.append(f'{name} blurs by {error} so far' if integrator['blurs'] else f'{name} stays {error} off')
    return notes


def reference_cells(results):
    reference = results['reference']
    noise = percent(reference['relMse'] ** 0.5) if reference['relMse'] is not None else 'unknown'
    bias = reference['bias']
    blur = 'unknown' if bias is None else 'none' if bias == 0 and not reference['biasIsLimit'] else percent(bias)
    if reference['biasIsLimit']:
        blur = 'at most ' + blur
    return [f'{reference["integrator"]}, {reference["samplesPerPixel"]} spp', noise, blur]


def missing_table(rows):
    cells = []
    for scene, results in rows:
        notes = [note for integrator in results['integrators'] for note in missing_notes(integrator)]
        cells.append([scene, *reference_cells(results), '; '.join(notes) or 'nothing'])
    return table(['scene', 'reference', 'its noise', 'its bias', 'what is missing'], cells)


def auto_table(rows, budgets):
    """`auto` against the best fixed integrator of every scene, at the last budget, and at the first."""
    cells = []
    for scene, results in rows:
        best, auto = best_fixed(results), named(results, 'auto')
        value = ratio(results, 'auto', best) if best else None
        verdict = 'not measured' if value is None else 'wins' if value[1] > 1 else 'loses' if value[2] < 1 else 'even'
        at_first = ratio(results, 'auto', best, 0) if best else None
        cells.append([scene, best or 'none', error_cell(named(results, best)) if best else '–', error_cell(auto),
                      times(*value) if value else '–', verdict, digits(at_first[0]) + ' ×' if at_first else '–'])
    return table(['scene', 'best fixed', 'its error', 'error of auto', 'efficiency of auto over it', 'auto',
                  f'after {budgets[0]}'], cells)


def mean_table(tables):
    """Geometric means of the efficiency of `auto` over that of others."""
    cells = []
    for title, rows, integrators in tables:
        all_results = [results for _, results in rows]
        for against in ['the best fixed', *(name for name in integrators if name != 'auto')]:
            mean = geometric_mean(all_results, 'auto', best_fixed if against == 'the best fixed' else against)
            cells.append([title, against, times(*mean[:3]) if mean else '–', str(mean[3] if mean else 0)])
    return table(['scenes', 'auto against', 'geometric mean of efficiencies', 'scenes where both converge'], cells)


def winners(rows):
    """The best integrator of each scene, and its lead over the next best fixed integrator that converges."""
    wins = {}
    for scene, results in rows:
        best = best_fixed(results)
        if best is None:
            wins.setdefault('none', []).append(scene)
            continue
        others = [(i['name'], ratio(results, best, i['name'])) for i in results['integrators']
                  if i['name'] not in ('auto', best)]
        others = [(name, value) for name, value in others if value]
        if others:
            name, value = min(others, key=lambda pair: pair[1][0])
            shown = '' if value[1] > 1 else ', no difference shown'
            wins.setdefault(best, []).append(f'{scene} ({digits(value[0])} × {name}{shown})')
        else:
            wins.setdefault(best, []).append(f'{scene} (alone)')
    return [f'- `{name}`: {", ".join(scenes)}.' for name, scenes in sorted(wins.items(), key=lambda w: -len(w[1]))]


# --- the page --------------------------------------------------------------------------------------------------------

def section(title, rows, integrators, budget):
    return [
        f'## {title}', '',
        f'### Error after {budget}', '',
        'The root of relMSE, and the samples per pixel that the time was enough for. The time of `auto` includes its pilot.',
        '† does not converge to the reference: see what is missing below.', '',
        *error_table(rows, integrators), '',
        '### Efficiency', '',
        '1/(relMSE · time) over that of the best fixed integrator that converges, with 95 % intervals by the bootstrap over',
        'repeats.', '',
        *efficiency_table(rows, integrators), '',
        'Best of the fixed integrators that converge, and its efficiency over the next best:', '',
        *winners(rows), '',
        '### Time to an error of 10 %', '',
        '~ is beyond what was measured: relMSE is then taken to fall as 1/time; blur falls more slowly.',
        '"never": what is missing is more than that. "unresolved": all errors were within noise and blur of the reference.', '',
        *time_table(rows, integrators, 0.1), '',
        '### Time to an error of 1 %', '',
        *time_table(rows, integrators, 0.01), '',
        '### What more samples do not bring', '',
        'Differences from the reference that are not chance (p < 0.01; of the mean also p < 0.05, if it is above 5 %): of',
        'the mean, and of the pixels, as the root of the part of relMSE that all seeds have in common. Integrators that',
        'merge photons blur; that falls with more samples. The errors of the reference itself are noise, and bias where',
        'photons are merged in it, as roots of relMSE.', '',
        *missing_table(rows), '',
    ]


def few_seeds(repeats):
    if repeats >= 5:
        return []
    return ['Intervals are by the bootstrap over so few seeds, and too narrow where the noise is a few bright pixels: seeds then',
            'differ by a factor of two (caustics of small lamps in `glass-sphere`, `magnifier`, `diamond`, `tea`, `glass-caustic`).',
            '']


def page(tables, options, budgets, failures, skipped):
    budget = budgets[-1]
    first = tables[0][1][0][1]
    lines = [
        '# Speed and accuracy', '',
        'Which integrator wins where, by how much, and what it costs, measured by `lampyr compare` on one thread, in seconds of',
        'the processor. Written by `scripts/speed_and_accuracy.py`, which runs', '',
        '```', 'lampyr compare scenes/NAME.pbrt --integrators ' + ','.join(INTEGRATORS) + ' ' + ' '.join(options) +
        ' -o NAME', '```', '',
        f'and leaves a `report.html` for each scene: convergence plots, the spectra of the errors (section "Error over',
        f'frequencies"), and the pictures side by side. Means of {first["repeats"]} seeds.', '',
        *few_seeds(first['repeats']),
        '## `auto`', '',
        f'Against the fixed integrator that turned out to be the best of the scene, after {budget}, and against the same',
        f'one after {budgets[0]}, of which the pilot takes a larger part. Even: the interval includes 1.', '',
    ]
    for title, rows, _ in tables:
        lines += [f'{title}:', '', *auto_table(rows, budgets), '']
    lines += ['Over all scenes, with 95 % intervals by the bootstrap over scenes and repeats:', '', *mean_table(tables), '']
    for title, rows, integrators in tables:
        lines += section(title, rows, integrators, budget)
    if failures:
        lines += ['## Failed', '', *(f'- {job.table} {job.scene}: {text.splitlines()[-1]}'
                                     for job, text in failures.items()), '']
    if skipped:
        lines += [skipped, '']
    return '\n'.join(lines).rstrip('\n') + '\n'


def aligned(lines):
    """Tables of a page with their columns aligned, for a terminal."""
    cells = [[cell.strip() for cell in line.strip('|').split('|')] for line in lines]
    widths = [max(len(row[i]) for row in cells) for i in range(len(cells[0]))]
    cells = [row for i, row in enumerate(cells) if i != 1]
    return '\n'.join('  '.join(cell.ljust(width) for cell, width in zip(row, widths)).rstrip() for row in cells)


def print_auto(tables, work, budgets):
    for title, rows, _ in tables:
        print(f'\n{title}\n{aligned(auto_table(rows, budgets))}')
    print(f'\n{aligned(mean_table(tables))}')
    print(f'\nconvergence and error spectra: {work}/*/report.html')


# --- the command line ------------------------------------------------------------------------------------------------

def jobs_of(options, wanted, work):
    """The jobs, and a sentence on what is left out."""
    own = sorted(file.stem for file in (ROOT / 'scenes').glob('*.pbrt'))
    has_peer = PEER.is_dir()
    peer = [scene for scene in PEER_SCENES if (PEER / f'{scene}.pbrt').exists()]
    skipped = '' if has_peer else f'The scenes of other renderers were left out: there is no folder {os.path.relpath(PEER, ROOT)}.'
    if wanted:
        known = [*own, *(f'peer-{scene}' for scene in peer)]
        for scene in wanted:
            if scene not in known:
                sys.exit(f'error: --scenes: there is no scene "{scene}"; there are: {", ".join(known)}')
        own = [scene for scene in own if scene in wanted]
        peer = [scene for scene in peer if f'peer-{scene}' in wanted]
    jobs = [Job('own', scene, options, work) for scene in own] + [Job('peer', scene, options, work) for scene in peer]
    return jobs, skipped


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('work', nargs='?', type=pathlib.Path, default=ROOT / 'build/speed-and-accuracy',
                        help='folder of the reports (build/speed-and-accuracy)')
    parser.add_argument('--scenes', default='', help='names of scenes/*.pbrt, and peer-NAME, separated by commas; '
                        'default: all, and the page is written')
    parser.add_argument('--budget', default='2s,10s', help='times, rising (2s,10s)')
    parser.add_argument('--repeats', type=int, default=5, help='renders with other seeds (5)')
    parser.add_argument('--reference-time', default='40s', help='of every scene (40s)')
    parser.add_argument('--resolution', default='160x90', help='of the pictures (160x90)')
    parser.add_argument('--parallel', type=int, default=2, help='comparisons side by side (2)')
    parser.add_argument('--page', action='store_true', help='write the page even if scenes are chosen')
    arguments = parser.parse_args()
    if not LAMPYR.exists():
        sys.exit(f'error: there is no {LAMPYR.relative_to(ROOT)}; build it: cmake --build build/release --target lampyr')
    work = arguments.work.resolve()
    work.mkdir(parents=True, exist_ok=True)
    options = ['--resolution', arguments.resolution, '--budget', arguments.budget, '--repeat', str(arguments.repeats),
               '--reference-time', arguments.reference_time, '--threads', '1', '--cpu-time']
    jobs, skipped = jobs_of(options, [scene for scene in arguments.scenes.split(',') if scene], work)
    results, failures = run_all(jobs, arguments.parallel)
    tables, budgets = [], arguments.budget.split(',')
    for table_name, title in (('own', 'Scenes of this repository'), ('peer', 'Scenes of other renderers')):
        rows = [(job.scene, of) for job, of in results.items() if job.table == table_name]
        if rows:
            tables.append((title, rows, INTEGRATORS))
    if not tables:
        sys.exit('error: no scene was measured')
    print_auto(tables, os.path.relpath(work), budgets)
    if skipped:
        print(skipped)
    if not arguments.scenes or arguments.page:
        PAGE.write_text(page(tables, options, budgets, failures, skipped))
        print(f'{PAGE.relative_to(ROOT)} is written')
    sys.exit(1 if failures else 0)


if __name__ == '__main__':
    main()
