#!/usr/bin/env bash
# unless_held_up.sh PROGRAM [ARGUMENT ...]: runs a suite whose verdict hangs on time. On a virtual machine the host takes
# the processor away now and then, and the kernel counts that time ("steal"). A suite that fails (status 1) while time was
# stolen from it says nothing: it runs again, three times at most, the last verdict counts, and each run that did not is
# noted in $XDG_CACHE_HOME/held_up, which scripts/test.sh prints. Where nothing is stolen, nothing runs twice; nor does a
# long form, which looks for what is rare, nor what ends otherwise than with status 1, as what crashes.
set -uo pipefail
[ -z "${PALPATE_LONG_TESTS:-}" ] || exec "$@"
stolen() { awk '/^cpu /{print 10 * $9; exit}' /proc/stat; }  # [ms], of all cores; counted in hundredths of a second
for run in 1 2 3; do
  before=$(stolen)
  "$@"
  status=$?
  ms=$(($(stolen) - before))
  [ $status -eq 1 ] && [ "$run" -lt 3 ] && [ "$ms" -ge 50 ] || exit $status
  echo "$(basename "$1") ${*:2}: failed while the host took $ms ms; runs again" | tee -a "${XDG_CACHE_HOME:-/tmp}/held_up"
done
