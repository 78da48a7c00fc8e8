#!/usr/bin/env bash
# Runs every preset on every sequence and prints the errors against the ground
# truth as a markdown table.
#   tools/compare_presets.sh SEQUENCE... --output=DIR [further flags of sf_run]
# Runs that are finished are kept, so that the command can be repeated. DIR is
# the folder of an experiment of sf_batch (docs/experiments.md) and has
#   tasks/TASK/run/                  run directories, with pictures/
#   pictures/SEQUENCE/FRAME_*.jpg    the presets side by side
#   results.csv, results.sqlite      every figure
#   table.md                         the table
# All presets are judged at the same reference frame of the tracks, the one in
# which most true points are visible. Exit status as sf_batch: 0 done, 2 bad
# usage, 3 if a run failed (its row is there, unless all did). SPLITFUSION_BIN:
# folder of the programs, if not build/release/bin.
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

# Flags of sf_run as sf_batch takes them: KEY="VALUE"; KEY="VALUE".
settings() {
  local flag text=
  for flag in "${flags[@]}"; do
    flag="${flag#-}"
    flag="${flag#-}"
    [[ "$flag" == *=* ]] || flag="$flag=true"
    text+="${flag%%=*}=\"${flag#*=}\"; "
  done
  echo "$text"
}

# Prints the columns that are asked for by name, of the rows of results.csv.
columns() {
  awk -F, -v names="$*" '
    NR == 1 { for (i = 1; i <= NF; ++i) place[$i] = i; n = split(names, name, " ") }
    NR > 1 {
      for (i = 1; i <= n; ++i) printf "%s%s", $place[name[i]], i < n ? "," : "\n"
    }' "$output/results.csv"
}

print_table() {
  columns sequence preset ate_m surface_error_m view_error_m f_score_seen \
    missing stretched ghosts tracks_median_m tracks_mean_m | awk -F, '
    function mm(value) { return value == "" ? "-" : sprintf("%.1f", 1000 * value) }
    function share(value) { return value == "" ? "-" : sprintf("%.1f %%", 100 * value) }
    BEGIN {
      print "| sequence | preset | ATE | moving: surface error | view error |" \
            " F-score of what was seen | missing | stretched | ghosts |" \
            " track error, median | mean |"
      print "|---|---|---|---|---|---|---|---|---|---|---|"
    }
    {
      print "| " $1 " | `" $2 "` | " mm($3) " | " mm($4) " | " mm($5) \
            " | " share($6) " | " share($7) " | " share($8) " | " share($9) \
            " | " mm($10) " | " mm($11) " |"
    }'
}

# The picture of the same frame in all presets that have it, side by side.
write_pictures() {
  local sequence="$1" kind="$2" name frame preset file tiles
  local -A run=()
  while IFS=, read -r of preset task; do
    [[ "$of" == "$sequence" ]] && run[$preset]="$output/tasks/$task/run"
  done < <(columns sequence preset task)
  for file in "${run[splitfusion]:-none}"/pictures/*_"$kind".png; do
    [[ -e "$file" ]] || continue
    name="${file##*/}"
    frame="${name%%_*}"
    tiles=("input:${run[splitfusion]}/pictures/${frame}_input.png")
    for preset in "${presets[@]}"; do
      file="${run[$preset]:-none}/pictures/$name"
      [[ -e "$file" ]] && tiles+=("$preset:$file")
    done
    mkdir -p "$output/pictures/$sequence"
    "$bin/sf_montage" --pictures="$(join "${tiles[@]}")" --columns=3 \
      --tile_width=320 --output="$output/pictures/$sequence/${frame}_$kind.jpg"
  done
}

status=0
mkdir -p "$output"
"$bin/sf_batch" run --sequences="$(join "${sequences[@]}")" \
  --grid="preset=$(join "${presets[@]}")" --set="$(settings)" \
  --output="$output" >"$output/batch.log" 2>"$output/batch.err.log" ||
  status=$?
if ((status != 0 && status != 3)); then
  refusal="$(tail -n 1 "$output/batch.err.log")"
  echo "compare_presets.sh: ${refusal#sf_batch: }" >&2
  exit "$status"
fi
if [[ "$(columns status)" != *complete* ]]; then
  echo "compare_presets.sh: every run failed; see sf_batch status" \
    "--output=$output" >&2
  exit "$status"
fi

print_table | tee "$output/table.md"
echo
echo "Distances in mm; '-': there is none. Missing: pixels of moving instances" \
  "without a model; docs/evaluation.md has the definitions."
for sequence in "${sequences[@]}"; do
  name="$(basename "$(cd "$sequence" && pwd)")"
  write_pictures "$name" composite
  write_pictures "$name" normals
  echo "Pictures: $output/pictures/$name"
done
exit "$status"
