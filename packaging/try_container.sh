#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
#
# try_container.sh [docker|apptainer]: carries out the last stage of the recipe of a container in a fresh
# chroot, for machines on which no container can be built: the commands of the Dockerfile's RUN lines, or of
# %post in greatx.def, on the smallest Debian. It then uses the result as the container's user. The packages
# are those of deb.sh, which does what the first stage does. It needs root and debootstrap.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/chroot.sh"
kind=${1:-docker}
suite=${SUITE:-bookworm}
name=$suite-try-$kind
recipes=$project/packaging/container
need_root
[ -d "$chroots/debs" ] || die "expected the packages of deb.sh in $chroots/debs, found none"

# last_stage: prints the instructions of the Dockerfile's last stage, each in one line.
last_stage() {
  sed -e ':a' -e '/\\$/N; s/\\\n//; ta' "$recipes/Dockerfile" | grep -v '^#' |
    awk '/^FROM/ {text = ""; next} {text = text $0 "\n"} END {printf "%s", text}'
}
rm -rf "${chroots:?}/$name"
make_chroot "$name" "$suite"
mkdir -p "$chroots/$name/debs"
cp "$chroots/debs/"*.deb "$project/scripts/setup.sh" "$chroots/$name/debs/"
run() {
  say "running $(tr -s ' \n' ' ' <<<"$1" | cut -c1-70) ..."
  enter "$name" sh -c "$1" >"$chroots/$name.log" 2>&1 ||
    { tail -n 20 "$chroots/$name.log" >&2; die "failed"; }
}
user=tester
settings=()
case $kind in
  docker)
    while read -r instruction rest; do
      case $instruction in
        RUN) run "$rest" ;;
        ENV) read -ra settings <<<"$rest" ;;
        USER) user=$rest ;;
        WORKDIR) workdir=$rest ;;
        COPY | ENTRYPOINT | CMD | "") ;; # the files are there, and the program is called by name below
        *) die "Dockerfile: expected an instruction that this script knows, found $instruction" ;;
      esac
    done < <(last_stage)
    ;;
  apptainer)
    run "$(awk '/^Stage: final/ {on = 1} on && /^%post/ {post = 1; next} /^%/ {post = 0} post' \
      "$recipes/greatx.def")"
    enter "$name" useradd --create-home tester
    workdir=/home/tester
    settings=(HOME=/home/tester) # Apptainer gives everybody the home folder that they have outside
    ;;
  *) die "expected docker or apptainer, found $kind" ;;
esac

[ ! -e "$chroots/$name/usr/bin/cc" ] || die "expected no compiler in the result"
[ "$user" != root ] || die "expected another user than root"
as_user() {
  enter "$name" setpriv --reuid="$user" --regid="$user" --init-groups \
    env -C "$workdir" "${settings[@]}" PATH=/usr/bin:/bin "$@"
}
say "the image takes $(du -sm "$chroots/$name" | cut -f1) MB"
as_user greatx --version
as_user greatx info | grep '^[0-9]'
as_user greatx generate city --ticks 2 -o run -q
as_user greatx verify run
as_user python3 -c 'import greatx; print(greatx.load("run"))' ||
  die "Python: failed"
say "the recipe works in a chroot"
