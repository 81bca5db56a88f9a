#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs Clerestory on reference scenes and makes the table of docs/validation.md: errors and CPU seconds.

  docs/make_validation.py build/release/clerestory tests/data/reference [FOLDER ...] [--accuracy draft standard ...]
      [--page docs/validation.md]

A folder holds a folder per scene, SCENE/SCENE.obj with SCENE/SCENE_overcast.csv (the cube: cube_emitter.csv).
Scenes that no folder holds are left out and named at the end. Needs nothing but Python 3.9 and a POSIX system.
"""
import argparse
import csv
import dataclasses
import math
import os
import pathlib
import sys
import tempfile

import page


@dataclasses.dataclass
class Scene:
    title: str
    model: str      # below a folder that is given
    reference: str  # beside the model
    study: str      # what the study states beside the model, the grid and the accuracy
    noise: str      # what is known of the reference's own error
    left_out: str = ""  # tag of sensors that are not compared


CLEAR = ('[sky]\ntype = "cie-12"\ndiffuse_horizontal_lx = 7761\ndirect_normal_lx = 69162\n'
         'sun = { altitude = 35.836, azimuth = 141.922 }\n[ground]\nreflectance = 0.2\n')
OVERCAST = '[sky]\ntype = "cie-overcast"\ndiffuse_horizontal_lx = 10000\n[ground]\nreflectance = 0.2\n'
SCENES = [
    Scene("empty office", "refoffice/refoffice.obj", "refoffice_overcast_paths.csv",
          OVERCAST + '[materials."glazing*"]\ntransmittance = 0.65\n', "paths, 0.4 %"),
    Scene("empty office", "refoffice/refoffice.obj", "refoffice_overcast.csv",
          OVERCAST + '[materials."glazing*"]\ntransmittance = 0.65\n', "Radiance, 0.28 %"),
    Scene("furnished office", "furnished/furnished.obj", "furnished_overcast_paths.csv",
          OVERCAST + '[materials."glazing*"]\ntransmittance = 0.65\n', "paths, 0.6 %"),
    Scene("furnished office", "furnished/furnished.obj", "furnished_overcast.csv",
          OVERCAST + '[materials."glazing*"]\ntransmittance = 0.65\n', "Radiance, 0.4 %"),
    Scene("floor of twelve offices", "floor/floor.obj", "floor_overcast_paths.csv",
          OVERCAST + '[materials."glazing*"]\ntransmittance = 0.65\n', "paths, 0.5 %"),
    Scene("floor of twelve offices", "floor/floor.obj", "floor_overcast.csv",
          OVERCAST + '[materials."glazing*"]\ntransmittance = 0.65\n', "Radiance, 1.7 %", left_out="corridor"),
    Scene("empty office, clear sky with sun", "refoffice/refoffice.obj", "refoffice_clear_paths.csv", CLEAR,
          "paths, 0.5 %"),
    Scene("empty office, clear sky with sun", "refoffice/refoffice.obj", "refoffice_clear.csv", CLEAR, "Radiance, 0.4 %"),
    Scene("furnished office, clear sky with sun", "furnished/furnished.obj", "furnished_clear_paths.csv", CLEAR,
          "paths, 0.5 %"),
    Scene("furnished office, clear sky with sun", "furnished/furnished.obj", "furnished_clear.csv", CLEAR,
          "Radiance, 0.4 %"),
    Scene("floor of twelve offices, clear sky with sun", "floor/floor.obj", "floor_clear_paths.csv", CLEAR,
          "paths, 0.6 %"),
    Scene("floor of twelve offices, clear sky with sun", "floor/floor.obj", "floor_clear.csv", CLEAR, "Radiance, 1.2 %",
          left_out="corridor"),
    Scene("white louvres", "louvres/louvres.obj", "louvres_overcast_paths.csv", OVERCAST, "paths, 0.5 %"),
    Scene("white louvres, clear sky with sun", "louvres/louvres.obj", "louvres_clear_paths.csv", CLEAR,
          "paths, 0.6 %"),
    Scene("tutorial room", "room-radiance-tutorial/rt_room.obj", "df_radiance.txt",
          OVERCAST + '[materials."Glazing"]\ntransmittance = 0.596\n', "0.5 %"),
    Scene("closed cube", "cube/cube.obj", "cube_emitter.csv",
          '[materials."emitter"]\nexitance = 56235\n', "0.4 %"),
]

# Radiance 5.4a on the same scenes: title -> (settings as docs/validation.md names them, CPU s, RMS, bias, p95,
# maximum); figures as they were measured, as texts.
RADIANCE = {
    "empty office": [
        ("low", "0.26", "38.2", "-33.5", "62", "71"), ("medium", "2.5", "10.4", "-7.8", "21", "25"),
        ("good", "13.2", "3.6", "-2.3", "6.7", "10.6"), ("high", "169", "1.1", "-0.5", "2.3", "3.9")],
    "furnished office": [
        ("low", "0.39", "37.4", "-31.2", "68", "128"), ("medium", "9.5", "11.8", "-7.9", "23", "48"),
        ("good", "51.1", "4.6", "-2.6", "7.4", "41")],
    "floor of twelve offices": [
        ("low", "3.7", "43.0", "-34.5", "89", "96"), ("medium", "86.9", "16.7", "-10.7", "37", "62"),
        ("good (420 sensors; time extrapolated)", "770", "3.7", "-1.7", "7.9", "")],
    "empty office, clear sky with sun": [
        ("low", "0.27", "40.4", "-35.7", "63", "69"), ("medium", "2.7", "10.4", "-8.3", "19", "24"),
        ("good", "11.3", "5.2", "-4.1", "8.6", "10.5"), ("high", "152", "2.2", "-1.8", "3.7", "4.4")],
    "furnished office, clear sky with sun": [
        ("low", "0.38", "38.8", "-34.2", "62", "74"), ("medium", "8.6", "11.0", "-8.5", "20", "41"),
        ("good", "53.3", "6.1", "-4.2", "9.2", "47")],
    "floor of twelve offices, clear sky with sun": [
        ("low", "4.0", "40.6", "-33.6", "83", "93"), ("medium", "93.1", "14.9", "-9.9", "36", "52")],
}

PATCH_EDGE_M = 0.04       # sensors so near the edge of a sun patch are left out: the reference's sun is a point
PATCH_STEP_LX = 5000.0    # a fifth of the beam behind the glass


def read_reference(file, left_out):
    """Rows (x, y, z, value); a daylight factor in % becomes lux under 10,000 lx."""
    rows = []
    for line in file.read_text().splitlines():
        fields = line.replace(",", " ").split()
        try:
            x, y, z, value = (float(field) for field in fields[:4])
        except ValueError:
            continue  # a header or a comment
        if left_out and fields[4:] == [left_out]:
            continue
        rows.append((x, y, z, value * (100.0 if file.name.startswith("df_") else 1.0)))
    return rows


def errors_of(ours, truth):
    """RMS, mean, 95th percentile and maximum of (ours - true) / max(true, 5 % of the mean), in %."""
    floor = 0.05 * sum(truth) / len(truth)
    errors = [100.0 * (a - b) / max(b, floor) for a, b in zip(ours, truth)]
    sizes = sorted(abs(error) for error in errors)
    rms = math.sqrt(sum(error * error for error in errors) / len(errors))
    return rms, sum(errors) / len(errors), sizes[math.ceil(0.95 * len(sizes)) - 1], sizes[-1]


def cpu_seconds(command):
    """User and system time of a whole process."""
    process = os.posix_spawnp(command[0], command, os.environ)
    _, status, usage = os.wait4(process, 0)
    if status != 0:
        sys.exit(f"{' '.join(command)} failed")
    return usage.ru_utime + usage.ru_stime


def around(truth):
    """Each sensor's place and four beside it, which tell whether a sun patch ends there."""
    for x, y, z, _ in truth:
        for dx, dy in ((0, 0), (PATCH_EDGE_M, 0), (-PATCH_EDGE_M, 0), (0, PATCH_EDGE_M), (0, -PATCH_EDGE_M)):
            yield x + dx, y + dy, z


def away_from_patch_edges(rows, truth):
    """The sensors' illuminances, and those of the reference, where no sun patch ends."""
    kept = []
    for i, (_, _, _, true) in enumerate(truth):
        sun = [float(row["sun_lx"]) for row in rows[5 * i:5 * i + 5]]
        if max(sun) - min(sun) <= PATCH_STEP_LX:
            kept.append((float(rows[5 * i]["illuminance_lx"]), true))
    return [ours for ours, _ in kept], [true for _, true in kept]


def measure(program, scene, model, accuracy, runs):
    truth = read_reference(model.parent / scene.reference, scene.left_out)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        has_sun = scene.study == CLEAR
        places = around(truth) if has_sun else (row[:3] for row in truth)
        lines = ["x_m,y_m,z_m"] + [f"{x},{y},{z}" for x, y, z in places]
        (folder / "points.csv").write_text("\n".join(lines) + "\n")
        (folder / "study.toml").write_text(
            f'[model]\nfile = "{model}"\nunits = "m"\nup = "z"\n{scene.study}'
            '[[grid]]\nname = "sensors"\npoints = "points.csv"\n')
        command = [program, "study", str(folder / "study.toml"), "-o", str(folder / "report"), "--accuracy", accuracy,
                   "--no-pictures", "--quiet", "--threads", "2"]
        seconds = min(cpu_seconds(command) for _ in range(runs))
        with open(folder / "report" / "sensors.csv", newline="", encoding="utf-8") as table:
            rows = list(csv.DictReader(table))
    ours, true = [float(row["illuminance_lx"]) for row in rows], [row[3] for row in truth]
    if has_sun:
        ours, true = away_from_patch_edges(rows, truth)
    return seconds, errors_of(ours, true), len(true)


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("program")
    arguments.add_argument("folders", nargs="+", type=pathlib.Path)
    arguments.add_argument("--accuracy", nargs="+", default=["draft", "standard", "fine"])
    arguments.add_argument("--runs", type=int, default=3, help="the least CPU time of so many counts")
    arguments.add_argument("--page", help="the page that the table is put into; else it is printed")
    given = arguments.parse_args()

    lines = ["| scene (sensors; its reference's standard error) | program | CPU s | RMS % | bias % | p95 % | max % |",
             "|---|---|---|---|---|---|---|"]
    absent = []
    for scene in SCENES:
        models = [folder.resolve() / scene.model for folder in given.folders]
        model = next((model for model in models if (model.parent / scene.reference).is_file()), None)
        if model is None:
            absent.append(scene.title)
            continue
        for accuracy in given.accuracy:
            seconds, (rms, bias, p95, most), sensors = measure(
                str(pathlib.Path(given.program).resolve()), scene, model, accuracy, given.runs)
            lines.append(f"| {scene.title} ({sensors}; {scene.noise}) | Clerestory, {accuracy} | {seconds:.2f} | "
                         f"{rms:.1f} | {bias:+.1f} | {p95:.1f} | {most:.1f} |")
            print(lines[-1], file=sys.stderr)
        by_paths = scene.reference.endswith("_paths.csv")
        for level, *figures in () if by_paths else RADIANCE.get(scene.title, []):
            lines.append(f"| | Radiance, {level} | " + " | ".join(figures) + " |")
    page.put(lines, "errors", given.page)
    if absent:
        print("Not in the folders given: " + ", ".join(absent), file=sys.stderr)


if __name__ == "__main__":
    main()
