#!/usr/bin/env bash
# Reconstructs sequences of DeepDeform (Bozic et al., CVPR 2020) and prints the
# 3D error of the motions that are annotated.
#   tools/reproduce/deepdeform.sh FOLDER... --output=DIR [flags of sf_run]
# FOLDER: seqNNN of train or val: color (or rgb), depth (millimetres) and
# intrinsics.txt (or camera.txt). The masks of a few frames, mask/FRAME.png or
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
  sequence="$output/sequences/$name"
  color=color
  [[ -d "$folder/color" ]] || color=rgb
  need "$folder" "$color"
  link_in "$folder" "$sequence" "$color" depth mask camera.txt
  if [[ ! -e "$sequence/camera.txt" ]]; then
    need "$folder" intrinsics.txt
    camera="$(matrix_intrinsics "$folder/intrinsics.txt")" || exit 2
    size="$(image_size "$(ls "$folder"/depth/*.png | sed -n 1p)")" || exit 2
    # shellcheck disable=SC2086
    write_camera "$sequence" $size $camera 1000
  fi
  write_pairs "$sequence" 30 "$color/*.jpg" 'depth/*.png'
  more=(--format=tum --pictures_every=0 --masks=none)
  if [[ -d "$sequence/mask" && " ${flags[*]-} " != *" --masks="* ]]; then
    labels_of "$sequence" >"$sequence/labels.csv"
    more=(--format=tum --pictures_every=0 --masks="$sequence/mask"
      --max_missed_frames=100000)
    [[ ! -s "$sequence/labels.csv" ]] ||
      more+=(--labels="$sequence/labels.csv")
  fi
  reconstruct "$sequence" "$output/$name" "${more[@]}"
  evaluate "$output/$name" --depth_every=1
  results+=("$output/$name" "$folder")
done
"$python" "$root/tools/reproduce/deepdeform_error.py" "${results[@]}"
