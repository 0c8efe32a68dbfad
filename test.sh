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
exec ctest --test-dir build/release --output-on-failure -j 2 "$@"
