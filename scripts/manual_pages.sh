#!/usr/bin/env bash
# manual_pages.sh BIN FOLDER: a manual page of every program and command in BIN, of what its --help says (help2man).
set -euo pipefail
bin=$(cd "$1" && pwd) folder=$2
version=$("$bin/palpate" --version)
mkdir -p "$folder"
page() { # NAME MEANING COMMAND...
  help2man --no-info --version-string="$version" --name="$2" --output="$folder/$1.1" "$3"
}
page palpate "a distributed haptic simulator of soft tissue" "$bin/palpate"
"$bin/palpate" help | sed -n 's/^  \([a-z]\+\)  *\(.*\)/\1 \2/p' | while read -r name meaning; do
  page "palpate-$name" "$meaning" "$bin/palpate $name"
done
for program in haptic_node deform_node render_node web_node ros_bridge palpate_spacemouse; do
  [ -x "$bin/$program" ] || continue  # a driver is built where its library is
  page "$program" "$("$bin/$program" --help | sed -n '1s/^[a-z_]*: //p')" "$bin/$program"
done
gzip -9nf "$folder"/*.1
