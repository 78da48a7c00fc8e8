#!/usr/bin/env bash
# Reconstructs sequences of VolumeDeform (Innmann et al., ECCV 2016) and prints
# how well the models agree with the live depth; the data set has no truth of
# motions.
#   tools/reproduce/volumedeform.sh FOLDER... --output=DIR [flags of sf_run]
# FOLDER holds frame-NNNNNN.color.png, frame-NNNNNN.depth.png (millimetres) and
# colorIntrinsics.txt or depthIntrinsics.txt, at any depth below it. The colour
# is taken as registered; where it is not sf_run notices, and says so. The
# object is all that there is: --masks=none --preset=dynamicfusion, unless other
# flags say so. Nothing is written into FOLDER. Finished runs are kept.
# SPLITFUSION_BIN: folder of the programs, if not build/release/bin.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"
parse_arguments "$@"
[[ "${flags[*]-}" == *--preset=* ]] || flags+=(--preset=dynamicfusion)
[[ "${flags[*]-}" == *--masks=* || "${flags[*]-}" == *--model=* ]] ||
  flags+=(--masks=none)

rows=()
for folder in "${folders[@]}"; do
  need "$folder"
  first="$(find -L "$folder" -name 'frame-*.color.png' | sort | sed -n 1p)"
  matrix="$(find -L "$folder" -name 'depthIntrinsics.txt' -o \
    -name 'colorIntrinsics.txt' | sort -r | sed -n 1p)"
  [[ -n "$first" ]] || refuse "$folder: has no frame-NNNNNN.color.png"
  [[ -n "$matrix" ]] || refuse "$folder: has no depthIntrinsics.txt"
  name="$(basename "$(realpath "$folder")")"
  sequence="$output/sequences/$name"
  mkdir -p "$sequence"
  ln -sfn "$(realpath "$(dirname "$first")")" "$sequence/images"
  camera="$(matrix_intrinsics "$matrix")" || exit 2
  size="$(image_size "${first%.color.png}.depth.png")" || exit 2
  # shellcheck disable=SC2086
  write_camera "$sequence" $size $camera 1000
  write_pairs "$sequence" 30 'images/frame-*.color.png' \
    'images/frame-*.depth.png'
  reconstruct "$sequence" "$output/$name" --format=tum --pictures_every=0
  evaluate "$output/$name"
  rows+=("$(table_row "$output/$name" "$name")")
done
table_heading
printf '%s\n' "${rows[@]}"
