#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
#
# check_install.sh CMAKE BUILD_FOLDER PYTHON: installs into a temporary prefix, checks where the loader would
# look for libraries, and runs the program from another folder.
set -euo pipefail
checks=$(cd "$(dirname "$0")" && pwd)
prefix=$(mktemp -d)
trap 'rm -rf "$prefix"' EXIT
"$1" --install "$2" --prefix "$prefix" >/dev/null
"$3" "$checks/check_binaries.py" 1 "$prefix"
cd "$prefix"
bin/greatx --version
bin/greatx explain city --ticks 1 > explained  # no pipe, because grep -q would close it early
grep -q line_of_sight explained
