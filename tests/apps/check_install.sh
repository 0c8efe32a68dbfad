#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
#
# check_install.sh CMAKE BUILD_FOLDER: installs into a scratch prefix and runs the program there, from another folder.
set -euo pipefail
prefix=$(mktemp -d)
trap 'rm -rf "$prefix"' EXIT
"$1" --install "$2" --prefix "$prefix" >/dev/null
cd "$prefix"
bin/greatx --version
bin/greatx explain city --ticks 1 > explained  # no pipe: grep -q would close it early
grep -q line_of_sight explained
