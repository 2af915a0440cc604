#!/usr/bin/env python3
"""Error against bytes of ways to table a cloth's exits, from the rays of tests/bench/exit_rays_bench:

    for cloth in viscose-satin viscose-plain wool-gabardine; do
        build/tests/tests/exit_rays_bench scenes/cloths/$cloth.toml $cloth.rays 25000 100000; done
    python3 tests/bench/charts/parameterisation.py viscose-satin.rays viscose-plain.rays wool-gabardine.rays

Draws parameterisation.svg and interpolation.svg beside this file. The error is the RMS difference of
the intensity over its mean at held-out incidence, by held-out rays: E² ∝ ∫f̂² − 2/N·Σ w f̂(x) + ∫f²,
the last from pairs of rays in bins much finer than any table's. The noise of the 25,000 paths a node,
which falls as 1/N, is taken out by tables of half the paths: 2·E²(N) − E²(N/2); the plain E(N) is
printed too. A chart maps exits to a and b in [0, 1); bins are planes over equal steps of both,
limited to stay positive.

Found, of fresh directions and of cloths whose fibres deviate. About the cone of the yarns that show, a
table is better than about the mirror direction on all three, by a quarter on satin, and about the other
yarns' cone it is much worse on satin (0.48), so each side of a cloth has the cone of those it shows more
of. 2.0 MB of it (satin's error 0.24 without noise, 0.37 with; plain 0.20 and 0.25; gabardine 0.00 and 0.18)
stand against 6.75 MB of 5° bins (0.41 and 0.55; 0.17 and 0.32; 0.00 and 0.36). Satin's first is reached by
0.34 MB of a quarter of the nodes (0.41 and 0.52), a twentieth of its bytes; on the plain weave, the two
cones being alike, 2.0 MB have 0.02 more of it without noise and a fifth less with. Half precision changes
the errors' fifth digit, and single would double all bytes; only 4 to 7 % of the bins are empty, so leaving
out empty blocks gains nothing. An error of 0 is one that the noise hides. At the first held-out direction
the paths have a highlight of 0.052 ± 0.005 1/sr on satin, the chosen way 0.048 and a blend in place 0.043.
"""
import pathlib
import sys

import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt
import numpy as np

HELD_OUT = 6
THETA = np.array([0, 10, 20, 30, 40, 50, 60, 70, 80, 88.0])
GRIDS = {"434 nodes": (THETA, 15, 434), "98 nodes": (THETA[::2], 30, 98)}  # both sides


def directions_of(path):
    raw = pathlib.Path(path).read_bytes()
    at = 0
    while at < len(raw):
        theta, phi, paths, exits = np.frombuffer(raw, "<f8", 4, at)
        rays = np.frombuffer(raw, "<f4", 4 * int(exits), at + 32).reshape(-1, 4).astype(float)
        at += 32 + 16 * int(exits)
        yield theta, phi, paths, rays[:, :3], rays[:, 3]


def unit(theta, phi):
    return np.array([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)])


def uniform(w, light):
    theta, phi = np.arccos(np.minimum(np.abs(w[:, 2]), 1)), np.arctan2(w[:, 1], w[:, 0])
    return theta / (np.pi / 2), phi / (2 * np.pi) % 1, np.maximum(np.sin(theta), 1e-4) * np.pi**2


def equal_area_disc(w, light):
    r, phi = np.sqrt(1 - np.abs(w[:, 2])), np.arctan2(w[:, 1], w[:, 0])
    phi = np.where(phi < -np.pi / 4, phi + 2 * np.pi, phi)
    side = np.floor((phi + np.pi / 4) / (np.pi / 2)).astype(int) % 4
    along = r * (phi - side * np.pi / 2) * 4 / np.pi
    a, b = np.choose(side, [r, -along, -r, along]), np.choose(side, [along, r, -along, -r])
    return (a + 1) / 2, (b + 1) / 2, np.full_like(r, 2 * np.pi)


def slide(x, origin):
    origin = np.clip(origin, -0.97, 0.97)  # kFarthest of materials/table/exit_chart.h
    length = np.where(x >= origin, 1 - origin, 1 + origin)
    return (x - origin) / length, length


def spaced(x, finest):
    step = (np.sqrt(finest**2 / 4 + (1 - finest) * np.abs(x)) - finest / 2) / (1 - finest)
    return 0.5 + 0.5 * np.sign(x) * step, 2 * (finest + 2 * (1 - finest) * step)


def about_the_mirror(w, light):
    u, of_u = slide(np.clip(w[:, 1], -1, 1), -light[1])
    v, of_v = slide(np.arctan2(w[:, 0], np.abs(w[:, 2])) / (np.pi / 2),
                    -np.arctan2(light[0], light[2]) / (np.pi / 2))
    (a, of_a), (b, of_b) = spaced(u, 0.15), spaced(v, 0.25)
    return a, b, of_u * of_v * of_a * of_b * np.pi / 2


def cone_of(along):
    """Of the weft, 0, or of the warp, 1: materials/table/exit_chart.h."""
    def chart(w, light):
        u, of_u = slide(np.clip(w[:, along], -1, 1), -light[along])
        a, of_a = spaced(u, 0.15)  # kFinest of materials/table/direction_mesh.h
        b = np.arctan2(w[:, 1 - along], np.abs(w[:, 2])) / np.pi + 0.5
        return a, b, of_u * of_a * np.pi

    return chart


class Table:
    """One direction's rays in columns × rows bins of both hemispheres."""

    def __init__(self, chart, columns, rows, wraps=False):
        self.chart, self.columns, self.rows, self.wraps = chart, columns, rows, wraps

    def cells(self, w, light):
        a, b, area = self.chart(w, light)
        i = np.clip((a * self.columns).astype(int), 0, self.columns - 1)
        j = np.clip((b * self.rows).astype(int), 0, self.rows - 1)
        return (w[:, 2] < 0).astype(int), i, j, 2 * (a * self.columns - i) - 1, \
            2 * (b * self.rows - j) - 1, area

    def fill(self, w, weight, paths, light):
        block, i, j, *_ = self.cells(w, light)
        shape = (2, self.columns, self.rows)
        mean = np.bincount(np.ravel_multi_index((block, i, j), shape), weight, np.prod(shape))
        mean = mean.reshape(shape) * self.columns * self.rows / paths
        p = np.pad(mean, ((0, 0), (1, 1), (1, 1)), "edge")
        if self.wraps:
            p[:, :, 0], p[:, :, -1] = p[:, :, -2], p[:, :, 1]
        slopes = np.array([p[:, 2:, 1:-1] - p[:, :-2, 1:-1], p[:, 1:-1, 2:] - p[:, 1:-1, :-2]]) / 4
        steepest = np.abs(slopes).sum(0)
        return mean, slopes * np.minimum(1, mean / np.maximum(steepest, 1e-30))

    def value(self, filled, w, light):
        mean, slopes = filled
        *at, xi, eta, area = self.cells(w, light)
        at = tuple(at)
        return (mean[at] + slopes[0][at] * xi + slopes[1][at] * eta) / area


def sphere(count):
    i = np.arange(count)
    z = 1 - 2 * (i + 0.5) / count
    return np.stack([np.sqrt(1 - z * z) * np.cos(i * np.pi * (3 - np.sqrt(5))),
                     np.sqrt(1 - z * z) * np.sin(i * np.pi * (3 - np.sqrt(5))), z], 1)


def square_integral(paths, w, weight):
    """Of pairs of rays, one from either half of them, in bins of equal solid angle. With half as
    many bins along both sides E changes by 0.001, with twice as many along one by 0.01."""
    shape, ranges = (200, 90, 2), ((-1, 1), (-np.pi / 2, np.pi / 2), (-0.5, 1.5))
    places = np.stack([w[:, 1], np.arctan2(w[:, 0], np.abs(w[:, 2])), w[:, 2] < 0], 1)
    first, second = (np.histogramdd(places[k::2], shape, ranges, weights=weight[k::2])[0]
                     for k in (0, 1))
    return (first * second).sum() * 4 / paths**2 * np.prod(shape) / (4 * np.pi)


def corners(theta, phi, thetas, step):
    t, p = np.degrees(theta), np.degrees(phi) % 360
    i, j = np.searchsorted(thetas, t, side="right") - 1, int(p // step)
    s, r = (t - thetas[i]) / (thetas[i + 1] - thetas[i]), p / step - j
    return [(thetas[i + a], 0 if thetas[i + a] == 0 else (j + b) * step % 360,
             (s if a else 1 - s) * (r if b else 1 - r)) for a in (0, 1) for b in (0, 1)]


def corner_tables(nodes, theta, phi, table, thetas, step, every=1):
    """Share, direction and filled table of each corner, of every so-many-th ray."""
    for t, p, share in corners(theta, phi, thetas, step):
        _, _, n, w, weight = nodes[round(t), round(p)]
        light = unit(np.radians(t), np.radians(p))
        yield share, light, table.fill(w[::every], weight[::every], n / every, light)


def squared_error(nodes, held_out, table, thetas, step, every, rounded):
    total = 0
    for theta, phi, paths, w, weight, squares in held_out:
        light, on_sphere, on_rays = unit(theta, phi), 0, 0
        for share, _, filled in corner_tables(nodes, theta, phi, table, thetas, step, every):
            filled = (rounded(filled[0]), filled[1])
            on_sphere = on_sphere + share * table.value(filled, SPHERE, light)
            on_rays = on_rays + share * table.value(filled, w, light)
        squared = 4 * np.pi * (on_sphere**2).mean() - 2 * (on_rays * weight).sum() / paths + squares
        total += 4 * np.pi * squared / (weight.sum() / paths) ** 2
    return total / len(held_out)


def errors_of(*case, rounded=lambda mean: mean):
    """With the noise of the nodes' paths, and without."""
    squared = [squared_error(*case, every, rounded) for every in (1, 2)]
    return [np.sqrt(max(x, 0)) for x in (squared[0], 2 * squared[0] - squared[1])]


def profile(axis, nodes, held_out):
    """Across the warp's ridge, within 0.1 quarter turns round the warp of the mirror direction, in 40
    bins: in finer ones the highest of the paths' would be their noise."""
    theta, phi, paths, w, weight, _ = held_out
    light, bins, fine = unit(theta, phi), 40, 4
    edges = np.linspace(-1, 1, bins + 1)
    turn = lambda x, z: np.arctan2(x, np.abs(z)) / (np.pi / 2)
    y, t = np.meshgrid((np.arange(bins * fine) + 0.5) / (bins * fine) * 2 - 1, turn(-light[0], light[2]) +
                       np.linspace(-0.1, 0.1, 40), indexing="ij")
    psi, across = t * np.pi / 2, np.sqrt(1 - y**2)
    points = np.stack([across * np.sin(psi), y, across * np.cos(psi)], -1).reshape(-1, 3)
    near = (w[:, 2] > 0) & (np.abs(turn(w[:, 0], w[:, 2]) - turn(-light[0], light[2])) < 0.1)
    of_bin = (edges[1] - edges[0]) * 0.2 * np.pi / 2 * paths
    reference = np.histogram(w[near, 1], edges, weights=weight[near])[0] / of_bin
    noise = np.sqrt(np.histogram(w[near, 1], edges, weights=weight[near] ** 2)[0]) / of_bin
    table, moved, in_place = Table(cone_of(1), 24, 16), 0, 0
    for share, node, filled in corner_tables(nodes, theta, phi, table, THETA, 15):
        moved = moved + share * table.value(filled, points, light)
        in_place = in_place + share * table.value(filled, points, node)
    mean = lambda values: values.reshape(bins, -1).mean(1)
    middles = (edges[1:] + edges[:-1]) / 2
    axis.fill_between(middles, reference - noise, reference + noise, color="0.85", lw=0)
    for name, values, style in (("reference (paths)", reference, "k-"), ("blended in place",
                                mean(in_place), "C1--"), ("chosen: moved", mean(moved), "C0-")):
        axis.plot(middles, values, style, lw=1, label=name)
        peak = values.argmax()
        print(f"  {name}: peak {values[peak]:.4f} 1/sr at y = {middles[peak]:.3f}, mirror at "
              f"{-light[1]:.3f}, RMS {np.sqrt(((values - reference)**2).mean()):.4f}; the paths' noise "
              f"there {noise[peak]:.4f}, RMS {np.sqrt((noise**2).mean()):.4f}")


SPHERE = sphere(100_000)
PROFILED = 0  # of the held-out directions
SIZES = [0.25, 0.5, 1, 2, 4, 8]  # MB, marked on the axis
WAYS = {
    "uniform θ × φ, 5°": [Table(uniform, 18, 72, True)],
    "equal-area disc (Shirley–Chiu)": [Table(equal_area_disc, n, n) for n in (20, 36)],
    "about the mirror direction": [Table(about_the_mirror, *n) for n in ((16, 12), (24, 16))],
    "cone of the warp": [Table(cone_of(1), *n) for n in ((16, 12), (24, 12), (24, 16), (32, 16))],
    "cone of the weft": [Table(cone_of(0), *n) for n in ((16, 12), (24, 12), (24, 16), (32, 16))],
}

plt.rcParams.update({"svg.hashsalt": "rapport", "svg.fonttype": "none", "font.size": 9})
(figure, axes), (other, profiles) = (
    plt.subplots(1, len(sys.argv) - 1, figsize=(4 * (len(sys.argv) - 1), 3.4), squeeze=False)
    for _ in range(2))
for axis, curves, path in zip(axes[0], profiles[0], sys.argv[1:]):
    everything = list(directions_of(path))
    nodes = {(round(np.degrees(d[0])), round(np.degrees(d[1])) % 360): d
             for d in everything[:-HELD_OUT]}
    held_out = [(*d, square_integral(*d[2:])) for d in everything[-HELD_OUT:]]
    for colour, (name, tables) in enumerate(WAYS.items()):
        for (grid, (thetas, step, count)), line in zip(GRIDS.items(), ("-o", "--s")):
            megabytes = [count * 2 * t.columns * t.rows * 6 / 1e6 for t in tables]
            errors = []
            for t, size in zip(tables, megabytes):
                noisy, found = errors_of(nodes, held_out, t, thetas, step)
                errors.append(found)
                print(f"{pathlib.Path(path).stem}, {name}, {grid}, {t.columns} x {t.rows}: "
                      f"{size:.2f} MB, error {found:.3f}, {noisy:.3f} with noise", flush=True)
            axis.plot(megabytes, errors, line, color=f"C{colour}", label=f"{name}, {grid}")
    axis.set(title=pathlib.Path(path).stem, xscale="log", xlabel="MB (three bands, half precision)",
             ylabel="error at held-out incidence", ylim=(0, None))
    axis.set_xticks(SIZES, [f"{size:g}" for size in SIZES])
    axis.minorticks_off()
    chosen = nodes, held_out, Table(cone_of(1), 24, 16), THETA, 15
    half = errors_of(*chosen, rounded=lambda mean: mean.astype(np.float16).astype(float))[0]
    empty = np.mean([(table[2][0] == 0).mean() for d in held_out
                     for table in corner_tables(nodes, *d[:2], *chosen[2:])])
    print(f"  in half precision: error {half:.5f} with noise, {errors_of(*chosen)[0]:.5f} in single; "
          f"{100 * empty:.1f} % of the bins are empty", flush=True)
    profile(curves, nodes, held_out[PROFILED])
    curves.set(title=pathlib.Path(path).stem, xlabel="y of the exit (along the warp)",
               ylabel="intensity [1/sr]")
for chart, name, drawn in ((figure, "parameterisation", axes), (other, "interpolation", profiles)):
    chart.legend(*drawn[0][0].get_legend_handles_labels(), frameon=False, fontsize=7, ncols=5, loc="lower center")
    chart.tight_layout(rect=(0, 0.12, 1, 1))
    chart.savefig(pathlib.Path(__file__).with_name(name + ".svg"), metadata={"Date": None})
