#!/usr/bin/env python3
"""Fits the unit costs of the pilot (render/analysis/pilot.cpp, Costs) to measured times.

    scripts/fit_costs.py [BINARY]

Renders the scenes of scenes/ at 96×96 by path, bdpt, vcm and sppm on one thread, some three minutes, and searches the
costs for which the counted rays, connections and photons give the same ratios of times within each scene. Prints them
with a ray at 260 ns, and what they get wrong: the predicted cost of each integrator over its measured one, relative to
path's.
"""
import glob
import json
import math
import pathlib
import random
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
SAMPLES = {'path': 24, 'bdpt': 10, 'vcm': 8, 'sppm': 12}
NAMES = ['ray', 'shadowRay', 'lookup', 'found', 'stored', 'connection over shadowRay']


def measure(binary, scene, integrator):
    """Counts per sample and nanoseconds per sample, the faster of two renders."""
    best = None
    with tempfile.TemporaryDirectory() as folder:
        for _ in range(2):
            subprocess.run([binary, 'render', scene, '--integrator', integrator, '--spp', str(SAMPLES[integrator]),
                            '--resolution', '96x96', '--threads', '1', '--stats', f'{folder}/s.json', '-o',
                            f'{folder}/a.exr', '--quiet'], check=True, stderr=subprocess.DEVNULL)
            stats = json.loads(pathlib.Path(folder, 's.json').read_text())
            if best is None or stats['seconds']['render'] < best['seconds']['render']:
                best = stats
    rays, photons, samples = best['rays'], best.get('photons') or {}, best['samples']
    counts = [rays['camera'] + rays['indirect'], rays['shadow']]
    counts += [photons.get(name, 0) for name in ('lookups', 'found', 'stored')]
    return [count / samples for count in counts], best['seconds']['render'] * 1e9 / samples


def with_connections(scene):
    """Shadow rays beyond those of path are connections."""
    direct = scene['path'][0][1]
    return {name: (counts + [max(counts[1] - direct, 0) if name in ('bdpt', 'vcm') else 0], time)
            for name, (counts, time) in scene.items()}


def logs(costs, scene):
    return {name: math.log(sum(a * b for a, b in zip(counts, costs)) / time) for name, (counts, time) in scene.items()}


def loss(costs, scenes):
    total = 0
    for scene in scenes.values():
        errors = list(logs(costs, scene).values())
        mean = sum(errors) / len(errors)
        total += sum((error - mean) ** 2 for error in errors)
    return total


def main():
    binary = sys.argv[1] if len(sys.argv) > 1 else str(ROOT / 'build/release/lampyr')
    scenes = {}
    for scene in sorted(glob.glob(str(ROOT / 'scenes/*.pbrt'))):
        scenes[pathlib.Path(scene).stem] = with_connections({name: measure(binary, scene, name) for name in SAMPLES})
    random.seed(1)
    costs = [260.0, 300.0, 250.0, 100.0, 300.0, 100.0]
    best = loss(costs, scenes)
    for _ in range(60000):
        tried = list(costs)
        i = random.randrange(len(costs))
        tried[i] = max(0.0, tried[i] * math.exp(random.gauss(0, 0.2)) + random.gauss(0, 2))
        if (value := loss(tried, scenes)) < best:
            best, costs = value, tried
    costs = [cost * 260 / costs[0] for cost in costs]
    print(', '.join(f'{name} {cost:.0f}' for name, cost in zip(NAMES, costs)))
    for name, scene in scenes.items():
        errors = logs(costs, scene)
        print(f'{name:14}', *(f'{integrator} {math.exp(error - errors["path"]):.2f}'
                              for integrator, error in errors.items()))


if __name__ == '__main__':
    main()
