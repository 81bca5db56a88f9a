#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs CIE 171:2006, cases 5.9 to 5.14, as whole studies and prints the table of docs/validation.md.

  docs/make_cie171.py build/release/clerestory tests/data/cie171/cie171-5.9-5.14.csv [--accuracy standard 1%]

The room of the cases is written as an OBJ: 4 x 4 x 3 m, black walls without thickness. Errors are shares of the
recomputed values, which are per cent of the horizontal illuminance.
"""
import argparse
import csv
import math
import os
import pathlib
import subprocess
import tempfile

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


def write_model(folder, case):
    lines = []
    for number, (material, outline) in enumerate(faces_of(case)):
        lines += [f"o {material}{number}", f"usemtl {material}"] + [f"v {x} {y} {z}" for x, y, z in outline]
        lines.append("f -4 -3 -2 -1")
    (folder / "room.obj").write_text("\n".join(lines) + "\n")


def points_of(count, ceiling):
    wall = [(2, 2e-4, 2.75 - 0.5 * i, 0, 1, 0) for i in range(6)] if count == 14 else []
    level, up = (3 - 2e-4, -1) if ceiling else (2e-4, 1)
    return wall + [(2, 0.25 + 0.5 * i, level, 0, 0, up) for i in range(8)]


def study_of(case, sky):
    glass = 'glass = "cie171-6mm"' if case.startswith(("5.10", "5.12")) else "transmittance = 1"
    mask = 100 * (0.0505 if case.startswith("5.13") else 0.30 * SHADED_FACE[sky])
    return (f'[model]\nfile = "room.obj"\nunits = "m"\nup = "z"\n[materials."wall"]\nreflectance = 0\n'
            f'[materials."pane"]\n{glass}\n'
            + (f'[materials."mask"]\nreflectance = 0\nexitance = {mask}\n' if case.startswith(("5.13", "5.14")) else "")
            + f'[sky]\ntype = "cie-{sky}"\ndiffuse_horizontal_lx = 100\nsun = {{ altitude = 60, azimuth = 0 }}\n'
            '[ground]\nreflectance = 0.3\n[[grid]]\nname = "points"\npoints = "points.csv"\n')


def percents(program, case, sky, count, ceiling, accuracy):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        write_model(folder, case)
        (folder / "points.csv").write_text("x_m,y_m,z_m,nx,ny,nz\n" + "".join(
            ",".join(str(value) for value in point) + "\n" for point in points_of(count, ceiling)))
        (folder / "study.toml").write_text(study_of(case, sky))
        subprocess.run([program, "study", "study.toml", "-o", "report", "--accuracy", accuracy, "--no-pictures",
                        "--quiet"], cwd=folder, check=True)
        with open(folder / "report" / "sensors.csv", newline="", encoding="utf-8") as table:
            return [float(row["illuminance_lx"]) for row in csv.DictReader(table)]


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("program")
    arguments.add_argument("table", type=pathlib.Path)
    arguments.add_argument("--accuracy", nargs="+", default=["standard", "1%"])
    given = arguments.parse_args()
    program = os.path.abspath(given.program)
    with open(given.table, newline="", encoding="utf-8") as table:
        rows = list(csv.reader(table))[1:]

    print("| case | sky | points | " + " | ".join(f"RMS %, {a} | max %, {a}" for a in given.accuracy) + " |")
    print("|---|---|---|" + "---|---|" * len(given.accuracy))
    for name, sky, *values in rows:
        ceiling = name.endswith("_ceil")
        case, sky = name.removesuffix("_ceil"), "5" if ceiling else sky
        truth = [float(value) for value in values]
        cells = []
        for accuracy in given.accuracy:
            ours = percents(program, case, sky, len(truth), ceiling, accuracy)
            errors = [100 * (a - b) / b for a, b in zip(ours, truth)]
            cells += [f"{math.sqrt(sum(e * e for e in errors) / len(errors)):.2f}", f"{max(map(abs, errors)):.2f}"]
        print(f"| {case.replace('_', ', ')}{', ceiling' if ceiling else ''} | {'any' if ceiling else sky} | "
              f"{len(truth)} | " + " | ".join(cells) + " |", flush=True)


if __name__ == "__main__":
    main()
