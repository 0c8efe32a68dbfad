#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
#
# build.sh PRESET [TARGET...]: configures the preset if needed and builds it. It prints the output of the
# tools only if a step fails.
set -euo pipefail
cd "$(dirname "$0")/.."
preset=$1
shift
targets=("${@:-all}")
log=build/$preset/build.log
mkdir -p "build/$preset"
step() { # step MESSAGE COMMAND...
  local message=$1
  shift
  [ -z "$message" ] || echo "$message"
  "$@" >"$log" 2>&1 || { cat "$log" >&2; exit 1; }
}
[ -f "build/$preset/build.ninja" ] || step "configuring build/$preset" cmake --preset "$preset"
if ninja -C "build/$preset" -n "${targets[@]}" | grep -q '^ninja: no work to do'; then exit 0; fi
step "building build/$preset" cmake --build "build/$preset" --target "${targets[@]}"
