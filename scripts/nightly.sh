#!/usr/bin/env bash
# nightly.sh [STAGE ...]: long (programs of tests that have a long form; logs of ten minutes, 21 GB in TMPDIR), address
# (with undefined behaviour) and thread (what has threads; sanitizers, short forms), fuzz (spoilt files and pages'
# messages, over an hour, under the address and undefined-behaviour sanitizers), tidy (clang-tidy over the programs),
# stability (every case; an error is what fails beside tests/stability/known_failures.txt, and a figure that
# docs/stability.md lacks), mcap (exports in the reference reader, which npm brings into out/mcap_reader), docs (every
# command of the pages), python (the module and its examples; installs pybind11-dev and python3-dev), papers
# (docs/papers.md in full, into out/papers_docs), packages (made, and tried in a bare Debian 12; needs root). All of
# them where none is named.
set -euo pipefail
cd "$(dirname "$0")/.."
export PATH=/usr/bin:$PATH  # the python3 that has Debian's modules
export LSAN_OPTIONS=suppressions=$PWD/tests/lsan.supp
export TSAN_OPTIONS="suppressions=$PWD/tests/tsan.supp ignore_noninstrumented_modules=1"
[ $# -gt 0 ] || set -- long address fuzz thread tidy stability mcap docs python papers packages
slots=$((2 * $(nproc) + 1))  # as in test.sh
for stage in "$@"; do
  echo "# $stage"
  case "$stage" in
    long)
      ./scripts/install.sh libcgal-demo  # a real liver, for its test
      mapfile -t folders < <(grep -rl PALPATE_LONG_TESTS tests | cut -d/ -f2 | grep -vx fuzz | sort -u)  # fuzz is a stage
      PALPATE_LONG_TESTS=1 ./scripts/test.sh --timeout 1800 -R "^test_($(IFS="|"; echo "${folders[*]}"))" ;;
    stability)
      ./scripts/install.sh plots
      ./scripts/build.sh release palpate palpate_study
      ./build/release/bin/palpate stability --known tests/stability/known_failures.txt -o out/stability
      python3 tests/docs/stability_figures.py out/stability/stability.csv docs/stability.md ;;
    mcap)
      ./scripts/build.sh release palpate test_mcap
      npm install --silent --no-save --prefix out/mcap_reader @mcap/core @foxglove/omgidl-parser @foxglove/omgidl-serialization
      PALPATE_MCAP_READER=$PWD/out/mcap_reader build/release/bin/test_mcap ;;
    docs)
      ./scripts/install.sh plots
      ./scripts/build.sh release programs palpate_study
      python3 tests/docs/run_commands.py build/release/bin --all ;;
    python)
      ./scripts/install.sh python plots file
      ./scripts/build.sh python palpate palpate_python
      for example in python/examples/*.py; do
        echo "$example"
        PYTHONPATH=build/python/python python3 "$example" scenes
      done
      PYTHONPATH=build/python/python python3 tests/python/simulator.py scenes
      mkdir -p out
      rm -f out/force_depth.png
      PYTHONPATH=build/python/python MPLBACKEND=Agg python3 python/examples/force_depth.py scenes out/force_depth.png
      file -b --mime-type out/force_depth.png | grep -qx image/png
      # the lines of docs/python.md
      sed -n '/^```python/,/^```/{/^```/!p}' docs/python.md | PYTHONPATH=build/python/python python3 - ;;
    papers)
      ./scripts/build.sh release
      python3 scripts/papers.py build/release/bin out/papers_docs ;;
    packages)
      ./scripts/install.sh debootstrap
      ./scripts/package.sh
      ./scripts/bare_host.sh ;;
    address|thread)
      tests=(all) chosen=.
      if [ "$stage" = thread ]; then
        tests=(test_{bus,deform,drive,drivers,fem,haptic,hostile,keys,loopback,models,network,network_logs,realtime,render,ros,security,sim,study,tensors,tools_nodes,web,web_browser})
        chosen="^($(IFS="|"; echo "${tests[*]}"))\\."
      fi
      ./scripts/build.sh "$stage" "${tests[@]}"
      # OpenMP's own joins are not seen by the thread sanitizer; resident memory means nothing under any. What the
      # commands of the pages print is judged in the stages docs and papers.
      OMP_NUM_THREADS=1 ctest --preset "$stage" --timeout 1200 --parallel "$slots" -R "$chosen" -E 'HapticMemory|^papers|^docs_commands' ;;
    fuzz)
      ./scripts/build.sh address test_fuzz
      PALPATE_LONG_TESTS=1 ctest --preset address --timeout 1200 --parallel "$slots" -R '^test_fuzz' ;;
    tidy) ./scripts/tidy.sh ;;
    -h|--help) sed -n '2,9p' "$0"; exit 0 ;;
    *) echo "nightly.sh: unknown stage $stage" >&2; exit 2 ;;
  esac
done
