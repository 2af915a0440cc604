#!/usr/bin/env python3
"""Times how long a garment of a million triangles takes from the command to its first picture, 64² pixels of
one sample: reading, cleaning, limit surface, tree and rendering, least of five runs.

    python3 tests/bench/million_triangles.py [build/tests/rapport]

Needs numpy (Debian: python3-numpy)."""
import json
import math
import struct
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy

PROGRAM = sys.argv[1] if len(sys.argv) > 1 else str(Path(__file__).resolve().parents[2] / "build/tests/rapport")
CELLS = 708  # along each side of a pleated tube, two triangles each
RUNS = 5


def garment(path):
    x = numpy.linspace(0, 1, CELLS + 1)
    u, v = numpy.meshgrid(x, x)
    radius = 0.3 + 0.05 * numpy.sin(36 * math.pi * u) * (1 - v) + 0.02 * numpy.sin(25 * v)
    points = numpy.stack([radius * numpy.cos(2 * math.pi * u), 1.2 * v, -radius * numpy.sin(2 * math.pi * u)], -1)
    uvs = numpy.stack([2 * u, 1.2 * (1 - v)], -1)
    cell = numpy.arange(CELLS * CELLS)
    a = cell // CELLS * (CELLS + 1) + cell % CELLS
    corners = numpy.stack([a, a + 1, a + CELLS + 2, a, a + CELLS + 2, a + CELLS + 1], -1)
    arrays = [(points.astype("<f4"), 5126, "VEC3"), (uvs.astype("<f4"), 5126, "VEC2"),
              (corners.astype("<u4").reshape(-1, 1), 5125, "SCALAR")]
    model = {"asset": {"version": "2.0"}, "nodes": [{"mesh": 0}], "bufferViews": [], "accessors": [],
             "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "indices": 2}]}]}
    data = b""
    for values, component, kind in arrays:
        flat = values.reshape(-1, values.shape[-1])
        model["bufferViews"].append({"buffer": 0, "byteOffset": len(data), "byteLength": flat.nbytes})
        model["accessors"].append({"bufferView": len(model["accessors"]), "componentType": component,
                                   "count": len(flat), "type": kind})
        data += flat.tobytes()
    model["buffers"] = [{"byteLength": len(data)}]
    text = json.dumps(model).encode()
    text += b" " * (-len(text) % 4)
    path.write_bytes(struct.pack("<III", 0x46546C67, 2, 28 + len(text) + len(data)) +
                     struct.pack("<II", len(text), 0x4E4F534A) + text +
                     struct.pack("<II", len(data), 0x004E4942) + data)
    return 2 * CELLS * CELLS


def main():
    with tempfile.TemporaryDirectory() as folder:
        model = Path(folder) / "garment.glb"
        triangles = garment(model)
        command = [PROGRAM, "render", model, "--spp", "1", "--size", "64x64", "-o", f"{folder}/first.exr", "--quiet"]
        seconds = []
        for _ in range(RUNS):
            start = time.perf_counter()
            subprocess.run(command, check=True)
            seconds.append(time.perf_counter() - start)
    print(f"{triangles} triangles: {min(seconds):.2f} s to the first picture")


if __name__ == "__main__":
    main()
