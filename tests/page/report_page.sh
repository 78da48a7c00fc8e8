#!/usr/bin/env bash
# Makes a short synthetic sequence and a run of it, and looks at its page in a
# browser.
#   report_page.sh BIN MODULES WORK
set -euo pipefail
bin="$1" modules="$2" work="$3"
here="$(dirname "${BASH_SOURCE[0]}")"

rm -rf "$work"
mkdir -p "$work"
"$bin/sf_synth" --output="$work/sequence" --frames=12 --width=320 --height=240
"$bin/sf_run" --sequence="$work/sequence" --output="$work/run" \
  --warped_every=3 --covariance=4 --pictures_every=6
exec node "$here/report_page.mjs" --modules="$modules" --run="$work/run" \
  --pictures="$work"
