# SPDX-License-Identifier: GPL-3.0-or-later
# Boxes, turned and swept shapes as polygons, and the OBJ with MTL that make_station.py and make_furniture.py write.
"""Shapes are lists of rings: points that run round a section, counterclockwise seen from the end of the shape.

`skin` joins ring to ring with quadrilaterals where these are flat, else with triangles. Points are rounded to
0.01 mm, so shapes that share points share them in the file. Nothing here is random.
"""

import math
import pathlib

FLAT_M = 2e-4  # corners of a quadrilateral that keep this near to its plane are one polygon


class Model:
    """Polygons by object and material, in the order in which they were drawn."""

    def __init__(self):
        self.points = {}  # rounded place -> number
        self.objects = {}  # (object, material) -> faces

    def point(self, place):
        rounded = tuple(round(c, 5) + 0.0 for c in place)
        return self.points.setdefault(rounded, len(self.points) + 1)

    def polygon(self, name, material, corners):
        numbers = [self.point(corner) for corner in corners]
        numbers = [n for i, n in enumerate(numbers) if n != numbers[i - 1]]
        if len(numbers) >= 3:
            self.objects.setdefault((name, material), []).append(numbers)

    def size(self):
        return sum(len(faces) for faces in self.objects.values())

    def write(self, folder, stem, materials):
        """materials: name -> lines of the MTL."""
        folder = pathlib.Path(folder)
        folder.mkdir(parents=True, exist_ok=True)
        with open(folder / (stem + ".mtl"), "w", encoding="ascii") as out:
            for name, lines in materials.items():
                out.write(f"newmtl {name}\n" + "".join(line + "\n" for line in lines) + "\n")
        with open(folder / (stem + ".obj"), "w", encoding="ascii") as out:
            out.write(f"# metres, z up\nmtllib {stem}.mtl\n")
            for x, y, z in self.points:
                out.write(f"v {x:.5f} {y:.5f} {z:.5f}\n")
            for (name, material), faces in self.objects.items():
                out.write(f"o {name}\nusemtl {material}\n")
                for face in faces:
                    out.write("f " + " ".join(map(str, face)) + "\n")


def matt(reflectance):
    return [f"Kd {reflectance} {reflectance} {reflectance}", "illum 1"]


def minus(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def plus(a, b, times=1.0):
    return (a[0] + times * b[0], a[1] + times * b[1], a[2] + times * b[2])


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(a):
    length = math.sqrt(dot(a, a))
    return (a[0] / length, a[1] / length, a[2] / length)


def box(model, name, material, low, high, sides="-x+x-y+y-z+z"):
    """The named faces of a box, seen from outside."""
    (x0, y0, z0), (x1, y1, z1) = low, high
    faces = {
        "-x": [(x0, y0, z0), (x0, y0, z1), (x0, y1, z1), (x0, y1, z0)],
        "+x": [(x1, y0, z0), (x1, y1, z0), (x1, y1, z1), (x1, y0, z1)],
        "-y": [(x0, y0, z0), (x1, y0, z0), (x1, y0, z1), (x0, y0, z1)],
        "+y": [(x0, y1, z0), (x0, y1, z1), (x1, y1, z1), (x1, y1, z0)],
        "-z": [(x0, y0, z0), (x0, y1, z0), (x1, y1, z0), (x1, y0, z0)],
        "+z": [(x0, y0, z1), (x1, y0, z1), (x1, y1, z1), (x0, y1, z1)],
    }
    for i in range(0, len(sides), 2):
        model.polygon(name, material, faces[sides[i : i + 2]])


def quad(model, name, material, a, b, c, d):
    """One polygon where it is flat, else two triangles along the shorter diagonal."""
    normal = cross(minus(c, a), minus(d, b))
    size = math.sqrt(dot(normal, normal))
    if size > 0.0 and abs(dot(minus(b, a), normal)) <= FLAT_M * size:
        model.polygon(name, material, [a, b, c, d])
    elif dot(minus(c, a), minus(c, a)) <= dot(minus(d, b), minus(d, b)):
        model.polygon(name, material, [a, b, c])
        model.polygon(name, material, [a, c, d])
    else:
        model.polygon(name, material, [a, b, d])
        model.polygon(name, material, [b, c, d])


def band(model, name, material, low, high):
    """Between two rings, perhaps of different numbers of points or one of a single point."""
    m, n = len(low), len(high)
    if m == n:
        for i in range(m):
            j = (i + 1) % m
            quad(model, name, material, low[i], low[j], high[j], high[i])
        return
    i = j = 0
    while i < m or j < n:
        takes_low = j == n or (i < m and (i + 1) * n <= (j + 1) * m)
        if takes_low and m > 1:
            model.polygon(name, material, [low[i % m], low[(i + 1) % m], high[j % n]])
        elif not takes_low and n > 1:
            model.polygon(name, material, [low[i % m], high[(j + 1) % n], high[j % n]])
        i, j = (i + 1, j) if takes_low else (i, j + 1)


def skin(model, name, material, rings, closed=False, caps=False):
    """`closed`: the last ring meets the first; `caps`: polygons close the ends."""
    for low, high in zip(rings, rings[1:]):
        band(model, name, material, low, high)
    if closed:
        band(model, name, material, rings[-1], rings[0])
    if caps:
        model.polygon(name, material, rings[0][::-1])
        model.polygon(name, material, rings[-1])


def circle(centre, radius, count, u=(1, 0, 0), v=(0, 1, 0), turn=0.0):
    """Points about u × v; a radius of nothing gives one point."""
    if radius == 0.0:
        return [tuple(centre)]
    angles = [2.0 * math.pi * (i + turn) / count for i in range(count)]
    return [plus(plus(centre, u, radius * math.cos(a)), v, radius * math.sin(a)) for a in angles]


def turned(centre, profile, count):
    """Rings of a profile of (radius, height) turned about the upright through the centre."""
    return [circle(plus(centre, (0, 0, z)), r, count) for r, z in profile]


def tube(path, radius, count, side):
    """Rings round a path that lies in the plane across the unit vector `side`."""
    rings = []
    for i, place in enumerate(path):
        way = unit(minus(path[min(i + 1, len(path) - 1)], path[max(i - 1, 0)]))
        rings.append(circle(place, radius, count, side, cross(way, side)))
    return rings


def rod(model, name, material, start, end, radius, count):
    """A straight round bar."""
    way = unit(minus(end, start))
    side = unit(cross(way, (0, 0, 1) if abs(way[2]) < 0.9 else (1, 0, 0)))
    skin(model, name, material, tube([start, end], radius, count, side), caps=True)
