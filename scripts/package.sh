#!/usr/bin/env bash
# package.sh: builds the programs and makes Debian packages of them, with manual pages, into build/packages.
set -euo pipefail
cd "$(dirname "$0")/.."
./scripts/install.sh images spacemouse help2man dpkg-dev file
./scripts/build.sh release programs palpate_study palpate_organ palpate_spacemouse
rm -rf build/release/man build/packages
./scripts/manual_pages.sh build/release/bin build/release/man
mkdir -p build/packages
(cd build/release && cpack -B ../packages >cpack.log) || { cat build/release/cpack.log >&2; exit 1; }
./scripts/install.sh python
./scripts/build.sh python palpate_python
(cd build/python && cpack -B ../packages >cpack.log) || { cat build/python/cpack.log >&2; exit 1; }
rm -rf build/packages/_CPack_Packages
ls -sh build/packages
