#!/usr/bin/env python3
"""Time to equal error of explicit fibres against their table: draws fibres.svg beside this file.

    build/tests/tests/fibres_bench --benchmark_format=json | python3 tests/bench/charts/fibres.py

Needs matplotlib (Debian: python3-matplotlib).
"""
import json
import pathlib
import sys

import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt

plt.rcParams.update({"svg.hashsalt": "rapport", "svg.fonttype": "none", "font.size": 9})

series = {}
for run in json.load(sys.stdin)["benchmarks"]:
    _, name, angle = run["name"].split("/")[:3]
    series.setdefault(name, []).append((int(angle), run["seconds_to_1_percent"]))

figure, axes = plt.subplots(figsize=(4.5, 3.2), layout="constrained")
for name, points in series.items():
    axes.loglog(*zip(*sorted(points)), "o-", label={"fibres": "explicit fibres"}.get(name, name))
angles = [angle for angle, _ in sorted(points)]
axes.set_xticks(angles, angles)
axes.set_xticks([], minor=True)
axes.set_title("A satin seen from afar: time to equal error")
axes.set_xlabel("half-angle of the lamp [°]")
axes.set_ylabel("time to a standard error of 1 % [s]")
axes.legend(frameon=False)
figure.savefig(pathlib.Path(__file__).with_name("fibres.svg"), metadata={"Date": None})
