#!/usr/bin/env python3
"""Makes docs/speed-and-accuracy.md: runs `lampyr compare` on the scenes of scenes/ and tells what came out.

    scripts/speed_and_accuracy.py [WORK_FOLDER]

Takes some 25 minutes of both cores of a machine that does nothing else. Reports that are in the work folder already
are not made again; their report.html are there to be looked at.
"""
import json
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
OPTIONS = ['--integrators', 'path,bdpt,light', '--resolution', '384x216', '--budget', '1s,4s', '--repeat', '5',
           '--reference-time', '60s']
SCENES = ['glass-sphere', 'ring', 'pool', 'still-life', 'spot-lens', 'caustics', 'lamp', 'sky', 'lights-1000', 'gallery']


def report(scene, work):
    folder = work / scene
    results = folder / 'results.json'
    known = json.loads(results.read_text()) if results.exists() else None
    if known is None or known['repeats'] < 5 or ' '.join(OPTIONS) not in known['command']:
        subprocess.run([ROOT / 'build/release/lampyr', 'compare', f'scenes/{scene}.pbrt', *OPTIONS, '-o', folder],
                       cwd=ROOT, check=True)
    return json.loads(results.read_text())


def digits(value):
    """Two significant digits, no exponent."""
    if value >= 10:
        return f'{float(f"{value:.2g}"):.0f}'
    return f'{value:.2g}' if value >= 1e-3 else f'{value:.1e}'


def percent(value):
    return f'{digits(100 * value)} %'


def last(integrator):
    return integrator['snapshots'][-1]


def is_complete(integrator):
    """Nothing is missing from its picture that could be told from chance."""
    systematic = integrator['systematic']
    return not integrator['bias']['significant'] and not (systematic['significant'] and systematic['value'] > 0)


def error_cell(integrator):
    estimate = last(integrator)['relMse']
    if not estimate:
        return 'within the reference\'s noise'
    return f'{percent(estimate["value"] ** 0.5)} ({digits(last(integrator)["samplesPerPixel"])} spp)'


def missing_cell(integrator):
    if is_complete(integrator):
        return ''
    notes = []
    if integrator['bias']['significant']:
        bias = integrator['bias']['value']
        notes.append(f'{integrator["name"]} is {percent(abs(bias))} too {"dark" if bias < 0 else "bright"}')
    if integrator['systematic']['significant'] and integrator['systematic']['value'] > 0:
        notes.append(f'{integrator["name"]} stays {percent(integrator["systematic"]["value"] ** 0.5)} off')
    return '; '.join(notes)


def time_cell(integrator, error):
    for time in integrator['timeToError']:
        if abs(time['error'] - error) < 1e-9:
            if time['kind'] in ('never', 'unresolved'):
                return time['kind']
            seconds = time['seconds']
            text = f'{digits(seconds)} s' if seconds < 120 else f'{digits(seconds / 60)} min'
            return ('~' if time['kind'] == 'extrapolated' else '') + text
    return ''


def ratio_text(results):
    """bdpt against path, at the longest time, in relMSE."""
    integrators = {i['name']: i for i in results['integrators']}
    for ratio in results['ratios']:
        if (ratio['integrator'], ratio['metric'], ratio['budget']) == ('bdpt', 'relMse', 4):
            value, low, high = ratio['value'], ratio['low'], ratio['high']
            text = f'{digits(value)} × ({digits(low)} to {digits(high)})'
            if not is_complete(integrators['path']):
                return text + ', and path is not right'
            return text if low > 1 or high < 1 else text + ', no difference shown'
    return ''


def listed(entries):
    return ', '.join(entries) if entries else 'none'


def summary(all_results):
    """Who wins where, by how much, and what it costs."""
    wins, losses, open_, missing, costs = [], [], [], {}, []
    for scene, results in all_results.items():
        integrators = {i['name']: i for i in results['integrators']}
        for integrator in results['integrators']:
            if not is_complete(integrator):
                missing.setdefault(integrator['name'], []).append(scene)
        costs.append(last(integrators['path'])['samplesPerPixel'] / last(integrators['bdpt'])['samplesPerPixel'])
        if not (is_complete(integrators['path']) and is_complete(integrators['bdpt'])):
            continue
        for ratio in results['ratios']:
            if (ratio['integrator'], ratio['metric'], ratio['budget']) != ('bdpt', 'relMse', 4):
                continue
            if ratio['low'] > 1:
                wins.append((ratio['value'], scene))
            elif ratio['high'] < 1:
                losses.append((1 / ratio['value'], scene))
            else:
                open_.append(scene)
    text = lambda pairs: listed([f'{scene} ({digits(value)} ×)' for value, scene in sorted(pairs, reverse=True)])
    undecided = f' No difference was shown in {listed(open_)}.' if open_ else ''
    lines = [
        f'- `bdpt` has the higher efficiency in {text(wins)}; `path` in {text(losses)}.{undecided}',
        f'- A sample of `bdpt` takes {digits(min(costs))} to {digits(max(costs))} times as long as one of `path`: what it '
        'wins, it wins by samples that are worth more.',
    ]
    for name, scenes in missing.items():
        lines.append(f'- `{name}` does not get to the right picture in {listed(scenes)}.')
    return lines


def write(all_results):
    first = next(iter(all_results.values()))
    lines = [
        '# Speed and accuracy',
        '',
        'Which integrator wins where, by how much, and what it costs: the scenes of `scenes/`, measured by',
        f'`lampyr compare` on {first["threads"]} threads. Written by `scripts/speed_and_accuracy.py`, which runs',
        '',
        '```',
        'lampyr compare scenes/NAME.pbrt ' + ' '.join(OPTIONS) + ' -o NAME',
        '```',
        '',
        'and leaves a `report.html` for each scene, with convergence plots and the pictures side by side.',
        '',
        '## In short',
        '',
        *summary(all_results),
        '',
        '## Error after four seconds',
        '',
        'The root of relMSE, over five seeds, and the samples per pixel that the time was enough for. The last column is',
        'the efficiency, 1/(relMSE · time), of `bdpt` over that of `path`, with its 95 % interval.',
        '',
        '| scene | path | bdpt | light | bdpt against path |',
        '|---|---|---|---|---|',
    ]
    for scene, results in all_results.items():
        integrators = {i['name']: i for i in results['integrators']}
        cells = []
        for name in ('path', 'bdpt', 'light'):
            cell = error_cell(integrators[name])
            cells.append(cell if is_complete(integrators[name]) else cell + ' †')
        lines.append(f'| {scene} | ' + ' | '.join(cells) + f' | {ratio_text(results)} |')
    lines += [
        '',
        '† does not converge to the reference: see what is missing below.',
        '',
        '## Time to an error',
        '',
        'Until the root of relMSE is at 10 % and at 1 %. ~ is beyond what was measured: relMSE is then taken to fall as',
        '1/time. "never": what is missing is more than that.',
        '',
        '| scene | path, 10 % | bdpt, 10 % | light, 10 % | path, 1 % | bdpt, 1 % | light, 1 % |',
        '|---|---|---|---|---|---|---|',
    ]
    for scene, results in all_results.items():
        integrators = {i['name']: i for i in results['integrators']}
        cells = [time_cell(integrators[name], error) for error in (0.1, 0.01) for name in ('path', 'bdpt', 'light')]
        lines.append(f'| {scene} | ' + ' | '.join(cells) + ' |')
    lines += [
        '',
        '## What more samples do not bring',
        '',
        'Differences from the reference that are not chance (p < 0.01): of the mean, and of the pixels, as the root of the',
        'part of relMSE that all seeds have in common.',
        '',
        '| scene | reference | its own error | what is missing |',
        '|---|---|---|---|',
    ]
    for scene, results in all_results.items():
        reference = results['reference']
        missing = '; '.join(filter(None, (missing_cell(i) for i in results['integrators'])))
        lines.append(f'| {scene} | {reference["integrator"]}, {reference["samplesPerPixel"]} spp | '
                     f'{percent(reference["relMse"] ** 0.5)} | {missing or "nothing"} |')
    text = '\n'.join(lines) + '\n'
    (ROOT / 'docs/speed-and-accuracy.md').write_text(text)


def main():
    work = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ROOT / 'build/speed-and-accuracy').resolve()
    work.mkdir(parents=True, exist_ok=True)
    write({scene: report(scene, work) for scene in SCENES})


if __name__ == '__main__':
    main()
