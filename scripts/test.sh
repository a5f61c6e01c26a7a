#!/usr/bin/env bash
# Sets up, builds and runs all tests. Fails if one fails. Further arguments go to ctest (e.g. -R pattern).
set -euo pipefail
cd "$(dirname "$0")/.."
./scripts/build.sh release
./scripts/format.sh --check
# One more than there are cores: tests that start nodes mostly wait.
ctest --preset release --timeout 300 --parallel $(($(nproc) + 1)) "$@"
