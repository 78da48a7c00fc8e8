#!/usr/bin/env bash
# Configures and builds the release preset into build/release.
#   tools/build_release.sh [-DOPTION=VALUE ...] [--target NAME ...]
# Warnings are errors, so that every caller builds everything once.
# On a terminal the tools speak for themselves; otherwise only warnings, errors
# and one closing line are printed.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

configure_arguments=(-DSPLITFUSION_WERROR=ON -DCMAKE_UNITY_BUILD=ON)
while (($#)) && [[ "$1" == -D* ]]; do
  configure_arguments+=("$1")
  shift
done

quiet=()
if [[ -t 1 ]]; then
  cmake --preset release "${configure_arguments[@]}"
else
  quiet=(-- --quiet)
  log="$(mktemp)"
  trap 'rm -f "$log"' EXIT
  if ! cmake --preset release "${configure_arguments[@]}" >"$log" 2>&1; then
    cat "$log" >&2
    exit 1
  fi
fi
SECONDS=0
[[ -t 1 ]] ||
  echo "build: build/release; a first build takes 10 to 40 minutes on two cores"
cmake --build --preset release --parallel "$(nproc)" "$@" "${quiet[@]}"
echo "build: build/release is up to date (took $SECONDS s)"
