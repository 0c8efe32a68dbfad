#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
#
# deb.sh: builds the packages greatx, python3-greatx, libgreatx and libgreatx-dev of Debian in the chroot of
# wheel.sh (packaging/chroot.sh), lets lintian look at them, installs them in a fresh chroot, and uses them.
# The packages are left in build/packaging/debs. It needs root and debootstrap.
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
${CCACHE_DIR:+$CCACHE_DIR /root/.cache/ccache}"
say "building"
packages "$name" build-essential lintian
enter "$name" env -C "$project" packaging/build_deb.sh build/debs >"$chroots/$name.log" 2>&1 ||
  { tail -n 30 "$chroots/$name.log" >&2; die "failed; see $chroots/$name.log"; }
say "lintian"
enter "$name" sh -c "lintian --fail-on error --no-tag-display-limit --allow-root $project/build/debs/*.deb" ||
  die "lintian has found errors"
rm -f "$chroots/debs/"*.deb
cp "$out/debs/"*.deb "$chroots/debs/"
BINDS=""

say "installing in a fresh chroot"
name=$suite-try-deb
rm -rf "${chroots:?}/$name"
make_chroot "$name" "$suite"
mkdir -p "$chroots/$name/debs"
cp "$chroots/debs/"*.deb "$chroots/$name/debs/"
before=$(du -sm "$chroots/$name" | cut -f1)
packages "$name" /debs/greatx_*.deb mesa-vulkan-drivers bash-completion man-db
say "greatx and its dependencies take $(($(du -sm "$chroots/$name" | cut -f1) - before)) MB"
[ ! -e "$chroots/$name/usr/bin/cc" ] || die "expected no compiler to come along"
enter "$name" useradd --create-home tester
as_user() { enter "$name" su tester -c "set -e; cd; $1"; }
as_user "greatx --version; greatx generate city --ticks 2 -o run -q; greatx verify run"
as_user "man greatx | grep -q SYNOPSIS" # minbase's dpkg may leave manual pages out
as_user 'bash -c "source /usr/share/bash-completion/bash_completion; _completion_loader greatx
  complete -p greatx | grep -q _greatx"'
as_user "cp -r /usr/share/greatx/examples/places/village . && cd village &&
  greatx scene build village.yaml -q -o ../village.glb --report ../report"

packages "$name" /debs/python3-greatx_*.deb
as_user "python3 -c 'import greatx; print(greatx.load(\"run\"))
print(len(greatx.Simulation(\"room\").paths()), \"paths\")'"

packages "$name" /debs/libgreatx*.deb cmake g++ make
as_user "cmake -S /usr/share/greatx/examples/embed -B embed >log && cmake --build embed >>log &&
  embed/two_antennas"
packages "$name" --purge greatx- python3-greatx- libgreatx-dev- "libgreatx0.1-"
left=$(enter "$name" find /usr /etc -name '*greatx*' -not -path '*/__pycache__/*')
[ -z "$left" ] || die "expected nothing to be left after removal, found $left"
say "$(cd "$chroots/debs" && stat -c '%n: %s bytes' ./*.deb)"
