#!/usr/bin/env bash
# Reconstructs sequences of the TUM RGB-D benchmark and prints a table of their
# errors beside those of the paper.
#   tools/reproduce/tum.sh FOLDER... --output=DIR [further flags of sf_run]
# FOLDER: what the archive of a sequence holds (rgb, depth, rgb.txt, depth.txt,
# groundtruth.txt), by its name or any with "freiburg1", "freiburg3", "fr1" or
# "fr3" in it; that tells the intrinsics, unless there is a camera.txt. Masks
# are those of FOLDER/masks_noisy or FOLDER/mask; without, --masks=DIR or
# --model=FILE.onnx, or none. Nothing is written into FOLDER. Finished runs are
# kept. SPLITFUSION_BIN: folder of the programs, if not build/release/bin.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"
parse_arguments "$@"

# Of the colour cameras, to which depth is registered: the benchmark's page
# "File formats". The correction of the depth scale is applied already.
camera_of() {
  case "$1" in
    *freiburg1* | *fr1*) echo 517.3 516.5 318.6 255.3 ;;
    *freiburg2* | *fr2*) echo 520.9 521.0 325.1 249.7 ;;
    *freiburg3* | *fr3*) echo 535.4 539.2 320.1 247.6 ;;
    *) refuse "$1: no camera.txt: expected one, or fr1 or fr3 in the name" ;;
  esac
}

# ATE of the paper's Table I, mm.
paper_of() {
  case "$1" in
    *freiburg1_xyz* | *fr1_xyz*) echo 15 ;;
    *freiburg1_desk2* | *fr1_desk2*) echo 40 ;;
    *walking_xyz*) echo 48 ;;
    *walking_static*) echo 210 ;;
    *) echo - ;;
  esac
}

rows=()
for folder in "${folders[@]}"; do
  need "$folder" rgb depth groundtruth.txt
  name="$(basename "$(realpath "$folder")")"
  sequence="$output/sequences/$name"
  link_in "$folder" "$sequence" rgb depth rgb.txt depth.txt associations.txt \
    groundtruth.txt camera.txt calibration.txt masks_noisy mask
  if [[ ! -e "$sequence/camera.txt" && ! -e "$sequence/calibration.txt" ]]; then
    camera="$(camera_of "$name")" || exit 2
    # shellcheck disable=SC2086
    write_camera "$sequence" 640 480 $camera 5000
  fi
  reconstruct "$sequence" "$output/$name" --pictures_every=0
  # Two poses have no ATE: the evaluator asks for three.
  if (($(wc -l <"$output/$name/frames.jsonl") < 3)); then
    evaluate "$output/$name" --depth_every=1
  else
    evaluate "$output/$name" --ground_truth="$sequence"
  fi
  rows+=("$(table_row "$output/$name" "$name" "$(paper_of "$name")")")
done
table_heading "paper's ATE mm"
printf '%s\n' "${rows[@]}"
