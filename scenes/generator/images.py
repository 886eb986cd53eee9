"""Image files without libraries: 8-bit PNG and Radiance HDR; and noise to fill them with."""
import math
import struct
import zlib


def write_png(path, width, height, pixel):
    """pixel(x, y) -> tuple of 1, 3 or 4 values in [0,1], encoded as they are (give sRGB values for colours)."""
    rows = bytearray()
    channels = 3
    for y in range(height):
        rows.append(0)
        for x in range(width):
            values = pixel(x, y)
            channels = len(values)
            rows += bytes(min(255, max(0, int(v * 255 + 0.5))) for v in values)
    colour_type = {1: 0, 3: 2, 4: 6}[channels]

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, colour_type, 0, 0, 0)))
        file.write(chunk(b"IDAT", zlib.compress(bytes(rows), 9)) + chunk(b"IEND", b""))


def rgbe(colour):
    largest = max(colour)
    if largest < 1e-32:
        return (0, 0, 0, 0)
    mantissa, exponent = math.frexp(largest)
    scale = mantissa * 256 / largest
    return tuple(min(255, int(c * scale)) for c in colour) + (exponent + 128,)


def write_hdr(path, width, height, pixel):
    """pixel(x, y) -> linear RGB, y counted from the top."""
    data = bytearray(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n" % (height, width))
    for y in range(height):
        row = [rgbe(pixel(x, y)) for x in range(width)]
        data += struct.pack(">BBH", 2, 2, width)
        for channel in range(4):
            values = [p[channel] for p in row]
            data += run_length(values)
    with open(path, "wb") as file:
        file.write(data)


def run_length(values):
    """Runs of 4 or more equal bytes as (128 + count, byte), the rest as (count, bytes…)."""
    out, literal, i = bytearray(), bytearray(), 0

    def flush():
        for k in range(0, len(literal), 128):
            part = literal[k:k + 128]
            out.append(len(part))
            out.extend(part)
        literal.clear()

    while i < len(values):
        run = 1
        while i + run < len(values) and run < 127 and values[i + run] == values[i]:
            run += 1
        if run >= 4:
            flush()
            out.extend((128 + run, values[i]))
            i += run
        else:
            literal.append(values[i])
            i += 1
    flush()
    return out


def equal_area_direction(x, y, size):
    """The direction of a pixel's centre in a square equal-area octahedral map (z is up)."""
    u, v = 2 * (x + 0.5) / size - 1, 2 * (y + 0.5) / size - 1
    signed = 1 - (abs(u) + abs(v))
    r = 1 - abs(signed)
    phi = math.pi / 4 * ((abs(v) - abs(u)) / r + 1) if r > 0 else 0.0
    z = math.copysign(1 - r * r, signed)
    s = r * math.sqrt(2 - r * r)
    return (math.copysign(math.cos(phi), u) * s, math.copysign(math.sin(phi), v) * s, z)


def hash_unit(*integers):
    """A fixed pseudo-random number in [0,1) for a tuple of integers."""
    h = 2166136261
    for i in integers:
        for byte in struct.pack("<q", i):
            h = ((h ^ byte) * 16777619) & 0xffffffff
    h ^= h >> 15
    h = (h * 2246822519) & 0xffffffff
    h ^= h >> 13
    return h / 4294967296


def noise(x, y, period, seed=0):
    """Smooth value noise in [0,1], repeating every `period` (an integer) in both directions."""
    x0, y0 = math.floor(x), math.floor(y)
    fx, fy = x - x0, y - y0
    fx, fy = fx * fx * (3 - 2 * fx), fy * fy * (3 - 2 * fy)
    corner = [[hash_unit((x0 + i) % period, (y0 + j) % period, seed) for i in range(2)] for j in range(2)]
    top = corner[0][0] + fx * (corner[0][1] - corner[0][0])
    bottom = corner[1][0] + fx * (corner[1][1] - corner[1][0])
    return top + fy * (bottom - top)


def fractal_noise(x, y, period, octaves, seed=0):
    total = weight = 0.0
    for i in range(octaves):
        total += noise(x * 2 ** i, y * 2 ** i, period * 2 ** i, seed + i) / 2 ** i
        weight += 1 / 2 ** i
    return total / weight
