#!/usr/bin/env bash
# Sets up, builds and runs all tests. Fails if one fails. Further arguments go to ctest (e.g. -R pattern).
set -euo pipefail
cd "$(dirname "$0")/.."
./scripts/install.sh images spacemouse python  # what is optional, and its tests
./scripts/build.sh release
./scripts/format.sh --check
# In slots: a test that computes takes two of them, as a core; one that only waits takes one.
held_up=build/release/cache/held_up
last=build/release/Testing/Temporary/LastTest.log
rm -f "$held_up" "$last"
say_at_end() {
  if [ $? -ne 0 ] && [ -e "$last" ]; then grep -A4 ': Failure$' "$last" | cut -c1-300 | head -n 60 || true; fi
  if [ -e "$held_up" ]; then cat "$held_up"; fi  # what ran again (tests/realtime/unless_held_up.cpp)
}
trap say_at_end EXIT
ctest --preset release --timeout 900 --parallel "$((2 * $(nproc) + 1))" "$@"
