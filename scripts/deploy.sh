#!/usr/bin/env bash
set -euo pipefail
here=$(cd "$(dirname "$(readlink -f "$0")")" && pwd)

usage() {
  cat <<'END'
deploy.sh HOST SCENE [OPTION ...] [-- NODE_OPTION ...]   brings nodes and a scene to a host by ssh and starts them
deploy.sh HOST --status | --stop | --remove [OPTION ...]

Programs, scene, what the scene names and the archives of its bodies are sent, their hashes checked there, and the nodes
started. Of a scene's keys those of these nodes are sent and no others. What runs there from an earlier call is replaced.
On failure or Ctrl-C nothing of this call is left there.

  --node NAME          haptic_node, deform_node or render_node; may be repeated; default: deform_node
  --interface NAME     network interface there; default: the scene's, else the address by which ssh reaches the host
  --peer HOST          host of other nodes; may be repeated; default: the scene's, else the address that ssh comes from
  --domain N           DDS domain in place of the scene's
  --dir FOLDER         where to put it, below the home directory or absolute; default: palpate
  --bin FOLDER         where the programs are here
  --ssh COMMAND        such as 'ssh -p 2222 -i key'; default: ssh -o ConnectTimeout=10
  --no-start           bring everything, start nothing: for a service
  --status             what runs there, its last words, and what is not as it was sent; exit status 1 unless all is well
  --stop               stops the nodes there (those named, or all) and leaves the files
  --remove             stops them and removes everything
NODE_OPTION goes to every node, such as --deform for a render_node.
END
}

fail() { echo "deploy.sh: $*" >&2; exit 1; }
value() { [ $# -ge 2 ] || fail "$1 needs a value"; }
# A word that every shell reads as it is.
quoted() { printf "'%s'" "${1//\'/\'\\\'\'}"; }

host="" scene="" action=bring then=start folder=palpate bin="" domain="" interface="" ssh=(ssh -o ConnectTimeout=10) nodes=() peers=() more=()
while [ $# -gt 0 ]; do
  case "$1" in
    -h|--help) usage; exit 0 ;;
    --node) value "$@"; nodes+=("$2"); shift ;;
    --domain) value "$@"; domain=$2; shift ;;
    --interface) value "$@"; interface=$2; shift ;;
    --peer) value "$@"; peers+=("$2"); shift ;;
    --dir) value "$@"; folder=$2; shift ;;
    --bin) value "$@"; bin=$2; shift ;;
    --ssh) value "$@"; read -r -a ssh <<<"$2"; [ ${#ssh[@]} -gt 0 ] || fail "--ssh needs a command"; shift ;;
    --no-start) then=stay ;;
    --status|--stop|--remove) action=${1#--} ;;
    --) shift; more=("$@"); break ;;
    -*) fail "unknown option $1; --help lists them" ;;
    *) if [ -z "$host" ]; then host=$1; elif [ -z "$scene" ]; then scene=$1; else fail "one host and one scene, not also $1"; fi ;;
  esac
  shift
done
[ -n "$host" ] || { usage >&2; exit 2; }
[[ $folder =~ ^[A-Za-z0-9._/-]*[A-Za-z0-9_-]$ && /$folder/ != */../* ]] || fail "--dir $folder: only letters, digits and . _ - / are taken"
for node in "${nodes[@]}"; do
  [[ $node =~ ^(haptic|deform|render)_node$ ]] || fail "there is no node $node: haptic_node, deform_node or render_node"
done

# Becomes ssh, which runs the other half on the host: ACTION and what it takes. Call it in a subshell.
become_remote() {
  local word line
  line="sh -c $(quoted "$(cat "$here/deploy_remote.sh")") deploy"
  for word in "$host" "$1" "$folder" "${@:2}"; do line+=" $(quoted "$word")"; done
  exec "${ssh[@]}" "$host" "$line"
}

if [ "$action" != bring ]; then
  [ -z "$scene" ] || fail "--$action takes no scene"
  become_remote "$action" "${nodes[@]}" </dev/null
fi

[ -n "$scene" ] || fail "which scene? --help shows the usage"
[ -f "$scene" ] || fail "$scene: there is no such scene"
[ ${#nodes[@]} -gt 0 ] || nodes=(deform_node)
if [ -z "$bin" ]; then
  bin=$here/../../../bin
  [ -x "$bin/palpate" ] || bin=$here/../build/release/bin
fi
for program in palpate "${nodes[@]}"; do [ -x "$bin/$program" ] || fail "$bin/$program is not there: build or install it, or give --bin"; done

# The files that the scene names: values of the keys that docs/scene.md gives as paths to read.
named_in_scene() {
  local keys=${1:-'mesh|specimen_mesh|force_curve|radial_curve|trajectory|backdrop|surface|materials|texture'}
  grep -oE "(^|[^[:alnum:]_])($keys)[[:space:]]*=[[:space:]]*(\"[^\"]*\"|'[^']*')" "$scene" | sed -E "s/^[^\"']*.(.*).\$/\1/" || true
}

# The files of the keys that the nodes take of the folder that the scene names, if it has [network.security].
key_files() {
  local name node role keys file
  while read -r name; do
    [[ $name != /* ]] || fail "$scene names $name: only paths relative to the scene are the same on another host"
    for node in "${nodes[@]}"; do
      role=${node%_node} keys=$1/$name
      [ ! -d "$keys/$role" ] || keys=$keys/$role
      [ -f "$keys/permissions.p7s" ] || fail "$scene has [network.security], and $keys/$role is not there: palpate keys makes it"
      grep -qF "<grant name=\"$role\">" "$keys/permissions.p7s" || fail "$keys holds no keys of the role $role"
      [ -z "$(find -L "$keys/key.pem" -perm /077)" ] || fail "$keys/key.pem may be read by others: chmod 600 it"
      for file in authority.pem certificate.pem key.pem governance.p7s permissions.p7s; do echo "$keys/$file"; done
    done
  done < <(named_in_scene keys)
}

# What a render_node reads a backdrop with, and a surface that is no OBJ file.
mesh_reader() {
  [[ " ${nodes[*]} " == *" render_node "* ]] && [ -n "$(named_in_scene 'backdrop|surface' | grep -v '\.obj$')" ] || return 0
  mkdir -p "$1/lib/palpate"
  ln -s "$(realpath "$bin/../lib/palpate/libpalpate_gmsh.so")" "$1/lib/palpate/"
}

# Links to all that is sent, in a folder: bin/, lib/, archives/ and scene/, where files lie to each other as they do here.
gather() {
  local all=$1 folder base file name archive
  folder=$(dirname "$(realpath -s "$scene")")
  local files=("$folder/$(basename "$scene")")
  while read -r name; do
    [[ $name != /* ]] || fail "$scene names $name: only paths relative to the scene are the same on another host"
    [ ! -f "$folder/$name" ] || files+=("$(realpath -ms "$folder/$name")")
  done < <(named_in_scene)
  key_files "$folder" >"$work/keys"
  while read -r file; do files+=("$(realpath -ms "$file")"); done <"$work/keys"
  base=$folder
  for file in "${files[@]}"; do
    while [[ $file != "${base%/}"/* ]]; do base=$(dirname "$base"); done
  done
  mkdir -p "$all/bin" "$all/archives"
  for file in "${files[@]}"; do
    name=scene/${file#"${base%/}/"}
    mkdir -p "$all/$(dirname "$name")"
    ln -sfn "$file" "$all/$name"
  done
  scene_there=scene/${files[0]#"${base%/}/"}
  for name in "${nodes[@]}"; do ln -s "$(realpath "$bin/$name")" "$all/bin/$name"; done
  mesh_reader "$all"
  "$bin/palpate" precompute "$scene" >"$work/archives"
  sed -n "s/^body '[^']*': \(up to date\|computed and written in [0-9.]* s\): //p" "$work/archives" |
    while read -r archive; do ln -sfn "$(realpath "$archive")" "$all/archives/"; done
  (cd "$all" && find -L . -type f -printf '%P\0' | sort -z | xargs -0 sha256sum) >"$work/sha256"
  mv "$work/sha256" "$all/sha256"
}

# What is sent, gathered as links.
work=$(mktemp -d)
token="$(hostname) $work"
sending=""
clean_up() {
  trap '' INT TERM
  if [ -n "$sending" ]; then
    kill "$sending" 2>/dev/null || true
    (become_remote undo "$token") </dev/null || echo "deploy.sh: could not tidy up on $host: --remove does it" >&2
  fi
  rm -rf "$work"
}
trap clean_up EXIT
trap 'exit 130' INT
trap 'exit 143' TERM

gather "$work/all"
sum=$(sha256sum <"$work/all/sha256")

# What every node is started with. The other half puts the ends of the ssh connection for @there and @here.
if [ -z "$interface" ] && ! grep -qE '(^|[^[:alnum:]_])interface[[:space:]]*=' "$scene"; then
  interface=@there
  [ ${#peers[@]} -gt 0 ] || peers=(@here)
fi
options=$(quoted "$scene_there")
[ -z "$domain" ] || options+=" --domain $(quoted "$domain")"
[ -z "$interface" ] || options+=" --interface $(quoted "$interface")"
for peer in "${peers[@]}"; do options+=" --peer $(quoted "$peer")"; done
for word in "${more[@]}"; do options+=" $(quoted "$word")"; done

# In the background, so that Ctrl-C is heard at once.
tar -c -h -f - --sort=name -C "$work/all" . | become_remote bring "$token" "${sum%% *}" "$then" "$options" "${nodes[@]}" &
sending=$!
wait "$sending" || { sending=""; exit 1; }
sending=""
