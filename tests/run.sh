#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Installs what is missing, builds everything and runs the whole test suite; what is given on the command line goes to ctest.
set -euo pipefail

project="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
models="${CLERESTORY_MODELS:-}" # a folder of further models to test with
if [ -n "$models" ]; then
  models="$(cd "$models" && pwd)"
fi
"$project/cmake/install-packages.sh"

cd "$project"
cmake --preset release -DCLERESTORY_TESTS=ON "-DCLERESTORY_MODELS=$models"
cmake --build --preset release --parallel "$(nproc)"
ctest --preset release --parallel "$(nproc)" "$@"
