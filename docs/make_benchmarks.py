#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the benchmarks of docs/validation.md anew: their tables into docs/data, their charts into docs/images.

  cmake --preset release -DCLERESTORY_BENCH=ON && cmake --build --preset release --target bench
  docs/make_benchmarks.py build/release paper          the paper's Tables 1 and 2
  docs/make_benchmarks.py build/release convergence    its section 4 and Figures 2 to 5, the two oracles
  docs/make_benchmarks.py build/release station        its section 5.4
  docs/make_benchmarks.py build/release growth         finer furniture, the same light
  docs/make_benchmarks.py build/release columns        what more columns cost
  docs/make_benchmarks.py build/release importance     importance where few figures are asked for
  docs/make_benchmarks.py build/release versus         against plain radiosity

The figures for the text are printed as Markdown. With --draw-only the tables are taken as they are. Scenes and
what is kept between runs lie in BUILD/bench. Needs nothing but Python 3.9.
"""
import argparse
import csv
import math
import pathlib
import shutil
import subprocess
import sys

DOCS = pathlib.Path(__file__).resolve().parent
BENCH = DOCS.parent / "tests" / "bench"
sys.path.insert(0, str(BENCH))
from chart import fitted_power  # noqa: E402

OFFICE, TABLE, DAY = "sample office by its panels", "room with a table", "furnished office by day"


def run(command):
    print("$ " + " ".join(map(str, command)), file=sys.stderr, flush=True)
    subprocess.run([str(part) for part in command], check=True)


def rows_of(name):
    with open(DOCS / "data" / name, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def chart(table, image, *options):
    run([sys.executable, BENCH / "chart.py", DOCS / "data" / table, DOCS / "images" / image, *options])


def print_table(header, rows):
    print("\n| " + " | ".join(header) + " |\n|" + "---|" * len(header))
    for row in rows:
        print("| " + " | ".join(row) + " |")


def grouped(value):
    return f"{int(value):,}"


# The paper's tables ------------------------------------------------------------------------------------------


def measure_paper(build, folder):
    run([build / "bench_paper", "--folder", folder, "--threads", "2"])
    return ["paper_steps.csv", "paper_totals.csv"]


def show_paper():
    totals = rows_of("paper_totals.csv")
    best = {row["by"]: row for row in totals if row["cache_links"] == "unlimited"}
    rows = []
    for row in totals:
        base = best[row["by"]]
        # The paper's ratios are of its times; ours of CPU time, which other work on the machine disturbs less.
        time = "cpu_seconds" if row["cpu_seconds"] else "seconds"
        cache = row["cache_links"]
        rows.append([row["by"], cache if cache == "unlimited" else grouped(cache), grouped(row["links_computed"]),
                     grouped(row["visibility_tests"]),
                     f"{float(row['visibility_tests']) / float(base['visibility_tests']):.2f}",
                     grouped(row["elements"]), f"{float(row['seconds']):,.2f}", row["cpu_seconds"],
                     f"{float(row[time]) / float(base[time]):.2f}"])
    print_table(["by", "cache, links", "computed links", "visibility tests", "of the unlimited cache's", "elements",
                 "s", "CPU s", "time, of the unlimited cache's"], rows)
    cached = "cache_links=100000|1000000"
    chart("paper_steps.csv", "paper-reuse.svg", "-x", "iteration", "-y", "reused_pct", "--linear", "xy",
          "--series", "by", "--series", "cache_links", "--filter", cached,
          "--title", "Links taken from the cache (Table 1)", "--y-label", "of the links required, %")
    chart("paper_steps.csv", "paper-links.svg", "-x", "iteration", "-y", "links_required", "--linear", "x",
          "--series", "by", "--filter", "cache_links=100000", "--title", "Links required in each iteration (Table 1)",
          "--y-label", "links")


# Section 4 and Figures 2 to 5 --------------------------------------------------------------------------------


def measure_convergence(build, folder):
    run([build / "bench_convergence", "--folder", folder, "--threads", "1"])
    return ["convergence.csv", "steps.csv", "bound.csv"]


def runs_of(scene, oracle, method):
    return [row for row in rows_of("convergence.csv")
            if (row["scene"], row["oracle"], row["method"]) == (scene, oracle, method)]


def cost_at(runs, error_pct, cost):
    """What a method takes to an error: along its front straight in logarithms, between runs only."""
    front = []
    for row in sorted(runs, key=lambda row: float(row[cost])):
        point = float(row[cost]), float(row["error_pct"])
        if not front or point[1] < front[-1][1]:
            front.append(point)
    for (low, worse), (high, better) in zip(front, front[1:]):
        if better <= error_pct <= worse:
            share = math.log(worse / error_pct) / math.log(worse / better)
            return low * (high / low) ** share
    return None


def common_errors(*methods):
    """A few round errors that all of them reach between their runs."""
    low = max(min(float(row["error_pct"]) for row in runs) for runs in methods)
    high = min(max(float(row["error_pct"]) for row in runs) for runs in methods)
    return [error for error in (40, 30, 25, 20, 15, 12, 10, 9, 8, 7, 6, 5, 4, 3, 2) if low <= error <= high]


def show_slopes():
    rows = []
    for scene in (TABLE, OFFICE, DAY):
        for oracle, method in (("transported power", "shooting"), ("transported power", "gathering"),
                               ("error", "shooting")):
            points = [(float(row["epsilon"]), float(row["error_pct"])) for row in runs_of(scene, oracle, method)]
            rows.append([scene, oracle, method, f"{points[0][0]:.0e} to {points[-1][0]:.1e}",
                         f"{points[0][1]:.1f} to {points[-1][1]:.1f}", f"{fitted_power(points):.2f}"])
    print_table(["scene", "oracle", "method", "ε", "error δ, %", "slope"], rows)
    for scene, image in ((TABLE, "paper-error-table.svg"), (OFFICE, "paper-error-office.svg")):
        chart("convergence.csv", image, "-x", "epsilon", "-y", "error_pct", "--series", "method", "--filter",
              f"scene={scene}", "--filter", "oracle=transported power", "--fit", "--slope", "0.25",
              "--title", f"Global error and threshold: {scene}", "--x-label", "ε",
              "--y-label", "error δ of radiosity, RMS over area, %")


def show_equal_error():
    rows = []
    for scene in (TABLE, OFFICE):
        shooting, gathering = (runs_of(scene, "transported power", method) for method in ("shooting", "gathering"))
        for error in common_errors(shooting, gathering):
            time = [cost_at(runs, error, "cpu_seconds") for runs in (shooting, gathering)]
            memory = [cost_at(runs, error, "link_bytes") for runs in (shooting, gathering)]
            links = [cost_at(runs, error, "links") for runs in (shooting, gathering)]
            if None in time + memory + links:
                continue
            rows.append([scene, f"{error}", f"{time[0]:.3g}", f"{time[1]:.3g}", f"{time[0] / time[1]:.2f}",
                         f"{memory[0] / 2**20:.2f}", f"{memory[1] / 2**20:.2f}", f"{memory[0] / memory[1]:.2f}"])
    print_table(["scene", "error, %", "shooting, CPU s", "gathering, CPU s", "ratio", "shooting's links, MiB",
                 "gathering's links, MiB", "ratio"], rows)
    for column, label, image in (("cpu_seconds", "CPU s", "paper-time.svg"), ("link_bytes", "bytes", "paper-memory.svg")):
        what = "Error and time" if column == "cpu_seconds" else "Error and memory of links"
        chart("convergence.csv", image, "-x", column, "-y", "error_pct", "--series", "method", "--filter",
              f"scene={OFFICE}", "--filter", "oracle=transported power", "--front", "--title", f"{what}: {OFFICE}",
              "--x-label", label, "--y-label", "error δ of radiosity, RMS over area, %")


def show_steps():
    """Figures 4 and 5 at two thresholds of about the same error: the finest that gathering has."""
    shooting, gathering = (runs_of(OFFICE, "transported power", method) for method in ("shooting", "gathering"))
    own = gathering[-1]
    other = min(shooting, key=lambda row: abs(float(row["error_pct"]) - float(own["error_pct"])))
    print(f"\nFigures 4 and 5: gathering at ε = {own['epsilon']} ({float(own['error_pct']):.1f} %), "
          f"shooting at ε = {other['epsilon']} ({float(other['error_pct']):.1f} %)")
    with open(DOCS / "data" / "steps_equal.csv", "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["method", "epsilon", "iteration", "links_required", "links_reused", "reused_pct"])
        for row in rows_of("steps.csv"):
            for chosen in (own, other):
                if all(row[key] == chosen[key] for key in ("scene", "method", "epsilon")):
                    writer.writerow([row[key] for key in ("method", "epsilon", "iteration", "links_required",
                                                          "links_reused", "reused_pct")])
    chart("steps_equal.csv", "paper-figure4.svg", "-x", "iteration", "-y", "links_required", "--linear", "x",
          "--series", "method", "--title", f"Links required (Figure 4): {OFFICE}", "--y-label", "links")
    chart("steps_equal.csv", "paper-figure5.svg", "-x", "iteration", "-y", "links_reused", "--linear", "xy",
          "--series", "method", "--title", f"Links that the step before had (Figure 5): {OFFICE}",
          "--y-label", "links")


def show_bound():
    rows = [row for row in rows_of("bound.csv") if row["scene"] == OFFICE]
    quantities = ["error of the step alone", "error against the partial sum", "bound by the sum of the steps",
                  "bound by the largest step", "error against the limit"]
    for method in ("shooting", "gathering"):
        own = [row for row in rows if row["method"] == method]
        steps = sorted({int(row["iteration"]) for row in own})
        value = {(int(row["iteration"]), row["quantity"]): float(row["percent"]) for row in own}
        print(f"\n{method}, ε = {own[0]['epsilon']}")
        print_table(["iteration", *quantities],
                    [[str(step), *(f"{value[step, quantity]:.2f}" for quantity in quantities)] for step in steps])
        number = 9 if method == "shooting" else 8
        chart("bound.csv", f"paper-bound-{method}.svg", "-x", "iteration", "-y", "percent", "--linear", "x", "--series",
              "quantity", "--filter", f"scene={OFFICE}", "--filter", f"method={method}",
              "--title", f"Error of {method} and equation {number}: {OFFICE}", "--y-label", "% of the radiosity's RMS")


def show_oracles():
    rows = []
    for scene in (TABLE, OFFICE, DAY):
        power, error_bound = (runs_of(scene, oracle, "shooting") for oracle in ("transported power", "error"))
        for column, what in (("error_pct", "radiosity"), ("surfaces_pct", "means of surfaces")):
            power_runs, error_runs = ([dict(row, error_pct=row[column]) for row in runs]
                                      for runs in (power, error_bound))
            for error in common_errors(power_runs, error_runs):
                links = [cost_at(runs, error, "links") for runs in (power_runs, error_runs)]
                time = [cost_at(runs, error, "cpu_seconds") for runs in (power_runs, error_runs)]
                if None in links + time:
                    continue
                rows.append([scene, what, f"{error}", grouped(links[0]), grouped(links[1]),
                             f"{links[1] / links[0]:.2f}", f"{time[0]:.3g}", f"{time[1]:.3g}",
                             f"{time[1] / time[0]:.2f}"])
    print_table(["scene", "error of", "%", "links, power", "links, error", "ratio", "CPU s, power", "CPU s, error",
                 "ratio"], rows)
    for scene, name in ((TABLE, "table"), (OFFICE, "office"), (DAY, "day")):
        chart("convergence.csv", f"oracles-{name}.svg", "-x", "links", "-y", "error_pct", "--series", "oracle",
              "--filter", f"scene={scene}", "--filter", "method=shooting", "--front",
              "--title", f"The two oracles: {scene}", "--x-label", "links in all steps",
              "--y-label", "error δ of radiosity, RMS over area, %")


def show_convergence():
    show_slopes()
    show_equal_error()
    show_steps()
    show_bound()
    show_oracles()


# Large and finer scenes --------------------------------------------------------------------------------------


def measure_station(build, folder):
    if not (folder / "station.obj").exists():
        run([sys.executable, BENCH / "make_station.py", folder])
    run([build / "bench_station", folder / "station.obj", "--folder", folder, "--threads", "2"])
    return ["station.csv"]


def show_station():
    rows = []
    for row in rows_of("station.csv"):
        percents = [row[key] and f"{float(row[key]):.1f}" for key in ("surfaces_pct", "elements_pct")]
        rows.append([row["oracle"], row["setting"], grouped(row["links_required"]), grouped(row["elements"]),
                     f"{float(row['cpu_seconds']):.1f}", f"{float(row['wall_seconds']):.1f}",
                     f"{float(row['before_mib']):.0f}", f"{float(row['peak_mib']):.0f}", *percents])
    print_table(["oracle", "ε or accuracy", "interactions", "elements", "CPU s", "s on 2 threads", "MiB before",
                 "MiB at most", "surfaces against a four times finer run, %", "elements, %"], rows)


def measure_growth(build, folder):
    models = []
    for polygons in (5000, 75000, 500000):
        models.append(folder / f"furniture-{polygons}.obj")
        if not models[-1].exists():
            run([sys.executable, BENCH / "make_furniture.py", polygons, folder])
    run([build / "bench_growth", *models, "--folder", folder])
    return ["growth.csv"]


def show_growth():
    rows = []
    for row in rows_of("growth.csv"):
        rows.append([*(grouped(row[key]) for key in ("polygons", "links_required", "links_first_step", "elements")),
                     f"{float(row['steps_cpu_seconds']):.2f}", f"{float(row['before_cpu_seconds']):.1f}",
                     f"{float(row['sensors_p95_pct']):.1f}", f"{float(row['sensors_rms_pct']):.1f}",
                     f"{float(row['truth_pct']):.1f}"])
    print_table(["polygons", "interactions", "of these in the first step", "elements", "all steps, CPU s",
                 "before them, CPU s", "sensors' p95, %", "RMS, %", "standard error of the truth, %"], rows)
    chart("growth.csv", "growth.svg", "-x", "polygons", "-y", "steps_cpu_seconds",
          "--title", "Time of all steps with finer furniture", "--y-label", "CPU s")


def measure_columns(build, folder):
    run([build / "bench_columns", "--folder", folder])
    return ["columns.csv"]


def show_columns():
    rows = []
    for row in rows_of("columns.csv"):
        rows.append([row["scene"], row["columns"], f"{float(row['first_s']):.3f}", f"{float(row['steps_s']):.3f}",
                     f"{float(row['ratio']):.2f}", grouped(row["nodes"]), grouped(row["geometry_bytes_per_node"]),
                     grouped(row["value_bytes_per_node"])])
    print_table(["scene", "columns", "first step, CPU s", "its reflections, CPU s", "of one column's", "nodes",
                 "geometry, bytes a node", "light, bytes a node"], rows)
    chart("columns.csv", "columns.svg", "-x", "columns", "-y", "ratio", "--linear", "y", "--series", "scene",
          "--title", "What more columns cost", "--y-label", "CPU time, of one column's")


def measure_importance(build, folder):
    floor = DOCS.parent / "tests" / "data" / "reference" / "floor" / "floor.obj"
    run([build / "bench_importance", "--folder", folder, "--floor", floor])
    return ["importance.csv"]


def show_importance():
    rows = []
    every = rows_of("importance.csv")
    for scene in dict.fromkeys(row["scene"] for row in every):
        own = [row for row in every if row["scene"] == scene]
        area, asked = ([row for row in own if row["weights"] == weights] for weights in ("by area", "with importance"))
        for error in common_errors(area, asked):
            links = [cost_at(runs, error, "links") for runs in (area, asked)]
            time = [cost_at(runs, error, "cpu_seconds") for runs in (area, asked)]
            if None in links + time:
                continue
            rows.append([scene, f"{error}", grouped(links[0]), grouped(links[1]), f"{links[1] / links[0]:.2f}",
                         f"{time[0]:.3f}", f"{time[1]:.3f}", f"{time[1] / time[0]:.2f}"])
        chart("importance.csv", f"importance-{scene.replace(' ', '-')}.svg", "-x", "cpu_seconds", "-y", "error_pct",
              "--series", "weights", "--filter", f"scene={scene}", "--front", "--title", f"Importance: {scene}",
              "--x-label", "CPU s", "--y-label", "error of the sensors asked for, RMS, %")
    print_table(["scene", "error, %", "links by area", "with importance", "ratio", "CPU s by area", "with importance",
                 "ratio"], rows)


def measure_versus(build, folder):
    rooms = [DOCS.parent / "tests" / "data" / "reference" / room / f"{room}.obj" for room in ("refoffice", "furnished")]
    run([build / "bench_versus", "--folder", folder, "--table", "versus.csv", "--seeds", "2", "--longest", "0.5", *rooms])
    run([build / "bench_versus", "--folder", folder, "--table", "versus_office.csv", "--seeds", "1", "--longest", "2",
         "--truth-size", "0.3", "--truth-rays", "128", DOCS.parent / "samples" / "office" / "study.toml"])
    office = (folder / "versus_office.csv").read_text().split("\n", 1)[1]
    with open(folder / "versus.csv", "a", encoding="utf-8") as table:
        table.write(office)
    return ["versus.csv"]


def show_versus():
    """The least time of any setting that comes to an error, and of those that all dearer ones keep to."""
    rows = []
    every = rows_of("versus.csv")
    for scene in dict.fromkeys(row["scene"] for row in every):
        for error in (5, 2, 1):
            line = [scene, f"{error} %"]
            for method in ("rival", "shooting"):
                runs = sorted((float(row["seconds"]), float(row["error_pct"])) for row in every
                              if (row["scene"], row["method"]) == (scene, method))
                line.append(next((f"{seconds:.4f}" for seconds, own in runs if own <= error), "–"))
                kept = len(runs)
                while kept > 0 and runs[kept - 1][1] <= error:
                    kept -= 1
                line.append(f"{runs[kept][0]:.4f}" if kept < len(runs) else "–")
            rows.append(line)
        chart("versus.csv", f"versus-{scene}.svg", "-x", "seconds", "-y", "error_pct", "--series", "method",
              "--filter", f"scene={scene}", "--front", "--title", f"Means of surfaces: {scene}", "--x-label", "CPU s",
              "--y-label", "error of surfaces over 0.1 m², RMS over area, %")
    print_table(["scene", "to", "rival, s", "all dearer ones too", "shooting, s", "all dearer ones too"], rows)


BENCHMARKS = {
    "paper": (measure_paper, show_paper),
    "convergence": (measure_convergence, show_convergence),
    "station": (measure_station, show_station),
    "growth": (measure_growth, show_growth),
    "columns": (measure_columns, show_columns),
    "importance": (measure_importance, show_importance),
    "versus": (measure_versus, show_versus),
}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("build", type=pathlib.Path, help="where the benchmarks were built")
    parser.add_argument("which", nargs="+", choices=BENCHMARKS)
    parser.add_argument("--draw-only", action="store_true")
    arguments = parser.parse_args()
    folder = arguments.build.resolve() / "bench"
    for place in (folder, DOCS / "data", DOCS / "images"):
        place.mkdir(parents=True, exist_ok=True)
    for name in arguments.which:
        measure, show = BENCHMARKS[name]
        if not arguments.draw_only:
            for table in measure(arguments.build.resolve(), folder):
                shutil.copyfile(folder / table, DOCS / "data" / table)
        show()


if __name__ == "__main__":
    main()
