#!/usr/bin/env bash
# Installs what building, testing and running need on Debian 12. Run as root, or
# as a user with sudo. Says what it installs; a second run finds all in place.
#   install_deps.sh [--tests]    with a browser, in which tests look at pages, and
#                                NumPy, h5py and matplotlib for those of python/
set -euo pipefail

packages=(
  g++ cmake ninja-build pkg-config git ca-certificates
  libceres-dev libeigen3-dev libsuitesparse-dev libopenblas0-pthread
  libopencv-dev libpcl-dev libopenvdb-dev libtbb-dev
  libgflags-dev libgoogle-glog-dev nlohmann-json3-dev libsqlite3-dev
  libxxhash-dev libhdf5-dev zlib1g-dev libminizip-dev
  libmeshoptimizer-dev
  libgtest-dev libgmock-dev libbenchmark-dev doxygen python3-onnx
)
# Bags of ROS 1 are read with these. Not every distribution has them.
optional=(librosbag-storage-dev libsensor-msgs-dev)
if [[ "${1:-}" == --tests ]]; then
  packages+=(chromium python3-numpy python3-h5py python3-matplotlib)
fi
# The programs of report pages; a node of another origin has its own npm.
command -v node >/dev/null || packages+=(nodejs)
command -v npm >/dev/null || packages+=(npm)

if ! command -v apt-get >/dev/null || ! command -v dpkg-query >/dev/null; then
  echo "install_deps: needs Debian 12 (apt-get, dpkg-query not found)" >&2
  exit 2
fi

is_installed() {
  [[ "$(dpkg-query -W -f='${db:Status-Status}' "$1" 2>/dev/null || true)" == \
     installed ]]
}

# What apt-get prints is shown only if it fails.
log="$(mktemp)"
trap 'rm -f "$log"' EXIT
apt_get() {
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get "$@" -qq \
    -o DPkg::Lock::Timeout=300 >"$log" 2>&1 </dev/null && return
  cat "$log" >&2
  echo "install_deps: apt-get failed" >&2
  exit 1
}

missing=()
for package in "${packages[@]}"; do
  is_installed "$package" || missing+=("$package")
done
may_install=yes
as_root=()
if ((EUID != 0)); then
  as_root=(sudo)
  command -v sudo >/dev/null || may_install=no
fi
if ((${#missing[@]})); then
  if [[ "$may_install" == no ]]; then
    echo "install_deps: missing ${missing[*]}; run as root or with sudo" >&2
    exit 2
  fi
  apt_get update
fi
for package in "${optional[@]}"; do
  is_installed "$package" && continue
  if [[ "$may_install" == yes ]] && apt-cache show "$package" &>/dev/null; then
    missing+=("$package")
  else
    echo "install_deps: without $package (optional): it is not in apt's" \
         "lists, or you are not root" >&2
  fi
done
if ((${#missing[@]})); then
  echo "install_deps: installing ${missing[*]} and what they need" \
       "(a few minutes)"
  apt_get install -y --no-install-recommends "${missing[@]}"
  echo "install_deps: done"
fi

# Sparse Cholesky takes its dense kernels from the BLAS that the alternatives
# point to: OpenBLAS, unless another one was chosen by hand.
blas="/usr/lib/$(g++ -print-multiarch)"
for name in libblas.so.3 liblapack.so.3; do
  if [[ "$(readlink -f "$blas/$name")" != *openblas* ]]; then
    echo "install_deps: $name is not OpenBLAS (slower); choose it with:" \
         "update-alternatives --config $name-${blas##*/}" >&2
  fi
done
