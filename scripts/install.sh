#!/usr/bin/env bash
# install.sh [GROUP | PACKAGE ...]: installs Debian packages by what they are for (default: programs); nothing of what is
# there. Groups:
#   programs    what the programs that run a scene are built from and run
#   images      palpate_organ: CGAL, and ITK for what scanners write
#   spacemouse  palpate_spacemouse
#   python      the Python module
#   plots       what the scripts draw plots and read archives with
#   tests       tests and benchmarks, the formatter, and the programs that tests drive; plots as well
set -euo pipefail
declare -A group
group[programs]="build-essential cmake ninja-build ccache pkg-config git python3
  libeigen3-dev libspectra-dev libsuitesparse-dev libopenblas0-pthread libopenblas-pthread-dev
  cyclonedds-dev cyclonedds-tools libssl-dev liblcm-dev zlib1g-dev libxxhash-dev libgmsh-dev libhdf5-dev
  libosmesa6-dev libpng-dev libfreetype-dev fonts-dejavu-core ffmpeg
  libboost-dev libcli11-dev libtomlplusplus-dev libspdlog-dev libfmt-dev nlohmann-json3-dev"
group[images]="libcgal-dev libinsighttoolkit5-dev"
group[spacemouse]="libspnav-dev"
group[python]="python3-dev pybind11-dev"
group[plots]="python3-numpy python3-h5py python3-matplotlib"
group[tests]="libgtest-dev libbenchmark-dev clang-format openssh-client openssh-server
  chromium chromium-driver python3-selenium ${group[plots]}"

[ $# -gt 0 ] || set -- programs
missing=()
for wanted in "$@"; do
  for package in ${group[$wanted]:-$wanted}; do
    status=$(dpkg-query -W -f='${Status}' "$package" 2>/dev/null || true)
    [ "$status" = "install ok installed" ] || missing+=("$package")
  done
done
[ ${#missing[@]} -eq 0 ] && exit 0

as_root=()
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo >/dev/null || { echo "install.sh: needs root or sudo to install: ${missing[*]}" >&2; exit 1; }
  as_root=(sudo)
fi
echo "Installing ${#missing[@]} Debian packages: ${missing[*]}"
export DEBIAN_FRONTEND=noninteractive
"${as_root[@]}" apt-get update -q
"${as_root[@]}" apt-get install -y -q --no-install-recommends "${missing[@]}"
