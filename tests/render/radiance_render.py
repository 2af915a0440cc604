"""Asks Radiance what a BSDF scatters: `rtrace` looks at squares of it under a small even lamp.

python3 radiance_render.py CLOTH.xml PAIRS
where PAIRS is JSON, [[eye, light] …], unit vectors in the frame of the cloth (weft, warp, normal of the face). Prints f,
luminance over illuminance on the plane [1/sr], as JSON. Needs numpy, and pyradiance, which brings Radiance's programs.
"""
import json
import subprocess
import sys
from pathlib import Path

import numpy
import pyradiance

PROGRAMS = Path(pyradiance.__file__).parent / "bin"
HALF_ANGLE = numpy.radians(0.25)
RADIANCE = 1000


def run(program, *arguments, given):
    return subprocess.run([PROGRAMS / program, *arguments], input=given.encode(), check=True, capture_output=True).stdout


def frame_about(z):
    x = numpy.cross([0, 1, 0] if abs(z[1]) < 0.9 else [1, 0, 0], z)
    x /= numpy.linalg.norm(x)
    return numpy.array([x, numpy.cross(z, x), z]).T


def text(*vectors):
    return " ".join(str(c) for v in vectors for c in v)


file, pairs = Path(sys.argv[1]).resolve(), numpy.array(json.loads(sys.argv[2]))
# One lamp, at the zenith; for each pair a square of the cloth that is turned towards it, so that the file is read once.
scene = f"void light lamp\n0\n0\n3{3 * f' {RADIANCE}'}\nlamp source above\n0\n0\n4 0 0 1 {2 * numpy.degrees(HALF_ANGLE)}\n"
rays = ""
for i, (eye, light) in enumerate(pairs):
    turn, centre = frame_about(light).T, numpy.array([100 * i, 0, 0])
    corners = [centre + turn @ corner for corner in ([-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0])]
    scene += (f"void BSDF cloth{i}\n6 0 {file} {text(turn @ [0, 1, 0])} .\n0\n0\n"
              f"cloth{i} polygon square{i}\n0\n0\n12 {text(*corners)}\n")
    rays += text(centre + 2 * turn @ eye, -turn @ eye) + "\n"
octree = file.with_suffix(".oct")
octree.write_bytes(run("oconv", "-", given=scene))
seen = numpy.array(run("rtrace", "-h", "-ab", "0", "-dj", "0", "-ss", "0", "-w+", octree, given=rays).split(), float)
luminance = seen.reshape(-1, 3) @ [0.265, 0.670, 0.065]
print(json.dumps(list(luminance / (RADIANCE * numpy.pi * numpy.sin(HALF_ANGLE) ** 2 * abs(pairs[:, 1, 2])))))
