#!/usr/bin/env bash
# Installs, configures and builds a preset (default: release) into build/PRESET. What is up to date is skipped.
set -euo pipefail
cd "$(dirname "$0")/.."
preset=${1:-release}
./scripts/install.sh
launcher=()
command -v ccache >/dev/null && launcher=(-DCMAKE_C_COMPILER_LAUNCHER=ccache -DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
[ -f "build/$preset/build.ninja" ] || cmake --preset "$preset" "${launcher[@]}"
cmake --build --preset "$preset"
