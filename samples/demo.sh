#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# From a fresh clone to a report: installs what is missing, builds the program and computes the office's daylight.
set -euo pipefail

project="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
"$project/cmake/install-packages.sh"

cd "$project"
cmake --preset release
cmake --build --preset release --target clerestory --parallel "$(nproc)"
build/release/clerestory study samples/office/study.toml -o build/office-report
echo "The report: $project/build/office-report/index.html"
