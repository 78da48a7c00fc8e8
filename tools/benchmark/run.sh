#!/usr/bin/env bash
# Builds and runs the benchmarks and prints one table: medians of wall-clock
# times, each beside its floor, the barest loop that does the same.
#   tools/benchmark/run.sh [--filter=REGEX] [--model=ONNX] [--decoder=NAME]
#                          [--json=FILE]
#   --filter   benchmarks whose name, or a companion's, matches
#   --model    network to time; without it that row is skipped
#   --decoder  its decoder, yolov8seg if not given
#   --json     the figures as one object, too; seconds
# Exit code 1 if a benchmark fails, 2 if an argument is wrong.
set -euo pipefail
root="$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)"

refuse() { echo "run.sh: $1" >&2; exit 2; }

arguments=()
for argument in "$@"; do
  case "$argument" in
    --filter=* | --json=*) arguments+=("$argument") ;;
    --model=*) export SPLITFUSION_MODEL="${argument#*=}" ;;
    --decoder=*) export SPLITFUSION_DECODER="${argument#*=}" ;;
    -h | --help) sed -n '2,/^set/{/^set/d;s/^# \{0,1\}//p}' "$0"; exit 0 ;;
    *) refuse "$argument: unknown argument; see --help" ;;
  esac
done
model="${SPLITFUSION_MODEL:-}"
[[ -z "$model" || -r "$model" ]] || refuse "--model=$model: cannot be read"
"$root/tools/build_release.sh" --target sf_benchmark
exec "$root/build/release/bin/sf_benchmark" "${arguments[@]}"
