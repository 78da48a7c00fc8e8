#!/usr/bin/env bash
# Builds sf_growth, measures the growth curves (some minutes) and draws the
# plots of docs/performance.md. Needs python3-matplotlib.
#   tools/benchmark/growth.sh [--output=DIR] [--images=DIR]
#                             [--curve=NAME | --plot_only]
#   --output     folder of the CSV files, runs/growth if not given
#   --images     folder of the plots, docs/images if not given
#   --curve      measures this one again, a CSV file without its ending
#   --plot_only  draws what an earlier call has measured
# Exit code 2 if an argument is wrong or matplotlib is missing.
set -euo pipefail
root="$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)"

refuse() { echo "growth.sh: $1" >&2; exit 2; }

output="$root/runs/growth"
images="$root/docs/images"
measure=yes
curve=()
for argument in "$@"; do
  case "$argument" in
    --output=?*) output="${argument#*=}" ;;
    --images=?*) images="${argument#*=}" ;;
    --curve=?*) curve=("$argument") ;;
    --plot_only) measure=no ;;
    -h | --help) sed -n '2,/^set/{/^set/d;s/^# \{0,1\}//p}' "$0"; exit 0 ;;
    *) refuse "$argument: unknown argument; see --help" ;;
  esac
done

python=
for candidate in python3 /usr/bin/python3; do
  if "$candidate" -c 'import matplotlib' 2>/dev/null; then
    python="$candidate"
    break
  fi
done
[[ -n "$python" ]] ||
  refuse "python3 has no matplotlib; install it: apt-get install python3-matplotlib"

if [[ "$measure" == yes ]]; then
  "$root/tools/build_release.sh" --target sf_growth
  "$root/build/release/bin/sf_growth" --output="$output" "${curve[@]}"
fi
"$python" "$root/tools/benchmark/plot_growth.py" "$output" "$images"
echo "CSV files: $output"
