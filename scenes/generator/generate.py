#!/usr/bin/env python3
"""Makes the meshes, images and includes of the scenes in this folder's parent: python3 scenes/generator/generate.py

Only the standard library is needed. The results are part of the repository; the same files come out every time.
"""
import math
import os
import sys

sys.dont_write_bytecode = True

import images
import meshes
from meshes import revolve, rounded_box, rounded_profile, smooth_profile, surface, tube

DATA = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "data")


def path(name):
    return os.path.join(DATA, name)


# Skies ---------------------------------------------------------------------------------------------------------------

def smoothstep(a, b, x):
    t = min(1.0, max(0.0, (x - a) / (b - a)))
    return t * t * (3 - 2 * t)


def mix(a, b, t):
    return tuple(x + (y - x) * t for x, y in zip(a, b))


def write_sky(name, size, sun, sun_degrees, sun_radiance, zenith, horizon, glow, ground):
    """A gradient from horizon to zenith, a glow about the sun, the sun's disk, and the ground below."""
    sun = meshes.normalize(sun)
    cells = 8  # sub-pixels along each side, for the edge of the sun

    def disk(x, y):
        inside = 0
        for j in range(cells):
            for i in range(cells):
                d = images.equal_area_direction(x - 0.5 + (i + 0.5) / cells, y - 0.5 + (j + 0.5) / cells, size)
                inside += sum(a * b for a, b in zip(d, sun)) > math.cos(math.radians(sun_degrees))
        return inside / cells ** 2

    def pixel(x, y):
        d = images.equal_area_direction(x, y, size)
        colour = mix(horizon, zenith, 1 - (1 - max(d[2], 0.0)) ** 3)
        cosine = sum(a * b for a, b in zip(d, sun))
        colour = tuple(c + g * (0.6 * max(cosine, 0.0) ** 12 + 2.0 * max(cosine, 0.0) ** 160) for c, g in zip(colour, glow))
        colour = mix(colour, ground, smoothstep(0.08, -0.25, d[2]))
        if cosine > math.cos(math.radians(sun_degrees + 8)):
            part = disk(x, y)
            colour = tuple(c + part * s for c, s in zip(colour, sun_radiance))
        return colour

    images.write_hdr(path(name), size, size, pixel)


def skies():
    write_sky("sky-noon.hdr", 128, (-0.62, 0.16, 0.80), 10.0, (34, 31.5, 27.5), (0.14, 0.30, 0.66), (0.60, 0.74, 0.92),
              (0.30, 0.26, 0.20), (0.22, 0.24, 0.16))
    write_sky("sky-evening.hdr", 256, (-0.70, -0.10, 0.42), 2.0, (1100, 800, 480), (0.09, 0.18, 0.42),
              (0.52, 0.55, 0.62), (0.85, 0.46, 0.17), (0.30, 0.27, 0.25))


# Textures ------------------------------------------------------------------------------------------------------------

def pool_tiles():
    tiles, size = 8, 256
    cell = size // tiles

    def pixel(x, y):
        i, j = x // cell, y // cell
        edge = min(x % cell, cell - 1 - x % cell, y % cell, cell - 1 - y % cell)
        if edge < 1:
            return (0.86, 0.89, 0.88)
        shade = 0.86 + 0.14 * images.hash_unit(i, j, 1)
        blue = images.hash_unit(i, j, 2)
        return tuple(shade * c for c in mix((0.50, 0.83, 0.84), (0.36, 0.72, 0.82), blue))

    images.write_png(path("pool-tiles.png"), size, size, pixel)


def paving():
    """Flagstones in two rows, half a stone apart: their colour, and the normals of their rounded edges."""
    size, stones = 256, 2
    cell = size // stones

    def stone(x, y):
        row = (y // cell) % stones
        shifted = (x + row * cell // 2) % size
        return shifted // cell, row, shifted % cell, y % cell

    def height(x, y):
        x, y = x % size, y % size
        _, _, u, v = stone(x, y)
        edge = min(u + 0.5, cell - u - 0.5, v + 0.5, cell - v - 0.5)
        rough = images.fractal_noise(x / size * 16, y / size * 16, 16, 4, 11)
        return 5.0 * smoothstep(1.0, 9.0, edge) + 3.0 * rough * smoothstep(2.0, 6.0, edge)

    heights = [[height(x, y) for x in range(size)] for y in range(size)]

    def colour(x, y):
        i, j, u, v = stone(x, y)
        edge = min(u + 0.5, cell - u - 0.5, v + 0.5, cell - v - 0.5)
        tone = images.hash_unit(i, j, 5)
        cloud = images.fractal_noise(x / size * 6, y / size * 6, 6, 5, 3)
        base = mix((0.60, 0.55, 0.49), (0.70, 0.63, 0.53), tone)
        base = tuple(c * (0.78 + 0.36 * cloud) for c in base)
        return mix((0.38, 0.35, 0.31), base, smoothstep(1.0, 5.0, edge))

    def normal(x, y):
        dx = heights[y][(x + 1) % size] - heights[y][x - 1]
        dy = heights[y - 1][x] - heights[(y + 1) % size][x]  # v grows upwards
        n = meshes.normalize((-dx / 2, -dy / 2, 1.0))
        return tuple(0.5 + 0.5 * c for c in n)

    images.write_png(path("paving.png"), size, size, colour)
    images.write_png(path("paving-normal.png"), size, size, normal)


def wood():
    """Planks along x: long streaks, a few rings, dark joints."""
    width, height, planks = 512, 256, 4
    plank = height // planks

    def pixel(x, y):
        row = y // plank
        offset = 37.0 * row
        warp = images.fractal_noise(x / width * 3 + offset, y / height * 6, 64, 3, 20 + row)
        rings = math.sin(2 * math.pi * (5.0 * (y % plank) / plank + 3.5 * warp + row))
        fibre = images.noise(x / width * 10 + offset, y * 0.9, 512, 31)
        colour = mix((0.47, 0.31, 0.19), (0.63, 0.45, 0.29), 0.5 + 0.28 * rings + 0.4 * (fibre - 0.5))
        colour = tuple(c * (0.88 + 0.2 * images.hash_unit(row, 77)) for c in colour)
        joint = min(y % plank, plank - 1 - y % plank)
        return tuple(c * (0.55 if joint < 1 else 1.0) for c in colour)

    images.write_png(path("wood.png"), width, height, pixel)


def screen_pattern():
    """A cut-out of interlaced circles, white where the material is."""
    size = 256

    def pixel(x, y):
        u, v = (x + 0.5) / size, (y + 0.5) / size
        solid = min(u, 1 - u, v, 1 - v) < 0.02
        for cx in (0.0, 0.5, 1.0):
            for cy in (0.0, 0.5, 1.0):
                solid = solid or abs(math.hypot(u - cx, v - cy) - 0.46) < 0.026
        return (1.0,) if solid else (0.0,)

    images.write_png(path("screen.png"), size, size, pixel)


def leaves():
    """A gobo: twigs with leaves, dark before the light, on one side more than on the other."""
    width, height = 320, 240
    state = [7]

    def random():
        state[0] = (state[0] * 1103515245 + 12345) % 2**31
        return state[0] / 2**31

    blades = []
    for twig in range(6):
        x, y, angle = 0.05 + 0.14 * twig * random(), 0.1 + 0.16 * twig, 0.5 * random() - 0.25
        for k in range(11):
            x += 0.075 * math.cos(angle)
            y += 0.075 * math.sin(angle)
            angle += 0.3 * (random() - 0.5)
            turn = angle + (1 if k % 2 else -1) * (0.6 + 0.5 * random())
            length = 0.05 + 0.035 * random()
            blades.append((x + length * math.cos(turn), y + length * math.sin(turn), turn, length, 0.35 * length))

    def covered(u, v):
        for x, y, turn, length, half in blades:
            dx, dy = u - x, v - y
            along = (dx * math.cos(turn) + dy * math.sin(turn)) / length
            if abs(along) < 1:
                across = abs(-dx * math.sin(turn) + dy * math.cos(turn)) / half
                if across < (1 - along * along) * (1 - 0.35 * along):
                    return True
        return False

    cells = 3

    def pixel(x, y):
        dark = sum(covered((x + (i + 0.5) / cells) / height, (y + (j + 0.5) / cells) / height)
                   for i in range(cells) for j in range(cells)) / cells**2
        return (1 - 0.96 * dark,)

    images.write_png(path("leaves.png"), width, height, pixel)


def glazing():
    """A gobo: the window of a lantern, with crossing diagonal bars."""
    size = 128

    def bar(t, period, half):
        return abs((t + period / 2) % period - period / 2) < half

    def pixel(x, y):
        u, v = (x + 0.5) / size - 0.5, (y + 0.5) / size - 0.5
        dark = bar(u + v, 0.25, 0.022) or bar(u - v, 0.25, 0.022)
        return (0.0 if dark else 1.0,)

    images.write_png(path("glazing.png"), size, size, pixel)


def print_chart():
    """A printed chart, black on white, 4.8 x 3: a ruled middle with rings, stars and gratings about it."""
    width, height, cells = 960, 600, 3

    def star(x, y, cx, cy, radius, rays):
        r, angle = math.hypot(x - cx, y - cy), math.atan2(y - cy, x - cx)
        return 0.03 < r < radius and math.sin(rays * angle) > 0

    def rings(x, y, cx, cy, radius, pitch):
        r = math.hypot(x - cx, y - cy)
        return r < radius and (r / pitch) % 1 < 0.5

    def within(x, y, x0, y0, x1, y1):
        return x0 < x < x1 and y0 < y < y1

    def ink(x, y):
        if not within(x, y, 0.14, 0.14, 4.66, 2.86):
            return False
        if not within(x, y, 0.16, 0.16, 4.64, 2.84):
            return True
        if within(x, y, 1.48, 0.68, 3.32, 2.32):  # the ruled middle, a thick line for every fifth
            u, v = x - 1.5, y - 0.7
            thin = min(u % 0.09, v % 0.09) < 0.02
            return thin or min((u + 0.01) % 0.45, (v + 0.01) % 0.45) < 0.04
        if star(x, y, 0.80, 2.18, 0.5, 24) or star(x, y, 4.0, 0.82, 0.5, 24):
            return True
        if rings(x, y, 4.0, 2.18, 0.5, 0.1) or rings(x, y, 0.80, 0.82, 0.5, 0.1):
            return True
        if within(x, y, 1.5, 0.30, 3.3, 0.56):  # gratings, finer to the right
            pitch = 0.12 * 0.75 ** int((x - 1.5) / 0.3)
            return (x - 1.5) % pitch < pitch / 2
        if within(x, y, 1.5, 2.44, 3.3, 2.70):  # squares
            return (int(x / 0.13) + int((y - 2.44) / 0.13)) % 2 == 0
        return False

    def pixel(i, j):
        black = sum(ink(4.8 * (i + (a + 0.5) / cells) / width, 3 - 3 * (j + (b + 0.5) / cells) / height)
                    for a in range(cells) for b in range(cells)) / cells**2
        return (0.90 - 0.86 * black,)

    images.write_png(path("chart.png"), width, height, pixel)


# Meshes --------------------------------------------------------------------------------------------------------------

def water_surface():
    """Waves with wavelengths from 0.4 to 1.3 m whose curvature throws the sun's image about a metre down."""
    waves = []
    for i in range(9):
        k = 2 * math.pi / (0.40 * 3.2 ** (i / 8.0))
        angle = 2 * math.pi * images.hash_unit(i, 901)
        waves.append((k * math.cos(angle), k * math.sin(angle), 0.32 / k ** 1.6, 2 * math.pi * images.hash_unit(i, 902)))

    def point(u, v):
        x, y = -2.02 + 4.04 * u, -1.52 + 3.04 * v
        return (x, y, sum(a * math.sin(kx * x + ky * y + phase) for kx, ky, a, phase in waves))

    surface(point, 108, 81).write(path("water.ply.gz"), with_uv=False)


def pool_furniture():
    def rail(t):
        """Up from the deck, over in a half circle, down into the water: 0.7 + 0.9 + 1.55 metres of tube."""
        s = t * (0.55 + 0.3 * math.pi + 1.45)
        if s < 0.55:
            return (0.0, 0.3, s)
        if s < 0.55 + 0.3 * math.pi:
            angle = (s - 0.55) / 0.3
            return (0.0, 0.3 * math.cos(angle), 0.55 + 0.3 * math.sin(angle))
        return (0.0, -0.3, 0.55 - (s - 0.55 - 0.3 * math.pi))

    tube(rail, 0.022, 90, 14, False, lambda t: (1.0, 0.0, 0.0)).write(path("rail.ply.gz"), with_uv=False)
    rounded_box((4.5, 0.28, 0.07), 0.025).write(path("coping-long.ply.gz"), with_uv=False)
    rounded_box((0.28, 2.98, 0.07), 0.025).write(path("coping-short.ply.gz"), with_uv=False)
    torus(0.42, 0.12, 72, 28).write(path("float.ply.gz"))


def torus(major, minor, columns, rows):
    return surface(lambda u, v: ((major + minor * math.cos(2 * math.pi * v)) * math.cos(2 * math.pi * u),
                                 (major + minor * math.cos(2 * math.pi * v)) * math.sin(2 * math.pi * u),
                                 minor * math.sin(2 * math.pi * v)), columns, rows, True, True)


def rings():
    band = [(0.50, 0.17, 0), (0.50, 0.0, 0.02), (0.55, 0.0, 0.02), (0.55, 0.34, 0.02), (0.50, 0.34, 0.02), (0.50, 0.17, 0)]
    revolve(rounded_profile(band), 160).write(path("band.ply.gz"), with_uv=False)
    torus(0.36, 0.035, 128, 24).write(path("bangle.ply.gz"), with_uv=False)


def cyclorama():
    """A sheet of paper that lies flat and sweeps up at the back: profile along y, extruded along x."""
    def point(u, v):
        s = -4.0 + 11.0 * v
        x = -6.0 + 12.0 * u
        bend, radius = 2.2, 1.2
        if s < bend:
            return (x, s, 0.0)
        angle = min((s - bend) / radius, math.pi / 2)
        rest = max(0.0, s - bend - radius * math.pi / 2)
        return (x, bend + radius * math.sin(angle), radius * (1 - math.cos(angle)) + rest)

    surface(point, 1, 110).write(path("cyclorama.ply.gz"), with_uv=False)


def optics():
    """A biconvex lens about z (radius 0.2, both faces curved with radius 0.5), its mount, a lamp housing, a foot."""
    curvature, radius, edge = 0.5, 0.2, 0.012
    sagitta = curvature - math.sqrt(curvature ** 2 - radius ** 2)
    half_angle = math.asin(radius / curvature)
    center = edge + sagitta - curvature  # height of the upper face's centre of curvature
    steps = 28
    lower = [(curvature * math.sin(half_angle * i / steps), -(center + curvature * math.cos(half_angle * i / steps)),
              math.sin(half_angle * i / steps), -math.cos(half_angle * i / steps)) for i in range(steps + 1)]
    rim = [(radius, -edge, 1.0, 0.0), (radius, edge, 1.0, 0.0)]
    upper = [(r, -z, nr, -nz) for r, z, nr, nz in reversed(lower)]
    revolve(lower + rim + upper, 112).write(path("lens.ply.gz"), with_uv=False)

    mount = [(0.202, 0.0, 0), (0.202, -0.022, 0.006), (0.232, -0.022, 0.006), (0.232, 0.022, 0.006),
             (0.202, 0.022, 0.006), (0.202, 0.0, 0)]
    revolve(rounded_profile(mount, 4), 80).write(path("lens-mount.ply.gz"), with_uv=False)
    housing = [(0.0, -0.30, 0), (0.10, -0.30, 0.04), (0.10, 0.05, 0.006), (0.085, 0.05, 0.006), (0.085, -0.27, 0.03),
               (0.0, -0.27, 0)]
    revolve(rounded_profile(housing, 5), 64).write(path("lamp-housing.ply.gz"), with_uv=False)
    foot = [(0.0, 0.0, 0), (0.13, 0.0, 0.006), (0.13, 0.025, 0.008), (0.03, 0.04, 0.02), (0.0, 0.04, 0)]
    revolve(rounded_profile(foot, 5), 56).write(path("foot.ply.gz"), with_uv=False)


def plinth():
    profile = [(0.0, 0.0, 0), (0.80, 0.0, 0.01), (0.80, 0.45, 0.03), (0.0, 0.45, 0)]
    revolve(rounded_profile(profile), 128).write(path("plinth.ply.gz"), with_uv=False)


def tumbler():
    """A glass of water in three surfaces that share their edges: glass to air, glass to water, water to air."""
    level, top, base = 0.68, 1.0, 0.10
    contact = 0.29 + 0.08 * (level - base) / (top - base)
    segments = 96
    outside = rounded_profile([(0.0, 0.0, 0), (0.32, 0.0, 0.04), (0.40, top, 0.0145), (0.37, top, 0.0145), (contact, level, 0)], 6)
    outside = refine(outside, 0.12)
    inside = refine(rounded_profile([(contact, level, 0), (0.29, base, 0.05), (0.0, base, 0)], 6), 0.12)
    meniscus = smooth_profile([(contact, level), (contact - 0.012, level - 0.012), (contact - 0.04, level - 0.018),
                               (contact - 0.1, level - 0.019), (0.1, level - 0.019), (0.0, level - 0.019)], 4)
    revolve(outside, segments).write(path("tumbler-glass-air.ply.gz"), with_uv=False)
    revolve(inside, segments).write(path("tumbler-glass-water.ply.gz"), with_uv=False)
    revolve(meniscus, segments).write(path("tumbler-water-air.ply.gz"), with_uv=False)


def refine(profile, longest):
    """Straight pieces longer than `longest` in equal parts."""
    result = [profile[0]]
    for a, b in zip(profile, profile[1:]):
        parts = max(1, math.ceil(math.hypot(b[0] - a[0], b[1] - a[1]) / longest))
        for i in range(1, parts + 1):
            t = i / parts
            normal = meshes.normalize((a[2] + (b[2] - a[2]) * t, a[3] + (b[3] - a[3]) * t, 0.0))
            result.append((a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t, normal[0], normal[1]))
    return result


def tableware():
    goblet = smooth_profile([(0.0, 0.0), (0.26, 0.0), (0.33, 0.012), (0.335, 0.03), (0.26, 0.05), (0.08, 0.10),
                             (0.045, 0.20), (0.040, 0.42), (0.06, 0.58), (0.22, 0.70), (0.36, 0.90), (0.39, 1.12),
                             (0.33, 1.42), (0.302, 1.50), (0.294, 1.506), (0.287, 1.50), (0.314, 1.42), (0.368, 1.12),
                             (0.338, 0.91), (0.20, 0.73), (0.08, 0.66), (0.0, 0.645)], 4)
    revolve(goblet, 88).write(path("goblet.ply.gz"), with_uv=False)
    bowl = smooth_profile([(0.0, 0.03), (0.26, 0.03), (0.28, 0.0), (0.32, 0.005), (0.36, 0.06), (0.60, 0.20), (0.78, 0.42),
                           (0.84, 0.60), (0.835, 0.62), (0.815, 0.61), (0.74, 0.43), (0.57, 0.24), (0.32, 0.11), (0.0, 0.09)], 4)
    revolve(bowl, 80).write(path("bowl.ply.gz"), with_uv=False)
    lemon = smooth_profile([(0.0, -0.40), (0.05, -0.385), (0.10, -0.34), (0.22, -0.24), (0.30, -0.08), (0.30, 0.08),
                            (0.22, 0.25), (0.10, 0.35), (0.06, 0.40), (0.0, 0.41)], 5)
    revolve(lemon, 56).write(path("lemon.ply.gz"))


def lamp():
    base = smooth_profile([(0.0, 0.0), (0.060, 0.0), (0.072, 0.006), (0.074, 0.016), (0.066, 0.026), (0.075, 0.06),
                           (0.098, 0.11), (0.095, 0.17), (0.060, 0.22), (0.026, 0.25), (0.018, 0.27), (0.020, 0.285),
                           (0.012, 0.29), (0.0, 0.29)], 5)
    revolve(base, 72).write(path("lamp-base.ply.gz"), with_uv=False)
    shade = rounded_profile([(0.205, 0.32, 0), (0.135, 0.56, 0)])
    revolve(refine(shade, 0.03), 96).write(path("lamp-shade.ply.gz"))
    rounded_box((1.7, 0.62, 0.045), 0.008).write(path("table-top.ply.gz"))
    rounded_box((0.30, 0.21, 0.035), 0.004).write(path("book-large.ply.gz"), with_uv=False)
    rounded_box((0.26, 0.18, 0.026), 0.004).write(path("book-small.ply.gz"), with_uv=False)
    mug = smooth_profile([(0.0, 0.0), (0.030, 0.0), (0.037, 0.004), (0.040, 0.02), (0.041, 0.05), (0.042, 0.088),
                          (0.040, 0.092), (0.0375, 0.088), (0.0365, 0.05), (0.034, 0.015), (0.0, 0.008)], 5)
    revolve(mug, 56).write(path("mug.ply.gz"), with_uv=False)


def sculptures():
    def knot(t):
        a = 2 * math.pi * t
        r = 0.48 + 0.17 * math.cos(3 * a)
        return (r * math.cos(2 * a), r * math.sin(2 * a), 0.22 * math.sin(3 * a))

    tube(knot, 0.085, 240, 24, True, lambda t: (0.0, 0.0, 1.0)).write(path("knot.ply.gz"), with_uv=False)
    vase = smooth_profile([(0.0, 0.0), (0.18, 0.0), (0.205, 0.012), (0.22, 0.05), (0.30, 0.25), (0.34, 0.45), (0.30, 0.68),
                           (0.17, 0.90), (0.13, 1.02), (0.17, 1.13), (0.20, 1.16), (0.19, 1.17), (0.155, 1.13), (0.11, 1.02),
                           (0.14, 0.88), (0.26, 0.66), (0.29, 0.45), (0.0, 0.06)], 5)
    revolve(vase, 88).write(path("vase.ply.gz"), with_uv=False)
    rounded_box((1.5, 1.5, 0.16), 0.02).write(path("slab.ply.gz"), with_uv=False)
    rounded_box((0.62, 0.62, 0.85), 0.015).write(path("pedestal.ply.gz"), with_uv=False)


def courtyard():
    table = [(0.0, 0.0, 0), (0.28, 0.0, 0.01), (0.28, 0.03, 0.015), (0.05, 0.05, 0.03), (0.05, 0.70, 0.02), (0.62, 0.72, 0.008),
             (0.62, 0.75, 0.012), (0.0, 0.75, 0)]
    revolve(rounded_profile(table, 4), 48).write(path("round-table.ply.gz"), with_uv=False)
    pot = [(0.0, 0.0, 0), (0.26, 0.0, 0.02), (0.30, 0.36, 0.015), (0.26, 0.36, 0.015), (0.25, 0.33, 0), (0.0, 0.33, 0)]
    revolve(rounded_profile(pot, 4), 40).write(path("pot.ply.gz"), with_uv=False)
    topiary = [(0.0, 0.60, 0), (0.46, 0.60, 0.12), (0.0, 1.95, 0)]
    revolve(refine(rounded_profile(topiary, 6), 0.2), 40).write(path("topiary.ply.gz"), with_uv=False)


# Includes ------------------------------------------------------------------------------------------------------------

def hue(h):
    """A saturated colour around the wheel, h in [0,1)."""
    channel = lambda shift: min(1.0, max(0.0, abs((h + shift) % 1 * 6 - 3) - 1))
    return tuple(0.012 + 0.988 * channel(shift) ** 1.5 for shift in (0.0, 2 / 3, 1 / 3))


def strings_of_bulbs():
    """25 strings of 40 bulbs from a mast to posts around it, hanging as parabolas; each string has a hue of its own."""
    strings, bulbs, radius = 25, 40, 7.0
    top, end, sag, below = 4.6, 2.7, 0.55, 0.11
    lines = ["# 1000 bulbs on 25 strings, with their cables and posts. Made by generator/generate.py."]
    for i in range(strings):
        angle = 2 * math.pi * (i + 0.5) / strings - math.pi / 2
        c, s = math.cos(angle), math.sin(angle)

        def hang(t):
            return (radius * t * c, radius * t * s, top + (end - top) * t - 4 * sag * t * (1 - t))

        lines.append('Material "diffuse" "rgb reflectance" [ 0.06 0.06 0.07 ]')
        # A parabola is a quadratic curve: raised to the cubic that the file format takes.
        p0, p2 = hang(0.0), hang(1.0)
        p1 = tuple(2 * m - (a + b) / 2 for m, a, b in zip(hang(0.5), p0, p2))
        cubic = [p0, tuple((a + 2 * b) / 3 for a, b in zip(p0, p1)), tuple((2 * b + a) / 3 for a, b in zip(p2, p1)), p2]
        numbers = " ".join("%.4f" % x for p in cubic for x in p)
        lines.append('Shape "curve" "string type" "cylinder" "float width" 0.016 "point3 P" [ %s ]' % numbers)
        lines.append('AttributeBegin Translate %.4f %.4f 0 Shape "cylinder" "float radius" 0.035 "float zmin" 0 "float zmax" 2.75'
                     % (radius * c, radius * s))
        lines.append('Translate 0 0 2.75 Shape "disk" "float radius" 0.035 AttributeEnd')
        base = hue(i / strings)
        for j in range(bulbs):
            p = hang((j + 1.2) / (bulbs + 1.2))
            strength = 30.0 * (0.6 + 0.8 * images.hash_unit(i, j, 7))
            colour = mix(base, hue(images.hash_unit(i, j, 8)), 0.0 if j % 5 else 0.9)
            lines.append('AttributeBegin AreaLightSource "diffuse" "rgb L" [ %s ] Translate %.4f %.4f %.4f Shape "sphere" '
                         '"float radius" 0.05 AttributeEnd'
                         % (" ".join("%.3g" % (strength * x) for x in colour), p[0], p[1], p[2] - 0.06))
    write_lines("bulbs.pbrt", lines)


def rooms():
    """A room of 4 x 4 x 2.6 with doorways to its neighbours and 100 lamps in it, and 10 x 10 of them side by side."""
    lines = ["# A room with 100 lamps, from 0 to 4 in x and y; its other two walls are the neighbours'. Made by",
             "# generator/generate.py."]

    def patch(a, b, c, d):
        lines.append('Shape "bilinearmesh" "point3 P" [ %s ]' % "  ".join("%g %g %g" % p for p in (a, b, c, d)))

    lines.append('Material "diffuse" "rgb reflectance" [ 0.35 0.27 0.20 ]')
    patch((0, 0, 0), (4, 0, 0), (0, 4, 0), (4, 4, 0))
    lines.append('Material "diffuse" "rgb reflectance" [ 0.72 0.70 0.66 ]')
    patch((0, 0, 2.6), (4, 0, 2.6), (0, 4, 2.6), (4, 4, 2.6))
    for from_, to, low, high in ((0, 1.4, 0, 2.6), (2.6, 4, 0, 2.6), (1.4, 2.6, 2.1, 2.6)):  # beside and above a door
        patch((from_, 0, low), (to, 0, low), (from_, 0, high), (to, 0, high))
        patch((0, from_, low), (0, to, low), (0, from_, high), (0, to, high))
    lines.append('Material "diffuse" "rgb reflectance" [ 0.1 0.1 0.1 ]')
    for i in range(100):
        x, y = (0.25 + 3.5 * images.hash_unit(i, k, 21) for k in (0, 1))
        z = 0.04 if i % 4 == 0 else 1.9 + 0.6 * images.hash_unit(i, 2, 21)  # on the floor, or hanging
        radius = 0.012 + 0.02 * images.hash_unit(i, 3, 21)
        strength = 4.0 * 40.0 ** images.hash_unit(i, 4, 21)
        colour = mix((1.0, 0.8, 0.6), hue(images.hash_unit(i, 5, 21)), 0.35)
        lines.append('AttributeBegin AreaLightSource "diffuse" "rgb L" [ %s ] Translate %.3f %.3f %.3f Shape "sphere" '
                     '"float radius" %.4f AttributeEnd'
                     % (" ".join("%.3g" % (strength * c) for c in colour), x, y, z, radius))
    write_lines("room.pbrt", lines)
    lines = ["# 100 rooms. Made by generator/generate.py."]
    for i in range(100):
        lines.append('AttributeBegin Translate %d %d 0 Include "room.pbrt" AttributeEnd' % (4 * (i % 10), 4 * (i // 10)))
    write_lines("rooms.pbrt", lines)


def write_lines(name, lines):
    with open(path(name), "w") as file:
        file.write("\n".join(lines) + "\n")


def grass():
    """A tuft of blades as Bézier curves, rooted in a disk of radius 0.17."""
    lines = ["# A tuft of grass. Made by generator/generate.py."]
    for i in range(420):
        r, a = 0.17 * math.sqrt(images.hash_unit(i, 1)), 2 * math.pi * images.hash_unit(i, 2)
        lean = a + 1.6 * (images.hash_unit(i, 3) - 0.5)
        reach = 0.04 + 1.1 * r + 0.10 * images.hash_unit(i, 4)
        height = 0.55 - 1.1 * r + 0.22 * images.hash_unit(i, 5)
        x, y, c, s = r * math.cos(a), r * math.sin(a), math.cos(lean), math.sin(lean)
        points = [(0, 0), (0.10 * reach, 0.45 * height), (0.45 * reach, 0.95 * height), (1.3 * reach, 0.98 * height - 0.6 * reach)]
        numbers = " ".join("%.4f %.4f %.4f" % (x + c * d, y + s * d, z) for d, z in points)
        lines.append('Shape "curve" "string type" "cylinder" "float width0" 0.009 "float width1" 0.0015 "point3 P" [ %s ]' % numbers)
    write_lines("grass.pbrt", lines)


def twisted_column():
    """A square column that turns as it rises: each side of each storey is one bilinear patch."""
    storeys, points, patches = 7, [], []
    for k in range(storeys + 1):
        size = 0.25 - 0.012 * k
        for j in range(4):
            angle = math.radians(45 + 90 * j + 17 * k)
            points.append((size * math.cos(angle), size * math.sin(angle), 0.125 * k))
    for k in range(storeys):
        for j in range(4):
            a, b = 4 * k + j, 4 * k + (j + 1) % 4
            patches.append((a, b, a + 4, b + 4))
    last = 4 * storeys
    patches.append((last, last + 1, last + 3, last + 2))
    lines = ["# A twisted column of bilinear patches. Made by generator/generate.py.", 'Shape "bilinearmesh"', '  "point3 P" [']
    lines += ["    %.5f %.5f %.5f" % p for p in points]
    lines += ["  ]", '  "integer indices" [ %s ]' % "  ".join(" ".join(map(str, p)) for p in patches)]
    write_lines("twisted-column.pbrt", lines)


def jack():
    """A cube with its faces drawn out into arms: the cage of a subdivision surface."""
    corners = [(x, y, z) for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)]
    points = [tuple(0.13 * c for c in p) for p in corners]
    triangles = []
    for axis in range(3):
        for sign in (-1, 1):
            a, b = (axis + 1) % 3, (axis + 2) % 3
            ring = []
            for da, db in ((-1, -1), (1, -1), (1, 1), (-1, 1)):
                corner = [0, 0, 0]
                corner[axis], corner[a], corner[b] = sign, da, db
                ring.append(corners.index(tuple(corner)))
            if sign < 0:
                ring.reverse()
            tips = []
            for i in ring:
                tip = [1.05 * c for c in points[i]]
                tip[axis] = sign * 0.42
                points.append(tuple(tip))
                tips.append(len(points) - 1)
            for i in range(4):
                j = (i + 1) % 4
                triangles += [(ring[i], ring[j], tips[j]), (ring[i], tips[j], tips[i])]
            triangles += [(tips[0], tips[1], tips[2]), (tips[0], tips[2], tips[3])]
    lines = ["# The cage of a subdivision surface. Made by generator/generate.py.", 'Shape "loopsubdiv" "integer levels" 4',
             '  "point3 P" [']
    lines += ["    %.4f %.4f %.4f" % p for p in points]
    lines += ["  ]", '  "integer indices" [ %s ]' % "  ".join("%d %d %d" % t for t in triangles)]
    write_lines("jack.pbrt", lines)


def handle():
    """The turned handle of a magnifying glass, along z from 0."""
    profile = smooth_profile([(0.0, 0.0), (0.075, 0.0), (0.085, 0.03), (0.075, 0.07), (0.085, 0.2), (0.12, 0.7), (0.115, 1.1),
                              (0.085, 1.42), (0.10, 1.50), (0.095, 1.56), (0.06, 1.60), (0.0, 1.61)], 5)
    revolve(profile, 48).write(path("handle.ply.gz"), with_uv=False)


def brilliant():
    """A round brilliant of radius 1 about z, its girdle's middle at z = 0: 57 facets and a girdle of 16 sides.

    Table 56 % of the diameter, crown 34.5 degrees, pavilion 40.75 degrees, stars half of the crown, lower halves 77 % of the
    pavilion. Stars and halves follow: their corners lie on the edges between neighbouring mains.
    """
    table, star, half = 0.56, 0.5, 0.77
    crown, pavilion, girdle = math.tan(math.radians(34.5)), math.tan(math.radians(40.75)), 0.03
    between = math.cos(math.pi / 8)

    def ring(count, first, radius, z):
        angles = [2 * math.pi * (first + k) / count for k in range(count)]
        return [(radius * math.cos(a), radius * math.sin(a), z) for a in angles]

    star_radius = table * between + star * (1 - table * between)
    points = ring(8, 0, table, girdle + crown * (1 - table))
    points += ring(8, 0.5, star_radius, girdle + crown * (1 - star_radius * between))
    points += ring(16, 0, 1.0, girdle) + ring(16, 0, 1.0, -girdle)
    points += ring(8, 0.5, 1 - half, -girdle - pavilion * (1 - (1 - half) * between))
    points.append((0.0, 0.0, -girdle - pavilion))
    top, stars, above, below, lower, culet = 0, 8, 16, 32, 48, 56
    triangles = [(top, top + k, top + k + 1) for k in range(1, 7)]
    for k in range(8):
        n = (k + 1) % 8
        triangles.append((top + k, stars + k, top + n))
        triangles += [(top + k, above + 2 * k, stars + k), (top + k, stars + (k - 1) % 8, above + 2 * k)]
        triangles += [(culet, lower + k, below + 2 * k), (culet, below + 2 * k, lower + (k - 1) % 8)]
        for j in (2 * k, 2 * k + 1):
            m = (j + 1) % 16
            triangles += [(stars + k, above + j, above + m), (lower + k, below + m, below + j)]
            triangles += [(above + j, below + j, below + m), (above + j, below + m, above + m)]
    lines = ["# A round brilliant. Made by generator/generate.py.", 'Shape "trianglemesh"', '  "point3 P" [']
    lines += ["    %.7f %.7f %.7f" % p for p in points]
    lines += ["  ]", '  "integer indices" [ %s ]' % "  ".join("%d %d %d" % t for t in triangles)]
    write_lines("brilliant.pbrt", lines)


def stack_of_bars():
    """20 instances of the object "storey", each turned a little further."""
    lines = ["# A turning stack of instances. Made by generator/generate.py."]
    for k in range(20):
        lines.append('AttributeBegin Translate 0 0 %.4f Rotate %.2f 0 0 1 ObjectInstance "storey" AttributeEnd'
                     % (0.0402 * k, 4.5 * k))
    write_lines("bars.pbrt", lines)
    rounded_box((0.50, 0.075, 0.02), 0.004, 2).write(path("bar.ply.gz"), with_uv=False)


def main():
    os.makedirs(DATA, exist_ok=True)
    for make in (skies, pool_tiles, paving, wood, screen_pattern, leaves, glazing, water_surface, pool_furniture, rings, cyclorama,
                 optics,
                 plinth, tumbler, tableware, lamp, sculptures, courtyard, strings_of_bulbs, grass, twisted_column, jack,
                 stack_of_bars, rooms,
                 print_chart, handle, brilliant):
        make()


if __name__ == "__main__":
    main()
