#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
#
# small_gdal.sh FOLDER: builds Debian's GDAL in FOLDER/build with the formats that `greatx scene build` opens
# (docs/places_reference.md) and no other. wheel.sh runs it in its chroot. FOLDER/build/libgdal.so.NN has the
# name and the interface of Debian's own, so it can take that one's place in a wheel. Debian's own brings 65
# libraries along, 34 MB in a wheel, among them some under the GPL.
set -euo pipefail
cd "$1"
[ ! -f whole ] || exit 0
grep -rq '^deb-src' /etc/apt/sources.list.d 2>/dev/null ||
  sed 's/^deb /deb-src /' /etc/apt/sources.list >/etc/apt/sources.list.d/sources.list
apt-get -qq update
rm -rf build gdal-*
apt-get -qq source gdal # unpacks and patches it
drivers=()
for name in AAIGRID RAW XYZ DTED SRTMHGT PNG JPEG OPENJPEG; do
  drivers+=("-DGDAL_ENABLE_DRIVER_$name=ON")
done
for name in GPKG FLATGEOBUF SQLITE; do drivers+=("-DOGR_ENABLE_DRIVER_$name=ON"); done
libraries=()
for name in TIFF GEOTIFF PNG JPEG ZLIB DEFLATE OPENJPEG SQLITE3 GEOS JSONC; do
  libraries+=("-DGDAL_USE_$name=ON")
done
cmake -S gdal-*/ -B build -G Ninja -DCMAKE_BUILD_TYPE=Release -DBUILD_SHARED_LIBS=ON -DBUILD_TESTING=OFF \
  -DBUILD_APPS=OFF -DBUILD_PYTHON_BINDINGS=OFF -DBUILD_JAVA_BINDINGS=OFF -DBUILD_CSHARP_BINDINGS=OFF \
  -DGDAL_BUILD_OPTIONAL_DRIVERS=OFF -DOGR_BUILD_OPTIONAL_DRIVERS=OFF -DGDAL_USE_EXTERNAL_LIBS=OFF \
  -DGDAL_USE_INTERNAL_LIBS=ON "${drivers[@]}" "${libraries[@]}"
cmake --build build --target GDAL
touch whole
