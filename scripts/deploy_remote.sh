# The half of deploy.sh that runs on the other host, given to its `sh -c`: HOST ACTION FOLDER and what the action takes.
# FOLDER, absolute or below the home directory, holds one deployment. One of these scripts works there at a time.
set -eu
host=$1 action=$2 folder=$3
shift 3
patience=60  # [s] that a node may take to load its scene

fail() { echo "deploy.sh: $host: $*" >&2; exit 1; }

# The process of a node that was brought here, whoever started it; nothing if there is none.
process_of() { find /proc/[0-9]*/exe -maxdepth 0 -lname "$folder/bin/$1*" 2>/dev/null | cut -d/ -f3; }

nodes_here() { [ ! -d "$folder/bin" ] || ls "$folder/bin"; }

stop() {
  signal=TERM
  tenths=0
  while pid=$(process_of "$1") && [ -n "$pid" ]; do
    [ "$tenths" -lt 50 ] || signal=KILL
    # shellcheck disable=SC2086  # may be several
    [ $((tenths % 50)) -ne 0 ] || kill -s "$signal" $pid 2>/dev/null || true
    tenths=$((tenths + 1))
    sleep 0.1
  done
  rm -f "$folder/$1.pid"
}

remove() {
  for node in $(nodes_here); do stop "$node"; done
  rm -rf "$folder" "$folder.new"
}

# The files in a folder that are not as they were sent.
damaged() { (cd "$1" && sha256sum --check --quiet --strict sha256 2>/dev/null) || true; }

check_runs() {
  lacking=$(ldd "$1/bin/$2" "$1"/lib/palpate/*.so 2>&1 | sed -n 's/^[[:space:]]*\([^ ]*\).*not found.*/\1/p' | sort -u | tr '\n' ' ')
  [ -z "$lacking" ] || fail "$2 needs what is not installed: ${lacking% }; docs/deploy.md names the packages"
  "$1/bin/$2" --version >/dev/null 2>&1 || fail "$2 is not a program for this machine"
}

# Puts the two ends of this ssh connection for @there and @here.
fill_in() {
  options=$1
  case "$options" in *@there* | *@here*) ;; *) echo "$options"; return ;; esac
  # shellcheck disable=SC2086  # four words
  set -- ${SSH_CONNECTION:-}
  case "${1:-:}" in *:*) fail "ssh came by no IPv4 address to go by: give --interface and --peer" ;; esac
  echo "$options" | sed "s/@there/$3/; s/@here/$1/"
}

# Folders of keys, which are nobody else's business.
close_keys() {
  find "$1" -name permissions.p7s | while read -r file; do
    chmod 700 "$(dirname "$file")"
    chmod 600 "$(dirname "$file")"/*
  done
}

write_start() {
  cat >"$folder.new/start" <<END
#!/bin/sh
# start NODE [OPTION ...]: becomes one of the nodes in bin, with what was brought here.
cd '$folder' || exit 1
export PALPATE_CACHE='$folder/archives'
node=\$1
shift
exec '$folder/bin/'"\$node" $1 "\$@"
END
  chmod +x "$folder.new/start"
}

start() {
  setsid "$folder/start" "$1" --supervised </dev/null >"$folder/$1.log" 2>&1 9<&- &
  started=$!
  echo "$started" >"$folder/$1.pid"
  # Before it becomes the node, the process is a shell.
  while [ -z "$(process_of "$1")" ] && kill -0 "$started" 2>/dev/null; do sleep 0.02; done
}

wait_until_ready() {
  tenths=0
  until grep -qx ready "$folder/$1.log" 2>/dev/null; do
    kill -0 "$PPID" 2>/dev/null || exit 1  # nobody is at the other end of ssh any more
    [ -n "$(process_of "$1")" ] || fail "$1 ended at once: $(tail -n 3 "$folder/$1.log")"
    [ "$tenths" -lt $((10 * patience)) ] || fail "$1 was not ready within $patience s"
    tenths=$((tenths + 1))
    sleep 0.1
  done
}

# TOKEN SUM THEN OPTIONS NODE ...: takes a tar from standard input, whose list of hashes has the hash SUM; THEN is start or stay.
bring() {
  token=$1 sum=$2 then=$3 options=$4
  shift 4
  [ ! -e "$folder" ] || [ -f "$folder/sha256" ] || fail "$folder is there and is not a deployment"
  for node in $(nodes_here); do
    case " $* " in *" $node "*) continue ;; esac
    [ -z "$(process_of "$node")" ] || fail "$node runs in $folder: name it too, stop it or give another --dir"
  done
  rm -rf "$folder.new"
  # shellcheck disable=SC2317  # called by the trap
  undo() { rm -rf "$folder.new"; }
  trap undo EXIT
  mkdir -p "$folder.new"
  tar -x --no-same-owner -f - -C "$folder.new" 2>/dev/null || fail "not all that was sent arrived"
  [ "$(sha256sum <"$folder.new/sha256")" = "$sum  -" ] || fail "what arrived is not what was sent: sha256"
  bad=$(damaged "$folder.new")
  [ -z "$bad" ] || fail "what arrived is not what was sent: $bad"
  close_keys "$folder.new/scene"
  for node in "$@"; do check_runs "$folder.new" "$node"; done
  options=$(fill_in "$options")
  echo "$token" >"$folder.new/token"
  write_start "$options"
  for node in $(nodes_here); do stop "$node"; done
  rm -rf "$folder"
  mv "$folder.new" "$folder"
  undo() { remove; }
  if [ "$then" = start ]; then
    for node in "$@"; do start "$node"; done
    for node in "$@"; do wait_until_ready "$node"; done
  fi
  echo "$host: in $folder, with $options"
  [ "$then" = stay ] || status "$@"
  trap - EXIT
}

status() {
  [ -f "$folder/sha256" ] || fail "nothing is deployed in $folder"
  well=0
  bad=$(damaged "$folder")
  if [ -n "$bad" ]; then
    well=1
    echo "not as it was sent: $bad"
  fi
  for node in "$@"; do
    pid=$(process_of "$node")
    state="runs, process $pid"
    [ -n "$pid" ] || { state="is stopped"; well=1; }
    echo "$node $state; last words: $(tail -n 1 "$folder/$node.log" 2>/dev/null)"
  done
  return $well
}

case "$folder" in /*) ;; *) folder=$HOME/$folder ;; esac
trap 'exit 1' HUP INT TERM
above=$(cd "$(dirname "$folder")" 2>/dev/null && pwd -P) || fail "there is no folder $(dirname "$folder")"
folder=$above/$(basename "$folder")
exec 9<"$above"
flock -w 90 9 || fail "another deployment is under way"
# The nodes that were named, or all.
# shellcheck disable=SC2046  # names without spaces
[ "$action" = bring ] || [ "$action" = undo ] || [ $# -gt 0 ] || set -- $(nodes_here)
case "$action" in
  bring) bring "$@" ;;
  undo) [ "$(cat "$folder/token" 2>/dev/null)" != "$1" ] || remove; rm -rf "$folder.new" ;;
  stop) for node in "$@"; do stop "$node"; done ;;
  remove) [ ! -e "$folder" ] || [ -f "$folder/sha256" ] || fail "$folder is not a deployment"; remove ;;
  status) status "$@" ;;
esac
