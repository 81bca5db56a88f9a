#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs Clerestory on reference scenes and prints the table of docs/validation.md: errors and CPU seconds.

  docs/make_validation.py build/release/clerestory tests/data/reference [FOLDER ...] [--accuracy draft standard ...]

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


@dataclasses.dataclass
class Scene:
    title: str
    model: str      # below a folder that is given
    reference: str  # beside the model
    study: str      # what the study states beside the model, the grid and the accuracy
    noise: str      # what is known of the reference's own error
    left_out: str = ""  # tag of sensors that are not compared


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
    Scene("floor of twelve offices", "floor/floor.obj", "floor_overcast.csv",
          OVERCAST + '[materials."glazing*"]\ntransmittance = 0.65\n', "1.7 %", left_out="corridor"),
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
}


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


def measure(program, scene, model, accuracy, runs):
    truth = read_reference(model.parent / scene.reference, scene.left_out)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        lines = ["x_m,y_m,z_m"] + [f"{x},{y},{z}" for x, y, z, _ in truth]
        (folder / "points.csv").write_text("\n".join(lines) + "\n")
        (folder / "study.toml").write_text(
            f'[model]\nfile = "{model}"\nunits = "m"\nup = "z"\n{scene.study}'
            '[[grid]]\nname = "sensors"\npoints = "points.csv"\n')
        command = [program, "study", str(folder / "study.toml"), "-o", str(folder / "report"), "--accuracy", accuracy,
                   "--no-pictures", "--quiet", "--threads", "2"]
        seconds = min(cpu_seconds(command) for _ in range(runs))
        with open(folder / "report" / "sensors.csv", newline="", encoding="utf-8") as table:
            ours = [float(row["illuminance_lx"]) for row in csv.DictReader(table)]
    return seconds, errors_of(ours, [row[3] for row in truth]), len(truth)


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("program")
    arguments.add_argument("folders", nargs="+", type=pathlib.Path)
    arguments.add_argument("--accuracy", nargs="+", default=["draft", "standard", "fine"])
    arguments.add_argument("--runs", type=int, default=3, help="the least CPU time of so many counts")
    given = arguments.parse_args()

    print("| scene (sensors; its reference's standard error) | program | CPU s | RMS % | bias % | p95 % | max % |")
    print("|---|---|---|---|---|---|---|")
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
            print(f"| {scene.title} ({sensors}; {scene.noise}) | Clerestory, {accuracy} | {seconds:.2f} | {rms:.1f} | "
                  f"{bias:+.1f} | {p95:.1f} | {most:.1f} |", flush=True)
        by_paths = scene.reference.endswith("_paths.csv")
        for level, *figures in () if by_paths else RADIANCE.get(scene.title, []):
            print(f"| | Radiance, {level} | " + " | ".join(figures) + " |", flush=True)
    if absent:
        print("Not in the folders given: " + ", ".join(absent), file=sys.stderr)


if __name__ == "__main__":
    main()
