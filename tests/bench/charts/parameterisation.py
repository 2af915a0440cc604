#!/usr/bin/env python3
"""Ways to table a cloth's exits: error against bytes and against the time of a look-up, from the rays of
tests/bench/exit_rays_bench and the times of tests/bench/parameterisation_bench:

    for cloth in viscose-satin viscose-plain wool-gabardine; do for side in front back; do
        build/tests/tests/exit_rays_bench scenes/cloths/$cloth.toml $side $cloth-$side.rays 50000 400000; done; done
    build/tests/tests/parameterisation_bench --benchmark_repetitions=31 --benchmark_min_time=0.01 \
        --benchmark_enable_random_interleaving=true --benchmark_format=json > lookup.json
    python3 tests/bench/charts/parameterisation.py lookup.json {viscose-satin,viscose-plain,wool-gabardine}-front.rays \
        {viscose-satin,viscose-plain,wool-gabardine}-back.rays

Draws parameterisation.svg, lookup.svg and interpolation.svg beside this file. The error is the RMS difference of
the intensity over its mean at held-out incidence, by held-out rays: E² ∝ ∫f̂² − 2/N·Σ w f̂(x) + ∫f²,
the last from pairs of rays in bins much finer than any table's. The noise of the paths of a node,
which falls as 1/N, is taken out by tables of half the paths: 2·E²(N) − E²(N/2); the plain E(N) is
printed too. A chart maps exits to a and b in [0, 1), and bins are planes over equal steps of both; those of
rings are planes of the intensity itself. All are limited to stay positive.

Found, without noise, of 2 MB in light from the front and from behind. Satin decides, having the largest error:
0.23 and 0.23 about the cone of the yarns that show (the warp on both sides), 0.31 and 0.29 about the mirror
direction, 0.45 and 0.44 about the other yarns' cone, and 0.36 to 0.43 in all ways that stand still, of which even
6.75 MB hardly help (0.33 to 0.35: what is wrong is between the nodes of incidence). The cone's 1 MB have 0.34 and
0.32, its 0.34 MB of a quarter of the nodes 0.43 and 0.43, where 5° bins have 0.34. Of cloths without a sharp
highlight, rings of near-equal solid angle are better than the cone: 0.18 and 0.16 against 0.19 and 0.18 on the plain
weave, 0.03 and 0.03 against 0.10 and 0.08 on the gabardine. Finer θ towards grazing helps the gabardine alone, by
0.02 to 0.03, at as many bytes. The cone is also the cheapest to look up, having one arc tangent: 114 ns, about the
mirror direction 136, in rings 119, on the disc 149, in 5° bins 131, which no longer fit into the cache. How much
finer the columns are at the highlight hardly matters on cloths without one; on satin 0.15 to 0.25 of equal ones are
the best. With the noise of 50,000 paths a node, 2 MB of the cone have 0.30 and 0.30, 0.22 and 0.21, 0.17 and 0.16 on
the three, 6.75 MB of 5° bins 0.43 and 0.44, 0.24 and 0.23, 0.25 and 0.25.
Half precision changes the errors' fifth digit, and single would double all bytes; only 2 to 4 % of the bins are
empty, so leaving out empty blocks gains nothing. An error of 0 is one that the noise hides.

Between the nodes, where the highlight of the satin's front is moved, its profile is nearer to the paths' at five of
six held-out directions than where it is blended in place, and its height off by 5 % (RMS; at most 9 %, at θ = 75°,
where it grows faster than linearly) against 6 % (at most 13 %), of which the paths' own error is 3 %. Peaks farther
than a quarter of the way from the ridge, as those of the yarns' slopes in light from the side, are wider in the table
than in truth.
"""
import json
import pathlib
import sys

import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt
import numpy as np

HELD_OUT = 6
THETA = np.array([0, 10, 20, 30, 40, 50, 60, 70, 80, 88.0])
GRIDS = {"434 nodes": (THETA, 15, 434), "98 nodes": (THETA[::2], 30, 98)}  # both sides


def directions_of(raw):
    at = 8
    while at < len(raw):
        theta, phi, paths, exits = np.frombuffer(raw, "<f8", 4, at)
        rays = np.frombuffer(raw, "<f4", 4 * int(exits), at + 32).reshape(-1, 4).astype(float)
        at += 32 + 16 * int(exits)
        yield theta, phi, paths, rays[:, :3], rays[:, 3]


def unit(theta, phi):
    return np.array([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)])


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


def cone_of(along, finest=0.15):  # kFinest of materials/table/direction_mesh.h
    """Of the weft, 0, or of the warp, 1: materials/table/exit_chart.h."""
    def chart(w, light):
        u, of_u = slide(np.clip(w[:, along], -1, 1), -light[along])
        a, of_a = spaced(u, finest)
        b = np.arctan2(w[:, 1 - along], np.abs(w[:, 2])) / np.pi + 0.5
        return a, b, of_u * of_a * np.pi

    return chart


class Table:
    """One direction's rays in bins of both hemispheres, each a plane. Of the bins of a hemisphere: `size`
    in the chart, `beside`, the neighbours before and after, along either of its coordinates."""

    def fill(self, w, weight, paths, light):
        bins = len(self.size)
        at, *_ = self.places(w, light)
        mean = np.bincount(at, weight, 2 * bins).reshape(2, bins) / self.size / paths
        slopes = np.array([mean[:, after] - mean[:, before] for before, after in self.beside]) / 4
        steepest = np.abs(slopes).sum(0)
        slopes *= np.minimum(1, mean / np.maximum(steepest, 1e-30))
        return mean.ravel(), *slopes.reshape(2, -1)

    @staticmethod
    def value(filled, places):
        mean, along_a, along_b = filled
        at, xi, eta, area = places
        return (mean[at] + along_a[at] * xi + along_b[at] * eta) / area


class Charted(Table):
    """In columns × rows over equal steps of a chart's a and b."""

    def __init__(self, chart, columns, rows):
        self.chart, self.columns, self.rows = chart, columns, rows
        self.size = np.full(columns * rows, 1 / (columns * rows))
        i, j = np.divmod(np.arange(columns * rows), rows)
        self.beside = [(np.maximum(i - 1, 0) * rows + j, np.minimum(i + 1, columns - 1) * rows + j),
                       (i * rows + np.maximum(j - 1, 0), i * rows + np.minimum(j + 1, rows - 1))]

    def places(self, w, light):
        a, b, area = self.chart(w, light)
        i = np.clip((a * self.columns).astype(int), 0, self.columns - 1)
        j = np.clip((b * self.rows).astype(int), 0, self.rows - 1)
        at = ((w[:, 2] < 0) * self.columns + i) * self.rows + j
        return at, 2 * (a * self.columns - i) - 1, 2 * (b * self.rows - j) - 1, area


class Rings(Table):
    """In rings between the θ of `edges`, each cut into its count of bins of φ; their planes are of the
    intensity itself."""

    def __init__(self, edges, counts):
        self.edges, self.counts = edges, np.asarray(counts)
        self.first = np.concatenate([[0], np.cumsum(self.counts)])
        ring = np.repeat(np.arange(len(self.counts)), self.counts)
        of_ring, number = self.counts[ring], np.arange(self.first[-1]) - self.first[ring]
        self.size = (np.cos(edges[:-1]) - np.cos(edges[1:]))[ring] * 2 * np.pi / of_ring

        def other(ring):
            at = ((number + 0.5) / of_ring * self.counts[ring]).astype(int)
            return self.first[ring] + at

        self.beside = [(other(np.maximum(ring - 1, 0)), other(np.minimum(ring + 1, ring[-1]))),
                       (self.first[ring] + (number - 1) % of_ring, self.first[ring] + (number + 1) % of_ring)]

    def places(self, w, light):
        theta, turn = np.arccos(np.minimum(np.abs(w[:, 2]), 1)), np.arctan2(w[:, 1], w[:, 0]) / (2 * np.pi) % 1
        ring = np.clip(np.searchsorted(self.edges, theta, side="right") - 1, 0, len(self.counts) - 1)
        low, high, count = self.edges[ring], self.edges[ring + 1], self.counts[ring]
        number = np.minimum((turn * count).astype(int), count - 1)
        return (w[:, 2] < 0) * self.first[-1] + self.first[ring] + number, \
            (2 * theta - low - high) / (high - low), 2 * (turn * count - number) - 1, 1


def even_rings(rings, counts):
    return Rings(np.linspace(0, np.pi / 2, rings + 1), counts)


def near_equal_rings(rings):
    """As wide in the middle as they are high."""
    middles = (np.arange(rings) + 0.5) / rings * np.pi / 2
    return even_rings(rings, np.rint(4 * rings * np.sin(middles)).astype(int))


def rings_to_grazing(rings, count):
    """Their heights grow linearly from the horizon, where they are a quarter of the mean."""
    s = np.linspace(1, 0, rings + 1)
    return Rings(np.pi / 2 * (1 - s * (0.25 + 0.75 * s)), np.full(rings, count))


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


def squared_errors(nodes, held_out, table, thetas, step, rounded):
    """Of tables of all paths of the nodes, and of every other."""
    totals = np.zeros(2)
    for theta, phi, paths, w, weight, squares in held_out:
        light = unit(theta, phi)
        on_sphere, on_rays = table.places(SPHERE, light), table.places(w, light)
        for k in (0, 1):
            f_sphere, f_rays = 0, 0
            for share, _, filled in corner_tables(nodes, theta, phi, table, thetas, step, k + 1):
                filled = (rounded(filled[0]), *filled[1:])
                f_sphere = f_sphere + share * table.value(filled, on_sphere)
                f_rays = f_rays + share * table.value(filled, on_rays)
            squared = 4 * np.pi * (f_sphere**2).mean() - 2 * (f_rays * weight).sum() / paths + squares
            totals[k] += 4 * np.pi * squared / (weight.sum() / paths) ** 2
    return totals / len(held_out)


def errors_of(*case, rounded=lambda mean: mean):
    """With the noise of the nodes' paths, and without."""
    squared = squared_errors(*case, rounded)
    return [np.sqrt(max(x, 0)) for x in (squared[0], 2 * squared[0] - squared[1])]


def peak_of(values):
    """Height and position, of three bins' means: the highest, and the middle of what about it is above three
    quarters of that."""
    smooth = np.convolve(values, np.full(3, 1 / 3), "same")
    top = smooth.argmax()
    above = smooth > 0.75 * smooth[top]
    low, high = top, top
    while low > 0 and above[low - 1]:
        low -= 1
    while high + 1 < len(above) and above[high + 1]:
        high += 1
    part = slice(low, high + 1)
    return smooth[top], (MIDDLES[part] * smooth[part]).sum() / smooth[part].sum()


def profile(axis, nodes, held_out, along):
    """Across the ridge of the charted yarns, within 0.1 quarter turns round them of the mirror direction, in
    40 bins. Returns for each way the peak's height over the paths' and its offset from theirs, and the
    paths' own errors of both."""
    theta, phi, paths, w, weight, _ = held_out
    light, fine, across = unit(theta, phi), 4, 1 - along
    turn = lambda x, z: np.arctan2(x, np.abs(z)) / (np.pi / 2)
    mirror = turn(-light[across], light[2])
    y, t = np.meshgrid((np.arange(BINS * fine) + 0.5) / (BINS * fine) * 2 - 1,
                       mirror + np.linspace(-0.1, 0.1, 40), indexing="ij")
    psi, beside = t * np.pi / 2, np.sqrt(1 - y**2)
    points = np.empty((*y.shape, 3))
    points[..., along], points[..., across], points[..., 2] = y, beside * np.sin(psi), beside * np.cos(psi)
    points = points.reshape(-1, 3)
    near = (w[:, 2] > 0) & (np.abs(turn(w[:, across], w[:, 2]) - mirror) < 0.1)
    of_bin = 2 / BINS * 0.2 * np.pi / 2 * paths
    binned = lambda power: np.histogram(w[near, along], BINS, (-1, 1), weights=weight[near] ** power)[0]
    reference, noise = binned(1) / of_bin, np.sqrt(binned(2)) / of_bin
    table, moved, in_place = Charted(cone_of(along), 24, 16), 0, 0
    for share, node, filled in corner_tables(nodes, theta, phi, table, THETA, 15):
        moved = moved + share * table.value(filled, table.places(points, light))
        in_place = in_place + share * table.value(filled, table.places(points, node))
    mean = lambda values: values.reshape(BINS, -1).mean(1)
    axis.fill_between(MIDDLES, reference - noise, reference + noise, color="0.85", lw=0)
    for name, values, style in (("reference (paths)", reference, "k-"), ("blended in place",
                                mean(in_place), "C1--"), ("chosen: moved", mean(moved), "C0-")):
        axis.plot(MIDDLES, values, style, lw=1, label=name)
    random = np.random.default_rng(1)
    again = np.array([peak_of(reference + noise * random.standard_normal(BINS)) for _ in range(200)])
    height, position = peak_of(reference)
    print(f"  light from θ {np.degrees(theta):.0f}°, φ {np.degrees(phi):.0f}°: peak of the paths {height:.4f} ± "
          f"{again[:, 0].std():.4f} 1/sr at {position:+.3f} ± {again[:, 1].std():.3f} (mirror {-light[along]:+.3f})")
    found = []
    for name, values in (("in place", mean(in_place)), ("moved", mean(moved))):
        h, p = peak_of(values)
        print(f"    {name}: {h:.4f} at {p:+.3f}; RMS of the profile {np.sqrt(((values - reference)**2).mean()):.4f}, "
              f"of the paths' noise {np.sqrt((noise**2).mean()):.4f}")
        found.append((h / height - 1, p - position))
    return found, (again[:, 0].std() / height, again[:, 1].std())


SPHERE = sphere(100_000)
BINS = 40  # of a profile
MIDDLES = (np.arange(BINS) + 0.5) * 2 / BINS - 1
SIZES = [0.25, 0.5, 1, 2, 4, 8]  # MB, marked on the axis
# Named and numbered as in tests/bench/parameterisation_bench.cpp.
WAYS = {
    "uniform θ × φ": [even_rings(n, np.full(n, 4 * n)) for n in (9, 18)],
    "θ finer towards grazing": [rings_to_grazing(n, 4 * n) for n in (9, 18)],
    "rings of near-equal solid angle": [near_equal_rings(n) for n in (9, 12, 18)],
    "equal-area disc (Shirley–Chiu)": [Charted(equal_area_disc, n, n) for n in (14, 20, 36)],
    "about the mirror direction": [Charted(about_the_mirror, *n) for n in ((16, 12), (24, 16), (32, 16))],
    "cone of the warp": [Charted(cone_of(1), *n) for n in ((16, 12), (24, 12), (24, 16), (32, 16))],
    "cone of the weft": [Charted(cone_of(0), *n) for n in ((16, 12), (24, 12), (24, 16), (32, 16))],
}

plt.rcParams.update({"svg.hashsalt": "rapport", "svg.fonttype": "none", "font.size": 9})
runs = {}
for run in json.loads(pathlib.Path(sys.argv[1]).read_text())["benchmarks"]:
    if run["run_type"] == "iteration":
        runs.setdefault(run["name"], []).append(run["cpu_time"])
times = {name: np.percentile(of_name, 25) for name, of_name in runs.items()}  # other work only adds to it
files = [pathlib.Path(name) for name in sys.argv[2:]]
columns = -(-len(files) // 2)
(figure, axes), (of_time, time_axes) = (
    plt.subplots(2, columns, figsize=(4 * columns, 5.8), squeeze=False) for _ in range(2))
other, profiles = plt.subplots(len(files), HELD_OUT, figsize=(12, 1.7 * len(files)), squeeze=False, sharex=True)
for axis, time_axis, curves, path in zip(axes.flat, time_axes.flat, profiles, files):
    raw = path.read_bytes()
    along = 1 - int(np.frombuffer(raw, "<f8", 1)[0])
    everything = list(directions_of(raw))
    nodes = {(round(np.degrees(d[0])), round(np.degrees(d[1])) % 360): d
             for d in everything[:-HELD_OUT]}
    held_out = [(*d, square_integral(*d[2:])) for d in everything[-HELD_OUT:]]
    for colour, (name, tables) in enumerate(WAYS.items()):
        for (grid, (thetas, step, count)), line in zip(GRIDS.items(), ("-o", "--s")):
            bins = [len(t.size) for t in tables]
            megabytes = [count * 2 * n * 6 / 1e6 for n in bins]
            errors = []
            for t, size in zip(tables, megabytes):
                noisy, found = errors_of(nodes, held_out, t, thetas, step)
                errors.append(found)
                print(f"{path.stem}, {name}, {grid}, {len(t.size)} bins: "
                      f"{size:.2f} MB, error {found:.3f}, {noisy:.3f} with noise", flush=True)
            axis.plot(megabytes, errors, line, color=f"C{colour}", ms=4)
            if grid == next(iter(GRIDS)):
                time_axis.plot([times[f"{name}/{n}"] for n in bins], errors, line, color=f"C{colour}", ms=4)
    for each in (axis, time_axis):
        each.set(title=path.stem.replace("-front", ", light from the front").replace("-back", ", from behind"),
                 ylim=(0, None))
    axis.set(xscale="log")
    axis.set_xticks(SIZES, [f"{size:g}" for size in SIZES])
    axis.minorticks_off()
    chosen = nodes, held_out, Charted(cone_of(along), 24, 16), THETA, 15
    half = errors_of(*chosen, rounded=lambda mean: mean.astype(np.float16).astype(float))[0]
    empty = np.mean([(table[2][0] == 0).mean() for d in held_out
                     for table in corner_tables(nodes, *d[:2], *chosen[2:])])
    print(f"  in half precision: error {half:.5f} with noise, {errors_of(*chosen)[0]:.5f} in single; "
          f"{100 * empty:.1f} % of the bins are empty", flush=True)
    for finest in (0.15, 0.25, 0.35, 0.5, 0.7, 0.99):
        noisy, error = errors_of(*chosen[:2], Charted(cone_of(along, finest), 24, 16), THETA, 15)
        print(f"  columns at the highlight {finest:g} of equal ones: error {error:.3f}, {noisy:.3f} with noise", flush=True)
    found = [profile(axis, nodes, d, along) for axis, d in zip(curves, held_out)]
    offsets = np.array([of for of, _ in found])  # [directions, ways, height or position]
    rms = np.sqrt((offsets**2).mean(0))
    noise = np.sqrt(np.mean([np.square(own) for _, own in found], axis=0))
    for name, (height, position) in zip(("in place", "moved"), rms):
        print(f"  peaks {name}: off by {100 * height:.1f} % of the height and {position:.3f} of 1 in position (RMS "
              f"over the directions; the paths' own errors {100 * noise[0]:.1f} % and {noise[1]:.3f})", flush=True)
    for axis, d in zip(curves, held_out):
        axis.set_title(f"θ {np.degrees(d[0]):.0f}°, φ {np.degrees(d[1]):.0f}°", fontsize=8)
        axis.set_ylim(0, None)
    curves[0].set_ylabel(path.stem.replace("-front", "\nfront").replace("-back", "\nback"), fontsize=8)
for axis in profiles[-1]:
    axis.set_xlabel("along the yarns", fontsize=8)
for chart_axes, label in ((axes, "MB (three bands, half precision)"), (time_axes, "ns of a look-up, all written alike")):
    for axis in chart_axes[-1]:
        axis.set_xlabel(label)
    for axis in chart_axes[:, 0]:
        axis.set_ylabel("error at held-out incidence")
line = lambda style, colour, label: plt.Line2D([], [], ls=style[:-1], marker=style[-1], ms=4, color=colour, label=label)
of_ways = [line("-o", f"C{k}", name) for k, name in enumerate(WAYS)]
of_grids = [line(style, "0.4", grid) for grid, style in zip(GRIDS, ("-o", "--s"))]
for chart, name, handles in ((figure, "parameterisation", of_ways + of_grids), (of_time, "lookup", of_ways),
                             (other, "interpolation", profiles[0][0].get_legend_handles_labels()[0])):
    chart.legend(handles=handles, frameon=False, fontsize=8, ncols=4, loc="lower center")
    chart.tight_layout(rect=(0, 0.09 if chart is not other else 0.03, 1, 1))
    chart.savefig(pathlib.Path(__file__).with_name(name + ".svg"), metadata={"Date": None})
