#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
#
# build.sh [KISSFFT_FOLDER]: builds greatx within the conda environment of environment.yml and installs it
# there.
#
# conda-forge has TinyGLTF as headers alone, Dear ImGui without a file for pkg-config, and no KISS FFT. This
# script compiles the first, describes the second, and builds the third from a folder with its sources
# (version 131.1.0; by default it is cloned). They go into the environment, and nothing else is written
# outside of build/. It is untried (docs/install.md).
set -euo pipefail
[ -n "${CONDA_PREFIX:-}" ] || { echo "expected an active conda environment, found none" >&2; exit 1; }
cd "$(dirname "$0")/../.."
prefix=$CONDA_PREFIX
pc=$prefix/lib/pkgconfig
work=build/conda-libraries
mkdir -p "$pc" "$work"
describe() { # describe NAME LIBRARY INCLUDE_FOLDER: writes a file for pkg-config
  [ -f "$pc/$1.pc" ] || printf 'Name: %s\nDescription: %s\nVersion: 0\nLibs: -L%s -l%s\nCflags: -I%s\n' \
    "$1" "$1" "$prefix/lib" "$2" "$3" >"$pc/$1.pc"
}

if [ ! -f "$pc/tinygltf.pc" ]; then
  printf '#define TINYGLTF_IMPLEMENTATION\n#define STB_IMAGE_IMPLEMENTATION\n%s\n#include <tiny_gltf.h>\n' \
    '#define STB_IMAGE_WRITE_IMPLEMENTATION' >"$work/tinygltf.cpp"
  "${CXX:-c++}" -std=c++17 -O2 -fPIC -I"$prefix/include" -c "$work/tinygltf.cpp" -o "$work/tinygltf.o"
  "${AR:-ar}" rcs "$prefix/lib/libtinygltf.a" "$work/tinygltf.o"
  describe tinygltf tinygltf "$prefix/include"
fi
describe imgui imgui "$prefix/include/imgui"
if [ ! -f "$pc/kissfft-float.pc" ]; then
  sources=${1:-$work/kissfft}
  [ -d "$sources" ] || git clone -q -b 131.1.0 https://github.com/mborgerding/kissfft "$sources"
  cmake -S "$sources" -B "$work/kissfft-build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DKISSFFT_TEST=OFF \
    -DKISSFFT_TOOLS=OFF -DKISSFFT_STATIC=ON -DCMAKE_POSITION_INDEPENDENT_CODE=ON \
    -DCMAKE_INSTALL_PREFIX="$prefix" -DCMAKE_INSTALL_LIBDIR=lib
  cmake --build "$work/kissfft-build" --target install
fi

export PKG_CONFIG_PATH=$pc
cmake --preset release -B build/conda -DGREATX_TESTS=OFF -DGREATX_PYTHON="$prefix/bin/python" \
  -DCMAKE_PREFIX_PATH="$prefix" -DCMAKE_INSTALL_PREFIX="$prefix"
cmake --build build/conda
cmake --install build/conda
echo "Vulkan's drivers are those of the machine: greatx info lists them"
echo "Python: export PYTHONPATH=$prefix/lib/greatx/python"
