#!/usr/bin/env python3
"""Renders ../shared/bench/sheet.pbrt (512², 64 samples, 199,712 triangles, two threads) in turn with the
program and with Mitsuba 3, scalar and LLVM, and prints for each the least seconds of rendering, the variance
of a pixel, their product over that of Mitsuba LLVM, and the mean difference of the images in standard errors.

    pip install mitsuba numpy; apt install libllvm19
    python3 tests/bench/sheet_against_mitsuba.py [build/tests/rapport]

The variance is measured in the same way for all, from pairs of pictures with different seeds; the program's
picture is mirrored first, because pbrt's camera is left-handed and Mitsuba's is not."""
import glob
import os
import re
import subprocess
import sys
import tempfile
import time
from pathlib import Path

libraries = sorted(glob.glob("/usr/lib/*/libLLVM*19*"))
if libraries:
    os.environ.setdefault("DRJIT_LIBLLVM_PATH", libraries[0])
import drjit
import mitsuba
import numpy

ROOT = Path(__file__).resolve().parents[2]
BENCH = ROOT.parent / "shared" / "bench"
PROGRAM = sys.argv[1] if len(sys.argv) > 1 else str(ROOT / "build" / "tests" / "rapport")
RUNS, SAMPLES = 4, 64


def with_program(folder, seed):
    picture = f"{folder}/sheet.exr"
    said = subprocess.run([PROGRAM, "render", BENCH / "sheet.pbrt", "--threads", "2", "--spp", str(SAMPLES),
                           "--seed", str(seed), "-o", picture], check=True, capture_output=True, text=True)
    seconds = float(re.search(r"([\d.]+) s\b", said.stdout + said.stderr).group(1))
    radiance = dict(mitsuba.Bitmap(picture).split())["<root>"]
    red = [field.name for field in radiance.struct_()].index("R")
    return seconds, numpy.array(radiance)[:, ::-1, red].astype(float)  # a grey scene


def mitsuba_scene():
    transform = mitsuba.ScalarTransform4f().look_at(origin=[1.6, -2.4, 1.9], target=[0, 0, 0.15], up=[0, 0, 1])
    return mitsuba.load_dict({
        "type": "scene",
        "integrator": {"type": "path", "max_depth": 6, "rr_depth": 100},
        "light": {"type": "constant"},
        "sheet": {"type": "ply", "filename": str(BENCH / "cloth200k.ply"),
                  "bsdf": {"type": "twosided", "b": {"type": "diffuse", "reflectance": 0.7}}},
        "camera": {"type": "perspective", "fov": 40, "to_world": transform,
                   "film": {"type": "hdrfilm", "width": 512, "height": 512, "rfilter": {"type": "box"}},
                   "sampler": {"type": "independent", "sample_count": SAMPLES}}})


def with_mitsuba(scene, seed):
    start = time.perf_counter()
    picture = mitsuba.render(scene, spp=SAMPLES, seed=seed)
    drjit.eval(picture)
    drjit.sync_thread()
    image = numpy.array(picture)
    return time.perf_counter() - start, image.reshape(512, 512, 3)[:, :, 0].astype(float)


renderers = {}
for variant in ("scalar_rgb", "llvm_ad_rgb"):
    try:
        mitsuba.set_variant(variant)
        mitsuba.set_log_level(mitsuba.LogLevel.Error)
        if variant != "scalar_rgb":
            drjit.set_thread_count(2)
        scene = mitsuba_scene()
        with_mitsuba(scene, 99)  # compiles the kernels
        renderers[variant] = scene
    except ImportError as error:
        print(f"{variant}: left out, {error}")

results = {name: [] for name in ["rapport", *renderers]}
with tempfile.TemporaryDirectory() as folder:
    for run in range(RUNS):
        results["rapport"].append(with_program(folder, run))
        for variant, scene in renderers.items():
            mitsuba.set_variant(variant)
            results[variant].append(with_mitsuba(scene, run))

figures = {}
for name, runs in results.items():
    images = [image for _, image in runs]
    pairs = [numpy.mean((a - b) ** 2) / 2 for a, b in zip(images[::2], images[1::2])]
    figures[name] = (min(seconds for seconds, _ in runs), float(numpy.mean(pairs)), numpy.mean(images, axis=0))
peer = "llvm_ad_rgb" if "llvm_ad_rgb" in figures else "scalar_rgb"
for name, (seconds, variance, mean) in figures.items():
    difference = mean - figures[peer][2]
    spread = difference.std() / difference.size ** 0.5
    print(f"{name:12} {seconds:6.2f} s   variance {variance:.3e}   time × variance over {peer}: "
          f"{seconds * variance / (figures[peer][0] * figures[peer][1]):.2f}   mean difference "
          f"{difference.mean():+.1e} ± {spread:.1e}")
