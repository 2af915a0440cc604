"""Renders a mesh with Mitsuba 3 under a sky and a sun, in several pictures whose mean and its variance it writes.

python3 mitsuba_render.py VARIANT MESH.ply BSDF OUT.exr SIZE SAMPLES SEED BOUNCES
where BSDF is one of Mitsuba's as JSON. Spectral variants have equal-energy light, and write X, Y and Z, which such
light makes equal on white. Needs numpy.
"""
import json
import sys

import mitsuba as mi
import numpy

PICTURES = 32

variant, mesh, bsdf, out, size, samples, seed, bounces = sys.argv[1:]
mi.set_variant(variant)
spectral = variant.endswith("spectral")
white = "uniform" if spectral else "rgb"
scene = mi.load_dict({
    "type": "scene",
    "integrator": {"type": "path", "max_depth": int(bounces) + 1},
    "sky": {"type": "constant", "radiance": {"type": white, "value": 0.3}},
    "sun": {"type": "directional", "direction": [1.5, -1.5, -2.5],
            "irradiance": {"type": white, "value": 0.6}},
    "mesh": {"type": "ply", "filename": mesh, "face_normals": True, "bsdf": json.loads(bsdf)},
    "camera": {"type": "perspective", "fov": 30,
               "to_world": mi.ScalarTransform4f().look_at([0.8, -2.6, 3], [0, 0, 0], [0, 0, 1]),
               "film": {"type": "hdrfilm", "width": int(size), "height": int(size),
                        "rfilter": {"type": "box"}, "pixel_format": "xyz" if spectral else "rgb"},
               "sampler": {"type": "independent", "sample_count": max(int(samples) // PICTURES, 1)}},
})
pictures = numpy.array([numpy.array(mi.render(scene, seed=int(seed) * PICTURES + i)) for i in range(PICTURES)],
                       numpy.float64)
told = numpy.concatenate([pictures.mean(0), pictures.var(0, ddof=1) / PICTURES], 2)
mi.Bitmap(told.astype(numpy.float32), mi.Bitmap.PixelFormat.MultiChannel,
          ["R", "G", "B", "variance.R", "variance.G", "variance.B"]).write(out)
