#!/usr/bin/env bash
# From a weave draft to a rendered garment: builds the program, measures a satin, dresses the form in it.
set -euo pipefail
cd "$(dirname "$0")/.."
accuracy=0.8
out=build/quickstart

bash .ci/setup.sh program
cmake --preset release
cmake --build --preset release --target rapport

mkdir -p "$out"
rapport=build/release/rapport
"$rapport" vgsp scenes/cloths/quickstart.toml -o "$out/satin.bsdf" --accuracy "$accuracy"
"$rapport" render scenes/quickstart.pbrt -o "$out/garment.exr" -o "$out/garment.png"

report=$("$rapport" info --json "$out/satin.bsdf")
reached=${report#*'"accuracy":'}
reached=$(printf '%.2f' "${reached%%,*}")
cat <<TEXT

The cloth, of accuracy $reached where $accuracy was asked:
  $out/satin.bsdf
The garment:
  $out/garment.exr
  $out/garment.png
TEXT
