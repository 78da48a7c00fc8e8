#!/usr/bin/env bash
# Reconstructs sequences of DeepDeform (Bozic et al., CVPR 2020) and prints the
# 3D error of the motions that are annotated.
#   tools/reproduce/deepdeform.sh FOLDER... --output=DIR [flags of sf_run]
# FOLDER: seqNNN of train or val: color, depth (millimetres) and intrinsics.txt
# (or camera.txt). The masks of a few frames, mask/FRAME.png or
# mask/FRAME_OBJECT.png, are given to sf_run as non-rigid objects, which it
# keeps in the frames between; --masks=none --preset=dynamicfusion takes the
# scene for one, --masks=DIR others. Annotations are
# FOLDER/scene_flow/OBJECT_SOURCE_TARGET.sflow, and the matches of
# train_matches.json or val_matches.json, where there is one beside seqNNN or
# two folders above it. Nothing is written into FOLDER. Finished runs are kept.
# SPLITFUSION_BIN: folder of the programs, if not build/release/bin.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"
parse_arguments "$@"

labels_of() {  # Classes of masks: FRAME_OBJECT.png.
  local file name
  for file in "$1"/mask/*_*.png; do
    [[ -e "$file" ]] || continue
    name="$(basename "$file" .png)"
    name="${name#*_}"
    echo "${name//_/ }, non_rigid"
  done | sort -u
}

results=()
for folder in "${folders[@]}"; do
  need "$folder" depth
  folder="$(realpath "$folder")"
  name="$(basename "$folder")"
  masks=(--masks=none)
  if [[ -d "$folder/mask" && " ${flags[*]-} " != *" --masks="* ]]; then
    labels="$output/$name.labels.csv"
    labels_of "$folder" >"$labels"
    masks=(--masks="$folder/mask" --max_missed_frames=100000)
    [[ ! -s "$labels" ]] || masks+=(--labels="$labels")
  fi
  reconstruct "$folder" "$output/$name" --format=deepdeform --pictures_every=0 \
    "${masks[@]}"
  evaluate "$output/$name" --depth_every=1
  results+=("$output/$name" "$folder")
done
"$python" "$root/tools/reproduce/deepdeform_error.py" "${results[@]}"
