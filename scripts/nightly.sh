#!/usr/bin/env bash
# The long tests: address, undefined-behaviour and thread sanitizers, and the long forms of seeded tests.
set -euo pipefail
cd "$(dirname "$0")/.."
export PALPATE_LONG_TESTS=1
export LSAN_OPTIONS=suppressions=$PWD/tests/lsan.supp
./scripts/test.sh
for preset in address thread; do
  ./scripts/build.sh "$preset"
  ctest --preset "$preset" --timeout 1200
done
