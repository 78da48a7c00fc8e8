#!/usr/bin/env bash
# Reconstructs sequences of the Bonn RGB-D Dynamic dataset (Palazzolo et al.,
# IROS 2019) and prints a table of their errors.
#   tools/reproduce/bonn.sh FOLDER... --output=DIR [further flags of sf_run]
# FOLDER: rgbd_bonn_NAME of the archive (rgb, depth, rgb.txt, depth.txt,
# groundtruth.txt: the layout of TUM). The intrinsics are those that the data
# set's page gives, unless FOLDER has a camera.txt; the lens distortion that it
# gives as well is not modelled. Masks as for tum.sh. Nothing is written into
# FOLDER. Finished runs are kept. SPLITFUSION_BIN: folder of the programs, if
# not build/release/bin.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"
parse_arguments "$@"

rows=()
for folder in "${folders[@]}"; do
  need "$folder" rgb depth groundtruth.txt
  name="$(basename "$(realpath "$folder")")"
  sequence="$output/sequences/$name"
  link_in "$folder" "$sequence" rgb depth rgb.txt depth.txt associations.txt \
    groundtruth.txt camera.txt masks_noisy mask
  [[ -e "$sequence/camera.txt" ]] ||
    write_camera "$sequence" 640 480 542.822841 542.576870 315.593520 \
      237.756098 5000
  reconstruct "$sequence" "$output/$name" --pictures_every=0
  evaluate "$output/$name" --ground_truth="$sequence"
  rows+=("$(table_row "$output/$name" "$name")")
done
table_heading
printf '%s\n' "${rows[@]}"
