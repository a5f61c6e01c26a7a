#!/usr/bin/env bash
# build.sh [PRESET [TARGET ...]]: installs what is missing, configures and builds a preset (default: release) into
# build/PRESET; all of it, or the targets named (`programs`: what runs a scene). What is up to date is skipped.
set -euo pipefail
cd "$(dirname "$0")/.."
preset=${1:-release}
targets=("${@:2}")
./scripts/install.sh
launcher=()
command -v ccache >/dev/null && launcher=(-DCMAKE_C_COMPILER_LAUNCHER=ccache -DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
[ -f "build/$preset/build.ninja" ] || cmake --preset "$preset" "${launcher[@]}"
# Ninja runs two more compilers than there are cores, which then wait for the memory: a tenth more time.
cmake --build --preset "$preset" --parallel "$(nproc)" ${targets[@]+--target "${targets[@]}"}
