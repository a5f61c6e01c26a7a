#!/usr/bin/env bash
# Sets up, builds and runs all tests. Fails if one fails. Further arguments go to ctest (e.g. -R pattern).
set -euo pipefail
cd "$(dirname "$0")/.."
./scripts/install.sh libcgal-dev libinsighttoolkit5-dev  # for `palpate mesh`, `organ` and `segment` and their tests
./scripts/build.sh release
./scripts/format.sh --check
# Two more than there are cores: tests that start nodes mostly wait.
ctest --preset release --timeout 300 --parallel $(($(nproc) + 2)) "$@"
