#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
#
# try_deb.sh: installs the packages that deb.sh has made in a fresh chroot, uses them as a user without root
# rights, and removes them. It needs root and debootstrap, and takes some minutes. SUITE is as for deb.sh.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/chroot.sh"
suite=${SUITE:-bookworm}
need_root
name=$suite-try-deb
rm -rf "${chroots:?}/$name"
make_chroot "$name" "$suite"
mkdir -p "$chroots/$name/debs"
cp "$chroots/debs/"*.deb "$chroots/$name/debs/"
files_of() { (cd "$chroots/$name" && printf '/%s\n' debs/$1_*.deb); } # files_of PACKAGE
before=$(du -sm "$chroots/$name" | cut -f1)
packages "$name" "$(files_of greatx)" mesa-vulkan-drivers bash-completion man-db
say "greatx and its dependencies take $(($(du -sm "$chroots/$name" | cut -f1) - before)) MB"
[ ! -e "$chroots/$name/usr/bin/cc" ] || die "expected no compiler to come along"
enter "$name" useradd --create-home tester
as_user() { enter "$name" su tester -c "set -e; cd; $1"; }
as_user "greatx --version; greatx generate city --ticks 2 -o run -q 2>log; greatx verify run"
as_user "man greatx | grep -q SYNOPSIS" # minbase's dpkg may leave manual pages out
as_user 'bash -c "source /usr/share/bash-completion/bash_completion; _completion_loader greatx
  complete -p greatx | grep -q _greatx"'
as_user "cp -r /usr/share/greatx/examples/places/village . && cd village &&
  greatx scene build village.yaml -q -o ../village.glb --report ../report"

packages "$name" "$(files_of python3-greatx)"
as_user "python3 -c 'import greatx; print(greatx.load(\"run\"))
print(len(greatx.Simulation(\"room\").paths()), \"paths\")'"

packages "$name" "$(files_of libgreatx-dev)" "$(files_of "libgreatx[0-9]*")" cmake g++ make
as_user "cmake -S /usr/share/greatx/examples/embed -B embed >log && cmake --build embed >>log &&
  embed/two_antennas"
library=$(basename "$(files_of "libgreatx[0-9]*")")
packages "$name" --purge greatx- python3-greatx- libgreatx-dev- "${library%%_*}-"
left=$(enter "$name" find /usr /etc -name '*greatx*' -not -name greatx-chroot)
[ -z "$left" ] || die "expected nothing to be left after removal, found $left"
say "the packages work"
