#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Charts error against time on the reference scenes and the sample office, for docs/validation.md.

  docs/make_charts.py build/release/clerestory tests/data/reference

Writes docs/images/chart-SCENE.svg and docs/data/chart-SCENE.csv by `clerestory chart`, against the tables by paths and
with Radiance's runs; the sample office has the program's own finest run as reference. Prints the least CPU time of each
method to an error.
"""
import argparse
import csv
import pathlib
import shutil
import subprocess
import sys
import tempfile

import make_validation

DOCS = pathlib.Path(__file__).resolve().parent
ROOT = DOCS.parent
FINEST = {"refoffice": "0.02", "furnished": "0.02", "floor": "0.035", "office": "0.05"}


def write_points(file, title):
    """Radiance's runs as `clerestory chart --points` takes them."""
    lines = ["method,setting,cpu_s,bias_pct,rms_pct,p95_pct,max_pct"]
    for level, cpu, rms, bias, p95, most in make_validation.RADIANCE.get(title, []):
        lines.append(f"Radiance,{level.split(' (')[0]},{cpu},{bias},{rms},{p95},{most}")
    file.write_text("\n".join(lines) + "\n")


def draw(program, name, study, options):
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary) / "chart"
        subprocess.run([program, "chart", str(study), "-o", str(folder), "--finest", FINEST[name], "--threads", "2",
                        "--longest", "30", "--quiet", *options], check=True, stdout=subprocess.DEVNULL)
        shutil.copy(folder / "chart.svg", DOCS / "images" / f"chart-{name}.svg")
        shutil.copy(folder / "chart.csv", DOCS / "data" / f"chart-{name}.csv")


def draw_reference_scene(program, name, scene, model):
    reference = model.parent / scene.reference
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        rows = make_validation.read_reference(reference, scene.left_out)
        (folder / "points.csv").write_text(
            "\n".join(["x_m,y_m,z_m"] + [f"{x},{y},{z}" for x, y, z, _ in rows]) + "\n")
        (folder / "study.toml").write_text(
            f'[model]\nfile = "{model}"\nunits = "m"\nup = "z"\n{scene.study}'
            '[[grid]]\nname = "sensors"\npoints = "points.csv"\n')
        write_points(folder / "radiance.csv", scene.title)
        draw(program, name, folder / "study.toml",
             ["--reference", str(reference), "--points", str(folder / "radiance.csv")])


def least_seconds(name, method, asked_pct):
    with open(DOCS / "data" / f"chart-{name}.csv", newline="", encoding="utf-8") as table:
        times = [float(row["cpu_s"]) for row in csv.DictReader(table)
                 if row["series"] == "accuracy" and row["method"] == method and float(row["rms_pct"]) <= asked_pct]
    return f"{min(times):.3f}" if times else "–"


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("program")
    arguments.add_argument("folders", nargs="+", type=pathlib.Path)
    arguments.add_argument("--scenes", nargs="+", default=list(FINEST), choices=list(FINEST))
    given = arguments.parse_args()
    program = str(pathlib.Path(given.program).resolve())
    print("| scene | method | to 5 % | to 2 % | to 1 % |\n|---|---|---|---|---|")
    for name in given.scenes:
        if name == "office":
            draw(program, name, ROOT / "samples" / "office" / "study.toml", [])
        else:
            scene = next(scene for scene in make_validation.SCENES
                         if scene.model.startswith(name + "/") and scene.reference.endswith("_overcast_paths.csv"))
            models = [folder.resolve() / scene.model for folder in given.folders]
            model = next((model for model in models if (model.parent / scene.reference).is_file()), None)
            if model is None:
                print(f"{name} is in none of the folders", file=sys.stderr)
                continue
            draw_reference_scene(program, name, scene, model)
        for method in ("shooting", "gathering", "plain"):
            print(f"| {name} | {method} | " + " | ".join(least_seconds(name, method, p) for p in (5, 2, 1)) + " |",
                  flush=True)


if __name__ == "__main__":
    main()
