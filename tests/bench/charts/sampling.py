#!/usr/bin/env python3
"""Variance against time of sampling a cloth's table and of lobes fitted to it: draws sampling.svg beside this
file from what tests/bench/sampling_bench prints, read from standard input, and prints the ratios.

    build/tests/tests/sampling_bench scenes/garments/dress.glb ../shared/bench/sheet.pbrt satin.bsdf plain.bsdf \\
        studio.exr sunset.exr | python3 tests/bench/charts/sampling.py

Needs matplotlib and numpy (Debian: python3-matplotlib, python3-numpy).
"""
import collections
import csv
import pathlib
import sys

import matplotlib
import numpy

matplotlib.use("svg")
import matplotlib.pyplot as plt
from matplotlib.ticker import LogLocator, NullFormatter, ScalarFormatter

plt.rcParams.update({"svg.hashsalt": "rapport", "svg.fonttype": "none", "font.size": 9})
LABELS = {"table": "the table", "lobes": "GGX and diffuse, fitted"}


def main():
    runs = collections.defaultdict(lambda: collections.defaultdict(list))
    for row in csv.DictReader(sys.stdin):
        relative = float(row["variance"]) / float(row["mean"]) ** 2
        runs[row["scene"], row["cloth"], row["sky"]][row["sampler"], int(row["samples"])].append((float(row["seconds"]), relative))
    columns = min(len(runs), 4)
    figure, grid = plt.subplots(-(-len(runs) // columns), columns, figsize=(3.4 * columns, 3.2 * -(-len(runs) // columns)),
                                layout="constrained", squeeze=False, sharey=True)
    for axes, ((scene, cloth, sky), of_case) in zip(grid.flat, runs.items()):
        cost = {}
        for sampler, label in LABELS.items():
            rounds = {samples: numpy.array(values) for (name, samples), values in of_case.items() if name == sampler}
            axes.loglog(*zip(*(values.mean(axis=0) for _, values in sorted(rounds.items()))), "o-", markersize=4,
                        label=label)
            most = rounds[max(rounds)] # time × variance of the longest runs, where variance is known best
            cost[sampler] = most[:, 0] * most[:, 1]
        ratio = cost["lobes"] / cost["table"]
        error = ratio.std(ddof=1) / len(ratio) ** 0.5
        print(f"{scene} in {cloth} under {sky}: variance × time of the lobes over the table's {ratio.mean():.2f} ± {error:.2f}")
        axes.set(title=f"{scene} in {cloth}\nunder {sky}: × {ratio.mean():.1f}", xlabel="seconds of processor time",
                 ylabel="variance of a pixel over the mean²")
        axes.xaxis.set_major_locator(LogLocator(subs=(1, 3)))
        axes.xaxis.set_major_formatter(ScalarFormatter())
        axes.xaxis.set_minor_formatter(NullFormatter())
        axes.grid(alpha=0.3)
        axes.legend(frameon=False)
    figure.savefig(pathlib.Path(__file__).with_name("sampling.svg"), metadata={"Date": None})


if __name__ == "__main__":
    main()
