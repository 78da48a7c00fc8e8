# shellcheck shell=bash
# What the scripts of this folder share; they source it. Bash.
# Sets root, bin, output, flags (of sf_run) and folders by the arguments.

root="$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)"
bin="${SPLITFUSION_BIN:-$root/build/release/bin}"
python=/usr/bin/python3
[[ -x "$python" ]] || python=python3
export PYTHONPATH="$root/python${PYTHONPATH:+:$PYTHONPATH}"

refuse() { echo "$(basename "$0"): $1" >&2; exit 2; }

# parse_arguments ARGUMENT...: folders of sequences, --output=DIR, and flags.
parse_arguments() {
  folders=() flags=() output=
  local argument
  for argument in "$@"; do
    case "$argument" in
      -h | --help) sed -n '2,/^[^#]/{s/^# \{0,1\}//p}' "$0"; exit 0 ;;
      --output=*) output="${argument#*=}" ;;
      -*) flags+=("$argument") ;;
      *) folders+=("$argument") ;;
    esac
  done
  ((${#folders[@]})) || refuse "expected the folder of a sequence"
  [[ -n "$output" ]] || refuse "expected --output=DIR"
  local program
  for program in sf_run sf_evaluate; do
    [[ -x "$bin/$program" ]] ||
      refuse "$bin/$program: not found; build with tools/build_release.sh"
  done
  "$python" -c 'import numpy' 2>/dev/null ||
    refuse "NumPy not found: install Debian's python3-numpy"
  mkdir -p "$output"
  output="$(realpath "$output")"
}

# need FOLDER NAME...: the files and folders that a sequence must have.
need() {
  local folder="$1" name
  shift
  [[ -d "$folder" ]] || refuse "$folder: not a folder: expected a sequence"
  for name in "$@"; do
    [[ -e "$folder/$name" ]] || refuse "$folder: has no $name: expected one"
  done
}

# link_in FOLDER SEQUENCE NAME...: links what there is of these in SEQUENCE.
link_in() {
  local folder="$1" sequence="$2" name
  shift 2
  mkdir -p "$sequence"
  for name in "$@"; do
    [[ -e "$folder/$name" ]] || continue
    ln -sfn "$(realpath "$folder/$name")" "$sequence/$name"
  done
}

# write_camera SEQUENCE WIDTH HEIGHT FX FY CX CY DEPTH_SCALE
write_camera() {
  printf '%s\n' "width $2" "height $3" "fx $4" "fy $5" "cx $6" "cy $7" \
    "depth_scale $8" >"$1/camera.txt"
}

# reconstruct SEQUENCE RUN FLAG...: what is finished is kept.
reconstruct() {
  local sequence="$1" run="$2" status=0
  shift 2
  echo "$(basename "$0"): $run" >&2
  "$bin/sf_run" --sequence="$sequence" --output="$run" --keep_same --overwrite \
    "$@" "${flags[@]}" >"$run.log" 2>&1 || status=$?
  if ((status)); then
    tail -n 3 "$run.log" >&2
    refuse "sf_run failed, see $run.log"
  fi
}

# evaluate RUN FLAG...
evaluate() {
  local run="$1"
  shift
  "$bin/sf_evaluate" --run="$run" "$@" >"$run.evaluate.log" 2>&1 ||
    refuse "sf_evaluate failed, see $run.evaluate.log"
}

# Row of a table about a run; with a first line, its heading. Further arguments
# are columns that are put in as they are.
table_heading() { "$python" "$root/tools/reproduce/row.py" --heading "$@"; }
table_row() { "$python" "$root/tools/reproduce/row.py" "$@"; }
