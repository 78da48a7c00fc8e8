#!/usr/bin/env bash
# Builds and runs the benchmarks and prints one table.
#   tools/benchmark/run.sh [--filter=REGEX] [--model=ONNX] [--decoder=NAME]
#                          [--json=FILE]
#   --filter   benchmarks whose name matches
#   --model    network to time; without it that row is skipped
#   --decoder  its decoder, yolov8seg if not given
#   --json     the figures of Google Benchmark as a file, too
set -euo pipefail
root="$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)"

refuse() { echo "run.sh: $1" >&2; exit 2; }

arguments=()
for argument in "$@"; do
  case "$argument" in
    --filter=*) arguments+=("--benchmark_filter=${argument#*=}") ;;
    --model=*) export SPLITFUSION_MODEL="${argument#*=}" ;;
    --decoder=*) export SPLITFUSION_DECODER="${argument#*=}" ;;
    --json=*)
      arguments+=("--benchmark_out=${argument#*=}" "--benchmark_out_format=json")
      ;;
    -h | --help) sed -n '2,/^set/{/^set/d;s/^# \{0,1\}//p}' "$0"; exit 0 ;;
    *) refuse "$argument: unknown argument; see --help" ;;
  esac
done
model="${SPLITFUSION_MODEL:-}"
[[ -z "$model" || -r "$model" ]] || refuse "--model=$model: cannot be read"
"$root/tools/build_release.sh" --target sf_benchmark
log="$(mktemp)"
trap 'rm -f "$log"' EXIT
"$root/build/release/bin/sf_benchmark" "${arguments[@]}" 2>&1 | tee "$log"
if grep -q "Failed to match" "$log"; then refuse "--filter matches nothing"; fi
