#!/usr/bin/env bash
# Tests the package python/splitfusion_io, also on runs that it makes of every
# preset. With Debian's Python; without its NumPy says so and exits with 77.
#   tests/python.sh [FOLDER OF THE PROGRAMS]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
bin="$(realpath "${1:-build/release/bin}")"

python=/usr/bin/python3
[[ -x "$python" ]] || python=python3
if ! "$python" -c 'import numpy' 2>/dev/null; then
  echo "python.sh: skipped: NumPy not found: install Debian's python3-numpy"
  exit 77
fi
for program in sf_synth sf_run sf_evaluate; do
  [[ -x "$bin/$program" ]] && continue
  echo "python.sh: skipped: $bin/$program is not built"
  exit 77
done
for module in h5py matplotlib; do
  "$python" -c "import $module" 2>/dev/null ||
    echo "python.sh: without $module what needs it is not tested"
done
PYTHONDONTWRITEBYTECODE=1 PYTHONPATH=python SPLITFUSION_BIN="$bin" \
  exec "$python" -m unittest discover -s python/tests
