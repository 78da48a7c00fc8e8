#!/usr/bin/env bash
# Reconstructs sequences of the Bonn RGB-D Dynamic dataset (Palazzolo et al.,
# IROS 2019) and prints a table of their errors.
#   tools/reproduce/bonn.sh FOLDER... --output=DIR [further flags of sf_run]
# FOLDER: rgbd_bonn_NAME of the archive (rgb, depth, rgb.txt, depth.txt,
# groundtruth.txt: the layout of TUM). Intrinsics and lens distortion are those
# that the data set's page gives, unless FOLDER has a camera.txt. Masks as for
# tum.sh. Nothing is written into FOLDER. Finished runs are kept.
# SPLITFUSION_BIN: folder of the programs, if not build/release/bin.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"
parse_arguments "$@"

rows=()
for folder in "${folders[@]}"; do
  need "$folder" rgb depth groundtruth.txt
  name="$(basename "$(realpath "$folder")")"
  reconstruct "$folder" "$output/$name" --format=bonn --pictures_every=0
  evaluate "$output/$name" --ground_truth="$folder"
  rows+=("$(table_row "$output/$name" "$name")")
done
table_heading
printf '%s\n' "${rows[@]}"
