#!/usr/bin/env python3
"""Renders three scenes in turn with the program and with Mitsuba 3, scalar and LLVM, two threads each:

  sheet     ../shared/bench/sheet.pbrt, 199,712 triangles under an even sky, diffuse
  cloth     the same in a measured cloth; Mitsuba has what `rapport export` makes of the table as its `measured`,
            which reflects only, where ours also transmits
  synthetic the same, but Mitsuba has the smaller `measured` of ../shared/bench/tables.py, another material: only times
            compare
  garment   the dress in that cloth, on its form, under a sky from a photograph; noise on the garment alone

and prints for each the least seconds of rendering of some interleaved runs, the user CPU seconds beside them as a
check against a busy machine, the relative mean squared error that they leave (variance over the squared mean plus
0.01), the seconds to bring that to 1e-3, and the mean difference of the pictures in standard errors.

    pip install mitsuba numpy; apt install libllvm19
    python3 tests/bench/against_mitsuba.py [build/tests/rapport [TABLE.bsdf [sheet|cloth|synthetic|garment …]]]

Without a table the quickstart satin is measured to accuracy 0.8 first. The error is measured in the same way for
all, from pairs of pictures with different seeds; the program's picture is mirrored first, because pbrt's camera is
left-handed and Mitsuba's is not."""
import glob
import json
import os
import re
import resource
import struct
import subprocess
import sys
import tempfile
import time
from pathlib import Path

libraries = sorted(glob.glob("/usr/lib/*/libLLVM*19*"))
if libraries:
    os.environ.setdefault("DRJIT_LIBLLVM_PATH", libraries[0])
import drjit
import mitsuba
import numpy

ROOT = Path(__file__).resolve().parents[2]
SHARED = ROOT.parent / "shared"
SHEET = SHARED / "bench" / "cloth200k.ply"
SKY = SHARED / "data" / "env" / "pmndrs_sunset.exr"
PROGRAM = sys.argv[1] if len(sys.argv) > 1 else str(ROOT / "build" / "tests" / "rapport")
RUNS, SAMPLES = int(os.environ.get("RUNS", 4)), int(os.environ.get("SAMPLES", 64))
SCENES = sys.argv[3:] or ["sheet", "cloth", "synthetic", "garment"]
for file in SHEET, SKY:
    if not file.exists():
        sys.exit(f"{file} is not here")


def cpu(who):
    return resource.getrusage(who).ru_utime


# The scenes, for both programs


def write_ply(path, model, data, name):
    """One mesh of a glTF model, with normals smooth over its seams."""
    def accessor(index):
        a = model["accessors"][index]
        view = model["bufferViews"][a["bufferView"]]
        kind = {5123: "<u2", 5125: "<u4", 5126: "<f4"}[a["componentType"]]
        width = {"SCALAR": 1, "VEC2": 2, "VEC3": 3}[a["type"]]
        start = view.get("byteOffset", 0) + a.get("byteOffset", 0)
        return numpy.frombuffer(data, kind, a["count"] * width, start).reshape(-1, width)

    mesh = next(m for m in model["meshes"] if m["name"] == name)["primitives"][0]
    points = accessor(mesh["attributes"]["POSITION"])
    uvs = accessor(mesh["attributes"]["TEXCOORD_0"]) * [1, -1] + [0, 1]
    corners = accessor(mesh["indices"]).reshape(-1, 3).astype("<i4")
    _, place = numpy.unique(points.round(6), axis=0, return_inverse=True)
    place = place.reshape(-1)
    a, b, c = (points[corners[:, i]] for i in range(3))
    sums = numpy.zeros((place.max() + 1, 3))
    for i in range(3):
        numpy.add.at(sums, place[corners[:, i]], numpy.cross(b - a, c - a))
    normals = sums[place] / numpy.linalg.norm(sums[place], axis=1, keepdims=True)
    vertices = numpy.concatenate([points, normals, uvs], 1).astype("<f4")
    faces = numpy.zeros(len(corners), [("count", "u1"), ("corners", "<i4", 3)])
    faces["count"], faces["corners"] = 3, corners
    properties = "".join(f"property float {name}\n" for name in ("x", "y", "z", "nx", "ny", "nz", "u", "v"))
    header = (f"ply\nformat binary_little_endian 1.0\nelement vertex {len(vertices)}\n{properties}"
              f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n")
    path.write_bytes(header.encode() + vertices.tobytes() + faces.tobytes())


def write_garment(folder):
    sky = numpy.array(mitsuba.Bitmap(str(SKY)).convert(mitsuba.Bitmap.PixelFormat.RGB,
                                                       mitsuba.Struct.Type.Float32, False))
    mitsuba.Bitmap(numpy.maximum(sky, 0)).write(str(folder / "sky.exr"))  # its compression left some below
    glb = (ROOT / "scenes" / "garments" / "dress.glb").read_bytes()
    length = struct.unpack("<I", glb[12:16])[0]
    model, data = json.loads(glb[20:20 + length]), glb[28 + length:]
    for name in ("Body", "Form"):
        write_ply(folder / f"{name}.ply", model, data, name)


def pbrt_scene(name, folder, table):
    view, sky, depth, size = {
        "garment": ("LookAt 0.85 1.25 2.35  0 0.8 0  0 1 0", f'"string filename" "{folder}/sky.exr"', 5, 256),
    }.get(name, ("LookAt 1.6 -2.4 1.9  0 0 .15  0 0 1", '"rgb L" [1 1 1]', 5, 512))
    fov = 32 if name == "garment" else 40
    cloth = f'Material "cloth" "string filename" "{table}"\n'
    sheet = f'Shape "plymesh" "string filename" "{SHEET}"\n'
    shapes = {
        "sheet": 'Material "diffuse" "rgb reflectance" [.7 .7 .7]\n' + sheet, "cloth": cloth + sheet,
        "synthetic": cloth + sheet,
        "garment": cloth + f'Shape "plymesh" "string filename" "{folder}/Body.ply"\n'
                   'Material "diffuse" "rgb reflectance" [.45 .45 .45]\n'
                   f'Shape "plymesh" "string filename" "{folder}/Form.ply"\n'}[name]
    path = folder / f"{name}.pbrt"
    path.write_text(
        f'{view}\nCamera "perspective" "float fov" {fov}\nSampler "zsobol"\nPixelFilter "box"\n'
        f'Integrator "path" "integer maxdepth" {depth}\n'
        f'Film "rgb" "integer xresolution" {size} "integer yresolution" {size} "string filename" "out.exr"\n'
        # The photograph's up is +z, the model's +y.
        f'WorldBegin\nAttributeBegin\n{"Rotate -90 1 0 0" if name == "garment" else ""}\n'
        f'LightSource "infinite" {sky}\nAttributeEnd\n{shapes}')
    return path


def mitsuba_scene(name, folder, measured):
    garment = name == "garment"
    view = {"origin": [0.85, 1.25, 2.35], "target": [0, 0.8, 0], "up": [0, 1, 0]} if garment else {
        "origin": [1.6, -2.4, 1.9], "target": [0, 0, 0.15], "up": [0, 0, 1]}
    size = 256 if garment else 512

    def ply(file, bsdf):
        return {"type": "ply", "filename": str(file), "bsdf": {"type": "twosided", "b": bsdf}}

    def grey(reflectance):
        return {"type": "diffuse", "reflectance": reflectance}

    cloth = {"type": "measured", "filename": str(measured)}
    shapes = {"sheet": {"sheet": ply(SHEET, grey(0.7))}, "cloth": {"sheet": ply(SHEET, cloth)},
              "synthetic": {"sheet": ply(SHEET, cloth)},
              "garment": {"body": ply(folder / "Body.ply", cloth), "form": ply(folder / "Form.ply", grey(0.45))}}
    # Ours: azimuth from +x falls from left to right, z up, turned with the model; Mitsuba's has y up.
    turned = mitsuba.ScalarTransform4f().rotate([1, 0, 0], -90) @ mitsuba.ScalarTransform4f(
        [[0, 0, 1, 0], [1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 0, 1]])
    sky = {"type": "envmap", "filename": str(folder / "sky.exr"), "to_world": turned} if garment else {"type": "constant"}
    return mitsuba.load_dict({
        "type": "scene", "integrator": {"type": "path", "max_depth": 6, "rr_depth": 100}, "sky": sky,
        **shapes[name],
        "camera": {"type": "perspective", "fov": 32 if garment else 40,
                   "to_world": mitsuba.ScalarTransform4f().look_at(**view),
                   "film": {"type": "hdrfilm", "width": size, "height": size, "rfilter": {"type": "box"}},
                   "sampler": {"type": "independent", "sample_count": SAMPLES}}})


# One picture: seconds, user CPU seconds, pixels


def with_program(scene, samples, seed, whole=False):
    picture = scene.with_suffix(".exr")
    start = cpu(resource.RUSAGE_CHILDREN)
    said = subprocess.run([PROGRAM, "render", scene, "--threads", "2", "--spp", str(samples), "--seed", str(seed),
                           "-o", picture], check=True, capture_output=True, text=True)
    user = cpu(resource.RUSAGE_CHILDREN) - start
    seconds = float(re.search(r"([\d.]+) s\b", said.stdout).group(1))
    parts = dict(mitsuba.Bitmap(str(picture)).split())
    radiance = numpy.array(parts["<root>"])[:, ::-1].astype(float)
    names = [field.name for field in parts["<root>"].struct_()]
    pixels = radiance[:, :, [names.index(c) for c in "RGB"]]
    return (seconds, user, pixels) if not whole else (pixels, radiance[:, :, names.index("Z")] > 0)


def with_mitsuba(scene, samples, seed):
    start, user = time.perf_counter(), cpu(resource.RUSAGE_SELF)
    picture = mitsuba.render(scene, spp=samples, seed=seed)
    drjit.eval(picture)
    drjit.sync_thread()
    pixels = numpy.array(picture)[:, :, :3].astype(float)
    return time.perf_counter() - start, cpu(resource.RUSAGE_SELF) - user, pixels


def compare(name, folder, table, measured):
    scene = pbrt_scene(name, folder, table)
    _, seen = with_program(scene, 1, 0, whole=True)
    mask = seen if name == "garment" else numpy.ones_like(seen)
    setup = min(with_program(scene, 1, 0)[1] for _ in range(2))  # CPU seconds of reading the scene
    renderers = {"rapport": None}
    for variant in ("scalar_rgb", "llvm_ad_rgb"):
        try:
            mitsuba.set_variant(variant)
            mitsuba.set_log_level(mitsuba.LogLevel.Error)
            if variant != "scalar_rgb":
                drjit.set_thread_count(2)
            renderers[variant] = mitsuba_scene(name, folder, measured)
            with_mitsuba(renderers[variant], 1, 99)  # compiles the kernels
        except ImportError as error:
            print(f"{variant}: left out, {error}")
    runs = {renderer: [] for renderer in renderers}
    for run in range(RUNS):
        for renderer, loaded in renderers.items():
            if loaded is None:
                seconds, user, pixels = with_program(scene, SAMPLES, run)
                runs[renderer].append((seconds, user - setup, pixels))
            else:
                mitsuba.set_variant(renderer)
                runs[renderer].append(with_mitsuba(loaded, SAMPLES, run))
    figures = {}
    for renderer, results in runs.items():
        images = [pixels[mask] for _, _, pixels in results]
        mean = numpy.mean(images, axis=0)
        variance = numpy.mean([(a - b) ** 2 / 2 for a, b in zip(images[::2], images[1::2])], axis=0)
        figures[renderer] = (min(r[0] for r in results), min(r[1] for r in results),
                             float(numpy.mean(variance / (mean ** 2 + 0.01))), mean)
    peer = figures["scalar_rgb" if name == "garment" or "llvm_ad_rgb" not in figures else "llvm_ad_rgb"]
    print(f"{name}, {SAMPLES} samples a pixel")
    for renderer, (seconds, user, error, mean) in figures.items():
        difference = mean - peer[3]
        print(f"  {renderer:12} {seconds:6.2f} s  {user:6.2f} CPU s  relMSE {error:.2e}  "
              f"to 1e-3 {1e3 * error * seconds:7.2f} s  {1e3 * error * user:7.2f} CPU s   "
              f"mean difference {difference.mean():+.1e} ± {difference.std() / difference.size ** 0.5:.1e}")
    ours, names = figures["rapport"], {True: "Mitsuba scalar", False: "Mitsuba LLVM"}[peer is figures["scalar_rgb"]]
    for what, ratio in (("time", lambda f, i: f[i]), ("time × error", lambda f, i: f[i] * f[2])):
        print(f"  {what} over {names}'s: {ratio(ours, 0) / ratio(peer, 0):.3f}, by CPU time "
              f"{ratio(ours, 1) / ratio(peer, 1):.3f}", flush=True)


with tempfile.TemporaryDirectory() as temporary:
    folder = Path(temporary)
    table, measured = Path(sys.argv[2]).resolve() if len(sys.argv) > 2 else folder / "satin.bsdf", folder / "measured.bsdf"
    if SCENES != ["sheet"]:
        if not table.exists():
            subprocess.run([PROGRAM, "vgsp", ROOT / "scenes/cloths/quickstart.toml", "--accuracy", "0.8", "-o", table],
                           check=True)
        subprocess.run([PROGRAM, "export", table, "--to", "mitsuba", "-o", measured], check=True, capture_output=True)
        mitsuba.set_variant("scalar_rgb")
        write_garment(folder)
    for name in SCENES:
        if name == "synthetic":
            subprocess.run([sys.executable, SHARED / "bench" / "tables.py", folder / "synthetic.bsdf"], check=True)
        compare(name, folder, table, folder / "synthetic.bsdf" if name == "synthetic" else measured)
