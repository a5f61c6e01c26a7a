#!/usr/bin/env bash
# bare_host.sh: installs the packages of build/packages into a bare Debian 12 in a folder of its own. There an ordinary
# user presses the liver with the haptic node alone, then with the command line, verifies a log that was recorded here, and
# has all the rest. Needs root and debootstrap; prints how long it took. Removes the folder.
set -euo pipefail
cd "$(dirname "$0")/.."
root=$(mktemp -d /tmp/palpate-bare-XXXXXX)
chmod 755 "$root"  # it is the / of those within
mirror=${1:-$(apt-get indextargets --format '$(REPO_URI)' "Codename: bookworm" "Created-By: Packages" | sed -n 1p)}  # as this machine has it
leave() {
  umount "$root/proc" "$root/dev" 2>/dev/null || true
  rm -rf --one-file-system "$root"
}
trap leave EXIT
debootstrap --variant=minbase bookworm "$root" "$mirror" >/dev/null
mount --bind /proc "$root/proc"
mount --bind /dev "$root/dev"
cp /etc/resolv.conf "$root/etc/"
[ ! -d /etc/apt/apt.conf.d ] || cp -r /etc/apt/apt.conf.d/. "$root/etc/apt/apt.conf.d/"
mkdir "$root/packages"
cp build/packages/*.deb "$root/packages/"
chroot "$root" apt-get update -q >/dev/null
chroot "$root" useradd --create-home user

# What is brought along: a scene with what it names, its archive, and a log of a run here.
carried=$root/carried
mkdir -p "$carried/scene/meshes" "$carried/scene/trajectories"
cp scenes/liver.toml "$carried/scene"
cp scenes/meshes/{liver.msh,ribs.stl} "$carried/scene/meshes"
cp scenes/trajectories/liver_probe.csv "$carried/scene/trajectories"
PALPATE_CACHE=$carried/archives build/release/bin/palpate run scenes/liver.toml --seconds 4 --record "$carried/session.lcmlog"
chmod -R a+rX "$carried"

install() {
  chroot "$root" sh -c "DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends $(printf '/packages/%s_*.deb ' "$@") >/dev/null"
}
as_user() {
  chroot "$root" su user -c "cd; $1"
}
# What is said of the largest force, if that is more than nothing.
force_of() {
  grep -oE 'largest force [0-9.]*[1-9][0-9.]* N'
}

begin=$SECONDS
install palpate-haptic
as_user 'PALPATE_CACHE=/carried/archives haptic_node /carried/scene/liver.toml --seconds 4' 2>&1 | force_of
echo "haptic node alone, of a scene and archive brought along: a force after $((SECONDS - begin)) s"

begin=$SECONDS
install palpate-mesh palpate-tools
as_user 'palpate run /usr/share/palpate/scenes/liver.toml --seconds 3' | force_of
echo "with the command line, which computes the archive: a force after $((SECONDS - begin)) s more"
as_user 'palpate cache list'
as_user 'palpate replay /carried/session.lcmlog --verify'  # recorded on another host; nothing of it is here
if chroot "$root" dpkg-query -W -f '${Package}\n' | grep -iE 'insighttoolkit|cgal|mpfr'; then
  echo "bare_host.sh: these are for organs alone" >&2
  exit 1
fi

install 'palpate-*'
echo "all of it: after $((SECONDS - begin)) s"
install python3-palpate
as_user 'python3 -c "import palpate; s = palpate.Simulator(palpate.Scene(\"/usr/share/palpate/scenes/liver.toml\")); s.follow(2500); print(\"Python: a force of\", s.force[0])"'
as_user 'python3 /usr/share/doc/python3-palpate/examples/read_log.py /usr/share/palpate/scenes'
