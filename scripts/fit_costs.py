#!/usr/bin/env python3
"""Fits the costs of merging in the pilot (render/analysis/pilot_candidates.cpp, Costs) to measured times.

    scripts/fit_costs.py [BINARY]

Renders the scenes of scenes/ at 96×96 by path, bdpt, vcm and sppm on one thread, some three minutes, and searches the
costs of lookups, found and stored photons for which vcm takes the measured times as long as bdpt, with the costs of rays
as they are below; then the cost of the photons that sppm finds, which it does not weight, for sppm against path. Prints
the costs, and the error of the pilot's model: predicted ratios of times over measured ones.
"""
import json
import math
import pathlib
import random
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
SAMPLES = {'path': 24, 'bdpt': 10, 'vcm': 10, 'sppm': 24}
# As in the pilot, nanoseconds. The mix of rays in path and bdpt varies so little between scenes that the times hardly
# determine their separate costs.
RAY, SHADOW_RAY, CONNECTION, CAMERA_PATH_WITH_WEIGHTS, SIDE_BY_SIDE = 260, 350, 530, 1.12, 0.75
MERGING = ['lookup', 'found', 'stored']


def measure(binary, scene, integrator):
    """Counts per sample and nanoseconds per sample, the faster of two renders."""
    best = None
    with tempfile.TemporaryDirectory() as folder:
        for _ in range(2):
            subprocess.run([binary, 'render', scene, '--integrator', integrator, '--spp', str(SAMPLES[integrator]),
                            '--resolution', '96x96', '--threads', '1', '--no-guide-photons', '--no-guide-paths',
                            '--stats', f'{folder}/s.json', '-o', f'{folder}/a.exr', '--quiet'],
                           check=True, stderr=subprocess.DEVNULL)
            stats = json.loads(pathlib.Path(folder, 's.json').read_text())
            if best is None or stats['seconds']['render'] < best['seconds']['render']:
                best = stats
    rays, photons, samples = best['rays'], best.get('photons') or {}, best['samples']
    return {'rays': (rays['camera'] + rays['indirect']) / samples, 'shadow': rays['shadow'] / samples,
            'merging': [photons.get(name, 0) / samples for name in ('lookups', 'found', 'stored')],
            'time': best['seconds']['render'] * 1e9 / samples}


def predicted(scene, merging):
    """Nanoseconds per sample of each integrator, as in CostsOf."""
    path, bdpt = scene['path'], scene['bdpt']
    camera = RAY * path['rays'] + SHADOW_RAY * path['shadow']
    light_rays = max(bdpt['rays'] - path['rays'], 0)
    connections = max(bdpt['shadow'] - path['shadow'], 0)
    both = CAMERA_PATH_WITH_WEIGHTS * camera + SIDE_BY_SIDE * (RAY * light_rays + CONNECTION * connections)
    return {'path': camera, 'bdpt': both,
            'vcm': both + sum(cost * count for cost, count in zip(merging, scene['vcm']['merging']))}


def predicted_sppm(scene, merging, gathered):
    """Nanoseconds per sample of sppm. `gathered`: of a photon that is found."""
    sppm = scene['sppm']
    lookups, found, stored = sppm['merging']
    return (RAY * sppm['rays'] + SHADOW_RAY * sppm['shadow'] + merging[0] * lookups + gathered * found +
            merging[2] * stored)


def ratio_of_sppm(scene, merging, gathered):
    return predicted_sppm(scene, merging, gathered) / predicted(scene, merging)['path'] / (
        scene['sppm']['time'] / scene['path']['time'])


def ratio(scene, merging, a, b):
    """Predicted ratio of the times of two integrators over the measured one."""
    costs = predicted(scene, merging)
    return costs[a] / costs[b] / (scene[a]['time'] / scene[b]['time'])


def loss(merging, scenes):
    return sum(math.log(ratio(scene, merging, 'vcm', 'bdpt')) ** 2 for scene in scenes.values())


def main():
    binary = sys.argv[1] if len(sys.argv) > 1 else str(ROOT / 'build/release/lampyr')
    scenes = {file.stem: {name: measure(binary, str(file), name) for name in SAMPLES}
              for file in sorted((ROOT / 'scenes').glob('*.pbrt'))}
    random.seed(1)
    merging = [200.0, 200.0, 200.0]
    best = loss(merging, scenes)
    for _ in range(20000):
        tried = list(merging)
        tried[random.randrange(3)] *= math.exp(random.gauss(0, 0.1))
        if (value := loss(tried, scenes)) < best:
            best, merging = value, tried
    print(', '.join(f'{name} {cost:.0f}' for name, cost in zip(MERGING, merging)))
    print(f'typical error of vcm over bdpt: {100 * math.sqrt(best / len(scenes)):.0f} %')
    def loss_of_sppm(gathered):
        return sum(math.log(ratio_of_sppm(scene, merging, gathered)) ** 2 for scene in scenes.values())
    gathered = min(range(0, 500, 5), key=loss_of_sppm)
    print(f'gathered {gathered}, typical error of sppm over path: '
          f'{100 * math.sqrt(loss_of_sppm(gathered) / len(scenes)):.0f} %')
    for name, scene in scenes.items():
        print(f'{name:14} bdpt over path {ratio(scene, merging, "bdpt", "path"):.2f}, '
              f'vcm over bdpt {ratio(scene, merging, "vcm", "bdpt"):.2f}, '
              f'sppm over path {ratio_of_sppm(scene, merging, gathered):.2f}')


if __name__ == '__main__':
    main()
