#!/usr/bin/env bash
# Sets up, builds the programs, precomputes the liver's tensors and runs the liver scene for ten seconds over DDS on loopback.
# Says in the end how to touch it. Leaves out/liver.mp4, out/liver.png, out/liver.lcmlog and out/summary.json.
set -euo pipefail
cd "$(dirname "$0")/.."
./scripts/build.sh release programs
mkdir -p out
bin=build/release/bin
"$bin/palpate" precompute scenes/liver.toml
"$bin/palpate" run scenes/liver.toml --seconds 10 --film out/liver.mp4 --still out/liver.png --record out/liver.lcmlog --summary out/summary.json
echo
echo "Press the liver with the mouse: start the live view, and open the address that it says:"
echo "    $bin/palpate run scenes/liver.toml --web"
