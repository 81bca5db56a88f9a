# SPDX-License-Identifier: GPL-3.0-or-later
# Writes a railway station hall of about 75,000 polygons, closed and lit by luminous panels.
"""A hall of 120 m (x) by 45 m (y) by 20 m (z) with three platforms, two trains and a vault in shells.

    python3 tests/bench/make_station.py [FOLDER]     default: the working directory
    clerestory study FOLDER/station.toml --no-pictures --accuracy draft

Platforms lie at z = 0, the tracks 1.1 m below. Solids that stand on others keep 5 mm off them, so that nothing
coincides and no facet hides in another. Whatever is round is curved both ways or corrugated: merging coplanar
neighbours takes almost nothing away.
"""

import math
import pathlib
import sys

from meshes import Model, box, circle, matt, plus, rod, skin, tube, turned

LENGTH_M, WIDTH_M, SPRING_M, RISE_M = 120.0, 45.0, 8.0, 11.4
BAY_M = 10.0
BAYS = 12
TRACK_M = -1.1
TRACKS = ((13.0, 18.0), (27.0, 32.0))  # y from, to
COLUMN_ROWS = (9.0, 36.0)
GAP_M = 0.005
PANEL_CD_M2 = 3000

MATERIALS = {
    "floor": matt(0.2),
    "ballast": matt(0.15),
    "wall": matt(0.5),
    "vault": matt(0.7),
    "stone": matt(0.55),
    "steel": matt(0.4),
    "wood": matt(0.35),
    "carriage": matt(0.6),
    "rubber": matt(0.1),
    "concrete": matt(0.3),
    "opal": matt(0.8),
    "panel": ["Kd 0.8 0.8 0.8", f"Ke {PANEL_CD_M2} {PANEL_CD_M2} {PANEL_CD_M2}", "illum 1"],
}


def vault_point(x, angle, inset=0.0):
    """On the shell of the vault: an ellipse across the hall that bulges between the ribs."""
    bulge = 1.0 + 0.06 * math.sin(math.pi * x / BAY_M) ** 2
    return (
        x,
        0.5 * WIDTH_M - (0.5 * WIDTH_M - inset) * math.cos(angle),
        SPRING_M + (RISE_M * bulge - inset) * math.sin(angle),
    )


def draw_envelope(model):
    across, along = 44, 9 * BAYS
    angles = [math.pi * i / across for i in range(across + 1)]
    rows = [[vault_point(LENGTH_M * k / along, a) for a in angles] for k in range(along + 1)]
    for row, after in zip(rows, rows[1:]):
        for i in range(across):
            model.polygon("vault", "vault", [row[i], row[i + 1], after[i + 1]])
            model.polygon("vault", "vault", [row[i], after[i + 1], after[i]])

    profile = [(0.0, SPRING_M), (0.0, 0.0)]
    for low, high in TRACKS:
        profile += [(low, 0.0), (low, TRACK_M), (high, TRACK_M), (high, 0.0)]
    profile += [(WIDTH_M, 0.0), (WIDTH_M, SPRING_M)]
    for (y0, z0), (y1, z1) in zip(profile, profile[1:]):
        if y0 == y1:
            name = ("side wall", "wall") if y0 in (0.0, WIDTH_M) else ("platform edge", "concrete")
        else:
            name = ("platform", "floor") if z0 == 0.0 else ("track bed", "ballast")
        model.polygon(*name, [(0, y0, z0), (LENGTH_M, y0, z0), (LENGTH_M, y1, z1), (0, y1, z1)])
    for x, row in ((0.0, rows[0]), (LENGTH_M, rows[-1])):
        outline = [(x, y, z) for y, z in profile] + row[-2:0:-1]
        model.polygon("end wall", "wall", outline if x == 0.0 else outline[::-1])


def draw_ribs(model):
    steps = 48
    for bay in range(1, BAYS):
        angles = [math.pi * (0.02 + 0.96 * i / steps) for i in range(steps + 1)]
        path = [vault_point(bay * BAY_M, a, 0.55) for a in angles]
        skin(model, "rib", "steel", tube(path, 0.3, 10, (1, 0, 0)), caps=True)


def fluted(radius, flutes, steps):
    """A ring of a Doric shaft: arcs cut into a round."""
    ring = []
    for i in range(flutes * steps):
        depth = 0.085 * radius * math.sin(math.pi * (i % steps) / steps)
        a = 2.0 * math.pi * i / (flutes * steps)
        ring.append(((radius - depth) * math.cos(a), (radius - depth) * math.sin(a)))
    return ring


def draw_column(model, x, y):
    base = [(0.72, 0.0)]
    base += [(0.72 + 0.09 * math.sin(math.pi * t / 6), 0.28 * (1 - math.cos(math.pi * t / 6)) / 2) for t in range(1, 6)]
    base += [(0.68, 0.28)]
    skin(model, "column base", "stone", turned((x, y, GAP_M), base, 24), caps=True)
    rings = []
    levels = 5
    for k in range(levels + 1):
        t = k / levels
        radius = 0.62 - 0.16 * t + 0.05 * math.sin(math.pi * t)  # entasis
        z = 0.28 + 2 * GAP_M + 5.9 * t
        rings.append([(x + px, y + py, z) for px, py in fluted(radius, 16, 4)])
    skin(model, "column", "stone", rings, caps=True)
    z = 0.28 + 3 * GAP_M + 5.9
    echinus = [(0.48 + 0.27 * math.sin(0.5 * math.pi * t / 6), 0.4 * (1 - math.cos(0.5 * math.pi * t / 6))) for t in range(7)]
    skin(model, "capital", "stone", turned((x, y, z), echinus, 24), caps=True)
    z += 0.4 + GAP_M
    box(model, "abacus", "stone", (x - 0.8, y - 0.8, z), (x + 0.8, y + 0.8, z + 0.22))


def draw_bench(model, x, y):
    """A ring of a seat round a column; its section is a loop of (radius, height)."""
    section = []
    for i in range(6):
        t = i / 5
        section.append((1.62 - 0.62 * t, 0.43 - 0.05 * math.sin(math.pi * t)))  # seat, hollowed
    for i in range(1, 5):
        t = i / 4
        section.append((1.00 - 0.08 * t * t, 0.43 + 0.45 * t))  # back rest, leaning
    for i in range(1, 3):
        a = math.pi * i / 2
        section.append((0.89 + 0.03 * math.cos(a), 0.88 + 0.03 * math.sin(a)))
    section += [(0.85, 0.75), (0.86, 0.6), (0.89, 0.47), (0.96, 0.38), (1.1, 0.345), (1.35, 0.34), (1.58, 0.365)]
    skin(model, "bench", "wood", turned((x, y, 0.0), section, 24), closed=True)
    for i in range(4):
        a = 0.5 * math.pi * i
        place = (x + 1.3 * math.cos(a), y + 1.3 * math.sin(a), GAP_M)
        leg = [(0.06, 0.0), (0.03, 0.05), (0.025, 0.2), (0.05, 0.31)]
        skin(model, "bench legs", "steel", turned(place, leg, 6), caps=True)


def draw_truss(model, y):
    """A lattice girder over a row of columns, its lower chord in arches."""
    top = 8.3
    rod(model, "truss", "steel", (0.6, y, top), (LENGTH_M - 0.6, y, top), 0.12, 10)
    for bay in range(BAYS):
        x0 = bay * BAY_M + 0.25
        arch = [(x0 + 9.5 * i / 16, y, 6.98 + 0.9 * math.sin(math.pi * i / 16)) for i in range(17)]
        skin(model, "truss", "steel", tube(arch, 0.09, 10, (0, 1, 0)), caps=True)
        for i in range(16):  # bars go up and down between the chords and end off them
            low, high = (i, i + 1) if i % 2 == 0 else (i + 1, i)
            lean = 0.06 if low < high else -0.06  # so that two bars do not meet
            foot = plus(arch[low], (lean, 0, 0.12))
            head = (arch[high][0] - lean, y, top - 0.135)
            if head[2] - foot[2] > 0.1:
                rod(model, "truss", "steel", foot, head, 0.025, 6)


def draw_arcade(model, y, inward):
    """Blind arches on a side wall, a moulding round each and an urn in every second."""
    for bay in range(BAYS):
        x = (bay + 0.5) * BAY_M
        angles = [math.pi * i / 18 for i in range(19)]
        arch = [(x - 3.2 * math.cos(a), y + inward * 0.16, 3.4 + 3.2 * math.sin(a)) for a in angles]
        path = [(x - 3.2, y + inward * 0.16, 0.2), *arch, (x + 3.2, y + inward * 0.16, 0.2)]
        skin(model, "archivolt", "stone", tube(path, 0.15, 8, (0, 1, 0)), caps=True)
        if bay % 2 == 1:
            continue
        place = (x, y + inward * 0.6, GAP_M)
        urn = [(0.28, 0.0), (0.3, 0.08), (0.16, 0.2), (0.12, 0.5), (0.2, 0.75), (0.36, 1.05), (0.42, 1.35), (0.36, 1.6)]
        urn += [(0.3, 1.72), (0.34, 1.8), (0.3, 1.81), (0.25, 1.72), (0.3, 1.5), (0.22, 1.2)]
        skin(model, "urn", "stone", turned(place, urn, 24), caps=True)


def draw_panels(model):
    """Luminous panels under housings that hang from the vault on two rods."""
    for bay in range(BAYS):
        x = (bay + 0.5) * BAY_M
        for y in (9.6, 22.5, 35.4):
            low, high = (x - 1.6, y - 1.1, 11.5), (x + 1.6, y + 1.1, 11.7)
            box(model, "panel housing", "steel", low, high, "-x+x-y+y+z")
            box(model, "panel", "panel", low, high, "-z")
            for side in (-1.2, 1.2):
                height = vault_point(x + side, math.acos(1.0 - 2.0 * y / WIDTH_M))[2]
                rod(model, "panel rods", "steel", (x + side, y, 11.7 + GAP_M), (x + side, y, height - 0.2), 0.02, 6)


def draw_lamp_post(model, x, y):
    post = [(0.22, 0.0), (0.24, 0.1), (0.12, 0.3), (0.075, 0.8), (0.06, 2.0), (0.05, 3.0), (0.09, 3.2), (0.04, 3.3)]
    skin(model, "lamp post", "steel", turned((x, y, GAP_M), post, 12), caps=True)
    globe = [(0.28 * math.sin(math.pi * i / 12), 0.28 - 0.28 * math.cos(math.pi * i / 12)) for i in range(1, 12)]
    skin(model, "lamp globe", "opal", turned((x, y, 3.31 + GAP_M), globe, 14), caps=True)


def draw_track(model, low, high):
    middle = 0.5 * (low + high)
    for i in range(150):
        x = 0.4 + 0.8 * i
        box(
            model,
            "sleepers",
            "concrete",
            (x - 0.13, middle - 1.25, TRACK_M + GAP_M),
            (x + 0.13, middle + 1.25, TRACK_M + 0.15),
        )
    z = TRACK_M + 0.15 + GAP_M
    for side in (-0.7525, 0.7525):
        box(model, "rails", "steel", (0.3, middle + side - 0.035, z), (LENGTH_M - 0.3, middle + side + 0.035, z + 0.16))


def body_section(scale, count):
    """A carriage's section about its middle: a rounded box, corrugated along its length."""
    ring = []
    for i in range(count):
        a = 2.0 * math.pi * (i + 0.5) / count
        c, s = math.cos(a), math.sin(a)
        corrugation = 0.02 * (i % 2)
        ring.append(
            (
                (1.4 - corrugation) * scale * math.copysign(abs(c) ** 0.4, c),
                (1.5 - corrugation) * scale * math.copysign(abs(s) ** 0.4, s),
            )
        )
    return ring


def draw_carriage(model, x0, x1, y, nose_low, nose_high):
    """Its ends are bulged a little, those with a nose by 4 m."""
    z = TRACK_M + 2.75
    stations = []
    ends = ((x0, 1.0, 4.0 if nose_low else 0.35), (x1, -1.0, 4.0 if nose_high else 0.35))
    for end, inward, depth in ends:
        steps = 16 if depth > 1.0 else 4
        part = []
        for i in range(1, steps + 1):
            t = i / steps
            part.append((end + inward * depth * (1.0 - math.cos(0.5 * math.pi * t)), 0.3 + 0.7 * math.sin(0.5 * math.pi * t)))
        stations += part if inward > 0 else part[::-1]
    rings = [[(x, y + py, z + pz * size) for py, pz in body_section(size, 48)] for x, size in stations]
    skin(model, "train", "carriage", rings, caps=True)
    wheel = [(0.1, -0.07), (0.42, -0.05), (0.46, 0.0), (0.45, 0.07), (0.3, 0.02), (0.1, 0.07)]
    for bogie in (x0 + 5.0, x1 - 5.0):
        for axle in (-1.25, 1.25):
            for side in (-0.7525, 0.7525):
                centre = (bogie + axle, y + side, TRACK_M + 0.16 + 0.16 + 2 * GAP_M + 0.46)
                rings = [circle(plus(centre, (0, 1, 0), h), r, 14, (0, 0, 1), (1, 0, 0)) for r, h in wheel]
                skin(model, "wheels", "rubber", rings, caps=True)


def draw_clock(model, x, y):
    z = 4.6
    face = [(0.55, -0.12), (0.62, -0.1), (0.64, 0.0), (0.62, 0.1), (0.55, 0.12)]
    rings = [circle(plus((x, y, z), (1, 0, 0), h), r, 32, (0, 1, 0), (0, 0, 1)) for r, h in face]
    skin(model, "clock", "opal", rings, caps=True)
    rod(model, "clock", "steel", (x, y, GAP_M), (x, y, z - 0.65), 0.05, 12)


def draw():
    model = Model()
    draw_envelope(model)
    draw_ribs(model)
    for y in COLUMN_ROWS:
        for bay in range(1, BAYS):
            draw_column(model, bay * BAY_M, y)
            draw_bench(model, bay * BAY_M, y)
        draw_truss(model, y)
    draw_arcade(model, 0.0, 1.0)
    draw_arcade(model, WIDTH_M, -1.0)
    draw_panels(model)
    for bay in range(BAYS):
        for y in (19.5, 25.5):
            draw_lamp_post(model, (bay + 0.5) * BAY_M, y)
    for low, high in TRACKS:
        draw_track(model, low, high)
    for (low, high), start in zip(TRACKS, (3.0, 16.0)):
        for car in range(4):
            x = start + 25.0 * car
            draw_carriage(model, x, x + 24.4, 0.5 * (low + high), car == 0, car == 3)
    for x in (20.0, 60.0, 100.0):
        draw_clock(model, x, 22.5)
    return model


STUDY = """[model]
file = "station.obj"

[[grid]]
name = "Platforms"
room = "Room 1"
height = 0.85
spacing = 2.0
"""


def main():
    if len(sys.argv) > 2:
        sys.exit(__doc__)
    model = draw()
    folder = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".")
    model.write(folder, "station", MATERIALS)
    (folder / "station.toml").write_text(STUDY, encoding="ascii")
    print(f"{model.size()} polygons")


if __name__ == "__main__":
    main()
