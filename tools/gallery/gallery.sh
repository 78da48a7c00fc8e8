#!/usr/bin/env bash
# Makes the pictures of docs/gallery.md, all from the sequence that sf_synth
# writes.
#   tools/gallery/gallery.sh [WORK]     WORK: for sequence and runs, runs/gallery
# Needs a build with tools and node, and Debian's imagemagick and chromium.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

work="${1:-runs/gallery}"
bin=build/release/bin
out=docs/images/gallery
largest=1000000  # Bytes of a picture.

if ! convert -version 2>/dev/null | grep -q ImageMagick; then
  echo "gallery: ImageMagick not found" >&2
  exit 2
fi
for program in chromium node "$bin/sf_run"; do
  if ! command -v "$program" >/dev/null; then
    echo "gallery: $program not found" >&2
    exit 2
  fi
done
mkdir -p "$work" "$out"

# animate NAME DELAY PICTURE...: a GIF, with fewer colours if it is too large.
animate() {
  local name="$1" delay="$2" colors
  shift 2
  for colors in 128 64 32 16; do
    convert -delay "$delay" -loop 0 "$@" +dither -colors "$colors" \
      -layers optimize "$out/$name.gif"
    (($(stat -c %s "$out/$name.gif") < largest)) && return
  done
  echo "gallery: $name.gif is larger than $largest bytes" >&2
  exit 1
}

# strip FOLDER NAME...: pictures of every fifth frame side by side.
strip() {
  local folder="$1" first last frame
  shift
  mkdir -p "$folder"
  for first in "$work"/run/pictures/*[05]_"$1".png; do
    frame="$(basename "$first" "_$1.png")"
    last=()
    for name in "$@"; do last+=("$work/run/pictures/${frame}_$name.png"); done
    convert "${last[@]}" -resize 220x +append +repage "$folder/$frame.png"
  done
}

"$bin/sf_synth" --output="$work/sequence" --frames=60 --overwrite
"$bin/sf_run" --sequence="$work/sequence" --output="$work/run" --overwrite \
  --pictures_every=1 --covariance=10 --freeze=10
"$bin/sf_evaluate" --run="$work/run" --ground_truth="$work/sequence/gt"
"$bin/sf_report" "$work/run" --output="$work/page.html"

strip "$work/split" input labels composite
animate split 20 "$work"/split/*.png
strip "$work/shape" normals depth error
animate shape 20 "$work"/shape/*.png

"$bin/sf_synth" --output="$work/small" --frames=20 --width=320 --height=240 \
  --overwrite
"$bin/sf_batch" run --sequences="$work/small" --output="$work/sweep" \
  --grid="terms.arap.weight=1,4,16" --repeat=3 --jobs=2
"$bin/sf_solve" "$work"/run/problems/*_001.h5 --output="$work/solved" \
  --solvers=gn_pcg,gn_cholesky,ceres --overwrite
cp "$work/solved/profile_1e-4.svg" "$out/solvers.svg"

rm -rf "$work/shots"
node tools/gallery/shots.mjs build/release/page "$work" "$work/shots"
animate viewer 12 "$work"/shots/turn_*.png
animate residual 12 "$work"/shots/residual_*.png
for name in page sweep; do
  convert "$work/shots/$name.png" -resize 1000x -quality 85 "$out/$name.jpg"
done
ls -l "$out"
