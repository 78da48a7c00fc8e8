#!/usr/bin/env bash
# Reconstructs sequences of VolumeDeform (Innmann et al., ECCV 2016) and prints
# how well the models agree with the live depth; the data set has no truth of
# motions.
#   tools/reproduce/volumedeform.sh FOLDER... --output=DIR [flags of sf_run]
# FOLDER, or FOLDER/data, holds frame-NNNNNN.color.png, frame-NNNNNN.depth.png
# (millimetres) and depthIntrinsics.txt (docs/data_sets.md). The object is all
# that there is: --masks=none --preset=dynamicfusion, unless other flags say so.
# Nothing is written into FOLDER. Finished runs are kept. SPLITFUSION_BIN:
# folder of the programs, if not build/release/bin.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"
parse_arguments "$@"
[[ "${flags[*]-}" == *--preset=* ]] || flags+=(--preset=dynamicfusion)
[[ "${flags[*]-}" == *--masks=* || "${flags[*]-}" == *--model=* ]] ||
  flags+=(--masks=none)

rows=()
for folder in "${folders[@]}"; do
  need "$folder"
  name="$(basename "$(realpath "$folder")")"
  reconstruct "$folder" "$output/$name" --format=volumedeform --pictures_every=0
  evaluate "$output/$name"
  rows+=("$(table_row "$output/$name" "$name")")
done
table_heading
printf '%s\n' "${rows[@]}"
