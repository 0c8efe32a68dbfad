#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
#
# Installs missing packages, builds greatx and its Python package (Release), generates the embedded default
# scenario into out/demo and draws its contact sheet and animation. A second run does only the remaining
# steps. Arguments are passed to `greatx generate`.
set -euo pipefail
cd "$(dirname "$0")"
scripts/setup.sh
scripts/build.sh release greatx greatx_python greatx_engine_library

demo() { build/release/greatx generate --output out/demo --resume "$@"; }
if ! demo "$@"; then
  # A demo of an older greatx, another driver or other arguments cannot be resumed. It is kept under another
  # name.
  demo "$@" 2>&1 | grep -q 'another run' || exit 1
  number=1
  while [ -e "out/demo.$number" ]; do number=$((number + 1)); done
  mv out/demo "out/demo.$number"
  echo "out/demo is of another run: kept as out/demo.$number, generating anew"
  demo "$@"
fi
build/release/greatx inspect out/demo --animation out/demo/animation.webp | tail -n 2
