#!/usr/bin/env python3
"""What accuracy a measurement is asked for, reaches, and costs: for each cloth and accuracy the worst
direction's ε, how many of the directions claim more than was asked, the paths spent on each in the mean,
in units of 1/asked², and over the ideal number, ε²·N/asked² with each direction's ε² of the same run.
Two programs are compared side by side.

    python3 tests/bench/accuracy.py build/release/rapport [ANOTHER_RAPPORT]
"""
import json
import pathlib
import subprocess
import sys
import tempfile

CLOTHS = ["viscose-plain", "quickstart", "cotton-twill"]
ASKED = [0.8, 0.4]


def measured(program, cloth, asked):
    with tempfile.TemporaryDirectory() as temporary:
        table = pathlib.Path(temporary) / "cloth.bsdf"
        subprocess.check_call([program, "vgsp", cloth, "--accuracy", str(asked), "--quiet", "-o", table])
        return json.loads(subprocess.check_output([program, "info", "--json", table]))["incident"]


def main():
    folder = pathlib.Path(__file__).resolve().parents[2] / "scenes" / "cloths"
    print("| cloth | program | asked | reached | directions above | paths | a direction's ε²·paths | over the ideal |")
    print("|---|---|---|---|---|---|---|---|")
    for cloth in CLOTHS:
        for asked in ASKED:
            for program in sys.argv[1:]:
                incident = measured(program, folder / f"{cloth}.toml", asked)
                reached = [direction["accuracy"] for direction in incident]
                paths = [direction["paths"] for direction in incident]
                ideal = sum(n * (e / asked) ** 2 for n, e in zip(paths, reached))
                print(f"| `{cloth}` | {program} | {asked} | {max(reached):.3f} "
                      f"| {sum(e > asked for e in reached)} of {len(reached)} "
                      f"| {sum(paths):,} | {sum(paths) * asked**2 / len(paths):,.0f} "
                      f"| {sum(paths) / ideal:.2f} |", flush=True)


if __name__ == "__main__":
    main()
