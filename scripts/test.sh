#!/usr/bin/env bash
# Sets up, builds and runs all tests. Fails if one fails. Further arguments go to ctest (e.g. -R pattern).
set -euo pipefail
cd "$(dirname "$0")/.."
./scripts/build.sh release
./scripts/format.sh --check
# One more than there are cores: tests that start nodes mostly wait. What asserts forces in real time may meet a busy
# machine: a test that fails is run again, twice at most; one that always fails still fails.
ctest --preset release --timeout 300 --repeat until-pass:3 --parallel $(($(nproc) + 1)) "$@"
