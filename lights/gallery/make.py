#!/usr/bin/env python3
"""Makes the pictures of lights/README.md: one small scene per light, rendered by lampyr, as PNG beside this file.

  lights/gallery/make.py            all of them
  lights/gallery/make.py rect dome  some of them

Needs nothing but Python's standard library; the scenes, the images that they use and the renders go to a folder of
their own that is removed again.
"""
import math
import pathlib
import struct
import subprocess
import sys
import tempfile
import zlib

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent

CAMERA = """Scale -1 1 1
LookAt 0 -5.2 2.1  0 0.6 0.85  0 0 1
Camera "perspective" "float fov" 36
Film "rgb" "integer xresolution" 264 "integer yresolution" 176
Sampler "zsobol" "integer pixelsamples" {samples}
Integrator "path" "integer maxdepth" 6
WorldBegin
Include "{stage}"
"""

# name: statements of the light, exposure of the picture in stops
LIGHTS = {
    "point": ('Translate 0.4 -1.2 2.2\nLightSource "point" "rgb I" [ 9 9 9 ]', 0),
    "spot": ('LightSource "spot" "point3 from" [ -1.8 -2.2 3 ] "point3 to" [ 0.1 0.3 0.4 ] "rgb I" [ 45 42 38 ]\n'
             '  "float coneangle" 17 "float conedeltaangle" 4', 1.3),
    "goniometric": ('Translate 0.4 -1 2.1\nLightSource "goniometric" "string filename" "stripes.png" "float scale" 16', 0),
    "projection": ('Translate -0.3 -3.4 2\nRotate -98 1 0 0\nLightSource "projection" "string filename" "window.png" "float fov" 42\n'
                   '  "float scale" 55', 0),
    "ies": ('Translate 0 2.6 2.4\nLightSource "point" "string shaping:ies:file" "PROFILES/downlight.ies" "float intensity" 0.006', 2.2),
    "distant": ('LightSource "distant" "point3 from" [ -2 -2 3 ] "point3 to" [ 0 0 0 ] "rgb L" [ 3 2.8 2.5 ]', 0),
    "distant-angle": ('LightSource "distant" "point3 from" [ -2 -2 3 ] "point3 to" [ 0 0 0 ] "rgb L" [ 3 2.8 2.5 ]\n'
                      '  "float angle" 12 "bool normalize" true', 0),
    "infinite": ('LightSource "infinite" "rgb L" [ 0.9 0.95 1 ]', 0),
    "dome": ('LightSource "dome" "string texture:file" "sky.hdr" "string poleAxis" "Z"', 0),
    "portal": ('Translate -3.2 0 1.6\nRotate -90 0 1 0\nLightSource "portal" "float width" 1.8 "float height" 1.8\n'
               '  "string texture:file" "sky.hdr" "string poleAxis" "Z" "float intensity" 6', 0.9),
    "rect": ('Translate 0 -0.6 2.6\nLightSource "rect" "float width" 2.4 "float height" 0.7 "float intensity" 7', 0.4),
    "rect-textured": ('Translate 0 1.6 2.3\nRotate -55 1 0 0\nLightSource "rect" "float width" 3 "float height" 1.4 "string texture:file" "bulbs.png"\n'
                      '  "float intensity" 9', 0.9),
    "disk": ('Translate 0.5 -0.8 2.5\nLightSource "disk" "float radius" 0.6 "float intensity" 12\n'
             '  "float shaping:cone:angle" 35 "float shaping:cone:softness" 0.4', 0.7),
    "sphere": ('Translate 0.35 -0.5 1.75\nLightSource "sphere" "float radius" 0.16 "float intensity" 110\n'
               '  "bool enableColorTemperature" true "float colorTemperature" 3400', 0),
    "cylinder": ('Translate 0 0.2 1.9\nLightSource "cylinder" "float length" 3 "float radius" 0.05 "float intensity" 28', 0.4),
    "mesh": ('AttributeBegin\nMaterial "diffuse" "rgb reflectance" [ 0 0 0 ]\nTranslate 0.3 -0.2 1.75\nRotate 35 1 0.4 0\n'
             'AreaLightSource "mesh" "float intensity" 16 "rgb color" [ 1 0.82 0.6 ]\n'
             'Shape "trianglemesh" "integer indices" [ 0 2 4  2 1 4  1 3 4  3 0 4  2 0 5  1 2 5  3 1 5  0 3 5 ]\n'
             '  "point3 P" [ 0.35 0 0  -0.35 0 0  0 0.35 0  0 -0.35 0  0 0 0.35  0 0 -0.35 ]\nAttributeEnd', 0.6),
}


def write_png(path, width, height, pixel):
    """8-bit RGB; pixel(x, y) gives three numbers in [0,1], y counts down."""
    rows = b""
    for y in range(height):
        rows += b"\0" + bytes(round(255 * min(max(c, 0.0), 1.0)) for x in range(width) for c in pixel(x, y))
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b""))


def write_hdr(path, width, height, pixel):
    """Radiance RGBE without run lengths."""
    data = bytearray()
    for y in range(height):
        for x in range(width):
            color = pixel(x, y)
            largest = max(color)
            if largest < 1e-32:
                data += b"\0\0\0\0"
                continue
            mantissa, exponent = math.frexp(largest)
            data += bytes(min(255, int(c * 256 * mantissa / largest)) for c in color) + bytes([exponent + 128])
    path.write_bytes(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n" % (height, width) + bytes(data))


def window(x, y):
    """A gobo: six panes with a bar between, one of them warm."""
    px, py = x / 192, y / 128
    bar = min(abs(px * 3 - round(px * 3)) / 3, abs(py * 2 - round(py * 2)) / 2)
    if bar < 0.018:
        return (0, 0, 0)
    return (1, 0.72, 0.4) if (int(px * 3), int(py * 2)) == (1, 0) else (0.85, 0.93, 1)


def stripes(x, y):
    v = 1.0 if (x // 8 + y // 8) % 2 == 0 else 0.18
    return (v, v, v)


def bulbs(x, y):
    colors = [(1, 0.25, 0.15), (1, 0.8, 0.35), (0.25, 0.6, 1)]
    cx, cy = x % 32 - 15.5, y % 32 - 15.5
    inside = max(0.0, 1 - (cx * cx + cy * cy) / 150)
    c = colors[(x // 32 + y // 32) % 3]
    return tuple(inside * k + 0.01 for k in c)


def sky(x, y):
    """Evening: a pale horizon, a blue zenith, a low sun; dark ground. Pole +z."""
    latitude = math.pi * (0.5 - (y + 0.5) / 128)
    longitude = 2 * math.pi * (x + 0.5) / 256
    if latitude < 0:
        return (0.08, 0.075, 0.07)
    h = math.sin(latitude)
    color = [0.75 * (1 - h) + 0.12 * h, 0.62 * (1 - h) + 0.24 * h, 0.5 * (1 - h) + 0.6 * h]
    away = math.acos(min(1.0, math.cos(latitude - 0.5) * math.cos(longitude - 3.9)))
    glow = 60 * math.exp(-(away / 0.06) ** 2) + 0.9 * math.exp(-away / 0.35)
    return tuple(c + glow * k for c, k in zip(color, (1, 0.8, 0.55)))


def main():
    names = sys.argv[1:] or list(LIGHTS)
    unknown = [n for n in names if n not in LIGHTS]
    if unknown:
        sys.exit("there is no picture of " + ", ".join(unknown) + "; there are: " + " ".join(LIGHTS))
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        write_png(folder / "window.png", 192, 128, window)
        write_png(folder / "stripes.png", 64, 64, stripes)
        write_png(folder / "bulbs.png", 128, 64, bulbs)
        write_hdr(folder / "sky.hdr", 256, 128, sky)
        for name in names:
            statements, exposure = LIGHTS[name]
            scene = folder / (name + ".pbrt")
            text = CAMERA.format(samples=144, stage=HERE / "stage.pbrt")
            text += "AttributeBegin\n" + statements.replace("PROFILES", str(ROOT / "scenes" / "profiles")) + "\nAttributeEnd\n"
            scene.write_text(text)
            subprocess.run([ROOT / "lampyr.sh", "render", scene, "-o", folder / (name + ".exr"), "--png", "--exposure",
                            str(exposure), "--quiet"], check=True)
            (HERE / (name + ".png")).write_bytes((folder / (name + ".png")).read_bytes())
            print(name)


main()
