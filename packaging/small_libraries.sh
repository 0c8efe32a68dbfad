#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
#
# small_libraries.sh FOLDER: builds two libraries from Debian's sources, with less in them, into FOLDER/lib.
# wheel.sh runs it in its chroot. They have the names and the interfaces of Debian's own, so they can take the
# places of those in a wheel:
#
#   libgdal   with the formats that `greatx scene build` opens (docs/places_reference.md) and no other.
#             Debian's own brings 65 libraries along, 34 MB in a wheel, among them some under the GPL
#   libxml2   without ICU, whose tables take 14 MB in a wheel. LLVM links libxml2 for manifests of Windows,
#             which greatx has none of
set -euo pipefail
mkdir -p "$1/lib"
cd "$1"
[ ! -f whole ] || exit 0
sed 's/^deb /deb-src /' /etc/apt/sources.list >/etc/apt/sources.list.d/sources.list
apt-get -qq update
rm -rf gdal* libxml2*
apt-get -qq source gdal libxml2 # unpacks and patches them

drivers=()
for name in AAIGRID RAW XYZ DTED SRTMHGT PNG JPEG JP2OPENJPEG; do
  drivers+=("-DGDAL_ENABLE_DRIVER_$name=ON")
done
for name in GPKG FLATGEOBUF SQLITE; do drivers+=("-DOGR_ENABLE_DRIVER_$name=ON"); done
libraries=()
for name in TIFF GEOTIFF PNG JPEG ZLIB DEFLATE OPENJPEG SQLITE3 GEOS JSONC; do
  libraries+=("-DGDAL_USE_$name=ON")
done
cmake -S gdal-*/ -B gdal-build -G Ninja -DCMAKE_BUILD_TYPE=Release -DBUILD_SHARED_LIBS=ON -DBUILD_APPS=OFF \
  -DBUILD_TESTING=OFF -DBUILD_PYTHON_BINDINGS=OFF -DBUILD_JAVA_BINDINGS=OFF -DBUILD_CSHARP_BINDINGS=OFF \
  -DGDAL_BUILD_OPTIONAL_DRIVERS=OFF -DOGR_BUILD_OPTIONAL_DRIVERS=OFF -DGDAL_USE_EXTERNAL_LIBS=OFF \
  -DGDAL_USE_INTERNAL_LIBS=ON "${drivers[@]}" "${libraries[@]}"
cmake --build gdal-build --target GDAL
# The tools that wrote libxml2's configure are not needed again, though a patch has touched their input.
(cd libxml2-*/ && ./configure -q --disable-static --without-icu --without-python --without-lzma &&
  make ACLOCAL=: AUTOMAKE=: AUTOCONF=: AUTOHEADER=: libxml2.la)

strip --strip-unneeded -o "lib/$(basename gdal-build/libgdal.so.[0-9][0-9])" gdal-build/libgdal.so.[0-9][0-9]
strip --strip-unneeded -o lib/libxml2.so.2 libxml2-*/.libs/libxml2.so.2

# The formats of scene/place/source.
python3 - lib/libgdal.so.* <<'PYTHON'
import ctypes, sys

gdal = ctypes.CDLL(sys.argv[1])
gdal.GDALAllRegister()
gdal.GDALGetDriverByName.restype = ctypes.c_void_p
formats = "GTiff SRTMHGT AAIGrid EHdr XYZ DTED PNG JPEG JP2OpenJPEG".split()
formats += ["GeoJSON", "GeoJSONSeq", "GPKG", "ESRI Shapefile", "FlatGeobuf"]
missing = [name for name in formats if not gdal.GDALGetDriverByName(name.encode())]
if missing:
    sys.exit(f"{sys.argv[1]}: expected the formats {missing}, found none of them")
print(gdal.GDALGetDriverCount(), "formats")
PYTHON
touch whole
