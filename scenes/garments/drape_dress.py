"""Cuts, sews and drapes a strapless dress on a dressmaker's form, and writes dress.glb beside this file.

    blender --background --python scenes/garments/drape_dress.py

The dress is cut from eight flat gores. Each runs from the neckline to the hem in one piece: it follows the
form down to the waist and then flares, and all eight together make three quarters of a circle. Springs sew
the gores; the bodice is held to the form as boning would hold it; the skirt falls over a petticoat that only
the solver sees; then the gores are welded where they meet. Two glTF materials: `Body` (the cloth) and `Form`
(the stand).

UV is the flat pattern in metres: u along the weft, v along the warp, which runs up the middle of each gore.
Every gore has its own island and none is mirrored. Units are metres, and the stand's foot is at height 0.
Made with Blender 3.4; equal runs give equal files. Blender is needed only to make the file again.
"""

import math
import os

import bpy
import numpy as np

GORES = 8
COLUMNS = 11  # quads across a gore
BODICE_ROWS, SKIRT_ROWS = 14, 36
WAIST = 1.04  # height above the floor
SKIRT_LENGTH = 0.74
FLARE = math.radians(0.75 * 360 / GORES / 2)  # half the angle of one gore
EASE = 0.005  # gap between form and cloth
INSET = 0.004  # the form is made this much slimmer once the dress is draped, so that it never shows through
BELL, HIP_RISE, HIP_LENGTH = 0.36, 0.04, 0.12  # the skirt's first shape, see bell()
FLUTES = 13  # its folds
PETTICOAT_GAP, PETTICOAT_FLUTE = 0.008, 0.6  # how far inside the petticoat lies, and its share of a fold's depth
FRAMES = 60
SEED = 7

# Sections of the form: height, half width, depth in front, depth behind.
SECTIONS = np.array([
    (0.74, 0.140, 0.095, 0.112), (0.81, 0.166, 0.106, 0.128), (0.88, 0.171, 0.106, 0.124),
    (0.96, 0.150, 0.100, 0.098), (1.04, 0.118, 0.088, 0.078), (1.12, 0.128, 0.098, 0.084),
    (1.22, 0.142, 0.108, 0.094), (1.30, 0.152, 0.104, 0.100), (1.37, 0.164, 0.088, 0.098),
    (1.42, 0.148, 0.070, 0.088), (1.455, 0.098, 0.058, 0.074), (1.48, 0.062, 0.052, 0.062),
    (1.52, 0.052, 0.048, 0.056), (1.56, 0.050, 0.046, 0.054)])


def cubic(x, xs, ys):
    """Cubic Hermite interpolation with central-difference slopes."""
    slopes = np.gradient(ys, xs)
    i = np.clip(np.searchsorted(xs, x) - 1, 0, len(xs) - 2)
    h = xs[i + 1] - xs[i]
    t = (x - xs[i]) / h
    return ((1 + 2 * t) * (1 - t) ** 2 * ys[i] + t * (1 - t) ** 2 * h * slopes[i]
            + t * t * (3 - 2 * t) * ys[i + 1] + t * t * (t - 1) * h * slopes[i + 1])


def form_point(angle, height, inset=0.0):
    """Point of the form; angle 0 is its front (-Y), growing towards +X. Blender's axes: Z is up."""
    width, front, back = (cubic(height, SECTIONS[:, 0], SECTIONS[:, c]) - inset for c in (1, 2, 3))
    s, c = np.sin(angle), np.cos(angle)
    x = width * np.sign(s) * np.abs(s) ** 0.9
    y = -np.where(c > 0, front, back) * np.sign(c) * np.abs(c) ** 0.9
    bust = 0.034 * np.exp(-(np.abs(x) / 0.105) ** 4 - ((height - 1.225) / 0.062) ** 2)
    return np.stack([x, y - bust * np.clip(c, 0, 1) ** 0.5, height + 0 * x], -1)


class Section:
    """The cloth's horizontal section at one height: the form, offset by the ease."""

    def __init__(self, height):
        self.angle = np.linspace(-math.pi / GORES, 2 * math.pi - math.pi / GORES, 1441)
        p = form_point(self.angle, np.full_like(self.angle, height))
        tangent = np.gradient(p, axis=0)
        normal = np.stack([-tangent[:, 1], tangent[:, 0], 0 * tangent[:, 0]], -1)
        self.normal = -normal / np.linalg.norm(normal, axis=1, keepdims=True)
        self.point = p + EASE * self.normal
        self.arc = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(self.point, axis=0), axis=1))])

    def gore(self, k):
        """Arc lengths at the two seams of gore k."""
        return np.interp(np.array([k - 0.5, k + 0.5]) * 2 * math.pi / GORES, self.angle, self.arc)

    def at(self, k, t, values):
        """`values` at the fraction t in [-1, 1] of gore k's width."""
        a, b = self.gore(k)
        arc = a + (t + 1) / 2 * (b - a)
        return np.array([np.interp(arc, self.arc, values[:, i]) for i in range(3)])


def neckline(angle):
    """Height of the upper edge: a sweetheart front, lower under the arms and at the back."""
    c = math.cos(angle)
    front = max(c, 0) ** 1.5
    return 1.275 + 0.045 * front - 0.03 * math.exp(-(angle / 0.22) ** 2) - 0.02 * max(-c, 0)


def smoothstep(x):
    x = min(max(x, 0), 1)
    return x * x * (3 - 2 * x)


def pattern_point(width, flare, t, v):
    """Flat point at the fraction t of a row of the given width: an arc about the gore's apex."""
    if flare < 1e-6:
        return t * width / 2, v
    radius = width / (2 * flare)
    return radius * math.sin(t * flare), v + radius * (1 - math.cos(t * flare))


def skirt_depth(row):
    """Distance from the waist along the cloth; rows are closer together near it."""
    f = row / SKIRT_ROWS
    return SKIRT_LENGTH * (0.6 * f + 0.4 * f * f)


def bell(s):
    """How far out and how far down the skirt is at the distance s along the cloth: flatter
    over the hips, where the cut gives just the length that lies without folds."""
    x = np.linspace(0, s, 60)
    tilt = BELL + HIP_RISE / HIP_LENGTH * np.exp(-x / HIP_LENGTH)
    return (BELL * s + HIP_RISE * (1 - math.exp(-s / HIP_LENGTH)),
            np.trapz(np.sqrt(1 - np.minimum(tilt**2 + 0.01, 0.9)), x))


def hang_skirt():
    """First positions of the skirt, (row, column round the waist), and the points of the petticoat under it,
    which only the cloth solver sees: a bell with uneven flutes, so deep that each row has the length of the
    cloth. The petticoat's flutes are shallower and lie inside."""
    rng = np.random.default_rng(SEED)
    waist = Section(WAIST)
    widths = np.array([np.ptp(waist.gore(k)) for k in range(GORES)])
    phase = FLUTES * waist.angle + sum(rng.uniform(0.4, 0.8) * np.sin(n * waist.angle + rng.uniform(0, 2 * math.pi))
                                       for n in (1, 2, 3, 5))
    depth = 1 + sum(0.12 * np.sin(n * waist.angle + rng.uniform(0, 2 * math.pi)) for n in (1, 2, 3))
    skirt, petticoat = [], []
    for row in range(SKIRT_ROWS + 3):
        s = skirt_depth(row)
        out, down = bell(s)
        target = np.concatenate([[0], np.cumsum(np.repeat((widths + 2 * FLARE * s) / COLUMNS, COLUMNS))])

        def ring(amplitude):
            flute = out + amplitude * depth * np.cos(phase)
            points = waist.point + flute[:, None] * waist.normal - [0, 0, down]
            return points, np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])

        low, high = 0.0, 0.3
        for _ in range(40):
            middle = (low + high) / 2
            low, high = (middle, high) if ring(middle)[1][-1] < target[-1] else (low, middle)
        points, arc = ring(low)
        skirt.append(np.stack([np.interp(target * arc[-1] / target[-1], arc, points[:, i]) for i in range(3)], -1))
        inside = PETTICOAT_GAP + low * depth * (1 - PETTICOAT_FLUTE) * (1 + np.cos(phase))
        petticoat.append((points - inside[:, None] * waist.normal)[:-1:8])
    return np.array(skirt), petticoat[2:]


def cut_gore(k, skirt):
    """One gore as grids (row from the neckline down, column): flat pattern and first position."""
    flat = np.zeros((BODICE_ROWS + SKIRT_ROWS + 1, COLUMNS + 1, 2))
    space = np.zeros(flat.shape[:2] + (3,))
    centre = 2 * math.pi * k / GORES
    heights = np.linspace(WAIST, 1.36, 161)
    line = np.array([Section(h).at(k, 0.0, Section(h).point) for h in heights])
    meridian = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))])
    waist_width = np.ptp(Section(WAIST).gore(k))
    for column in range(COLUMNS + 1):
        t = 2 * column / COLUMNS - 1
        angle = (centre + t * math.pi / GORES + math.pi) % (2 * math.pi) - math.pi
        for row in range(BODICE_ROWS):
            height = WAIST + (neckline(angle) - WAIST) * (1 - row / BODICE_ROWS)
            section = Section(height)
            flare = FLARE * smoothstep((1.13 - height) / (1.13 - WAIST))
            flat[row, column] = pattern_point(np.ptp(section.gore(k)), flare, t,
                                              np.interp(height, heights, meridian))
            space[row, column] = section.at(k, t, section.point)
        for row in range(SKIRT_ROWS + 1):
            s = skirt_depth(row)
            flat[BODICE_ROWS + row, column] = pattern_point(waist_width + 2 * FLARE * s, FLARE, t, -s)
            space[BODICE_ROWS + row, column] = skirt[row, k * COLUMNS + column]
    return flat, space


def form_rings(inset):
    """Rings of points of the torso, the pole and the foot, each from its lower end to its upper."""
    angle = np.linspace(0, 2 * math.pi, 49)[:-1]

    def cap(height, scale, drop):
        p = form_point(angle, np.full_like(angle, height), inset)
        middle = p.mean(0)
        return middle + (p - middle) * [scale, scale, 1] + [0, 0, drop]

    low, high = SECTIONS[0, 0], SECTIONS[-1, 0]
    torso = [cap(low, s, d) for s, d in ((0.02, -0.03), (0.45, -0.028), (0.8, -0.02), (0.95, -0.008))]
    torso += [form_point(angle, np.full_like(angle, h), inset) for h in np.linspace(low, high, 62)]
    torso += [cap(high, s, d) for s, d in ((0.97, 0.006), (0.8, 0.014), (0.4, 0.018), (0.02, 0.019))]

    def turned(profile):
        circle = np.stack([np.sin(angle[::2]), -np.cos(angle[::2]), 0 * angle[::2]], -1)
        return [r * circle + [0, 0.008, z] for r, z in profile]

    pole = turned([(0.0005, 0.01), (0.013, 0.012)] + [(0.013, z) for z in np.linspace(0.02, 0.72, 15)]
                  + [(0.013, 0.725), (0.0005, 0.726)])
    foot = turned([(0.002, 0.0), (0.1, 0.0), (0.168, 0.0), (0.175, 0.003), (0.176, 0.01), (0.172, 0.018),
                   (0.15, 0.022), (0.08, 0.03), (0.04, 0.036), (0.024, 0.048), (0.018, 0.07), (0.001, 0.071)])
    return [torso, pole, foot]


def form_mesh(inset):
    """The form as triangles with UVs in metres round and along each turned part."""
    points, faces, uvs = [], [], []
    for rings in form_rings(inset):
        first, n = sum(len(p) for p in points), len(rings[0])
        round_ = max(np.linalg.norm(np.roll(r, -1, 0) - r, axis=1).sum() for r in rings)
        along = np.concatenate([[0], np.cumsum([np.linalg.norm(b - a, axis=1).mean()
                                                for a, b in zip(rings, rings[1:])])])
        points += rings
        for j in range(len(rings) - 1):
            for i in range(n):
                a, b = first + j * n + i, first + j * n + (i + 1) % n
                corner = [(round_ * c / n, along[r]) for c, r in ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1))]
                quad = (a, b, b + n, a + n)
                for order in ((0, 1, 2), (0, 2, 3)):
                    faces.append([quad[c] for c in order])
                    uvs.append([corner[c] for c in order])
        for ring, sign in ((0, -1), (len(rings) - 1, 1)):  # the small holes left at both ends
            base = first + ring * n
            for i in range(1, n - 1):
                fan = (base, base + i, base + i + 1) if sign > 0 else (base, base + i + 1, base + i)
                faces.append(fan)
                uvs.append([(round_ + sign * rings[ring][f - base][0], rings[ring][f - base][1]) for f in fan])
    return np.concatenate(points), faces, uvs


def new_object(name, points, edges, faces):
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata([tuple(p) for p in points], edges, [tuple(f) for f in faces])
    mesh.update()
    thing = bpy.data.objects.new(name, mesh)
    bpy.context.collection.objects.link(thing)
    return thing


def index(k, row, column):
    return (k * (BODICE_ROWS + SKIRT_ROWS + 1) + row) * (COLUMNS + 1) + column


def drape(flat, space, petticoat):
    """Positions of all gores' points after the fall; the seams are springs of rest length zero."""
    rows = range(BODICE_ROWS + SKIRT_ROWS)
    quads = [(index(k, r + 1, c), index(k, r + 1, c + 1), index(k, r, c + 1), index(k, r, c))
             for k in range(GORES) for r in rows for c in range(COLUMNS)]
    seams = [(index(k, r, COLUMNS), index((k + 1) % GORES, r, 0))
             for k in range(GORES) for r in range(len(rows) + 1)]
    dress = new_object("dress", space.reshape(-1, 3), seams, quads)

    dress.shape_key_add(name="draped")
    rest = dress.shape_key_add(name="pattern")
    for k in range(GORES):
        for i, (u, v) in enumerate(flat[k].reshape(-1, 2)):
            rest.data[index(k, 0, 0) + i].co = (u + k, 0, v)
    boned = dress.vertex_groups.new(name="bodice")  # it keeps its shape, as a boned bodice does
    boned.add([index(k, r, c) for k in range(GORES) for r in range(BODICE_ROWS + 1) for c in range(COLUMNS + 1)],
              1.0, "REPLACE")

    cloth = dress.modifiers.new("cloth", "CLOTH")
    s = cloth.settings
    s.quality = 6
    s.mass = 0.03
    s.air_damping = 5
    s.bending_model = "ANGULAR"
    s.tension_stiffness = s.compression_stiffness = 40
    s.shear_stiffness = 15
    s.bending_stiffness = 0.08
    s.tension_damping = s.compression_damping = s.shear_damping = 10
    s.bending_damping = 0.2
    s.use_sewing_springs = True
    s.vertex_group_mass = "bodice"
    s.rest_shape_key = rest
    c = cloth.collision_settings
    c.collision_quality = 3
    c.distance_min = 0.002
    c.use_self_collision = True
    c.self_distance_min = 0.002
    c.friction = 5
    cloth.point_cache.frame_end = FRAMES

    points, faces, _ = form_mesh(0)
    n = len(petticoat[0])
    tube = [(j * n + i, (j + 1) * n + i, (j + 1) * n + (i + 1) % n, j * n + (i + 1) % n)
            for j in range(len(petticoat) - 1) for i in range(n)]
    colliders = [new_object("form", points, [], faces), new_object("petticoat", np.concatenate(petticoat), [], tube)]
    for collider in colliders:
        collider.modifiers.new("collision", "COLLISION")
        collider.collision.thickness_outer = 0.002
        collider.collision.cloth_friction = 10
    for frame in range(1, FRAMES + 1):
        bpy.context.scene.frame_set(frame)
        if frame % 25 == 0:
            print("frame", frame, flush=True)
    evaluated = dress.evaluated_get(bpy.context.evaluated_depsgraph_get())
    points = np.array([v.co for v in evaluated.data.vertices])
    for thing in (dress, *colliders):
        bpy.data.objects.remove(thing)
    gap = max(np.linalg.norm(points[a] - points[b]) for a, b in seams)
    print(f"widest seam before welding: {1000 * gap:.2f} mm")
    return points


def weld(points, flat):
    """One mesh of triangles: columns shared at the seams, UV per corner, all quads cut the same way."""
    height = BODICE_ROWS + SKIRT_ROWS + 1
    grid = points.reshape(GORES, height, COLUMNS + 1, 3)
    around = np.empty((height, GORES * COLUMNS, 3))
    for k in range(GORES):
        around[:, k * COLUMNS:(k + 1) * COLUMNS] = grid[k][:, :-1]
        around[:, k * COLUMNS] = (grid[k][:, 0] + grid[k - 1][:, -1]) / 2
    faces, uvs = [], []
    left = 0.0
    for k in range(GORES):
        u0 = left - flat[k][:, :, 0].min()
        left = u0 + flat[k][:, :, 0].max() + 0.02
        low = min(f[:, :, 1].min() for f in flat)
        for r in range(height - 1):
            for c in range(COLUMNS):
                corner = ((r + 1, c), (r + 1, c + 1), (r, c + 1), (r, c))
                for order in ((0, 1, 2), (0, 2, 3)):
                    faces.append([corner[i][0] * GORES * COLUMNS + (k * COLUMNS + corner[i][1]) % (GORES * COLUMNS)
                                  for i in order])
                    uvs.append([(flat[k][corner[i]][0] + u0, flat[k][corner[i]][1] - low) for i in order])
    return around.reshape(-1, 3), faces, uvs


def finished(name, colour, points, faces, uvs):
    thing = new_object(name, points, [], faces)
    layer = thing.data.uv_layers.new(name="UVMap")
    layer.data.foreach_set("uv", np.array(uvs, dtype=np.float32).ravel())
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    principled = material.node_tree.nodes["Principled BSDF"]
    principled.inputs["Base Color"].default_value = (*colour, 1)
    principled.inputs["Roughness"].default_value = 0.6
    thing.data.materials.append(material)
    return thing


def main():
    bpy.ops.wm.read_factory_settings(use_empty=True)
    skirt, petticoat = hang_skirt()
    gores = [cut_gore(k, skirt) for k in range(GORES)]
    flat, space = [g[0] for g in gores], np.array([g[1] for g in gores])
    finished("Body", (0.45, 0.03, 0.06), *weld(drape(flat, space, petticoat), flat))
    finished("Form", (0.75, 0.7, 0.62), *form_mesh(INSET))
    bpy.ops.export_scene.gltf(filepath=os.path.join(os.path.dirname(os.path.abspath(__file__)), "dress.glb"),
                              export_format="GLB", export_normals=False, export_animations=False,
                              export_materials="EXPORT", export_yup=True)


main()
