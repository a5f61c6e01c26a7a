#!/usr/bin/env bash
# Sets up, builds and runs all tests. Fails if one fails. Further arguments go to ctest (e.g. -R pattern).
set -euo pipefail
cd "$(dirname "$0")/.."
./scripts/install.sh images spacemouse python  # what is optional, and its tests
./scripts/build.sh release
./scripts/format.sh --check
ctest --preset release --timeout 300 --parallel "$(nproc)" "$@"
