"""Renders a mesh with Mitsuba 3 under a sky and perhaps a sun, in several pictures whose mean and its variance it
writes.

python3 mitsuba_render.py VARIANT WORLD OUT.exr SIZE SAMPLES SEED
where WORLD is JSON: "mesh" the name of a PLY file, "eye", "centre" and "fov" of the camera, "sky" a radiance, "sun" the
direction towards it and "irradiance" what comes from there, "bsdf" one of Mitsuba's, "bounces". Spectral variants have
equal-energy light, and write X, Y and Z, which such light makes equal on white. Needs numpy.
"""
import json
import sys

import mitsuba as mi
import numpy

PICTURES = 32

variant, world, out, size, samples, seed = sys.argv[1:]
world = json.loads(world)
mi.set_variant(variant)
spectral = variant.endswith("spectral")


def white(value):
    return {"type": "uniform" if spectral else "rgb", "value": value}


sun = {"sun": {"type": "directional", "direction": [-x for x in world["sun"]],
               "irradiance": white(world["irradiance"])}} if world["irradiance"] > 0 else {}
scene = mi.load_dict({
    "type": "scene",
    "integrator": {"type": "path", "max_depth": world["bounces"] + 1},
    "sky": {"type": "constant", "radiance": white(world["sky"])}, **sun,
    "mesh": {"type": "ply", "filename": world["mesh"], "face_normals": True, "bsdf": world["bsdf"]},
    "camera": {"type": "perspective", "fov": world["fov"],
               "to_world": mi.ScalarTransform4f().look_at(world["eye"], world["centre"], [0, 0, 1]),
               "film": {"type": "hdrfilm", "width": int(size), "height": int(size),
                        "rfilter": {"type": "box"}, "pixel_format": "xyz" if spectral else "rgb"},
               "sampler": {"type": "independent", "sample_count": max(int(samples) // PICTURES, 1)}},
})
pictures = numpy.array([numpy.array(mi.render(scene, seed=int(seed) * PICTURES + i)) for i in range(PICTURES)],
                       numpy.float64)
told = numpy.concatenate([pictures.mean(0), pictures.var(0, ddof=1) / PICTURES], 2)
mi.Bitmap(told.astype(numpy.float32), mi.Bitmap.PixelFormat.MultiChannel,
          ["R", "G", "B", "variance.R", "variance.G", "variance.B"]).write(out)
