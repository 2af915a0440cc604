"""Draws the profiles that table_interpolation_bench prints:

    table_interpolation_bench HELD_OUT.bsdf NODES.bsdf … | python3 table_interpolation.py THETA PHI

One panel a cloth, light from THETA, PHI (degrees; one of the held-out directions); writes
table_interpolation.svg beside this script.
"""

import pathlib
import sys

import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt

theta, phi = float(sys.argv[1]), float(sys.argv[2])
profiles = {}
for line in sys.stdin:
    words = line.split()
    if words[:1] != ["profile"] or (float(words[2]), float(words[3])) != (theta, phi):
        print(line, end="") if words[:1] != ["profile"] else None
        continue
    profiles.setdefault(pathlib.Path(words[1]).stem, []).append([float(w) for w in words[4:]])
if not profiles:
    sys.exit(f"no profile of light from {theta:g}, {phi:g}")

plt.rcParams.update({"svg.hashsalt": "rapport", "font.size": 9})
figure, axes = plt.subplots(1, len(profiles), figsize=(4.2 * len(profiles), 3.2), squeeze=False)
for axis, (cloth, rows) in zip(axes[0], profiles.items()):
    angle, reference, blend, moved = zip(*rows)
    axis.plot(angle, reference, color="black", label="measured at this incidence")
    axis.plot(angle, blend, color="tab:red", linestyle="--", label="nodes blended in place")
    axis.plot(angle, moved, color="tab:blue", label="highlights moved, then blended")
    axis.set_title(f"{cloth.removesuffix('-held')}, light from θ {theta:g}°, φ {phi:g}°")
    axis.set_xlabel("exit angle to the weft plane [°]")
    axis.set_ylabel("reflected intensity, mean round the warp [1/sr]")
    axis.set_ylim(bottom=0)
axes[0][0].legend(frameon=False, fontsize=8)
figure.tight_layout()
figure.savefig(pathlib.Path(__file__).with_suffix(".svg"), metadata={"Date": None})
