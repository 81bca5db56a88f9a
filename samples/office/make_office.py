# SPDX-License-Identifier: GPL-3.0-or-later
# Draws the sample office and writes it as office.obj with office.mtl, and as office.glb.
"""Draws the sample office of Clerestory, twice the same: office.obj with office.mtl, and office.glb.

    python3 make_office.py [FOLDER]        default: the folder of this script

The room is 12 m (x, east) by 8 m (y, north) by 3 m (z, up), its windows look south, the inner face of the
window wall is y = 0. Everything here is drawn in whole millimetres, so both files hold the same points: the
OBJ in metres with three decimals and z up, the GLB in float32 metres and y up, (x, y, z) -> (x, z, -y).
Polygons keep their corners in the OBJ and are triangulated in the GLB. Faces run counterclockwise seen from
where the light is: from outside of solids, from inside of the room. Single sheets (panes, leaves) are doubleSided.

Numbers in both files: `Kd` = baseColorFactor = linear reflectance; `Ke` = emissiveStrength = luminance in
cd/m2; `Tf` = transmissionFactor = transmittance of the whole pane.

Three objects are Catmull-Clark cages with semi-sharp creases.
In the OBJ such an object carries OpenSubdiv's tags, where A, B and V are ZERO-based indices into the file's
list of `v` lines (the `f` lines count from one, as always in OBJ):
    t interpolateboundary 1/0/0 N      1: edge-and-corner, 2: edge-only
    t crease 2/1/0 A B SHARPNESS
    t corner 1/1/0 V SHARPNESS
In the GLB the mesh shows the triangulated cage, each point once, and its extras hold
    {"clerestory": {"scheme": "catmark", "boundary": "edge-only" | "edge-and-corner",
                    "face_sizes": [...], "face_points": [...], "creases": [[a, b, sharpness], ...],
                    "corners": [[v, sharpness], ...]}}
with indices into the POSITION accessor of the mesh's only primitive.
"""

import json
import math
import os
import random
import struct
import sys

# --- materials ----------------------------------------------------------------------------------------------

LUMINANCE_CD_M2 = 3000
PANE_TRANSMITTANCE = 0.7
PANE_ALPHA = 0.3
SHEETS = ("glazing", "leaf", "lampshade")

MATERIALS = {
    "wall_white": (0.72, 0.70, 0.66),
    "wall_accent": (0.55, 0.25, 0.15),
    "ceiling_white": (0.80, 0.80, 0.79),
    "luminaire": (0.80, 0.80, 0.80),
    "floor_oak": (0.42, 0.29, 0.18),
    "facade_render": (0.46, 0.43, 0.38),
    "roof_gravel": (0.26, 0.25, 0.23),
    "concrete": (0.42, 0.41, 0.39),
    "window_frame": (0.58, 0.58, 0.56),
    "window_board": (0.66, 0.65, 0.62),
    "glazing": (1.0, 1.0, 1.0),  # a filter's colour: clear
    "radiator_white": (0.75, 0.75, 0.73),
    "skirting_white": (0.70, 0.68, 0.64),
    "door_wood": (0.38, 0.23, 0.12),
    "steel": (0.50, 0.50, 0.51),
    "steel_dark": (0.08, 0.08, 0.085),
    "desk_birch": (0.60, 0.49, 0.34),
    "felt": (0.20, 0.27, 0.24),
    "furniture_white": (0.65, 0.64, 0.61),
    "chair_fabric": (0.06, 0.10, 0.22),
    "plastic_black": (0.04, 0.04, 0.04),
    "plastic_grey": (0.28, 0.28, 0.27),
    "screen": (0.03, 0.03, 0.035),
    "paper": (0.80, 0.79, 0.75),
    "mug_red": (0.50, 0.06, 0.05),
    "mug_blue": (0.08, 0.20, 0.42),
    "shelf_oak": (0.50, 0.38, 0.24),
    "book_red": (0.42, 0.06, 0.05),
    "book_orange": (0.62, 0.27, 0.05),
    "book_yellow": (0.70, 0.55, 0.12),
    "book_green": (0.10, 0.28, 0.12),
    "book_teal": (0.05, 0.26, 0.28),
    "book_blue": (0.07, 0.13, 0.38),
    "book_grey": (0.33, 0.32, 0.30),
    "book_cream": (0.72, 0.66, 0.52),
    "whiteboard": (0.82, 0.82, 0.82),
    "rug_blue": (0.19, 0.26, 0.34),
    "lounge_mustard": (0.60, 0.38, 0.07),
    "lampshade": (0.72, 0.66, 0.55),
    "pot_ceramic": (0.66, 0.63, 0.58),
    "soil": (0.05, 0.035, 0.02),
    "leaf": (0.07, 0.22, 0.04),
    "stem": (0.16, 0.20, 0.07),
}
BOOK_MATERIALS = [name for name in MATERIALS if name.startswith("book_")]

# --- shapes: lists of polygons, a polygon is a list of points in millimetres --------------------------------


def mm(value):
    """The nearest whole millimetre; what lies halfway goes up on every machine's cosine."""
    return math.floor(value + 0.5 + 1e-6)


def doubled_area(outline):
    return sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(outline, outline[1:] + outline[:1]))


def prism(outline, low, high, axis="z"):
    """A closed prism along `axis`. `outline` is in (x, y), (x, z) or (y, z), in either direction."""
    place = {"x": lambda u, v, w: (w, u, v), "y": lambda u, v, w: (u, w, v), "z": lambda u, v, w: (u, v, w)}[axis]
    if (doubled_area(outline) < 0) != (axis == "y"):  # x, z and y are left-handed
        outline = outline[::-1]
    bottom = [place(u, v, low) for u, v in outline]
    top = [place(u, v, high) for u, v in outline]
    sides = [[bottom[i - 1], bottom[i], top[i], top[i - 1]] for i in range(len(outline))]
    return sides + [bottom[::-1], top]


def box(x0, x1, y0, y1, z0, z1):
    return prism([(x0, y0), (x1, y0), (x1, y1), (x0, y1)], z0, z1)


def rectangle(axis, at, u0, u1, v0, v1, facing):
    """A rectangle across `axis`; u and v are the other two axes in the order x, y, z; `facing` is 1 or -1."""
    place = {"x": lambda u, v: (at, u, v), "y": lambda u, v: (u, at, v), "z": lambda u, v: (u, v, at)}[axis]
    corners = [place(u0, v0), place(u1, v0), place(u1, v1), place(u0, v1)]
    return corners if (facing > 0) != (axis == "y") else corners[::-1]


def wall(axis, at, u0, u1, v0, v1, openings, facing):
    """A rectangle with openings (u0, u1, v0, v1), from left to right, as rectangles beside, below and above them."""
    faces = []
    for left, right, bottom, top in openings:
        faces.append(rectangle(axis, at, u0, left, v0, v1, facing))
        if bottom > v0:
            faces.append(rectangle(axis, at, left, right, v0, bottom, facing))
        if top < v1:
            faces.append(rectangle(axis, at, left, right, top, v1, facing))
        u0 = right
    return faces + [rectangle(axis, at, u0, u1, v0, v1, facing)]


def frame(axis, low, high, outer, inner):
    """A closed, mitred frame across `axis` between the rectangles `outer` and `inner` (u0, u1, v0, v1)."""
    faces = []
    for at, facing in ((low, -1), (high, 1)):
        out = rectangle(axis, at, *outer, facing)
        hole = rectangle(axis, at, *inner, facing)
        faces += [[out[i - 1], out[i], hole[i], hole[i - 1]] for i in range(4)]
    for rim, outward in ((outer, True), (inner, False)):
        near, far = rectangle(axis, low, *rim, 1), rectangle(axis, high, *rim, 1)
        sides = [[near[i - 1], near[i], far[i], far[i - 1]] for i in range(4)]
        faces += sides if outward else [side[::-1] for side in sides]
    return faces


def ngon(count, radius, x=0, y=0, phase_deg=None, stretch=1.0):
    """A regular polygon with an edge to the south, unless `phase_deg` says where its first corner lies."""
    phase = math.pi / count - math.pi / 2 if phase_deg is None else math.radians(phase_deg)
    angles = [phase + 2 * math.pi * i / count for i in range(count)]
    return [(mm(x + radius * math.cos(a)), mm(y + stretch * radius * math.sin(a))) for a in angles]


def rounded(x0, x1, y0, y1, radius, steps=2):
    """A rectangle with rounded corners of `steps` edges each."""
    outline = []
    west, east, south, north = x0 + radius, x1 - radius, y0 + radius, y1 - radius
    for quarter, (x, y) in enumerate([(east, north), (west, north), (west, south), (east, south)]):
        for step in range(steps + 1):
            angle = math.pi / 2 * (quarter + step / steps)
            outline.append((mm(x + radius * math.cos(angle)), mm(y + radius * math.sin(angle))))
    return outline


def bar(x, y, degrees, length, width):
    """The plan of a thin bar that begins at (x, y)."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    ends = [(0, -width / 2), (length, -width / 2), (length, width / 2), (0, width / 2)]
    return [(mm(x + u * c - v * s), mm(y + u * s + v * c)) for u, v in ends]


def cup(count, outer, inner, z0, floor, z1, x=0, y=0):
    """A closed cup with upright sides: bins and mugs."""
    out, hole = ngon(count, outer, x, y), ngon(count, inner, x, y)
    faces = prism(out, z0, z1)[:-1]
    faces += [side[::-1] for side in prism(hole, floor, z1)[:-2]]
    faces.append([(u, v, floor) for u, v in hole])
    faces += [[(*out[i - 1], z1), (*out[i], z1), (*hole[i], z1), (*hole[i - 1], z1)] for i in range(count)]
    return faces


def placed(points, at, degrees=0):
    """Points turned about the z axis and moved. Only upright prisms stay planar at angles other than quarters."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return [(mm(x * c - y * s) + at[0], mm(x * s + y * c) + at[1], z + at[2]) for x, y, z in points]


class Office:
    """The objects of the model in the order they are drawn, each a list of (material, polygon)."""

    def __init__(self):
        self.objects = {}
        self.cages = {}

    def add(self, name, *parts, at=(0, 0, 0), degrees=0):
        """Adds parts (material, polygons) to the object `name`."""
        faces = self.objects.setdefault(name, [])
        for material, polygons in parts:
            assert material in MATERIALS, material
            faces += [(material, placed(polygon, at, degrees)) for polygon in polygons]

    def add_cage(self, name, cage, at=(0, 0, 0), degrees=0):
        self.cages[name] = cage.placed(at, degrees)
        self.objects[name] = [(cage.material, polygon) for polygon in self.cages[name].polygons()]


class Cage:
    """A Catmull-Clark cage: points, faces as indices, and sharpness of edges and points."""

    def __init__(self, material, boundary, points, faces, creases, corners):
        self.material, self.boundary = material, boundary
        self.points, self.faces = points, faces
        self.creases, self.corners = creases, corners

    def placed(self, at, degrees):
        points = placed(self.points, at, degrees)
        return Cage(self.material, self.boundary, points, self.faces, self.creases, self.corners)

    def polygons(self):
        return [[self.points[i] for i in face] for face in self.faces]


# --- the building -------------------------------------------------------------------------------------------

WIDTH, DEPTH, HEIGHT = 12000, 8000, 3000
WEST, EAST, SOUTH, NORTH, BELOW, ABOVE = -300, 12300, -350, 8300, -300, 3400  # outer faces
SILL, HEAD = 900, 2700
WINDOWS = [(500 + 2300 * i, 2300 + 2300 * i) for i in range(5)]
DOOR = (10400, 11400, 0, 2100)
PANEL_X, PANEL_Y, PANEL = [1500, 4500, 7500, 10500], [1400, 4000, 6600], 600  # luminous ceiling panels: centres, size


def shell():
    """Inner and outer faces, reveals and luminous panels: together one closed solid of walls, slab and roof."""
    openings = [(left, right, SILL, HEAD) for left, right in WINDOWS]
    faces = {
        "floor": ("floor_oak", [rectangle("z", 0, 0, WIDTH, 0, DEPTH, 1)]),
        "ceiling": ("ceiling_white", []),
        "wall_south": ("wall_white", wall("y", 0, 0, WIDTH, 0, HEIGHT, openings, 1)),
        "wall_north": ("wall_white", wall("y", DEPTH, 0, WIDTH, 0, HEIGHT, [DOOR], -1)),
        "wall_west": ("wall_white", [rectangle("x", 0, 0, DEPTH, 0, HEIGHT, 1)]),
        "wall_east": ("wall_accent", [rectangle("x", WIDTH, 0, DEPTH, 0, HEIGHT, -1)]),
        "facade_south": ("facade_render", wall("y", SOUTH, WEST, EAST, BELOW, ABOVE, openings, -1)),
        "facade_north": ("facade_render", wall("y", NORTH, WEST, EAST, BELOW, ABOVE, [DOOR], 1)),
        "facade_west": ("facade_render", [rectangle("x", WEST, SOUTH, NORTH, BELOW, ABOVE, -1)]),
        "facade_east": ("facade_render", [rectangle("x", EAST, SOUTH, NORTH, BELOW, ABOVE, 1)]),
        "roof": ("roof_gravel", [rectangle("z", ABOVE, WEST, EAST, SOUTH, NORTH, 1)]),
        "slab": ("concrete", [rectangle("z", BELOW, WEST, EAST, SOUTH, NORTH, -1)]),
        "door_reveal": ("wall_white", reveal(*DOOR, DEPTH, NORTH)),
    }
    for number, (left, right) in enumerate(WINDOWS, 1):
        faces["window_%d_reveal" % number] = ("wall_white", reveal(left, right, SILL, HEAD, SOUTH, 0))
    half, south, number = PANEL // 2, 0, 0
    for y in PANEL_Y:
        ceiling = faces["ceiling"][1]
        ceiling.append(rectangle("z", HEIGHT, 0, WIDTH, south, y - half, -1))
        row = [(x - half, x + half, y - half, y + half) for x in PANEL_X]
        ceiling += wall("z", HEIGHT, 0, WIDTH, y - half, y + half, row, -1)
        for panel in row:
            number += 1
            faces["luminaire_%d" % number] = ("luminaire", [rectangle("z", HEIGHT, *panel, -1)])
        south = y + half
    faces["ceiling"][1].append(rectangle("z", HEIGHT, 0, WIDTH, south, DEPTH, -1))
    return conforming(faces)


def reveal(left, right, bottom, top, y0, y1):
    """The four inner sides of an opening through a wall."""
    return [rectangle("x", left, y0, y1, bottom, top, 1), rectangle("x", right, y0, y1, bottom, top, -1),
            rectangle("z", bottom, left, right, y0, y1, 1), rectangle("z", top, left, right, y0, y1, -1)]


def conforming(faces):
    """Gives every straight edge the points of its neighbours that lie on it, so that no T-junction is left."""
    points = sorted({p for _, polygons in faces.values() for polygon in polygons for p in polygon})

    def along(a, b):
        axis = next(i for i in range(3) if a[i] != b[i])
        others = [i for i in range(3) if i != axis]
        low, high = sorted((a[axis], b[axis]))
        on_edge = [p for p in points if low < p[axis] < high and all(p[i] == a[i] for i in others)]
        return [a] + sorted(on_edge, key=lambda p: abs(p[axis] - a[axis]))

    def completed(polygon):
        return [p for i in range(len(polygon)) for p in along(polygon[i - 1], polygon[i])]

    return {name: (material, [completed(polygon) for polygon in polygons])
            for name, (material, polygons) in faces.items()}


def window(left, right):
    """Frame, mullion and transoms in mid-reveal; each reaches 5 or 10 mm into what holds it, as the panes do."""
    middle, transom = (left + right) // 2, 2150
    inner = (left + 60, right - 60, SILL + 60, HEAD - 60)
    bars = frame("y", -210, -140, (left - 10, right + 10, SILL - 10, HEAD + 10), inner)
    bars += box(middle - 30, middle + 30, -205, -145, inner[2] - 5, inner[3] + 5)
    lights = [(inner[0], middle - 30), (middle + 30, inner[1])]
    panes = []
    for u0, u1 in lights:
        bars += box(u0 - 5, u1 + 5, -200, -150, transom - 25, transom + 25)
        for v0, v1 in ((inner[2], transom - 25), (transom + 25, inner[3])):
            panes.append(rectangle("y", -175, u0 - 10, u1 + 10, v0 - 10, v1 + 10, 1))
    handle = box(middle - 14, middle + 14, -150, -136, 1480, 1560) + box(middle - 9, middle + 9, -138, -120, 1430, 1545)
    return [("window_frame", bars), ("steel", handle)], [("glazing", panes)]


def radiator(centre):
    """A corrugated panel under a window, held off the wall, with two pipes into the floor."""
    front = [(centre + 650 - 65 * i, (125, 125, 140, 140)[i % 4]) for i in range(21)]
    panel = prism([(centre - 650, 60), (centre + 650, 60)] + front, 150, 720)
    for x in (centre - 500, centre + 470):
        panel += box(x, x + 30, -5, 65, 600, 630)
    for x in (centre + 560, centre + 610):
        panel += prism(ngon(6, 10, x, 95), -5, 155)
    return [("radiator_white", panel)]


def draw_building(office):
    for name, faces in shell().items():
        office.add(name, faces)
    for number, (left, right) in enumerate(WINDOWS, 1):
        bars, panes = window(left, right)
        office.add("window_%d_frame" % number, *bars)
        office.add("window_%d_glass" % number, *panes)
        board = box(left - 5, right + 5, -145, 60, SILL - 5, SILL + 25)
        office.add("window_%d_board" % number, ("window_board", board))
        office.add("radiator_%d" % number, *radiator((left + right) // 2))
    office.add("column", ("concrete", prism(ngon(16, 200, 5000, 5200), -50, HEIGHT + 50)))

    # The skirting runs round the room from one side of the door to the other, 5 mm into walls and floor.
    back = [(11405, 8005), (12005, 8005), (12005, -5), (-5, -5), (-5, 8005), (10395, 8005)]
    front = [(10395, 7988), (12, 7988), (12, 12), (11988, 12), (11988, 7988), (11405, 7988)]
    office.add("skirting", ("skirting_white", prism(back + front, -5, 80)))

    lining = [(10390, -5), (10450, -5), (10450, 2050), (11350, 2050)]
    lining += [(11350, -5), (11410, -5), (11410, 2110), (10390, 2110)]
    office.add("door_frame", ("skirting_white", prism(lining, 7985, 8120, "y")))
    office.add("door_leaf", ("door_wood", box(10430, 11370, 8030, 8070, -5, 2070)))
    handle = prism(ngon(8, 26, 10510, 1050), 8018, 8035, "y")
    handle += box(10501, 10519, 7975, 8020, 1041, 1059) + box(10500, 10630, 7958, 7977, 1040, 1060)
    office.add("door_handle", ("steel", handle))


# --- desks --------------------------------------------------------------------------------------------------
# Seen by who sits at it: x to the right, y away from the chair.


def desk():
    steel = []
    for side in (-1, 1):
        legs = sorted((side * 740, side * 790))
        for y in (-390, 340):
            steel += box(*legs, y, y + 50, 0, 730)
        rail = sorted((side * 750, side * 780))
        steel += box(*rail, -345, 345, 660, 700)
    tray = [(200, 620), (330, 620), (330, 690), (326, 690), (326, 624), (204, 624), (204, 690), (200, 690)]
    steel += prism(tray, -755, 755, "x")
    return [("desk_birch", box(-800, 800, -400, 400, 725, 750)), ("steel", steel),
            ("furniture_white", box(-745, 745, 356, 374, 380, 730))]


def pedestal():
    fronts, handles = [], []
    for z0, z1 in ((12, 240), (246, 398), (404, 552)):
        fronts += box(338, 722, -346, -327, z0, z1)
        handles += box(470, 590, -362, -344, z1 - 50, z1 - 38)
    return [("furniture_white", box(330, 730, -330, 220, 0, 560) + fronts), ("steel", handles)]


def monitor():
    x, y0, y1, z0, z1, bezel = 280, 90, 125, 870, 1200, 12
    case = box(-x, x, y0, y1, z0, z1)
    del case[1]  # the front: a bezel round the screen
    edge = rectangle("y", y0, -x, x, z0, z1, -1)
    screen = rectangle("y", y0, bezel - x, x - bezel, z0 + bezel, z1 - bezel, -1)
    case += [[edge[i - 1], edge[i], screen[i], screen[i - 1]] for i in range(4)]
    stand = prism(ngon(8, 115, 0, 125), 750, 762) + box(-25, 25, 120, 150, 760, 1020)
    return [("plastic_black", case), ("screen", [screen]), ("steel_dark", stand)]


def keyboard():
    keys = []
    for row in range(4):
        keys += box(-212, 212, -174 + 32 * row, -146 + 32 * row, 762, 769)
    return [("plastic_grey", box(-220, 220, -182, -44, 750, 764)), ("plastic_black", keys)]


def mouse():
    return [("plastic_black", prism(ngon(8, 32, 300, -115, stretch=1.6), 750, 782))]


def papers(number):
    """What lies about: a stack of paper at some desks, a mug at others."""
    if number % 2:
        sheets = prism(bar(-640, -190, 8 * number, 297, 210), 750, 756 + 4 * number)
        return [("paper", sheets), ("book_blue", box(-720, -510, 60, 330, 750, 768))]
    return [("mug_red" if number % 4 else "mug_blue", cup(10, 42, 37, 750, 756, 845, -480, 40))]


def chair():
    """A swivel chair that looks along y. Upright prisms only, so that it can stand at any angle."""
    star = []
    for leg in range(5):
        angle = 90 + 72 * leg
        c, s = math.cos(math.radians(angle)), math.sin(math.radians(angle))
        notch = math.radians(angle + 36)
        star += [(mm(300 * c + 18 * s), mm(300 * s - 18 * c)), (mm(300 * c - 18 * s), mm(300 * s + 18 * c)),
                 (mm(60 * math.cos(notch)), mm(60 * math.sin(notch)))]
    dark = prism(star, 55, 85) + prism(ngon(6, 28), 80, 435)
    for leg in range(5):
        angle = math.radians(90 + 72 * leg)
        dark += prism(ngon(6, 27, 272 * math.cos(angle), 272 * math.sin(angle)), 0, 60)
    dark += box(-25, 25, -245, 60, 412, 432) + box(-30, 30, -266, -236, 414, 900)
    for x in (-1, 1):
        post, pad = sorted((x * 244, x * 268)), sorted((x * 226, x * 288))
        dark += box(*post, -20, 30, 450, 696) + prism(rounded(*pad, -130, 130, 25, 1), 692, 716)
    sweep = [math.radians(-90 - 33 + 13.2 * i) for i in range(6)]
    back = [(mm(420 * math.cos(a)), mm(180 + 420 * math.sin(a))) for a in sweep]
    back += [(mm(388 * math.cos(a)), mm(180 + 388 * math.sin(a))) for a in reversed(sweep)]
    fabric = prism(rounded(-250, 250, -225, 245, 90), 430, 490) + prism(rounded(-225, 225, -200, 225, 80, 1), 486, 512)
    return [("steel_dark", dark), ("chair_fabric", fabric + prism(back, 570, 1010))]


def draw_desks(office):
    """Two blocks of four desks that face each other, at a right angle to the windows."""
    turns = [6, -14, 21, 4, -9, 33, -24, 11]
    number = 0
    for block in (3000, 7000):
        for row, y in enumerate((2100, 3720)):
            for side in (-1, 1):
                number += 1
                at, degrees = (block + side * 420, y, 0), side * 90
                for name, parts in (
                    ("desk", desk()),
                    ("pedestal", pedestal()),
                    ("monitor", monitor()),
                    ("keyboard", keyboard()),
                    ("mouse", mouse()),
                    ("desk_things", papers(number)),
                ):
                    office.add("%s_%d" % (name, number), *parts, at=at, degrees=degrees)
                pulled = {3: 1120, 6: 960}.get(number, 900)
                office.add("chair_%d" % number, *chair(), at=(block + side * pulled, y - side * 40, 0),
                           degrees=degrees + turns[number - 1])
            clamps = box(block - 30, block + 30, y - 500, y - 460, 745, 765)
            clamps += box(block - 30, block + 30, y + 460, y + 500, 745, 765)
            office.add("desk_screen_%d_%d" % (1 if block == 3000 else 2, row + 1),
                       ("felt", box(block - 12, block + 12, y - 790, y + 790, 600, 1120)), ("steel", clamps))
    for i, x in enumerate((2600, 3400, 6600, 7400), 1):
        office.add("bin_%d" % i, ("steel_dark" if i % 2 else "furniture_white", cup(10, 130, 126, 0, 6, 320, x, 4760)))


# --- along the walls ----------------------------------------------------------------------------------------


class Dice:
    """Repeatable choices: random() of a seeded generator is the same for every Python."""

    def __init__(self, seed):
        self.random = random.Random(seed).random

    def between(self, low, high):
        return low + int(self.random() * (high - low + 1))

    def one_of(self, choices):
        return choices[self.between(0, len(choices) - 1)]


def bookcase(x):
    """A unit 1.2 m wide whose boards reach 5 mm into its sides and its back."""
    oak = box(x, x + 20, 7660, 7980, 0, 2100) + box(x + 1180, x + 1200, 7660, 7980, 0, 2100)
    oak += box(x + 15, x + 1185, 7965, 7975, 10, 2090) + box(x + 15, x + 1185, 7690, 7710, 5, 82)
    for z in BOARDS + [2070]:
        oak += box(x + 15, x + 1185, 7664, 7969, z, z + 20)
    return [("shelf_oak", oak)]


BOARDS = [80, 478, 876, 1274, 1672]


def books(x, end, z, dice):
    """Books from `x` to about `end` on a board's top `z`: upright, in gaps, now and then one that leans or a pile."""
    parts = []
    while x < end:
        width, height, depth = dice.between(22, 62), dice.between(205, 325), dice.between(150, 235)
        front, kind = 7680 + dice.between(0, 22), dice.random()
        colour = dice.one_of(BOOK_MATERIALS)
        if kind < 0.06 and x + 330 < end:  # a pile
            level = z
            for layer in range(dice.between(2, 4)):
                thick, length = dice.between(22, 48), dice.between(240, 290)
                shift = dice.between(0, 8) + 10 * (layer % 2)  # no two edges meet
                left, back = x + shift, front + depth + shift // 2
                book = box(left, left + length, front - shift, back, level, level + thick)
                parts.append((dice.one_of(BOOK_MATERIALS), book))
                level += thick
            x += 315
        elif kind < 0.12 and parts:  # one that leans on its neighbour
            angle = math.radians(dice.between(7, 13))
            c, s = math.cos(angle), math.sin(angle)
            foot = x + 2 + mm(height * s)
            outline = [(0, 0), (width, 0), (width, height), (0, height)]
            leaning = [(foot + mm(u * c - v * s), z + mm(u * s + v * c)) for u, v in outline]
            parts.append((colour, prism(leaning, front, front + depth, "y")))
            x = leaning[1][0] + dice.between(30, 200)
        else:
            parts.append((colour, box(x, x + width, front, front + depth, z, z + height)))
            x += width + dice.between(1, 3) + (dice.between(60, 260) if dice.random() < 0.08 else 0)
    return parts


def draw_bookcases(office):
    dice = Dice(2001)
    for unit in range(3):
        x = 700 + 1210 * unit
        office.add("bookcase_%d" % (unit + 1), *bookcase(x))
        for shelf, board in enumerate(BOARDS, 1):
            begin = x + 24 + dice.between(0, 60)
            end = x + (1060 if dice.random() < 0.35 else dice.between(350, 900))
            office.add("books_%d_%d" % (unit + 1, shelf), *books(begin, end, board + 20, dice))


def draw_cabinet(office):
    """A low cabinet with a printer on it, on the north wall."""
    doors, handles = [], []
    for i in range(4):
        x = 5912 + 598 * i
        doors += box(x, x + 582, 7547, 7563, 75, 728)
        grip = x + (540 if i % 2 == 0 else 30)
        handles += box(grip, grip + 12, 7530, 7550, 420, 600)
    body = box(5900, 8300, 7560, 7980, 60, 740) + box(5895, 8305, 7545, 7985, 735, 760)
    plinth = box(5930, 8270, 7600, 7970, 0, 65)
    office.add("cabinet", ("furniture_white", body + doors), ("steel", handles), ("steel_dark", plinth))
    office.add(
        "printer",
        ("plastic_grey", box(6100, 6560, 7600, 7960, 760, 980) + box(6080, 6580, 7590, 7950, 975, 1030)),
        ("plastic_black", box(6160, 6500, 7590, 7605, 960, 970)),
        ("paper", box(6180, 6480, 7480, 7610, 820, 830)),
    )
    for i, colour in enumerate(("book_grey", "book_grey", "book_red", "book_grey", "book_blue")):
        office.add("binders", (colour, box(7400 + 82 * i, 7478 + 82 * i, 7640, 7920, 760, 1080)))


def draw_walls(office):
    """What hangs on the walls, 5 mm into them."""
    rim = frame("x", -5, 24, (2600, 5000, 900, 2100), (2630, 4970, 930, 2070))
    tray = box(-5, 90, 3300, 4300, 868, 880) + box(85, 95, 3300, 4300, 868, 895)
    pens = []
    for colour, y in (("mug_red", 3400), ("mug_blue", 3600), ("steel_dark", 3860)):
        pens.append((colour, prism(ngon(6, 10, 50, 889), y, y + 130, "y")))
    office.add("whiteboard", ("steel", rim + tray), ("whiteboard", box(-5, 14, 2625, 4975, 925, 2075)), *pens)

    rim = frame("x", 11965, 12005, (4900, 6500, 1150, 2250), (4940, 6460, 1190, 2210))
    canvas = box(11978, 12005, 4935, 6465, 1185, 2215)
    office.add("picture_frame", ("steel_dark", rim), ("paper", canvas))
    blocks = (
        ("book_blue", 5050, 5520, 1300, 1690),
        ("book_yellow", 5540, 6350, 1300, 1480),
        ("book_red", 5540, 5900, 1500, 2100),
        ("book_cream", 5920, 6350, 1500, 1800),
        ("book_teal", 5920, 6350, 1820, 2100),
        ("book_grey", 5050, 5520, 1710, 2100),
    )
    office.add("picture", *[(colour, box(11975, 11980, *sides)) for colour, *sides in blocks])

    dial = prism(ngon(16, 160, 7900, 2150), 7975, 8005, "y")
    face = prism(ngon(16, 146, 7900, 2150), 7971, 7980, "y")
    hands = prism(bar(7900, 2150, 60, 80, 10), 7967, 7973, "y") + prism(bar(7900, 2150, 150, 115, 7), 7963, 7969, "y")
    office.add("clock", ("steel_dark", dial), ("paper", face), ("plastic_black", hands))


# --- the lounge corner: subdivision cages -------------------------------------------------------------------


def lounge_chair():
    """A tub chair that looks along y: the skin of some cells of a grid, bent and creased."""
    xs, ys, zs = [-400, -270, 0, 270, 400], [-400, -230, 60, 360], [190, 300, 420, 600, 830]
    cells = {(i, j, k) for i in range(4) for j in range(3) for k in range(4)
             if k < 2 or (k == 2 and i in (0, 3)) or j == 0}
    points, faces, normals = {}, [], {}
    for i, j, k in sorted(cells):
        for axis in range(3):
            for side in (0, 1):
                beyond = [i, j, k]
                beyond[axis] += 2 * side - 1
                if tuple(beyond) in cells:
                    continue
                corners = []
                for u, v in ((0, 0), (1, 0), (1, 1), (0, 1)):
                    corner = [i, j, k]
                    corner[axis] += side
                    corner[(axis + 1) % 3] += u
                    corner[(axis + 2) % 3] += v
                    corners.append(points.setdefault(tuple(corner), len(points)))
                corners = corners if side else corners[::-1]
                faces.append(corners)
                for a, b in zip(corners, corners[1:] + corners[:1]):
                    normals.setdefault((min(a, b), max(a, b)), []).append((axis, side))
    keys = list(points)
    bottom = [index for key, index in points.items() if key[2] == 0]
    creases = []
    for (a, b), (one, other) in sorted(normals.items()):
        if one != other:
            at_bottom = a in bottom and b in bottom
            creases.append([a, b, 4.0 if at_bottom else 2.5 if keys[a][2] == keys[b][2] == 2 else 1.25])
    corners = [[points[i, j, 0], 4.0] for i in (0, 4) for j in (0, 3)]

    def bent(key):
        x, y, z = xs[key[0]], ys[key[1]], zs[key[2]]
        lean = max(0, z - 420) * (0.32 if key[1] < 2 else 0.1)
        crown = 25 if key == (2, 2, 2) else 0
        drop = 40 if key[2] == 3 and key[1] == 3 else 0
        return (mm(x * (1 + 0.06 * (z - 190) / 640)), mm(y - lean), z + crown - drop)

    return Cage("lounge_mustard", "edge-and-corner", [bent(key) for key in keys], faces, creases, corners)


def revolved(material, boundary, count, rings, sharpness, caps):
    """A cage of rings (radius, z) that run up the outer side, and down the inner one if there is one."""
    points = [(x, y, z) for radius, z in rings for x, y in ngon(count, radius)]
    faces = []
    for ring in range(len(rings) - 1):
        low, high = ring * count, (ring + 1) * count
        faces += [[low + i, low + (i + 1) % count, high + (i + 1) % count, high + i] for i in range(count)]
    if caps:
        faces.append(list(range(count))[::-1])
        faces.append(list(range((len(rings) - 1) * count, len(rings) * count)))
    creases = [[ring * count + i, ring * count + (i + 1) % count, sharp]
               for ring, sharp in sharpness.items() for i in range(count)]
    return Cage(material, boundary, points, faces, creases, [])


def plant(dice):
    """Stems and leaves. A leaf is a parallelogram, which stays planar in whole millimetres."""
    stems, leaves = [], []
    for x, y, top in ((0, 0, 1250), (70, 40, 1050), (-60, 50, 900), (10, -70, 1120)):
        stems += prism(ngon(6, 8, x, y), 245, top)
        for i in range(12):
            z = top - 30 - (top - 420) * i // 12
            azimuth = math.radians(137.5 * i + 40 * len(stems))
            rise = math.radians(dice.between(-25, 50))
            length, half = dice.between(200, 340), dice.between(32, 52)
            c, s = math.cos(azimuth), math.sin(azimuth)
            root = (mm(x + 6 * c), mm(y + 6 * s), z)
            reach = length * math.cos(rise)
            tip = (mm(x + reach * c), mm(y + reach * s), mm(z + length * math.sin(rise)))
            across = (half * s, -half * c, 0)
            side = tuple(mm(0.4 * tip[k] + 0.6 * root[k] + across[k]) for k in range(3))
            leaves.append([root, side, tip, tuple(root[k] + tip[k] - side[k] for k in range(3))])
    return [("stem", stems), ("leaf", leaves)]


def draw_lounge(office):
    office.add("rug", ("rug_blue", box(9300, 11600, 1650, 4000, 0, 8)))

    at, degrees = (10850, 2950, 8), 105
    office.add_cage("lounge_chair", lounge_chair(), (at[0], at[1], 0), degrees)
    legs = [face for x in (-300, 270) for y in (-330, 270) for face in box(x, x + 30, y, y + 30, 0, 240)]
    office.add("lounge_chair_legs", ("shelf_oak", legs), at=at, degrees=degrees)

    table = prism(ngon(16, 260), 420, 445) + prism(ngon(8, 25), 18, 425) + prism(ngon(16, 170), 0, 22)
    office.add("side_table", ("furniture_white", table), ("book_orange", prism(bar(-120, 30, 20, 230, 160), 445, 463)),
               ("mug_blue", cup(10, 42, 37, 445, 451, 540, 90, -110)), at=(9950, 2350, 8))

    at = (11480, 4330, 0)
    spokes = [face for i in range(3) for face in prism(bar(0, 0, 30 + 120 * i, 150, 6), 1600, 1606)]
    stand = prism(ngon(16, 150), 0, 22) + prism(ngon(8, 12), 18, 1612) + prism(ngon(8, 24), 1470, 1560)
    office.add("floor_lamp", ("steel_dark", stand + spokes), ("paper", prism(ngon(8, 38), 1370, 1475)), at=at)
    rings = [(255, 1300), (245, 1390), (175, 1560), (155, 1660)]
    office.add_cage("lamp_shade", revolved("lampshade", "edge-only", 12, rings, {1: 1.5}, caps=False), at)

    at = (11430, 720, 0)
    rings = [(140, 0), (190, 110), (215, 330), (185, 330), (165, 200), (120, 60)]
    sharpness = {0: 10.0, 2: 2.5, 3: 2.5, 5: 0.5}
    pot = revolved("pot_ceramic", "edge-only", 8, rings, sharpness, caps=True)
    office.add_cage("plant_pot", pot, at)
    office.add("plant_soil", ("soil", prism(ngon(16, 168), 240, 262)), at=at)
    office.add("plant", *plant(Dice(7)), at=at)


def draw_office():
    office = Office()
    draw_building(office)
    draw_desks(office)
    draw_bookcases(office)
    draw_cabinet(office)
    draw_walls(office)
    draw_lounge(office)
    return office


# --- triangles ----------------------------------------------------------------------------------------------


def normal(polygon):
    """Newell's normal, exact for whole millimetres."""
    total = [0, 0, 0]
    for a, b in zip(polygon, polygon[1:] + polygon[:1]):
        for i in range(3):
            j, k = (i + 1) % 3, (i + 2) % 3
            total[i] += (a[j] - b[j]) * (a[k] + b[k])
    return total


def triangulated(polygon):
    """Triangles as corner numbers within `polygon`, none of them degenerate, by cutting the plumpest ear."""
    up = normal(polygon)
    axis = max(range(3), key=lambda i: abs(up[i]))
    sign = 1 if up[axis] > 0 else -1
    flat = [(p[(axis + 1) % 3], sign * p[(axis + 2) % 3]) for p in polygon]

    def cross(a, b, c):
        (ax, ay), (bx, by), (cx, cy) = flat[a], flat[b], flat[c]
        return (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)

    def within(p, a, b, c):
        return min(cross(a, b, p), cross(b, c, p), cross(c, a, p)) >= 0

    def plumpness(a, b, c):
        longest = max(math.dist(flat[p], flat[q]) for p, q in ((a, b), (b, c), (c, a)))
        return cross(a, b, c) / longest**2

    left, triangles = list(range(len(polygon))), []
    while len(left) > 3:
        ears = []
        for i in range(len(left)):
            a, b, c = left[i - 1], left[i], left[(i + 1) % len(left)]
            others = (p for p in left if p not in (a, b, c))
            if cross(a, b, c) > 0 and not any(within(p, a, b, c) for p in others):
                ears.append((plumpness(a, b, c), -i, (a, b, c)))
        _, place, ear = max(ears)
        triangles.append(ear)
        del left[-place]
    assert cross(*left) > 0
    return triangles + [tuple(left)]


def fan(face):
    return [(face[0], face[i], face[i + 1]) for i in range(1, len(face) - 1)]


# --- OBJ ----------------------------------------------------------------------------------------------------


def mtl_text():
    lines = ["# SPDX-License-Identifier: GPL-3.0-or-later"]
    lines.append("# Written by make_office.py. Kd: linear reflectance; Ke: luminance in cd/m2.")
    for name, colour in MATERIALS.items():
        lines += ["", "newmtl " + name, "Kd %g %g %g" % colour]
        if name == "luminaire":
            lines.append("Ke %g %g %g" % ((LUMINANCE_CD_M2,) * 3))
        if name == "glazing":
            lines += ["Tf %g %g %g" % ((PANE_TRANSMITTANCE,) * 3), "d %g" % PANE_ALPHA]
        lines.append("illum 4" if name == "glazing" else "illum 1")
    return "\n".join(lines) + "\n"


def obj_text(office):
    lines = ["# SPDX-License-Identifier: GPL-3.0-or-later"]
    lines.append("# Written by make_office.py. Metres, z up. `t` lines are OpenSubdiv's tags, see there.")
    lines.append("mtllib office.mtl")
    first = 0  # zero-based index of the object's first point in the file
    for name, faces in office.objects.items():
        cage = office.cages.get(name)
        points = {p: i for i, p in enumerate(cage.points)} if cage else {}
        for _, polygon in faces:
            for p in polygon:
                points.setdefault(p, len(points))
        lines += ["", "o " + name]
        lines += ["v %.3f %.3f %.3f" % tuple(c / 1000 for c in p) for p in points]
        current = None
        for material, polygon in faces:
            if material != current:
                lines.append("usemtl " + material)
                current = material
            lines.append("f " + " ".join(str(first + points[p] + 1) for p in polygon))
        if cage:
            lines.append("t interpolateboundary 1/0/0 %d" % (2 if cage.boundary == "edge-only" else 1))
            lines += ["t crease 2/1/0 %d %d %g" % (first + a, first + b, sharpness) for a, b, sharpness in cage.creases]
            lines += ["t corner 1/1/0 %d %g" % (first + v, sharpness) for v, sharpness in cage.corners]
        first += len(points)
    return "\n".join(lines) + "\n"


# --- GLB ----------------------------------------------------------------------------------------------------


def float32(value):
    return struct.unpack("<f", struct.pack("<f", value))[0]


class Glb:
    """A glTF document with one buffer: all positions, then all indices."""

    def __init__(self):
        self.positions, self.indices = bytearray(), bytearray()
        self.accessors, self.meshes = [], []

    def primitive(self, points, triangles, material):
        """Points are millimetres, z up; y-up metres are written."""
        turned = [tuple(float32(c / 1000) for c in (x, z, -y)) for x, y, z in points]
        bounds = {"min": [min(column) for column in zip(*turned)], "max": [max(column) for column in zip(*turned)]}
        position = self.accessor(0, len(self.positions), 5126, len(turned), "VEC3", **bounds)
        self.positions += b"".join(struct.pack("<3f", *p) for p in turned)
        flat = [i for triangle in triangles for i in triangle]
        indices = self.accessor(1, len(self.indices), 5123, len(flat), "SCALAR")
        self.indices += struct.pack("<%dH" % len(flat), *flat)
        self.indices += bytes(-len(self.indices) % 4)
        number = list(MATERIALS).index(material)
        return {"attributes": {"POSITION": position}, "indices": indices, "material": number}

    def accessor(self, view, offset, component, count, kind, **bounds):
        entry = {"bufferView": view, "byteOffset": offset, "componentType": component, "count": count, "type": kind}
        self.accessors.append({**entry, **bounds})
        return len(self.accessors) - 1

    def add_mesh(self, name, faces):
        by_material = {}
        for material, polygon in faces:
            points, triangles = by_material.setdefault(material, ({}, []))
            corners = [points.setdefault(p, len(points)) for p in polygon]
            triangles += [tuple(corners[i] for i in triangle) for triangle in triangulated(polygon)]
        primitives = [self.primitive(list(points), triangles, material)
                      for material, (points, triangles) in by_material.items()]
        self.meshes.append({"name": name, "primitives": primitives})

    def add_cage(self, name, cage):
        triangles = [triangle for face in cage.faces for triangle in fan(face)]
        primitive = self.primitive(cage.points, triangles, cage.material)
        tags = {
            "scheme": "catmark",
            "boundary": cage.boundary,
            "face_sizes": [len(face) for face in cage.faces],
            "face_points": [i for face in cage.faces for i in face],
            "creases": cage.creases,
            "corners": cage.corners,
        }
        self.meshes.append({"name": name, "primitives": [primitive], "extras": {"clerestory": tags}})

    def document(self):
        positions, indices = len(self.positions), len(self.indices)
        return {
            "asset": {"version": "2.0", "generator": "Clerestory make_office.py", "copyright": "GPL-3.0-or-later"},
            "extensionsUsed": ["KHR_materials_transmission", "KHR_materials_emissive_strength"],
            "scene": 0,
            "scenes": [{"name": "office", "nodes": list(range(len(self.meshes)))}],
            "nodes": [{"name": mesh["name"], "mesh": i} for i, mesh in enumerate(self.meshes)],
            "meshes": self.meshes,
            "materials": [gltf_material(name) for name in MATERIALS],
            "accessors": self.accessors,
            "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": positions, "byteStride": 12, "target": 34962},
                            {"buffer": 0, "byteOffset": positions, "byteLength": indices, "target": 34963}],
            "buffers": [{"byteLength": positions + indices}],
        }

    def data(self):
        text = json.dumps(self.document(), separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        binary = bytes(self.positions + self.indices)
        chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(binary), b"BIN\0") + binary
        return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def gltf_material(name):
    alpha = PANE_ALPHA if name == "glazing" else 1.0
    surface = {"baseColorFactor": [*MATERIALS[name], alpha], "metallicFactor": 0.0, "roughnessFactor": 1.0}
    material = {"name": name, "pbrMetallicRoughness": surface}
    if name in SHEETS:
        material["doubleSided"] = True
    if name == "glazing":
        material["alphaMode"] = "BLEND"
        material["extensions"] = {"KHR_materials_transmission": {"transmissionFactor": PANE_TRANSMITTANCE}}
    if name == "luminaire":
        material["emissiveFactor"] = [1.0, 1.0, 1.0]
        material["extensions"] = {"KHR_materials_emissive_strength": {"emissiveStrength": float(LUMINANCE_CD_M2)}}
    return material


def glb_data(office):
    glb = Glb()
    for name, faces in office.objects.items():
        if name in office.cages:
            glb.add_cage(name, office.cages[name])
        else:
            glb.add_mesh(name, faces)
    return glb.data()


def main():
    folder = sys.argv[1] if len(sys.argv) > 1 else os.path.dirname(os.path.abspath(__file__))
    office = draw_office()
    files = {"mtl": mtl_text().encode(), "obj": obj_text(office).encode(), "glb": glb_data(office)}
    for ending, data in files.items():
        with open(os.path.join(folder, "office." + ending), "wb") as file:
            file.write(data)
    polygons = sum(len(faces) for faces in office.objects.values())
    print("%d polygons in %d objects, %d of them cages" % (polygons, len(office.objects), len(office.cages)))


if __name__ == "__main__":
    main()
