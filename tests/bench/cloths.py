#!/usr/bin/env python3
"""Prints the README's table of cloths: what each cloth of scenes/cloths/ weighs, and does to light
along its normal, in the mean over its bands.

    python3 tests/bench/cloths.py build/release/rapport
"""
import json
import pathlib
import subprocess
import sys
import tempfile

PATHS = 40_000  # standard error of a share: 0.0025 or less


def info(program, file):
    return json.loads(subprocess.check_output([program, "info", "--json", file]))


def mean(values):
    return sum(values) / len(values)


def main():
    program = sys.argv[1]
    folder = pathlib.Path(__file__).resolve().parents[2] / "scenes" / "cloths"
    print("| cloth | mass [g/m²] | thickness [mm] | cover | reflected | transmitted | straight through "
          "| overlap [%] | thinned [%] |")
    print("|---|---|---|---|---|---|---|---|---|")
    for file in sorted(folder.glob("*.toml")):
        element = info(program, file)["micro_element"]
        with tempfile.TemporaryDirectory() as temporary:
            table = pathlib.Path(temporary) / "cloth.bsdf"
            subprocess.check_call([program, "vgsp", file, "--incidence", "0,0", "--side", "front",
                                   "--max-rays", str(PATHS), "--realisations", "1", "--quiet",
                                   "-o", table])
            light = info(program, table)["incident"][0]
        print(f"| `{file.stem}` | {element['mass_g_per_m2']:.0f} "
              f"| {element['thickness_um'] / 1000:.2f} | {element['cover_factor']:.2f} "
              f"| {mean(light['R']):.3f} | {mean(light['T']):.3f} "
              f"| {mean(light['unscattered']):.3f} | {100 * element['overlap_fraction']:.2f} "
              f"| {100 * element['thinned']:.1f} |", flush=True)


if __name__ == "__main__":
    main()
