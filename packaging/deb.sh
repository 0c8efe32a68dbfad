#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
#
# deb.sh: builds the packages greatx, python3-greatx, libgreatx and libgreatx-dev of Debian in the chroot of
# wheel.sh (packaging/chroot.sh), into build/packaging/debs, and lets lintian look at them. It needs root and
# debootstrap. try_deb.sh installs and uses them.
#
# SUITE and CCACHE_DIR are as for wheel.sh.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/chroot.sh"
suite=${SUITE:-bookworm}
name=$suite-build
need_root
make_chroot "$name" "$suite"
out=$chroots/$suite-deb.out # the build folder of the chroot, apart from that of wheel.sh: another set-up
mkdir -p "$out" "$chroots/debs"
BINDS="$project $project
$out $project/build
${CCACHE_DIR:+$CCACHE_DIR /ccache}"
say "building"
packages "$name" build-essential lintian
enter "$name" env -C "$project" ${CCACHE_DIR:+CCACHE_DIR=/ccache} packaging/build_deb.sh build/debs \
  >"$chroots/$name.log" 2>&1 ||
  { tail -n 30 "$chroots/$name.log" >&2; die "failed; see $chroots/$name.log"; }
say "lintian"
enter "$name" sh -c "lintian --fail-on error --tag-display-limit 0 --allow-root $project/build/debs/*.deb" ||
  die "lintian has found errors"
rm -f "$chroots/debs/"*.deb
cp "$out/debs/"*.deb "$chroots/debs/"
say "$(cd "$chroots/debs" && stat -c '%n: %s bytes' ./*.deb)"
