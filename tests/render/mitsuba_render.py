"""Renders a mesh in a `measured` reflectance with Mitsuba 3: one bounce, under a sky and a sun.

python3 mitsuba_render.py MESH.ply FILE.bsdf OUT.exr SIZE SAMPLES SEED
Exit status 3 where there is no Mitsuba.
"""
import sys

try:
    import mitsuba as mi
except ImportError:
    sys.exit(3)

mesh, reflectance, out, size, samples, seed = sys.argv[1:]
mi.set_variant("scalar_rgb")
scene = mi.load_dict({
    "type": "scene",
    "integrator": {"type": "path", "max_depth": 2},
    "sky": {"type": "constant", "radiance": {"type": "rgb", "value": 0.3}},
    "sun": {"type": "directional", "direction": [1.5, -1.5, -2.5],
            "irradiance": {"type": "rgb", "value": 0.6}},
    "mesh": {"type": "ply", "filename": mesh, "face_normals": True,
             "bsdf": {"type": "measured", "filename": reflectance}},
    "camera": {"type": "perspective", "fov": 30,
               "to_world": mi.ScalarTransform4f().look_at([0.8, -2.6, 3], [0, 0, 0], [0, 0, 1]),
               "film": {"type": "hdrfilm", "width": int(size), "height": int(size),
                        "rfilter": {"type": "box"}},
               "sampler": {"type": "independent", "sample_count": int(samples)}},
})
mi.Bitmap(mi.render(scene, seed=int(seed))).write(out)
