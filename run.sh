#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
#
# Installs what is missing, builds greatx (Release) and generates the embedded default scenario into out/demo.
set -euo pipefail
cd "$(dirname "$0")"
scripts/setup.sh
scripts/build.sh release greatx
build/release/greatx generate --output out/demo --resume "$@"
build/release/greatx inspect out/demo
