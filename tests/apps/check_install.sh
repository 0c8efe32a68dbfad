#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
#
# check_install.sh CMAKE BUILD_FOLDER PYTHON CXX: installs into a temporary prefix and moves it. Then checks
# where the loader would look for libraries, runs the programs from there, builds the example that embeds the
# engine against the installed package, and compares what it computes with what the installed Python package
# computes.
set -euo pipefail
checks=$(cd "$(dirname "$0")" && pwd)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
DESTDIR='' "$1" --install "$2" --prefix "$folder/first" >/dev/null
prefix=$folder/moved
mv "$folder/first" "$prefix"
"$3" "$checks/check_binaries.py" 2 "$prefix"
cd "$prefix"
for file in share/man/man1/greatx.1 share/bash-completion/completions/greatx share/zsh/*/_greatx \
  share/fish/vendor_completions.d/greatx.fish share/greatx/schema/scenario.schema.json \
  share/doc/greatx/README.md share/doc/greatx/docs/install.md share/greatx/examples/tutorial.yaml; do
  [ -s "$file" ] || { echo "$file: expected it below the prefix, found none or an empty one" >&2; exit 1; }
done
if grep -rIl "$folder/first" . >&2; then
  echo "the files above name the prefix, so the folder cannot be moved" >&2
  exit 1
fi

bin/greatx --version
bin/greatx explain city --ticks 1 >explained # no pipe, because grep -q would close it early
grep -q line_of_sight explained
if [ -x bin/greatx-places ]; then # by a relative path, from another folder, and by a link
  ln -s "$prefix/bin/greatx" "$folder/greatx"
  (cd share/greatx/examples/places/village && ../../../../../bin/greatx scene build village.yaml \
    -o "$folder/village.glb" --report "$folder/report" -q >/dev/null)
  "$folder/greatx" scene build --print-materials >materials
  [ -s "$folder/village.glb" ] && [ -s materials ]
fi

flags="-Wall -Wextra -Werror"
# A library with sanitizers needs a program with them.
if ldd "$(echo lib*/libgreatx.so)" >"$folder/needed" && grep -q libasan "$folder/needed"; then
  flags+=" -fsanitize=address,undefined"
fi
CXX=$4 "$1" -S share/greatx/examples/embed -B "$folder/embed" -DCMAKE_PREFIX_PATH="$prefix" \
  -DCMAKE_CXX_FLAGS="$flags" >"$folder/log" 2>&1 &&
  "$1" --build "$folder/embed" >>"$folder/log" 2>&1 || { cat "$folder/log" >&2; exit 1; }
"$folder/embed/two_antennas" >embedded
cat embedded
[ -f lib/greatx/python/greatx/_native.*.so ] || exit 0 # a build without the compiled module
PYTHONPATH=lib/greatx/python "$3" - >computed <<'PYTHON'
import greatx

scene = {"generate": {"kind": "city", "seed": 3, "size_m": 120}}
simulation = greatx.Simulation({"greatx": 1, "name": "two_antennas", "ticks": 1, "scene": scene})
simulation.place_transmitter("mast", [13, 13, 25])
simulation.place_receiver("phone", [0, -20, 1.5])
simulation.add_channel("link", carrier_hz=3.5e9, bandwidth_hz=20e6, subcarriers=8, max_depth=2)
paths = simulation.paths("link")
for i, delay in enumerate(paths.delay):
    print(f"path {i}: {1e9 * delay:.3f} ns")
for k, value in enumerate(paths.cfr().reshape(-1)):
    print(f"H[{k}] = {value.real:+.8e} {value.imag:+.8e}j")
PYTHON
diff embedded computed
