#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
#
# Installs the packages that greatx needs to build and run, if they are missing. It prints nothing if there is
# nothing to do. It supports Debian 12 or newer and Ubuntu 24.04 or newer, as root or with sudo.
#
# The release's own Mesa is enough. GREATX_BACKPORTS=1 takes a newer one from the backports suite if the
# release's own is older than 24.1: a run then needs half of the time. GREATX_PACKAGES="" installs Mesa alone,
# for a machine that gets greatx as a package. GREATX_LEARNING=1 adds PyTorch and what else the tasks of
# docs/learning.md and their tests need, some 0.7 GB; without it, those tests say that they are skipped.
set -euo pipefail

packages=(
  build-essential cmake ninja-build pkg-config ccache glslang-tools
  libvulkan-dev vulkan-validationlayers libglm-dev libtinygltf-dev libopenexr-dev libhdf5-dev libstb-dev
  libyaml-cpp-dev nlohmann-json3-dev libcli11-dev libfmt-dev libspdlog-dev libssl-dev zlib1g-dev libpng-dev
  libjpeg-dev libdeflate-dev libwebp-dev libpugixml-dev libkissfft-dev libglfw3-dev libimgui-dev
  libgdal-dev libproj-dev libgeos-dev libosmium2-dev libexpat1-dev libbz2-dev
  libeigen3-dev libsqlite3-dev libgtest-dev libgmock-dev pybind11-dev python3-dev python3-numpy python3-h5py
  python3-jsonschema python3-yaml xvfb xauth fonts-dejavu-core zsh fish
)
# Without OpenBLAS, Debian's PyTorch multiplies matrices by the reference BLAS, 20 times slower.
[ "${GREATX_LEARNING:-0}" = 0 ] ||
  packages+=(python3-torch python3-torchvision python3-matplotlib libopenblas0-pthread)
[ "${GREATX_PACKAGES-all}" = all ] || packages=()
# lavapipe, Mesa's software Vulkan driver, runs greatx from mesa_minimum on: rays go through greatx's own
# trees. From mesa_newer on it is twice as fast and also has ray queries and conditional rendering.
mesa_package=mesa-vulkan-drivers
mesa_minimum=22.3
mesa_newer=24.1

say() { printf 'setup: %s\n' "$*"; }
die() { printf 'setup: error: %s\n' "$*" >&2; exit 1; }

command -v apt-get >/dev/null ||
  die "this script knows apt only; install the packages that it lists by hand:" \
    "${packages[*]} and $mesa_package >= $mesa_minimum"
as_root=()
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo >/dev/null || die "not root and no sudo"
  as_root=(sudo)
fi
apt_get() {
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -qq -o Dpkg::Use-Pty=0 "$@" >/dev/null
}

version_of() {
  dpkg-query -W -f '${db:Status-Abbrev} ${Version}' "$1" 2>/dev/null |
    awk '$1 == "ii" {print $2}' | head -n 1
}
at_least() { [ -n "$1" ] && dpkg --compare-versions "$1" ge "$2"; }
candidate_of() { LC_ALL=C apt-cache policy "$1" | awk '/Candidate:/ && $2 != "(none)" {print $2}'; }
mesa_wanted=$mesa_newer
[ "${GREATX_BACKPORTS:-0}" != 0 ] || mesa_wanted=$mesa_minimum

missing=()
for package in "${packages[@]}"; do
  [ -n "$(version_of "$package")" ] || missing+=("$package")
done
mesa_ready=false
at_least "$(version_of "$mesa_package")" "$mesa_wanted" && mesa_ready=true
[ "${#missing[@]}" -gt 0 ] || ! $mesa_ready || exit 0

say "refreshing the package lists"
apt_get update || say "warning: some package lists could not be refreshed"

if [ "${#missing[@]}" -gt 0 ]; then
  say "installing ${missing[*]}"
  apt_get install -y --no-install-recommends "${missing[@]}"
fi
$mesa_ready && exit 0

candidate=$(candidate_of "$mesa_package")
if at_least "$candidate" "$mesa_wanted"; then
  say "installing $mesa_package $candidate"
  apt_get install -y --no-install-recommends "$mesa_package"
  at_least "$candidate" "$mesa_newer" ||
    say "Mesa >= $mesa_newer would halve the time of a run: GREATX_BACKPORTS=1 scripts/setup.sh takes it"
  exit 0
fi
[ "$mesa_wanted" = "$mesa_newer" ] ||
  die "apt offers $mesa_package '$candidate', but >= $mesa_minimum is needed"

# The Mesa of the distribution is too old, but its backports suite has a newer one. That suite is in the same
# archive as the release itself, so its address, perhaps that of a mirror, is that of the current apt sources.
codename=$(. /etc/os-release && printf '%s' "${VERSION_CODENAME:-}")
read -r archive signed_by < <(apt-get indextargets \
  --format '$(REPO_URI) $(RELEASE) $(COMPONENT) $(SIGNED_BY)' 'Created-By: Packages' |
  awk -v release="$codename" '$2 == release && $3 == "main" {print $1, ($4 ~ /^\// ? $4 : "")}' |
  head -n 1) ||
  die "no apt source with the suite '$codename main' found, so the archive with" \
    "$mesa_package >= $mesa_wanted is unknown"

sources=/etc/apt/sources.list.d/greatx-backports.list
preferences=/etc/apt/preferences.d/greatx-backports
say "$mesa_package >= $mesa_wanted is not in $codename; taking Mesa alone from $codename-backports:"
say "  adding $sources (the archive this machine uses already)"
say "  adding $preferences (nothing but Mesa and the libdrm it needs may come from there)"
options=""
[ -z "$signed_by" ] || options="[signed-by=$signed_by] "
printf 'deb %s%s %s-backports main\n' "$options" "$archive" "$codename" |
  "${as_root[@]}" tee "$sources" >/dev/null
"${as_root[@]}" tee "$preferences" >/dev/null <<PIN
# Written by greatx's scripts/setup.sh: ray queries on lavapipe need Mesa >= $mesa_newer.
Package: *
Pin: release n=$codename-backports
Pin-Priority: -1

Package: src:mesa:any src:libdrm:any
Pin: release n=$codename-backports
Pin-Priority: 500
PIN
apt_get update || say "warning: some package lists could not be refreshed"
at_least "$(candidate_of "$mesa_package")" "$mesa_wanted" ||
  die "$codename-backports offers $mesa_package '$(candidate_of "$mesa_package")'," \
    "but >= $mesa_wanted is needed"
say "installing $mesa_package $(candidate_of "$mesa_package")"
apt_get install -y --no-install-recommends "$mesa_package"
