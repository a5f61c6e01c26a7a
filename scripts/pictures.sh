#!/usr/bin/env bash
# pictures.sh [NAME ...]: draws pictures of the scenes anew, in docs/pictures: liver, liver_visual, hepatectomy, hepatectomy_parts,
# catheter_insertion by the scenes in lock step, live by a browser (needs chromium, chromium-driver and python3-selenium). All of them where none is named.
set -euo pipefail
cd "$(dirname "$0")/.."
bin=build/release/bin
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# draw NAME SCENE FROM TO [OPTION ...]: the moment of the largest force between FROM and TO [s]; options are those of drive.
draw() {
  "$bin/palpate" drive "scenes/$2.toml" --seconds "$4" "${@:5}" --log "$work/$1.lcmlog"
  "$bin/palpate" film "$work/$1.lcmlog" --from "$3" --to "$4" --width 800 --height 600 --still "$work/$1.png" -o "$work/$1.mp4"
}
jpeg() { ffmpeg -loglevel error -y -i "$work/$1.png" -q:v 2 "docs/pictures/$1.jpg"; }

[ $# -gt 0 ] || set -- liver liver_visual hepatectomy hepatectomy_parts catheter_insertion live
for name in "$@"; do
  case "$name" in
    liver) draw liver liver 0 8 && jpeg liver ;;
    liver_visual) draw liver_visual liver_visual 0 4 && jpeg liver_visual ;;
    hepatectomy) draw hepatectomy hepatectomy 13 13.2 && jpeg hepatectomy ;;
    hepatectomy_parts) draw hepatectomy_parts hepatectomy 13 13.2 --set render.colour=parts && jpeg hepatectomy_parts ;;
    catheter_insertion) draw catheter_insertion catheter_insertion 10.5 10.8 && jpeg catheter_insertion ;;
    live) /usr/bin/python3 scripts/live_view.py --picture "$work/live.png" && jpeg live ;;
    -h|--help) sed -n '2,3p' "$0" ;;
    *) echo "pictures.sh: unknown picture $name" >&2; exit 2 ;;
  esac
done
