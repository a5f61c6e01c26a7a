#!/usr/bin/env bash
# tidy.sh [FILE ...]: clang-tidy over the programs' sources, or these, with the checks in .clang-tidy. It reads them
# without precompiled headers, so that a source that does not include what it uses is found too. Not image_library.cpp:
# ITK's headers, as Debian 12 configures them, are for GCC alone; nor dispatch.cpp, since clang 14 does not know the
# names of x86-64's levels.
set -euo pipefail
cd "$(dirname "$0")/.."
./scripts/install.sh programs tests clang-tidy
cmake --preset tidy
cmake --build --preset tidy --target palpate_idl palpate_ros_messages  # their headers are generated
files=("$@")
[ $# -gt 0 ] || mapfile -t files < <(git ls-files {common,haptic_node,deform_node,render_node,web_node,ros_bridge,tools}/'*.cpp' ':!tools/organ/image_library.cpp' ':!common/kernels/dispatch.cpp')
printf '%s\0' "${files[@]}" | xargs -0 -n 1 -P "$(nproc)" clang-tidy -p build/tidy --quiet
