#!/usr/bin/env bash
# Installs what is missing, builds with warnings as errors, runs every test and
# closes with a summary. Exit status 0 if and only if all of that went well.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

tools/install_deps.sh --tests
tools/build_release.sh

log=build/release/tests.log
SECONDS=0
status=0
if [[ -t 1 ]]; then
  ctest --preset release --parallel "$(nproc)" --output-log "$log" || status=1
else
  ctest --preset release --parallel "$(nproc)" >"$log" 2>&1 || status=1
  if ((status)); then
    grep -vE '^ +Start +[0-9]+: | +Passed +[0-9.]+ sec$' "$log" || true
  fi
fi

count() { grep -cE "$1" "$log" || true; }
passed="$(count '^ *[0-9]+/[0-9]+ Test .* Passed +[0-9.]+ sec')"
skipped="$(count '^ *[0-9]+/[0-9]+ Test .*\*\*\*Skipped')"
total="$(count '^ *[0-9]+/[0-9]+ Test ')"
echo "tests: $passed passed, $((total - passed - skipped)) failed," \
     "$skipped skipped in $SECONDS s (log: $log)"
if ((skipped)); then
  grep -ohE '(shared data|slurm|librosbag-storage|Chromium or playwright-core|python3-[a-z, -]+) not found.*|this processor, or .*' \
    build/release/Testing/Temporary/LastTest.log | sort -u |
    sed 's/^/tests: skipped: /' || true
fi
if ((total == 0)); then
  echo "tests: none found" >&2
  status=1
fi
exit "$status"
