#!/usr/bin/env bash
# The long forms of seeded tests, every stability case, and the address, undefined-behaviour and thread sanitizers.
set -euo pipefail
cd "$(dirname "$0")/.."
export PALPATE_LONG_TESTS=1
export LSAN_OPTIONS=suppressions=$PWD/tests/lsan.supp
export TSAN_OPTIONS="suppressions=$PWD/tests/tsan.supp ignore_noninstrumented_modules=1"
./scripts/test.sh --timeout 1800
./build/release/bin/palpate stability -o out/stability
for preset in address thread; do
  ./scripts/build.sh "$preset"
  # OpenMP's own joins are not seen by the thread sanitizer; resident memory means nothing under any.
  OMP_NUM_THREADS=1 ctest --preset "$preset" --timeout 1200 -E HapticMemory
done
