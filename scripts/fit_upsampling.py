#!/usr/bin/env python3
"""Fits the upsampling basis (src/spectral/wavelengths.cpp, kBasis) and prints it in the form of that table.

    scripts/fit_upsampling.py [--check]

The basis is the reflectances of red, green and blue of linear Rec. 709 ([Mallett19]): three functions of the wavelength
with knots every 10 nm from 360 to 830 nm, linear in between. They minimise the sum of the squared differences of
neighbouring knots. Each is within [0, 1], they add up to 1, and the colour of each under D65 is exactly its primary.
Colours are integrals at 1 nm by the trapezoid rule, over the matching functions and the daylight of
src/spectral/cie.cpp, calibrated so that D65 is exactly white.

--check compares the table of the tree with the fit, and fails where they differ by more than 1e-6. It needs numpy and
scipy.
"""
import pathlib
import re
import sys

import numpy
from scipy.optimize import minimize

ROOT = pathlib.Path(__file__).resolve().parent.parent
FIRST, LAST, STEP = 360, 830, 10
WHITE = (0.3127, 0.3290)
PRIMARIES = [(0.64, 0.33), (0.30, 0.60), (0.15, 0.06)]
D65_WEIGHTS = (1, -0.295, -0.689)  # weights of the mean and the characteristic vectors of daylight
TOLERANCE = 1e-6


def rows(text, name, columns):
    """The numbers of the table `name` of a C++ source."""
    body = text[text.index(f' {name} = {{{{') :]
    body = body[: body.index('}};')]
    number = r'(-?[\d.]+)'
    pattern = r'\{' + ', '.join([number] * columns) + r'\}'
    return numpy.array([[float(value) for value in row] for row in re.findall(pattern, body)])


def matching_functions(wavelengths):
    table = rows((ROOT / 'src/spectral/cie.cpp').read_text(), 'kMatching', 3)
    if len(table) != 95:
        sys.exit('the table of matching functions in src/spectral/cie.cpp has not 95 rows')
    position = (wavelengths - FIRST) / 5
    i = numpy.minimum(position.astype(int), 93)
    t = (position - i)[:, None]
    a, b, d, e = (table[numpy.clip(i + k, 0, 94)] for k in (-1, 0, 1, 2))
    return numpy.maximum(b + 0.5 * t * (d - a + t * (2 * a - 5 * b + 4 * d - e + t * (3 * (b - d) + e - a))), 0)


def xyz_of(x, y):
    return numpy.array([x / y, 1, (1 - x - y) / y])


def channel_weights(wavelengths):
    """What a reflectance of 1 at each wavelength adds to red, green and blue under D65."""
    vectors = rows((ROOT / 'src/spectral/cie.cpp').read_text(), 'kDaylight', 3)
    if len(vectors) != 54:
        sys.exit('the table of daylight in src/spectral/cie.cpp has not 54 rows')
    d65 = numpy.interp(wavelengths, 300 + 10 * numpy.arange(54), vectors @ D65_WEIGHTS)
    trapezoid = numpy.ones(len(wavelengths))
    trapezoid[[0, -1]] = 0.5
    weighted = matching_functions(wavelengths) * (d65 * trapezoid)[:, None]
    calibrated = weighted / weighted.sum(axis=0) * xyz_of(*WHITE)
    directions = numpy.array([[x, y, 1 - x - y] for x, y in PRIMARIES]).T
    to_xyz = directions * numpy.linalg.solve(directions, xyz_of(*WHITE))
    return calibrated @ numpy.linalg.inv(to_xyz).T


def fit():
    """Red and blue at the knots, by row."""
    wavelengths = numpy.arange(FIRST, LAST + 1, 1.0)
    knots = numpy.arange(FIRST, LAST + 1, STEP, dtype=float)
    count = len(knots)
    hats = numpy.stack([numpy.interp(wavelengths, knots, unit) for unit in numpy.eye(count)], axis=1)
    of_knots = channel_weights(wavelengths).T @ hats  # colour of a function, from its values at the knots
    # Unknowns: red and green at the knots. Blue is 1 minus both, and its colour follows from theirs.
    nothing = numpy.zeros_like(of_knots)
    colours = numpy.block([[of_knots, nothing], [nothing, of_knots]])
    wanted = numpy.array([1, 0, 0, 0, 1, 0], dtype=float)
    sums = numpy.hstack([numpy.eye(count), numpy.eye(count)])
    difference = numpy.diff(numpy.eye(count), axis=0)

    def roughness(unknowns):
        red, green = unknowns[:count], unknowns[count:]
        of_red, of_green = difference @ red, difference @ green
        of_blue = -of_red - of_green
        gradient = numpy.concatenate([difference.T @ (of_red - of_blue), difference.T @ (of_green - of_blue)])
        return of_red @ of_red + of_green @ of_green + of_blue @ of_blue, 2 * gradient

    result = minimize(
        roughness, numpy.full(2 * count, 1 / 3), jac=True, method='SLSQP', bounds=[(0, 1)] * (2 * count),
        constraints=[
            {'type': 'eq', 'fun': lambda u: colours @ u - wanted, 'jac': lambda u: colours},
            {'type': 'ineq', 'fun': lambda u: 1 - sums @ u, 'jac': lambda u: -sums},
        ], options={'maxiter': 2000, 'ftol': 1e-14})
    if not result.success:
        sys.exit(f'the fit fails: {result.message}')
    red, green = result.x[:count], result.x[count:]
    return numpy.clip(numpy.stack([red, 1 - red - green], axis=1), 0, 1)


def main():
    table = fit()
    if sys.argv[1:] == ['--check']:
        present = rows((ROOT / 'src/spectral/wavelengths.cpp').read_text(), 'kBasis', 2)
        if present.shape != table.shape:
            sys.exit(f'the table of the tree has {len(present)} rows, the fit {len(table)}')
        largest = abs(present - table).max()
        print(f'largest difference {largest:.1e}')
        sys.exit(0 if largest <= TOLERANCE else 1)
    if sys.argv[1:]:
        sys.exit(__doc__)
    for row in table:
        print('    {' + ', '.join(f'{value:.7f}'.rstrip('0').rstrip('.') for value in row) + '},')


if __name__ == '__main__':
    main()
