#!/usr/bin/env python3
"""A dress from afar and from near in one cloth, under a small lamp that turns round it: frames, and a contact
sheet of them with the luminance along the middle of each close-up, for the eye to judge whether highlights glide
or jump and double.

    python3 tests/bench/turning_light.py build/release/rapport satin.bsdf build/turning-light

The cloth's table should be more accurate (0.3) than the noise that the eye is to see past. Needs numpy and matplotlib
(Debian: python3-numpy, python3-matplotlib).
"""
import argparse
import math
import pathlib
import subprocess

import matplotlib

matplotlib.use("agg")
import matplotlib.pyplot as plt

ROOT = pathlib.Path(__file__).resolve().parents[2]
VIEWS = {
    "far": "LookAt 0.85 1.25 2.35  0 0.8 0  0 1 0\nCamera \"perspective\" \"float fov\" 36",
    "near": "LookAt 0.85 1.25 2.35  0.02 0.62 0.15  0 1 0\nCamera \"perspective\" \"float fov\" 7",
}
SCENE = """Scale -1 1 1 # pbrt's world is left-handed, glTF's right-handed
{view}
Film "rgb" "integer xresolution" {width} "integer yresolution" {height}
Sampler "sobol" "integer pixelsamples" {spp}
Integrator "path" "integer maxdepth" 4
WorldBegin
LightSource "infinite" "rgb L" [0.06 0.06 0.06]
LightSource "distant" "rgb L" [3 3 3] "point3 from" [{x} 0.7 {z}] "point3 to" [0 0 0]
MakeNamedMaterial "Body" "string type" "cloth" "string filename" "{cloth}"
MakeNamedMaterial "Form" "string type" "diffuse" "rgb reflectance" [0.45 0.42 0.38]
Shape "gltf" "string filename" "{model}"
"""


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("rapport")
    parser.add_argument("cloth")
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--frames", type=int, default=8)
    parser.add_argument("--step", type=float, default=10, help="degrees between frames")
    parser.add_argument("--width", type=int, default=240)
    parser.add_argument("--spp", type=int, default=32)
    options = parser.parse_args()

    options.folder.mkdir(parents=True, exist_ok=True)
    height = options.width * 5 // 4
    angles = [(i - (options.frames - 1) / 2) * options.step for i in range(options.frames)]
    figure, grid = plt.subplots(3, len(angles), figsize=(1.6 * len(angles), 5.6), layout="constrained", squeeze=False,
                                sharey="row", gridspec_kw={"height_ratios": [2, 2, 1]})
    for column, angle in enumerate(angles):
        for axes, (name, view) in zip(grid[:, column], VIEWS.items()):
            scene = options.folder / f"{name}-{column}.pbrt"
            picture = scene.with_suffix(".png")
            scene.write_text(SCENE.format(
                view=view, width=options.width, height=height, spp=options.spp,
                x=math.sin(math.radians(angle)), z=math.cos(math.radians(angle)),
                cloth=pathlib.Path(options.cloth).resolve(), model=ROOT / "scenes/garments/dress.glb"))
            subprocess.run([options.rapport, "render", scene, "-o", picture, "--quiet"], check=True)
            pixels = plt.imread(picture)[:, :, :3]
            axes.imshow(pixels)
            axes.set_axis_off()
        grid[0, column].set_title(f"{angle:+.0f}°", fontsize=9)
        middle = pixels[height // 2 - 2 : height // 2 + 3].mean(axis=(0, 2))
        grid[2, column].plot(middle, linewidth=1)
        grid[2, column].set(xticks=[], xlim=(0, options.width - 1))
    grid[2, 0].set_ylabel("middle row, near")
    figure.savefig(options.folder / "sheet.png", dpi=110)
    print(options.folder / "sheet.png")


if __name__ == "__main__":
    main()
