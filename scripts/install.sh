#!/usr/bin/env bash
# install.sh [PACKAGE ...]: installs what palpate is built from (Debian packages), and these. Nothing if all is there.
set -euo pipefail
packages=(
  build-essential cmake ninja-build ccache pkg-config git
  libeigen3-dev libspectra-dev libsuitesparse-dev libopenblas0-pthread libopenblas-pthread-dev
  cyclonedds-dev cyclonedds-tools libssl-dev liblcm-dev zlib1g-dev libxxhash-dev
  libgmsh-dev libhdf5-dev hdf5-tools libosmesa6-dev libpng-dev libfreetype-dev fonts-dejavu-core ffmpeg
  libboost-dev libcli11-dev libtomlplusplus-dev libspdlog-dev libfmt-dev nlohmann-json3-dev
  libgtest-dev libbenchmark-dev clang-format openssh-client openssh-server chromium chromium-driver python3-selenium python3 python3-numpy python3-h5py python3-matplotlib
  "$@"
)
missing=()
for package in "${packages[@]}"; do
  status=$(dpkg-query -W -f='${Status}' "$package" 2>/dev/null || true)
  [ "$status" = "install ok installed" ] || missing+=("$package")
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
