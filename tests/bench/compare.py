#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Compares two versions of Clerestory by their CPU seconds, in interleaved runs of the same studies.

  tests/bench/compare.py BASE NEW [--runs 7] [--only PATTERN] [--limit 1.1] [--json FILE] [--page docs/performance.md]

BASE and NEW are built programs or commits; a commit is checked out and built below build/compare/. Machines are
noisy, so only ratios of runs one after the other count. Exit code 1 where NEW is slower than the limit in three
quarters of the runs of a study. Needs nothing but Python 3.9, git, a POSIX system and what building takes.
"""
import argparse
import fnmatch
import json
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

PROJECT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(PROJECT / "docs"))
import page  # noqa: E402  (of docs/)

OFFICE = PROJECT / "samples/office"
SCENES = PROJECT / "tests/data/reference"
DAY = '[sky]\ntype = "cie-overcast"\ndiffuse_horizontal_lx = 10000\n[materials."glazing*"]\ntransmittance = 0.65\n'


def study_of(scene):
    return f'[model]\nfile = "{SCENES / scene / scene}.obj"\nunits = "m"\nup = "z"\n{DAY}'


# Title -> (text of a study or None, arguments; STUDY and REPORT stand for files).
CASES = {
    "start": (None, ["--help"]),
    "inspect the sample office": (None, ["inspect", str(OFFICE / "office.glb")]),
    "empty office, standard": (study_of("refoffice"), ["study", "STUDY", "-o", "REPORT", "--no-pictures"]),
    "furnished office, standard": (study_of("furnished"), ["study", "STUDY", "-o", "REPORT", "--no-pictures"]),
    "floor of twelve offices, draft": (study_of("floor"),
                                       ["study", "STUDY", "-o", "REPORT", "--no-pictures", "--accuracy", "draft"]),
    "sample office, standard": (None, ["study", str(OFFICE / "study.toml"), "-o", "REPORT"]),
}


def program_of(version):
    """The program at a path, or of a commit, which is built."""
    if pathlib.Path(version).is_file():
        return str(pathlib.Path(version).resolve())

    def git(*arguments):
        return subprocess.run(["git", "-C", PROJECT, *arguments], capture_output=True, text=True)

    commit = git("rev-parse", "--verify", "--quiet", version + "^{commit}").stdout.strip()
    if not commit:
        sys.exit(f"{version} is neither a program nor a commit")
    tree = PROJECT / "build/compare" / commit[:12]
    if not tree.is_dir():
        git("worktree", "add", "--detach", str(tree), commit).check_returncode()
    for step in (["--preset", "release", "-DCLERESTORY_TESTS=OFF"], ["--build", "--preset", "release"]):
        subprocess.run(["cmake", *step], cwd=tree, check=True, stdout=sys.stderr)
    return str(tree / "build/release/clerestory")


def run(program, study, arguments):
    """One run: CPU seconds of the process, and wall seconds up to each line that says what comes next."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        if study is not None:
            (folder / "study.toml").write_text(study)
        places = {"STUDY": str(folder / "study.toml"), "REPORT": str(folder / "report")}
        start = last = time.monotonic()
        process = subprocess.Popen([program, *(places.get(argument, argument) for argument in arguments)],
                                   stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        stages, stage = {}, "start-up"
        lines = []
        for line in process.stderr:
            lines.append(line)
            if ": " not in line or ":" in line.split(": ", 1)[1]:
                continue  # a warning or a result
            now = time.monotonic()
            stages[stage] = stages.get(stage, 0.0) + now - last
            stage, last = line.split(": ", 1)[1].strip(), now
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        end = time.monotonic()
        stages[stage] = stages.get(stage, 0.0) + end - last
    if process.returncode != 0:
        sys.exit(f"{program} {' '.join(arguments)} failed:\n{''.join(lines)}")
    return {"cpu_s": usage.ru_utime + usage.ru_stime, "wall_s": end - start, "stages_s": stages}


def compare(programs, title, runs):
    """Runs of both in turns, and the quartiles of their ratios."""
    study, arguments = CASES[title]
    pairs = []
    for i in range(runs):
        order = ["base", "new"] if i % 2 == 0 else ["new", "base"]
        pairs.append({which: run(programs[which], study, arguments) for which in order})
        print(f"{title}: {i + 1} of {runs}", file=sys.stderr)
    ratios = [pair["new"]["cpu_s"] / max(pair["base"]["cpu_s"], 1e-3) for pair in pairs]
    low, middle, high = statistics.quantiles(ratios, n=4) if runs > 1 else 3 * ratios
    return {"title": title, "runs": pairs, "ratio": {"low": low, "median": middle, "high": high}}


def rows_of(result):
    """Medians: the whole process, and the stages that take a fiftieth of it."""
    def median(which, seconds):
        return statistics.median(seconds(pair[which]) for pair in result["runs"])

    ratio = result["ratio"]
    wall = {which: median(which, lambda one: one["wall_s"]) for which in ("base", "new")}
    rows = [f"| **{result['title']}** | " + " | ".join(
        f"{median(which, lambda one: one['cpu_s']):.2f}" for which in ("base", "new")) +
        f" | {ratio['median']:.2f} ({ratio['low']:.2f} to {ratio['high']:.2f}) | {wall['base']:.2f} | {wall['new']:.2f} |"]
    stages = dict.fromkeys(stage for pair in result["runs"] for which in ("base", "new") for stage in pair[which]["stages_s"])
    for stage in stages if len(stages) > 1 else ():
        seconds = {which: median(which, lambda one: one["stages_s"].get(stage, 0.0)) for which in ("base", "new")}
        if any(seconds[which] >= 0.02 * wall[which] for which in seconds):
            rows.append(f"| {stage} | | | | {seconds['base']:.2f} | {seconds['new']:.2f} |")
    return rows


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("base")
    arguments.add_argument("new")
    arguments.add_argument("--runs", type=int, default=7)
    arguments.add_argument("--only", default="*", help="the cases that this matches; a name or a pattern")
    arguments.add_argument("--limit", type=float, default=1.1, help="a ratio that counts as slower")
    arguments.add_argument("--json", type=pathlib.Path, help="a file for all runs")
    arguments.add_argument("--page", help="the page that the table is put into; else it is printed")
    given = arguments.parse_args()

    programs = {"base": program_of(given.base), "new": program_of(given.new)}
    titles = [title for title in CASES if fnmatch.fnmatch(title, given.only)]
    if not titles:
        sys.exit(f"no case is called {given.only}; there are: {', '.join(CASES)}")
    results = [compare(programs, title, given.runs) for title in titles]
    if given.json:
        given.json.write_text(json.dumps({"base": given.base, "new": given.new, "cases": results}, indent=1) + "\n")
    lines = ["| study, and its stages | CPU s before | now | ratio (quartiles) | wall s before | now |",
             "|---|---|---|---|---|---|"]
    for result in results:
        lines += rows_of(result)
    page.put(lines, "stages", given.page)
    slower = [result["title"] for result in results if result["ratio"]["low"] > given.limit]
    if slower:
        sys.exit(f"slower than {given.limit:g} times: {', '.join(slower)}")


if __name__ == "__main__":
    main()
