#!/usr/bin/env bash
# without_organ.sh SOURCE BUILD: configured without palpate_organ, as where CGAL and ITK are not, no command of the build
# asks for anything of theirs, while commands of BUILD, which has it, do.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
asks_for_them() { ninja -C "$1" -t commands all | grep -E 'CGAL|ITK|mpfr' >/dev/null; }
asks_for_them "$2" || { echo "commands of $2 do not ask for CGAL and ITK: this test would see nothing"; exit 1; }
cmake -S "$1" -B "$folder" -G Ninja -DPALPATE_ORGAN=OFF -DCMAKE_BUILD_TYPE=Release >"$folder/said" 2>&1 || { cat "$folder/said"; exit 1; }
if asks_for_them "$folder"; then
  ninja -C "$folder" -t commands all | grep -m3 -E 'CGAL|ITK|mpfr'
  exit 1
fi
