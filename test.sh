#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
#
# Installs missing packages, builds greatx (Release) and runs all tests. Arguments are passed to ctest, for
# example: ./test.sh -L hard
set -euo pipefail
cd "$(dirname "$0")"
scripts/setup.sh
scripts/build.sh release

# Tests write thousands of small files and delete them again, which takes a fifth of their time on a disk.
# They go to memory if it has room and runs programs.
memory=/dev/shm
if [ -z "${TMPDIR:-}" ] && [ -w "$memory" ] &&
  [ "$(df --output=avail -k "$memory" | tail -n 1)" -ge $((6 << 20)) ] &&
  [ "$(awk '/^MemAvailable:/ {print $2}' /proc/meminfo)" -ge $((8 << 20)) ]; then
  TMPDIR=$(mktemp -d "$memory/greatx_tests.XXXXXX")
  trap 'rm -rf "$TMPDIR"' EXIT
  printf '#!/bin/sh\n' >"$TMPDIR/runs"
  chmod +x "$TMPDIR/runs"
  if "$TMPDIR/runs" 2>/dev/null; then export TMPDIR; fi
fi
ctest --test-dir build/release --output-on-failure -j 2 "$@"
