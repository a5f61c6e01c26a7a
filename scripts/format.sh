#!/usr/bin/env bash
# format.sh [--check]: formats every C and C++ source with clang-format, or fails where one is not formatted.
set -euo pipefail
cd "$(dirname "$0")/.."
how=(-i)
[ "${1:-}" = --check ] && how=(--dry-run -Werror)
git ls-files -z --cached --others --exclude-standard '*.cpp' '*.hpp' '*.c' | xargs -0 clang-format "${how[@]}"
