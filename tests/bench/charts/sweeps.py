#!/usr/bin/env python3
"""Draws the sweeps of tests/bench/sweeps_bench, read from standard input, as SVGs beside this file.

    build/tests/tests/sweeps_bench | python3 tests/bench/charts/sweeps.py

Needs matplotlib (Debian: python3-matplotlib).
"""
import csv
import pathlib
import sys

import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt
import matplotlib.ticker

# Equal numbers give equal files, and text stays text.
plt.rcParams.update({"svg.hashsalt": "rapport", "svg.fonttype": "none", "font.size": 9})

SHARE = "share of the incident light"
ERROR = "difference of R"
# sweep: title, x label, y label, x scale, y scale
CHARTS = {
    "incidence": ("Towards the horizon", "elevation of the light above the cloth [°]", SHARE, "log", "linear"),
    "overlap": ("Two fibres into one another", "overlap over the fibre's diameter",
                "reflected share", "linear", "linear"),
    "twist": ("Twist of a plain weave", "tilt of the outermost fibres [°]", SHARE, "linear", "linear"),
    "cell": ("Fibre diameter over cell size", "fibre diameter over cell size", ERROR, "log", "linear"),
    "scale": ("Scale of the scene", "factor", ERROR, "log", "linear"),
    "offset": ("Place of the cell", "offset [µm]", ERROR, "log", "linear"),
    "depth": ("Depth cap", "boundary events allowed to a path", "capped share", "log", "log"),
    "absorption": ("Volume absorption", "absorption [1/µm]", SHARE, "log", "linear"),
    "index": ("Refractive index", "refractive index", SHARE, "linear", "linear"),
    "peaks": ("Mirror images of the weft, light from 30°",
              "angle of exit [°], positive towards the light", "density [1/rad]", "linear", "linear"),
    "segments": ("Straight segments against the smooth fibre", "segments to a fibre of the repeat",
                 "RMS difference over the mean", "log", "log"),
    "sides": ("Extended cells", "repeats of the draft along both yarns",
              "RMS difference over the mean, without noise", "log", "linear"),
    "shear": ("Sheared cloth against rules for its table", "shear [°]",
              "RMS difference over the mean, without noise", "linear", "linear"),
    "highlights": ("Light along the normal (shaded: highlights as measured)",
                   "angle of exit along the warp [°]", "intensity [1/sr]", "linear", "log"),
}


def main():
    curves = {}
    for row in csv.DictReader(sys.stdin):
        points = curves.setdefault(row["sweep"], {}).setdefault(row["curve"], [])
        points.append((float(row["parameter"]), float(row["value"]), float(row["error"])))
    for sweep, named in curves.items():
        title, x_label, y_label, x_scale, y_scale = CHARTS[sweep]
        figure, axes = plt.subplots(figsize=(5 if len(named) <= 6 else 7.5, 3.2), layout="constrained")
        for name, points in named.items():
            x, y, error = zip(*points)
            if name.startswith("measured: "):
                colour = axes.lines[-1].get_color()  # of the cloth that was drawn just before
                for angle, width in zip(x, error):
                    axes.axvspan(angle - width, angle + width, color=colour, alpha=0.15)
            elif sweep in ("peaks", "highlights"):
                axes.plot(x, y, drawstyle="steps-mid", linewidth=1, label=name)
            else:
                axes.errorbar(x, y, yerr=error, marker=".", linewidth=1, capsize=2, label=name)
        axes.set(title=title, xlabel=x_label, ylabel=y_label, xscale=x_scale, yscale=y_scale)
        if x_scale == "log":  # the decades' numbers suffice
            axes.xaxis.set_minor_formatter(matplotlib.ticker.NullFormatter())
        if sweep == "peaks":  # room for the legend
            axes.margins(y=0.3)
            axes.set_ylim(bottom=0)
        axes.grid(alpha=0.3)
        if len(named) > 6:  # beside the curves
            axes.legend(bbox_to_anchor=(1.02, 1), loc="upper left", fontsize=7)
        elif len(named) > 1:
            axes.legend()
        file = pathlib.Path(__file__).parent / f"{sweep}.svg"
        figure.savefig(file, metadata={"Date": None})
        plt.close(figure)
        print(file)


if __name__ == "__main__":
    main()
