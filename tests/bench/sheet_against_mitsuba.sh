#!/usr/bin/env bash
# Renders ../shared/bench/sheet.pbrt (512², 64 samples, 200,000 triangles) with the program and with Mitsuba 3's
# scalar variant in turn, three times each, and prints the seconds that each says its rendering took.
set -euo pipefail
cd "$(dirname "$0")/../.."
program=$(realpath "${1:-build/tests/rapport}")
bench=$(realpath ../shared/bench)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
ln -s "$bench/cloth200k.ply" .
for run in 1 2 3; do
  "$program" render "$bench/sheet.pbrt" --threads 2 -o "$folder/sheet.exr"
  python3 "$bench/render.py" scalar_rgb diffuse 2 64
done
