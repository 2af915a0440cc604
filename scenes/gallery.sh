#!/usr/bin/env bash
# Six pictures and a sheet of them all: the dress in four cloths, a garment by somebody else, and the fibres of a
# satin beside its table. Measures the cloths whose tables build/gallery has not, or not in the program's format, which
# takes most of the time.
#   bash scenes/gallery.sh [PROGRAM [MODEL.glb]]
# The sheet wants python3-matplotlib.
set -euo pipefail
cd "$(dirname "$0")/.."
rapport=${1:-build/release/rapport}
model=${2:-../shared/data/gltf/tshirt_lengan_pendek.glb}
accuracy=${ACCURACY:-0.8} error=${ERROR:-0.03} height=${HEIGHT:-800}
out=build/gallery
mkdir -p "$out" build/quickstart

readable() { "$rapport" info "$1" >/dev/null 2>&1; }
table() {
    readable "$out/$1.bsdf" || "$rapport" vgsp "scenes/cloths/$1.toml" -o "$out/$1.bsdf" --accuracy "$accuracy" --resume
}
picture() { # name width arguments
    "$rapport" render "${@:3}" --size "$2x$height" --error "$error" -o "$out/$1.png"
}

for cloth in quickstart denim silk-shantung linen; do
    table "$cloth"
    picture "dress-$cloth" $((height * 4 / 5)) scenes/quickstart.pbrt --cloth Body="$out/$cloth.bsdf"
done
[[ -f $model ]] && picture shared $((height * 4 / 5)) "$model" --cloth "$out/silk-shantung.bsdf"
readable build/quickstart/satin.bsdf || cp "$out/quickstart.bsdf" build/quickstart/satin.bsdf
# Paths find the lamp by themselves alone between fibres: no sampling of lights to bring the noise down.
"$rapport" render scenes/close-up.pbrt --size "$((height * 8 / 5))x$height" --spp 64 -o "$out/close-up.png"

python3 - "$out" dress-quickstart dress-denim dress-silk-shantung dress-linen shared close-up <<'PYTHON'
import sys
from pathlib import Path

import matplotlib.image
import numpy

pictures = [matplotlib.image.imread(path)[:, :, :3] for path in
            (Path(sys.argv[1]) / f"{name}.png" for name in sys.argv[2:]) if path.exists()]
matplotlib.image.imsave(f"{sys.argv[1]}/sheet.png", numpy.concatenate([
    numpy.pad(p, ((0, 0), (0, 8), (0, 0)), constant_values=1) for p in pictures], 1)[::2, ::2])
PYTHON
echo "$out/sheet.png and the pictures beside it"
