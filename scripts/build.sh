#!/usr/bin/env bash
# build.sh [PRESET [TARGET ...]]: installs what is missing, configures and builds a preset (default: release) into
# build/PRESET; all of it, or the targets named (`programs`: what runs a scene). What is up to date is skipped. Tests and
# benchmarks, and what they need, are left out where none is asked for.
set -euo pipefail
cd "$(dirname "$0")/.."
preset=${1:-release}
targets=("${@:2}")
groups=(programs)
case " ${targets[*]:-all} " in *\ all\ * | *\ test_* | *\ bench_*) groups+=(tests) ;; esac
./scripts/install.sh "${groups[@]}"
options=()
command -v ccache >/dev/null && options=(-DCMAKE_C_COMPILER_LAUNCHER=ccache -DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
folder=build/$preset
if [ ${#groups[@]} -eq 1 ]; then
  [ -f "$folder/build.ninja" ] || cmake --preset "$preset" "${options[@]}" -DBUILD_TESTING=OFF -DPALPATE_BENCH=OFF
elif [ ! -f "$folder/build.ninja" ] || grep -q '^BUILD_TESTING:[A-Z]*=OFF' "$folder/CMakeCache.txt"; then
  cmake --preset "$preset" "${options[@]}"
fi
# Ninja runs two more compilers than there are cores, which then wait for the memory: a tenth more time.
cmake --build --preset "$preset" --parallel "$(nproc)" ${targets[@]+--target "${targets[@]}"}
