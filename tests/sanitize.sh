#!/usr/bin/env bash
# Builds everything under a sanitizer, runs the tests and the whole method on a
# short sequence with it, and fails on the first finding.
#   tests/sanitize.sh address [CTEST ARGUMENTS]   # and undefined behaviour
#   tests/sanitize.sh thread [CTEST ARGUMENTS]
# Takes about an hour on two cores. tests/run.sh checks a share of it.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

case "${1:-}" in
  address) preset=asan ;;
  thread) preset=tsan ;;
  *)
    echo "sanitize.sh: '${1:-}': expected address or thread" >&2
    exit 2
    ;;
esac
shift

tools/install_deps.sh
cmake --preset "$preset" -DSPLITFUSION_BUILD_BENCHMARKS=OFF >/dev/null
cmake --build --preset "$preset" --parallel "$(nproc)" -- --quiet

export ASAN_OPTIONS=detect_stack_use_after_return=1
export LSAN_OPTIONS="suppressions=$PWD/tests/sanitized/lsan.supp"
export UBSAN_OPTIONS=print_stacktrace=1
# TBB's library is not instrumented: what it hands from thread to thread looks
# like a race inside of it.
export TSAN_OPTIONS="suppressions=$PWD/tests/sanitized/tsan.supp"

out="$(mktemp -d)"
trap 'rm -rf "$out"' EXIT
bin="build/$preset/bin"
"$bin/sf_synth" --output="$out/sequence" --frames=8 --width=160 --height=120
"$bin/sf_run" --sequence="$out/sequence" --output="$out/run" --warped_every=2
"$bin/sf_evaluate" --run="$out/run" --ground_truth="$out/sequence"

# Not the tests of the project's texts, and not those that limit the address
# space, of which a sanitizer needs terabytes.
ctest --preset "$preset" --parallel "$(nproc)" \
  --exclude-regex '^project\.|ALackOfMemory|Benchmark|Growth' "$@"
