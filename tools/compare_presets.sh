#!/usr/bin/env bash
# Runs every preset on every sequence and prints the errors against the ground
# truth as a markdown table.
#   tools/compare_presets.sh SEQUENCE... --output=DIR [further flags of sf_run]
# Runs that are finished are kept, so that the command can be repeated. DIR has
#   options/PRESET.flags             what each preset is run with
#   SEQUENCE/PRESET/                 run directories, with pictures/
#   SEQUENCE/pictures/FRAME_*.jpg    the presets side by side
#   summary.csv, table.md            every figure; the table
# All presets are judged at the same reference frame of the tracks, the one in
# which most true points are visible. Exit status as sf_batch: 0 done, 2 bad
# usage, 3 if a run failed (its row is there, unless all did). SPLITFUSION_BIN: folder of the
# programs, if not build/release/bin.
set -euo pipefail
root="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
bin="${SPLITFUSION_BIN:-$root/build/release/bin}"
presets=(kinectfusion dynamicfusion cofusion background_only splitfusion)

refuse() { echo "compare_presets.sh: $1" >&2; exit 2; }

# The comment at the top of this file.
print_help() { sed -n '2,/^[^#]/{s/^# \{0,1\}//p}' "${BASH_SOURCE[0]}"; }

sequences=()
flags=()
output=
for argument in "$@"; do
  case "$argument" in
    -h | --help) print_help; exit 0 ;;
    --output=*) output="${argument#*=}" ;;
    -*) flags+=("$argument") ;;
    *) sequences+=("$argument") ;;
  esac
done
((${#sequences[@]})) || refuse "expected the folder of a sequence"
[[ -n "$output" ]] || refuse "expected --output=DIR"
for program in sf_batch sf_run sf_evaluate sf_montage; do
  [[ -x "$bin/$program" ]] ||
    refuse "$bin/$program: not found; build with tools/build_release.sh"
done

join() { local IFS=,; echo "$*"; }

option_files=()
write_options() {
  mkdir -p "$output/options"
  local preset file
  for preset in "${presets[@]}"; do
    file="$output/options/$preset.flags"
    printf '%s\n' "--preset=$preset" "${flags[@]}" >"$file"
    option_files+=("$file")
  done
}

# sf_run looks at its flags before it looks for its sequence: here there is none.
check_flags() {
  local file said none="$output/options/no-sequence"
  for file in "${option_files[@]}"; do
    said="$("$bin/sf_run" --flagfile="$file" --sequence="$none" \
      --output="$none" 2>&1 >/dev/null)" ||
      [[ "$said" == *"$none: no such folder"* ]] || refuse "${said##*$'\n'}"
  done
}

# A message may hold commas, but comes after the columns that are looked at.
some_run_finished() {
  awk -F, 'NR == 1 { for (i = 1; i <= NF; ++i) if ($i == "error") column = i }
           NR > 1 && $column == "" { found = 1 }
           END { exit !found }' "$output/summary.csv"
}

# Figures are counted from the end of a row: a message before them may hold
# commas.
print_table() {
  awk -F, '
    function mm(name) { return scaled(name, 1000, "%.1f") }
    function percent(name) { return scaled(name, 100, "%.1f %%") }
    function scaled(name, factor, format, value) {
      value = $(NF - from_end[name])
      return value == "" ? "-" : sprintf(format, factor * value)
    }
    NR == 1 {
      for (i = 1; i <= NF; ++i) from_end[$i] = NF - i
      print "| sequence | preset | ATE | background: error | complete |" \
            " moving: right | view error | missing | surface error |" \
            " F-score | track error, median | mean |"
      print "|---|---|---|---|---|---|---|---|---|---|---|---|"
      next
    }
    {
      print "| " $1 " | `" $2 "` | " mm("ate_rmse_m") \
            " | " mm("background_accuracy_m") \
            " | " percent("background_completeness") \
            " | " percent("objects_right") " | " mm("objects_view_m") \
            " | " percent("objects_uncovered") \
            " | " mm("objects_accuracy_m") \
            " | " percent("objects_f_score") \
            " | " mm("track_median_m") " | " mm("track_mean_m") " |"
    }' "$output/summary.csv"
}

# The picture of the same frame in all presets that have it, side by side.
write_pictures() {
  local sequence="$1" kind="$2" name frame preset file tiles
  for file in "$sequence"/splitfusion/pictures/*_"$kind".png; do
    [[ -e "$file" ]] || continue
    name="${file##*/}"
    frame="${name%%_*}"
    tiles=("input:$sequence/splitfusion/pictures/${frame}_input.png")
    for preset in "${presets[@]}"; do
      file="$sequence/$preset/pictures/$name"
      [[ -e "$file" ]] && tiles+=("$preset:$file")
    done
    mkdir -p "$sequence/pictures"
    "$bin/sf_montage" --pictures="$(join "${tiles[@]}")" --columns=3 \
      --tile_width=320 --output="$sequence/pictures/${frame}_$kind.jpg"
  done
}

write_options
check_flags
status=0
"$bin/sf_batch" --sequences="$(join "${sequences[@]}")" --output="$output" \
  --options="$(join "${option_files[@]}")" >"$output/batch.log" || status=$?
((status == 0 || status == 3)) || exit "$status"
if ! some_run_finished; then
  echo "compare_presets.sh: every run failed; see $output/summary.csv and the" \
    "*.err.log files beside" >&2
  exit "$status"
fi

print_table | tee "$output/table.md"
echo
echo "Distances in mm; '-': there is none. Right: pixels of moving instances" \
  "with the model within 20 mm of the truth; missing: without a model."
for sequence in "${sequences[@]}"; do
  name="$(basename "$(cd "$sequence" && pwd)")"
  write_pictures "$output/$name" composite
  write_pictures "$output/$name" normals
  echo "Pictures: $output/$name/pictures"
done
exit "$status"
