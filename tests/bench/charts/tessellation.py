#!/usr/bin/env python3
"""Draws what tests/bench/tessellation_bench prints, read from standard input, as tessellation.svg beside
this file: error of the picture against triangles and against time, for edge lengths and uniform levels.

    build/tests/tests/tessellation_bench scenes/garments/dress.glb | python3 tests/bench/charts/tessellation.py

Needs matplotlib (Debian: python3-matplotlib).
"""
import csv
import pathlib
import sys

import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt

plt.rcParams.update({"svg.hashsalt": "rapport", "svg.fonttype": "none", "font.size": 9})
UNITS = {"edgelength": "edges under {} px", "level": "{} pieces to an edge"}


def main():
    rows = list(csv.DictReader(sys.stdin))
    models = list(dict.fromkeys(row["model"] for row in rows))
    figure, grid = plt.subplots(len(models), 2, figsize=(9, 3.4 * len(models)), layout="constrained",
                                squeeze=False)
    for model, (by_triangles, by_time) in zip(models, grid):
        for axes, key, label in ((by_triangles, "triangles", "triangles"),
                                 (by_time, "seconds", "seconds to build the scene")):
            for curve, marker in (("level", "s"), ("edgelength", "o")):
                points = [row for row in rows if row["model"] == model and row["curve"] == curve]
                x = [float(row[key]) for row in points]
                y = [float(row["error"]) for row in points]
                axes.plot(x, y, marker=marker, markersize=3, linewidth=1,
                          label=UNITS[curve].format("n"))
                for point, a, b in zip(points, x, y):
                    axes.annotate(f"{float(point['parameter']):g}", (a, b), fontsize=6,
                                  textcoords="offset points", xytext=(3, 3))
            for row in rows:
                if row["model"] == model and row["curve"] == "noise":
                    axes.axhline(float(row["error"]), color="grey", linestyle=":",
                                 label="noise of 64 samples")
            axes.set(title=model, xlabel=label, ylabel="RMS error of pixels over their mean",
                     xscale="log", yscale="log")
            axes.grid(alpha=0.3)
            axes.legend()
    file = pathlib.Path(__file__).parent / "tessellation.svg"
    figure.savefig(file, metadata={"Date": None})
    print(file)


if __name__ == "__main__":
    main()
