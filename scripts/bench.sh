#!/usr/bin/env bash
# Runs everything in bench/ and the liver scene, and writes out/bench.csv:
# bench,case,metric,value,unit,machine,commit. --quick takes fewer samples. Leave the machine alone meanwhile.
# The live view's rows, `web`, are scripts/live_view.py's, which needs a browser.
set -euo pipefail
cd "$(dirname "$0")/.."
quick=()
seconds=10
for argument in "$@"; do
  case "$argument" in
    --quick) quick=(--quick); seconds=4 ;;
    -h|--help) sed -n '2,4p' "$0"; exit 0 ;;
    *) echo "bench.sh: unknown argument $argument" >&2; exit 2 ;;
  esac
done
./scripts/build.sh release
bin=build/release/bin
mkdir -p out
machine=$(awk -F': ' '/model name/ {print $2; exit}' /proc/cpuinfo | tr ',' ' ')
commit=$(git rev-parse --short HEAD 2>/dev/null || echo unknown)
[ -z "$(git status --porcelain 2>/dev/null)" ] || commit="$commit+"
echo "bench,case,metric,value,unit,machine,commit" > out/bench.csv
keep() { awk -F, -v m="$machine ($(nproc) cores)" -v c="$commit" 'NF == 5 {print $0 "," m "," c; fflush()}' | tee -a out/bench.csv; }

for program in "$bin"/bench_*; do
  echo "# $(basename "$program")" >&2
  "$program" "${quick[@]}" | keep
done

# The running systems: the liver for a while, the others to their end.
for scene in liver hepatectomy catheter_insertion; do
  echo "# palpate run $scene" >&2
  limit=()
  [ "$scene" = liver ] && limit=(--seconds "$seconds")
  "$bin/palpate" run "scenes/$scene.toml" "${limit[@]}" --processes 2 --domain 97 --summary out/bench_run.json >&2
  python3 scripts/run_rows.py out/bench_run.json "$scene" | keep
done
rm -f out/bench_run.json
echo "out/bench.csv: $(($(wc -l < out/bench.csv) - 1)) rows" >&2
