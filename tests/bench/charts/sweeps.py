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

SHARE = ("share of the incident light", "linear")
ERROR = ("difference of share", "linear")
OF_R = ("difference of R", "linear")
RMS = "RMS difference over the mean"
EXACT = "Error against every disk asked in double precision"
# chart: x label, x scale, panels from left to right; of each panel the sweep: title, (y label, y scale)
CHARTS = {
    "incidence": ("elevation of the light above parallel fibres [°]", "log", {
        "incidence": ("Towards the horizon", SHARE), "incidence error": (EXACT, ERROR)}),
    "absorption": ("volume absorption [1/µm]", "log", {
        "absorption": ("Absorption of parallel fibres", SHARE), "absorption error": (EXACT, ERROR)}),
    "index": ("refractive index − 1", "log", {
        "index": ("Refractive index of parallel fibres", SHARE), "index error": (EXACT, ERROR)}),
    "overlap": ("overlap over the fibre's diameter", "linear", {
        "overlap": ("Two fibres into one another", ("reflected share", "linear")),
        "overlap error": ("Error of the rule against one body", OF_R)}),
    "touching": ("overlap over the fibre's diameter", "symlog", {
        "touching": ("Two fibres that touch, against one body of glass", OF_R)}),
    "twist": ("tilt of the outermost fibres [°]", "linear", {
        "twist": ("Twist of a plain weave", SHARE),
        "twist error": ("Error against segments a quarter as long", ERROR)}),
    "beam": ("angle from the special direction [rad]", "log", {
        "beam": ("Beside special directions, against those", ("difference of R, or share", "linear"))}),
    "draft": ("ends = picks of a draft that repeats nowhere", "linear", {
        "draft": ("A large draft", ("cylinders [million]", "linear")),
        "draft memory": ("Memory to measure it", ("memory [GB]", "linear"))}),
    "cell": ("fibre diameter over cell size", "log", {
        "cell": ("One fibre size, ever wider cells, against the narrowest", ERROR)}),
    "scale": ("factor", "log", {"scale": ("Another unit, against µm", ERROR)}),
    "offset": ("offset [µm]", "log", {"offset": ("The cell moved, against where it was", OF_R)}),
    "depth": ("boundary events allowed to a path", "log", {
        "depth": ("Depth cap", ("capped share", "log"))}),
    "peaks": ("angle of exit [°], positive towards the light", "linear", {
        "peaks": ("Mirror images of the weft, light from 30°", ("density [1/rad]", "linear"))}),
    "segments": ("segments to a fibre of the repeat", "log", {
        "segments": ("Straight segments against the smooth fibre", (RMS, "log"))}),
    "sides": ("repeats of the draft along both yarns", "log", {
        "sides": ("Extended cells against unrounded twist", (RMS + ", without noise", "linear"))}),
    "shear": ("shear [°]", "linear", {
        "shear": ("Sheared cloth against rules for its table", (RMS + ", without noise", "linear"))}),
    "highlights": ("angle of exit along the warp [°]", "linear", {
        "highlights": ("Light along the normal (shaded: highlights as measured)",
                       ("intensity [1/sr]", "log"))}),
}


def draw(axes, sweep, curves):
    for name, points in curves.items():
        x, y, error = zip(*sorted(points)) if name == "bound" else zip(*points)
        if name.startswith("measured: "):
            colour = axes.lines[-1].get_color()  # of the cloth that was drawn just before
            for angle, width in zip(x, error):
                axes.axvspan(angle - width, angle + width, color=colour, alpha=0.15)
        elif name == "bound":
            axes.fill_between(x, [-bound for bound in y], y, color="grey", alpha=0.15, linewidth=0,
                              label="allowed by the tests\nat as many paths")
        elif sweep in ("peaks", "highlights"):
            axes.plot(x, y, drawstyle="steps-mid", linewidth=1, label=name)
        else:
            axes.errorbar(x, y, yerr=error if any(error) else None, marker=".", linewidth=1, capsize=2,
                          label=name)
    axes.grid(alpha=0.3)
    if len(curves) > 6:  # beside the curves
        axes.legend(bbox_to_anchor=(1.02, 1), loc="upper left", fontsize=7)
    elif "bound" in curves:  # below them
        axes.margins(y=0.25)
        axes.legend(fontsize=7, ncols=2, loc="lower center")
    elif len(curves) > 1:
        axes.legend()


def main():
    curves = {}
    for row in csv.DictReader(sys.stdin):
        points = curves.setdefault(row["sweep"], {}).setdefault(row["curve"], [])
        points.append((float(row["parameter"]), float(row["value"]), float(row["error"])))
    for chart, (x_label, x_scale, panels) in CHARTS.items():
        if not all(sweep in curves for sweep in panels):
            continue
        width = 9.5 if len(panels) > 1 else 5 if len(curves[chart]) <= 6 else 7.5
        figure, all_axes = plt.subplots(1, len(panels), figsize=(width, 3.2), layout="constrained",
                                        squeeze=False)
        for axes, (sweep, (title, (y_label, y_scale))) in zip(all_axes[0], panels.items()):
            draw(axes, sweep, curves[sweep])
            axes.set(title=title, xlabel=x_label, ylabel=y_label, yscale=y_scale)
            axes.set_xscale(x_scale, **({"linthresh": 1e-12} if x_scale == "symlog" else {}))
            if x_scale == "symlog":
                axes.set_xticks([sign * 10.0**power for sign in (-1, 1) for power in (-9, -5, -1)] + [0])
            if x_scale != "linear":  # the decades' numbers suffice
                axes.xaxis.set_minor_formatter(matplotlib.ticker.NullFormatter())
            if sweep == "peaks":  # room for the legend
                axes.margins(y=0.3)
                axes.set_ylim(bottom=0)
        file = pathlib.Path(__file__).parent / f"{chart}.svg"
        figure.savefig(file, metadata={"Date": None})
        plt.close(figure)
        print(file)


if __name__ == "__main__":
    main()
