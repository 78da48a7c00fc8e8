#!/usr/bin/env bash
# Packs the programs (cpack), unpacks them in a bare Debian 12 that has only the
# run-time packages of docs/cluster.md, and reconstructs a short sequence there
# and here: the results must be the same.
#   tests/bare_root.sh [FOLDER OF THE BUILD]   # build/release
# Must be run by root, after a build of everything. Needs debootstrap, which it
# installs, and Debian's packages, of which it loads about 250 MB.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
export LC_ALL=C

say() { echo "bare_root.sh: $(printf '%3d' $SECONDS) s: $*"; }
((EUID == 0)) || { echo "bare_root.sh: must be run by root" >&2; exit 2; }
build="$(realpath "${1:-build/release}")"
[[ -f "$build/CPackConfig.cmake" ]] || {
  echo "bare_root.sh: $build: expected the folder of a build" >&2
  exit 2
}
if ! command -v debootstrap >/dev/null; then
  echo "bare_root.sh: installing debootstrap"
  apt-get update -qq
  apt-get install -qq -y --no-install-recommends debootstrap >/dev/null
fi

SECONDS=0
tmp="$(mktemp -d)"
root="$tmp/root"
clean_up() {
  mountpoint -q "$root/proc" && umount "$root/proc"
  rm -rf --one-file-system "$tmp"
}
trap clean_up EXIT

# The block of packages in the page.
packages="$(sed -n '/^apt-get install/,/^```/p' docs/cluster.md |
            grep -oE '\blib[a-z0-9.+-]+')"
(cd "$build" && cpack -B "$tmp/package" >"$tmp/log" 2>&1) ||
  { cat "$tmp/log" >&2; exit 1; }
tarball="$(echo "$tmp"/package/*.tar.gz)"
say "$(basename "$tarball"), $(du -h "$tarball" | cut -f 1)"

debootstrap --variant=minbase bookworm "$root" >"$tmp/log" 2>&1 ||
  { tail "$tmp/log" >&2; exit 1; }
say "bare root: $(chroot "$root" dpkg -l | grep -c ^ii) packages"
mount -t proc proc "$root/proc"
# shellcheck disable=SC2086
DEBIAN_FRONTEND=noninteractive chroot "$root" apt-get install -qq -y \
  --no-install-recommends $packages >"$tmp/log" 2>&1 ||
  { tail "$tmp/log" >&2; exit 1; }
say "run-time packages: $(wc -w <<<"$packages") named," \
    "$(chroot "$root" dpkg -l | grep -c ^ii) in all"

mkdir "$root/any where"
tar -xzf "$tarball" -C "$root/any where" --strip-components=1
"$build/bin/sf_synth" --output="$tmp/sequence" --frames=8 --width=160 \
  --height=120 >/dev/null
cp -r "$tmp/sequence" "$root/sequence"
"$build/bin/sf_run" --sequence="$tmp/sequence" --output="$tmp/run" >/dev/null
for program in "$root/any where/bin"/*; do
  chroot "$root" "${program#"$root"}" --help >/dev/null ||
    { echo "bare_root.sh: $program does not start" >&2; exit 1; }
done
chroot "$root" "/any where/bin/sf_run" --sequence=/sequence --output=/result
chroot "$root" "/any where/bin/sf_batch" run --sequences=/sequence \
  --output=/experiment
for file in trajectory.txt surfaces/000_background/mesh.ply; do
  cmp "$tmp/run/$file" "$root/result/$file"
  cmp "$tmp/run/$file" "$root"/experiment/tasks/*/run/"$file"
done
count="$(find "$root/any where/bin" -type f | wc -l)"
say "PASSED: $count programs start there, and the results of sf_run and" \
    "sf_batch are those of this machine"
