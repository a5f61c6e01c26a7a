#!/usr/bin/env bash
# build_examples.sh BUILD FOLDER [OPTION ...]: installs what drivers are built with from BUILD into FOLDER/prefix, and
# builds the examples in C and C++ from what is installed there, into FOLDER/c and FOLDER/cpp; OPTIONs are CMake's.
set -euo pipefail
build=$1 folder=$2
shift 2
rm -rf "$folder"
cmake --install "$build" --prefix "$folder/prefix" --component dev
for language in c cpp; do
  cmake -S "$folder/prefix/share/palpate/drivers/$language" -B "$folder/$language" -DCMAKE_PREFIX_PATH="$folder/prefix" "$@"
  cmake --build "$folder/$language"
done
