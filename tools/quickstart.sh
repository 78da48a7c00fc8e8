#!/usr/bin/env bash
# From a fresh clone to a first reconstruction: installs what is missing, builds
# the tools, writes a synthetic sequence with a walking person, reconstructs it
# and compares the result with the ground truth. Everything goes to
# runs/quickstart, which a later run replaces.
#   tools/quickstart.sh [further flags of sf_run, such as --preset=cofusion]
set -euo pipefail
if [[ "${1:-}" == -h || "${1:-}" == --help ]]; then
  sed -n '2,/^set/{/^set/d;s/^# \{0,1\}//p}' "${BASH_SOURCE[0]}"
  exit 0
fi
cd "$(dirname "${BASH_SOURCE[0]}")/.."

tools/install_deps.sh
tools/build_release.sh --target sf_synth sf_run sf_evaluate

bin=build/release/bin
sequence=runs/quickstart/sequence
run=runs/quickstart/run
rm -rf "$sequence"
mkdir -p runs/quickstart

step() { printf '\n== %s\n' "$*"; }
step "sf_synth --output=$sequence"
"$bin/sf_synth" --output="$sequence"
step "sf_run${*:+ $*} --sequence=$sequence --output=$run --overwrite"
"$bin/sf_run" "$@" --sequence="$sequence" --output="$run" --overwrite
step "sf_evaluate --run=$run --ground_truth=$sequence/gt"
"$bin/sf_evaluate" --run="$run" --ground_truth="$sequence/gt"

cat <<END

The result is in $run:
  report.html                    charts, and the surfaces in 3D; open it in a browser
  summary.json, evaluation.json  figures of the run, errors against ground truth
  trajectory.txt                 camera poses, TUM format
  surfaces/*/mesh.ply            one mesh a surface; surfaces/*/warped/: in motion
  pictures/                      reconstruction beside the input
Next: docs/your_data.md.
END
