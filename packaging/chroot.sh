# shellcheck shell=bash
# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
#
# Functions for the scripts beside it, which source this file: they make and enter folders with a Debian of
# their own (chroots). Nothing of the machine but its kernel, its apt archive and its name server is used
# within, so a result does not depend on what is installed outside. All of it needs root and debootstrap.
#
#   make_base SUITE          makes build/packaging/SUITE-base once: the smallest Debian, with apt's sources
#   make_chroot NAME SUITE   makes build/packaging/NAME, a copy of that base, if it is missing
#   enter NAME COMMAND...    runs a command in it; BINDS: lines "OUTSIDE INSIDE" of folders that it sees, too
#
# Every entry has mounts and processes of its own, which end with it: nothing stays mounted or running.
#
# The archive is that of this machine's apt sources. GREATX_ARCHIVE=URI names another one, for example on a
# machine that is no Debian.

project=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
chroots=$project/build/packaging
BINDS=""

say() { printf '%s: %s\n' "$(basename "$0")" "$*"; }
die() { printf '%s: error: %s\n' "$(basename "$0")" "$*" >&2; exit 1; }

need_root() {
  [ "$(id -u)" -eq 0 ] || die "expected root rights, because it makes a chroot"
  command -v debootstrap >/dev/null || die "debootstrap is missing (Debian: apt-get install debootstrap)"
}

# sources_of SUITE: prints the sources of a suite, its updates and its security updates.
sources_of() {
  local listed archive security
  listed=$(apt-get indextargets --format '$(REPO_URI) $(RELEASE) $(COMPONENT)' 'Created-By: Packages' \
    2>/dev/null | awk '$3 == "main"' || true)
  archive=${GREATX_ARCHIVE:-$(awk '$2 !~ /-/ {print $1; exit}' <<<"$listed")}
  [ -n "$archive" ] || die "apt's sources name no archive of Debian: set GREATX_ARCHIVE to one"
  printf 'deb %s %s main\ndeb %s %s-updates main\n' "$archive" "$1" "$archive" "$1"
  security=$(awk '$2 ~ /-security$/ {print $1; exit}' <<<"$listed")
  [ -z "$security" ] || printf 'deb %s %s-security main\n' "$security" "$1"
}

# whole NAME: whether build/packaging/NAME was made to its end.
whole() { [ -f "$chroots/$1/etc/greatx-chroot" ]; }

make_base() {
  local suite=$1 name=$1-base sources
  whole "$name" && return
  sources=$(sources_of "$suite")
  rm -rf "${chroots:?}/$name"
  mkdir -p "$chroots"
  say "making $chroots/$name"
  local archive
  archive=$(awk '{print $2; exit}' <<<"$sources")
  unshare --mount debootstrap --variant=minbase "$suite" "$chroots/$name" "$archive" \
    >"$chroots/$name.log" 2>&1 || { tail -n 5 "$chroots/$name.log" >&2; die "debootstrap failed"; }
  printf '%s\n' "$sources" >"$chroots/$name/etc/apt/sources.list"
  printf '#!/bin/sh\nexit 101\n' >"$chroots/$name/usr/sbin/policy-rc.d" # starts no services
  chmod +x "$chroots/$name/usr/sbin/policy-rc.d"
  enter "$name" sh -c 'apt-get -qq update && apt-get -qq -y upgrade && apt-get clean' \
    >>"$chroots/$name.log" 2>&1 ||
    die "its packages could not be brought up to date; see $chroots/$name.log"
  touch "$chroots/$name/etc/greatx-chroot"
}

make_chroot() {
  whole "$1" && return
  make_base "$2"
  rm -rf "${chroots:?}/$1"
  cp -a "$chroots/$2-base" "$chroots/$1"
}

# packages NAME PACKAGE...: installs packages in a chroot; prints what apt says only if it fails.
packages() {
  local name=$1
  shift
  enter "$name" env DEBIAN_FRONTEND=noninteractive \
    apt-get -qq -o Dpkg::Use-Pty=0 install -y --no-install-recommends "$@" >"$chroots/$name.log" 2>&1 ||
    { tail -n 20 "$chroots/$name.log" >&2; die "$name: these packages could not be installed: $*"; }
}

enter() {
  local root=$chroots/$1
  shift
  cp -L /etc/resolv.conf "$root/etc/resolv.conf"
  BINDS=$BINDS unshare --mount --pid --fork --propagation private -- bash -c '
    set -eu
    root=$1
    shift
    mount -t tmpfs -o mode=755 dev "$root/dev"
    for device in null zero full random urandom tty; do
      touch "$root/dev/$device"
      mount --bind "/dev/$device" "$root/dev/$device"
    done
    mkdir -p "$root/dev/shm" "$root/dev/pts"
    mount -t tmpfs -o mode=1777 shm "$root/dev/shm"
    ln -s /proc/self/fd "$root/dev/fd"
    mount -t proc proc "$root/proc"
    while read -r outside inside; do
      [ -n "$outside" ] || continue
      mkdir -p "$root$inside"
      mount --bind "$outside" "$root$inside"
    done <<<"$BINDS"
    exec env -i PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 \
      TERM=dumb chroot "$root" "$@"' enter "$root" "$@"
}
