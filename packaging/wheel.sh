#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
#
# wheel.sh: builds a wheel of the Python package with the engine, the command `greatx`, the Vulkan loader and
# lavapipe within, into build/packaging/wheels. It compiles in a chroot with Debian 12 (packaging/chroot.sh),
# so nothing depends on what is installed on this machine. It needs root, debootstrap, 5 GB, and 15 to 30
# minutes on two cores; a second run only does what has changed. The wheel runs on every Linux on x86-64 whose
# glibc is not older than its name says, with the CPython of that name. A second wheel, py3-none, lacks the
# compiled module and fits every Python.
#
# SUITE=trixie builds with another release of Debian, and for its Python. CCACHE_DIR names a cache of compiled
# files that the chroot may use, too.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/chroot.sh"
suite=${SUITE:-bookworm}
name=$suite-build
need_root
make_chroot "$name" "$suite"

# The chroot sees the sources at their own place, with a build folder of its own.
mkdir -p "$chroots/$name.out" "$chroots/wheels"
BINDS="$project $project
$chroots/$name.out $project/build
${CCACHE_DIR:+$CCACHE_DIR /ccache}"
within() { enter "$name" env -C "$project" ${CCACHE_DIR:+CCACHE_DIR=/ccache} "$@"; }
step() { # step MESSAGE COMMAND...
  local log=$chroots/$name.log
  say "$1"
  shift
  "$@" >"$log" 2>&1 || { tail -n 30 "$log" >&2; die "failed; see $log"; }
}

# The newer Mesa of the release's backports, where there is one, computes twice as fast.
step "installing packages" within env GREATX_BACKPORTS=1 scripts/setup.sh
packages "$name" patchelf python3-pip python3-setuptools python3-wheel git ca-certificates dpkg-dev
within git config --global --replace-all safe.directory "$project" # it may belong to another user
step "building smaller libraries" within packaging/small_libraries.sh /build/small
step "configuring" within cmake --preset release -DGREATX_TESTS=OFF -DGREATX_VIDEO=OFF -DGREATX_EMBREE=OFF
step "building greatx" within cmake --build build/release
step "installing" within sh -c 'rm -rf build/prefix build/base
  cmake --install build/release --prefix build/prefix --strip
  GREATX_NATIVE=1 python3 -m pip -q wheel --no-index --no-deps --no-build-isolation -w build/base ./python'
step "making the wheel" within sh -c 'rm -rf build/wheels
  for python in "" --any-python; do
    packaging/bundle.py build/base/*.whl build/prefix --driver "$(ls /usr/share/vulkan/icd.d/lvp_icd*.json)" \
      --replace /build/small/lib $python --out build/wheels
  done'
cat "$chroots/$name.log"
cp "$chroots/$name.out/wheels/"*.whl "$chroots/wheels/"
