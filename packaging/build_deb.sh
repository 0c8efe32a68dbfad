#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
#
# build_deb.sh FOLDER: builds Debian's packages of greatx on this machine, a Debian or Ubuntu, and puts them
# into FOLDER. It installs missing packages, so it needs root or sudo. packaging/deb.sh runs it in a chroot,
# and the recipes of packaging/container run it in their first stage.
set -euo pipefail
folder=$(mkdir -p "$1" && cd "$1" && pwd)
cd "$(dirname "$0")/.."
GREATX_BACKPORTS=${GREATX_BACKPORTS:-1} scripts/setup.sh
command -v dpkg-shlibdeps >/dev/null || { echo "expected dpkg-dev to be installed" >&2; exit 1; }
cmake --preset release -DGREATX_TESTS=OFF -DGREATX_VIDEO=OFF -DGREATX_EMBREE=OFF -DGREATX_DEBIAN=ON
cmake --build build/release
rm -rf build/release/deb
(umask 022 && cpack --config build/release/CPackConfig.cmake)
cp build/release/deb/*.deb "$folder"
