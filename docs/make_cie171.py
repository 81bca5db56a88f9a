#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs CIE 171:2006, cases 5.2 to 5.14, as whole studies and makes the tables of docs/validation.md.

  docs/make_cie171.py build/release/clerestory tests/data/cie171/cie171-5.9-5.14.csv \\
      [--accuracy standard 1%] [--page docs/validation.md] [--values docs/data/cie171.csv]

The rooms of the cases are written as OBJ files, walls without thickness. Errors are shares of closed forms (5.2 to
5.8) or of recomputed values (5.9 to 5.14).
"""
import argparse
import csv
import dataclasses
import math
import os
import pathlib
import subprocess
import tempfile

import page

ROOF_HOLE = [(0, 0, 1.5, 4), (2.5, 0, 4, 4), (1.5, 0, 2.5, 1.5), (1.5, 2.5, 2.5, 4)]
WALL_HOLE = [(0, 0, 1, 3), (3, 0, 4, 3), (1, 0, 3, 1), (1, 2, 3, 3)]
ENDLESS = 200.0  # half the length of masks, which the cases take as endless
# Illuminance of the shaded face of the wall of case 5.14 by sky and ground, of a horizontal illuminance of 1.
SHADED_FACE = {"1": 0.529, "5": 0.650, "12": 0.496, "16": 0.546}


def flat(x0, y0, x1, y1, z):
    return [(x0, y0, z), (x1, y0, z), (x1, y1, z), (x0, y1, z)]


def upright(x0, z0, x1, z1, y):
    return [(x0, y, z0), (x1, y, z0), (x1, y, z1), (x0, y, z1)]


def faces_of(case):
    """(material, outline) of the case's room."""
    roof = case.startswith(("5.9", "5.10"))
    whole = case.endswith(("4x4", "4x3"))
    faces = [("wall", flat(0, 0, 4, 4, 0)), ("wall", upright(0, 0, 4, 3, 0)),
             ("wall", [(0, 0, 0), (0, 4, 0), (0, 4, 3), (0, 0, 3)]),
             ("wall", [(4, 0, 0), (4, 4, 0), (4, 4, 3), (4, 0, 3)])]
    faces.append(("wall", upright(0, 0, 4, 3, 4) if roof else flat(0, 0, 4, 4, 3)))
    if whole:
        faces.append(("pane", flat(0, 0, 4, 4, 3) if roof else upright(0, 0, 4, 3, 4)))
    elif roof:
        faces += [("wall", flat(*part, 3)) for part in ROOF_HOLE] + [("pane", flat(1.5, 1.5, 2.5, 2.5, 3))]
    else:
        faces += [("wall", upright(*part, 4)) for part in WALL_HOLE] + [("pane", upright(1, 1, 3, 2, 4))]
    if case.startswith("5.13"):
        faces.append(("mask", flat(2 - ENDLESS, 4, 2 + ENDLESS, 4 + float(case[5:]), 3)))
    if case.startswith("5.14"):
        faces.append(("mask", upright(2 - ENDLESS, 0, 2 + ENDLESS, float(case[5:]), 10)))
    return faces


def write_model(folder, faces):
    """`faces`: (material, outline); each an object of its own."""
    lines = []
    for number, (material, outline) in enumerate(faces):
        lines += [f"o {material}{number}", f"usemtl {material}"] + [f"v {x} {y} {z}" for x, y, z in outline]
        lines.append("f " + " ".join(str(-corner) for corner in range(len(outline), 0, -1)))
    (folder / "room.obj").write_text("\n".join(lines) + "\n")


def points_of(count, ceiling):
    wall = [(2, 2e-4, 2.75 - 0.5 * i, 0, 1, 0) for i in range(6)] if count == 14 else []
    level, up = (3 - 2e-4, -1) if ceiling else (2e-4, 1)
    return wall + [(2, 0.25 + 0.5 * i, level, 0, 0, up) for i in range(8)]


def study_of(case, sky):
    glass = 'glass = "cie171-6mm"' if case.startswith(("5.10", "5.12")) else "transmittance = 1"
    mask = 100 * (0.0505 if case.startswith("5.13") else 0.30 * SHADED_FACE[sky])
    return ('[materials."wall"]\nreflectance = 0\n'
            f'[materials."pane"]\n{glass}\n'
            + (f'[materials."mask"]\nreflectance = 0\nexitance = {mask}\n' if case.startswith(("5.13", "5.14")) else "")
            + f'[sky]\ntype = "cie-{sky}"\ndiffuse_horizontal_lx = 100\nsun = {{ altitude = 60, azimuth = 0 }}\n'
            '[ground]\nreflectance = 0.3\n')


def run(program, faces, study, points, accuracy, table="sensors.csv"):
    """Rows of a study's table; `points`: x, y, z and a direction."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        write_model(folder, faces)
        (folder / "points.csv").write_text("x_m,y_m,z_m,nx,ny,nz\n" + "".join(
            ",".join(str(value) for value in point) + "\n" for point in points))
        (folder / "study.toml").write_text('[model]\nfile = "room.obj"\nunits = "m"\nup = "z"\n' + study +
                                           '[[grid]]\nname = "points"\npoints = "points.csv"\n')
        subprocess.run([program, "study", "study.toml", "-o", "report", "--accuracy", accuracy, "--no-pictures",
                        "--quiet"], cwd=folder, check=True)
        with open(folder / "report" / table, newline="", encoding="utf-8") as rows:
            return list(csv.DictReader(rows))


def percents(program, case, sky, count, ceiling, accuracy):
    rows = run(program, faces_of(case), study_of(case, sky), points_of(count, ceiling), accuracy)
    return [float(row["illuminance_lx"]) for row in rows]


NIGHT = "[sky]\ndiffuse_horizontal_lx = 0\n"
OFF = 2e-4  # of a sensor from its surface: nothing to the light, enough for rays


def closed_box(height, material="wall", left_out=()):
    """4 x 4 m; floor, ceiling, y = 0, y = 4, x = 0, x = 4."""
    faces = [flat(0, 0, 4, 4, 0), flat(0, 0, 4, 4, height), upright(0, 0, 4, height, 0), upright(0, 0, 4, height, 4),
             [(0, 0, 0), (0, 4, 0), (0, 4, height), (0, 0, height)],
             [(4, 0, 0), (4, 4, 0), (4, 4, height), (4, 0, height)]]
    return [(material, face) for number, face in enumerate(faces) if number not in left_out]


def illuminances(program, faces, study, points, accuracy):
    return [float(row["illuminance_lx"]) for row in run(program, faces, study, points, accuracy)]


def point_source(program, accuracy):
    places = [(x / 2, y / 2) for x in range(4) for y in range(x + 1)]
    study = (NIGHT + '[materials."wall"]\nreflectance = 0\n[[luminaire]]\nintensity_cd = 1000\nlambertian = true\n'
             "position = [2, 2, 3]\n")
    points = [(2 + x, 2 + y, OFF, 0, 0, 1) for x, y in places]
    return ([f"{x} m, {y} m" for x, y in places], [9000 / (9 + x * x + y * y) ** 2 for x, y in places],
            illuminances(program, closed_box(3.01), study, points, accuracy))


def lit(material, exitance):
    return (NIGHT + f'[materials."wall"]\nreflectance = 0\n[materials."{material}"]\nreflectance = 0\n'
            f"exitance = {exitance}\n")


def area_source(program, accuracy):
    panel = [("panel", flat(1.5, 1.5, 2.5, 2.5, 3))]
    ceiling = [("wall", flat(*part, 3)) for part in ROOF_HOLE]
    points = ([(2, OFF, 2.75 - 0.5 * i, 0, 1, 0) for i in range(6)] +
              [(2, 0.25, OFF, 0, 0, 1), (2, 1.75, OFF, 0, 0, 1)])
    # Exact integration of the configuration factor; the published B, C, F, G and J are 0.1 to 0.3 % off.
    return (list("ABCDEFGJ"), [32.68, 75.19, 81.32, 69.06, 53.40, 40.00, 61.42, 105.78],
            illuminances(program, closed_box(3, left_out=(1,)) + ceiling + panel, lit("panel", 1000 * math.pi), points,
                         accuracy))


def reflected_by_floor(program, accuracy):
    points = ([(2, OFF, 0.75 + 0.5 * i, 0, 1, 0) for i in range(5)] +
              [(2, 0.25 + 0.5 * i, 3 - OFF, 0, 0, -1) for i in range(4)])
    faces = closed_box(3, left_out=(0,)) + [("floor", flat(0, 0, 4, 4, 0))]
    return (["wall 0.75 m", "wall 1.25 m", "wall 1.75 m", "wall 2.25 m", "wall 2.75 m", "G", "H", "I", "J"],
            [35.901, 27.992, 21.639, 16.716, 12.967, 26.80, 30.94, 33.98, 35.57],
            illuminances(program, faces, lit("floor", 100), points, accuracy))


def past_obstruction(program, accuracy):
    box = [upright(0, 0, 4, 1, 2.5), upright(0, 0, 4, 1, 2.7), flat(0, 2.5, 4, 2.7, 1), flat(0, 2.5, 4, 2.7, 0)]
    faces = (closed_box(3, left_out=(3,)) + [("bright", upright(0, 0, 4, 3, 4))] + [("wall", face) for face in box])
    points = ([(2, OFF, 2.75 - 0.5 * i, 0, 1, 0) for i in range(6)] +
              [(2, 0.25 + 0.5 * i, OFF, 0, 0, 1) for i in range(5)])
    return (list("ABCDEFGHIJK"), [16.07, 16.33, 15.40, 13.32, 10.32, 7.08, 3.38, 3.63, 3.01, 0, 0],
            illuminances(program, faces, lit("bright", 100), points, accuracy))


def mean_of_surfaces(program, height, reflectance, accuracy):
    study = (NIGHT + f'[materials."wall"]\nreflectance = {reflectance}\n[[luminaire]]\n'
             f"intensity_cd = {10000 / (4 * math.pi)}\nposition = [2, 2, {height / 2}]\n")
    rows = run(program, closed_box(height), study, [(1, 1, 1, 0, 0, 1)], accuracy, "surfaces.csv")
    return sum(float(row["area_m2"]) * float(row["illuminance_mean_lx"]) for row in rows) / sum(
        float(row["area_m2"]) for row in rows)


def flux_conservation(program, accuracy):
    return ["flux received"], [10000.0], [80 * mean_of_surfaces(program, 3, 0, accuracy)]


def glass_by_angle(program, accuracy):
    """The sun behind the case's 6 mm glass, at an incidence: what a sensor that faces it gets of the beam."""
    angles = [0, 30, 45, 60, 70, 80]
    truth, ours = [], []
    for angle in angles:
        cosine = math.cos(math.radians(angle))
        truth.append(100 * sum(a * cosine ** n for n, a in enumerate(
            (-0.028378, 3.156075, -3.058376, -1.428919, 4.014235, -1.775827))))
        # The pane of case 5.12 looks along +y: an azimuth from north is an incidence.
        study = ('[materials."wall"]\nreflectance = 0\n[materials."pane"]\nglass = "cie171-6mm"\n[sky]\n'
                 f'type = "uniform"\ndiffuse_horizontal_lx = 0\ndirect_normal_lx = 10000\n'
                 f"sun = {{ altitude = 0.01, azimuth = {angle} }}\n[ground]\nreflectance = 0\n")
        way = (math.sin(math.radians(angle)), cosine, 0)
        at = (2 - 0.02 * way[0], 4 - 0.02 * way[1], 1.5)
        row = run(program, faces_of("5.12, 4x3"), study, [at + way], accuracy)[0]
        ours.append(float(row["sun_lx"]) / 100)
    return [f"{angle} deg" for angle in angles], truth, ours


def interreflected(program, accuracy):
    reflectances = [0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95]
    direct = 10000 / 96
    return ([f"reflectance {value}" for value in reflectances], [direct * r / (1 - r) for r in reflectances],
            [mean_of_surfaces(program, 4, value, accuracy) - direct for value in reflectances])


# Case, what it is, how it is run, and other programs' mean errors as they are published (docs/validation.md).
LAMP_CASES = [
    ("5.2", "point source, lx", point_source, "Iray 0.1, AGi32 0.2, Cycles 0.99"),
    ("5.3", "area source, lx", area_source, "Iray 0, Cycles 4.94"),
    ("5.4", "conservation of flux, lm", flux_conservation, "AGi32 0.31"),
    ("5.5", "6 mm glass by angle, %", glass_by_angle, ""),
    ("5.6", "reflection by the floor, %", reflected_by_floor, "Radiance 0.14, Cycles 0.25"),
    ("5.7", "reflection past an obstruction, %", past_obstruction, "Radiance 0.14, Cycles 1.07"),
    ("5.8", "inter-reflection, lx", interreflected,
     "Radiance 0.32 up to 0.8, -5.7 at 0.9, -25.6 at 0.95; Cycles 0.31"),
]


@dataclasses.dataclass
class Values:
    """A case under one sky: its points, the truth, and ours by accuracy."""
    case: str
    sky: str
    points: list
    truth: list
    ours: dict

    def cells(self):
        for values in self.ours.values():
            errors = [100 * (a - b) / b for a, b in zip(values, self.truth) if b > 0]
            yield f"{math.sqrt(sum(e * e for e in errors) / len(errors)):.2f}"
            yield f"{max(map(abs, errors)):.2f}"


def head(first, accuracies, last=""):
    columns = first + [f"{size} %, {a}" for a in accuracies for size in ("RMS", "max")] + ([last] if last else [])
    return ["| " + " | ".join(columns) + " |", "|" + "---|" * len(columns)]


def write_values(file, all_values, accuracies):
    with open(file, "w", newline="", encoding="utf-8") as stream:
        table = csv.writer(stream, lineterminator="\n")
        table.writerow(["case", "sky", "point", "reference", *accuracies])
        for values in all_values:
            for i, (point, truth) in enumerate(zip(values.points, values.truth)):
                table.writerow([values.case, values.sky, point, f"{truth:.5g}"] +
                               [f"{values.ours[a][i]:.5g}" for a in accuracies])


def points_named(count, ceiling):
    return (list("ABCDEF") if count == 14 else []) + [name + ("'" if ceiling else "") for name in "GHIJKLMN"]


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("program")
    arguments.add_argument("table", type=pathlib.Path)
    arguments.add_argument("--accuracy", nargs="+", default=["standard", "1%"])
    arguments.add_argument("--page", help="the page that the tables are put into; else they are printed")
    arguments.add_argument("--values", help="a table of every value")
    given = arguments.parse_args()
    program = os.path.abspath(given.program)

    all_values = []
    lines = head(["case", "", "points"], given.accuracy, "others' mean errors, %")
    for case, title, measure, others in LAMP_CASES:
        measured = {accuracy: measure(program, accuracy) for accuracy in given.accuracy}
        points, truth, _ = next(iter(measured.values()))
        values = Values(case, "", points, truth, {accuracy: ours for accuracy, (_, _, ours) in measured.items()})
        all_values.append(values)
        lines.append(f"| {case} | {title} | {len(points)} | " + " | ".join(values.cells()) + f" | {others} |")
    page.put(lines, "cie171-lamps", given.page)

    with open(given.table, newline="", encoding="utf-8") as table:
        rows = list(csv.reader(table))[1:]
    lines = head(["case", "sky", "points"], given.accuracy)
    for name, sky, *texts in rows:
        ceiling = name.endswith("_ceil")
        case, sky = name.removesuffix("_ceil"), "5" if ceiling else sky
        truth = [float(text) for text in texts]
        values = Values(case.replace("_", ", "), "any" if ceiling else sky, points_named(len(truth), ceiling), truth, {
            accuracy: percents(program, case, sky, len(truth), ceiling, accuracy) for accuracy in given.accuracy})
        all_values.append(values)
        lines.append(f"| {values.case}{', ceiling' if ceiling else ''} | {values.sky} | {len(truth)} | "
                     + " | ".join(values.cells()) + " |")
    page.put(lines, "cie171-daylight", given.page)
    if given.values:
        write_values(given.values, all_values, given.accuracy)


if __name__ == "__main__":
    main()
