#!/usr/bin/env bash
# bare_host.sh: installs the packages of build/packages into a bare Debian 12 in a folder of its own and lets an ordinary
# user there press the liver. Needs root and debootstrap; prints how long it took. Removes the folder.
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

begin=$SECONDS
chroot "$root" sh -c 'DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends /packages/palpate-haptic_*.deb >/dev/null'
echo "haptic node alone: installed in $((SECONDS - begin)) s"
chroot "$root" haptic_node --help >/dev/null
chroot "$root" sh -c 'DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends /packages/palpate-*.deb >/dev/null'
echo "all of it: after $((SECONDS - begin)) s"
chroot "$root" su user -c 'cd; palpate run /usr/share/palpate/scenes/liver.toml --seconds 3 --summary run.json'
echo "first force: after $((SECONDS - begin)) s"
chroot "$root" su user -c 'cd; grep -q "force_max_n" run.json && palpate cache list'
chroot "$root" sh -c 'DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends /packages/python3-palpate_*.deb >/dev/null'
chroot "$root" su user -c 'cd; python3 -c "import palpate; s = palpate.Simulator(palpate.Scene(\"/usr/share/palpate/scenes/liver.toml\")); s.follow(2500); print(\"Python: a force of\", s.force[0])"'
chroot "$root" su user -c 'cd; python3 /usr/share/doc/python3-palpate/examples/read_log.py /usr/share/palpate/scenes'
