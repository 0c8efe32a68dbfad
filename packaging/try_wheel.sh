#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
#
# try_wheel.sh WHEEL: installs a wheel of packaging/wheel.sh in a fresh chroot that has no compiler and no
# Vulkan, as a user without root rights, and uses it: the default scenario for four ticks, its check, Python,
# a place, a radio map. Then it adds the machine's own lavapipe, which must take the bundled one's place. It
# needs root and debootstrap, and takes about five minutes. NumPy comes from PyPI, outside of the chroot.
#
# SUITE=trixie tries with another release of Debian, whose Python must be that of the wheel.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/chroot.sh"
[ $# -eq 1 ] && [ -f "$1" ] || die "expected the file of a wheel"
wheel=$(readlink -f "$1")
suite=${SUITE:-bookworm}
name=$suite-try
need_root
rm -rf "${chroots:?}/$name"
make_chroot "$name" "$suite"
packages "$name" python3 python3-venv
for tool in cc gcc c++ vulkaninfo glslangValidator; do
  [ ! -e "$chroots/$name/usr/bin/$tool" ] || die "expected a chroot without $tool"
done
[ ! -e "$chroots/$name/usr/share/vulkan" ] || die "expected a chroot without Vulkan drivers"

mkdir -p "$chroots/$name/wheels"
cp "$wheel" "$chroots/$name/wheels/"
version=$(enter "$name" python3 -c 'import sys; print("%d.%d" % sys.version_info[:2])')
python3 -m pip -q download --no-deps --only-binary :all: --python-version "$version" --platform \
  manylinux2014_x86_64 -d "$chroots/$name/wheels" numpy
chmod -R a+rX "$chroots/$name/wheels"
enter "$name" useradd --create-home tester
cp -r "$project/assets/examples/places/village" "$chroots/$name/home/tester/"
enter "$name" chown -R tester: /home/tester
as_user() { # as_user COMMAND: in the venv of the user
  enter "$name" su tester -c "set -e; cd; [ ! -d env ] || . env/bin/activate; $1"
}
timed() { # timed MESSAGE COMMAND
  local begin=$EPOCHREALTIME
  as_user "$2" >"$chroots/$name.log" 2>&1 || { tail -n 30 "$chroots/$name.log" >&2; die "$1: failed"; }
  awk -v a="$begin" -v b="$EPOCHREALTIME" -v what="$1" 'BEGIN {printf "  %6.1f s  %s\n", b - a, what}'
}

say "$(basename "$wheel"), $(stat -c %s "$wheel" | awk '{printf "%.1f MB", $1 / 1e6}')"
timed "venv" "python3 -m venv env"
timed "pip install" "pip -q install --no-index --find-links /wheels greatx"
as_user 'du -sm env/lib/python3*/site-packages/greatx*' >"$chroots/$name.size"
say "installed: $(awk '{s += $1} END {print s " MB"}' "$chroots/$name.size")"
timed "greatx --version" "greatx --version"
as_user "greatx info --json" >"$chroots/$name.info"
grep -q llvmpipe "$chroots/$name.info" || die "greatx info: expected the bundled lavapipe"
timed "generate city, 4 ticks" "greatx generate city --ticks 4 -o run -q"
timed "verify" "greatx verify run"
timed "inspect, with a contact sheet" "greatx inspect run"
timed "explain, paths" "greatx explain city >/dev/null; greatx paths room --brief"
timed "a radio map" "greatx map room --cell 1 -o map -q"
timed "a place: greatx scene build" \
  "cd village; greatx scene build village.yaml -q -o ../village.glb --report ../report"
timed "Python: load" "python3 - <<'PYTHON'
import greatx, greatx_engine, numpy as np
tick = greatx.load('run').at(3)
assert tick['uav/front'].rgb.ndim == 3 and np.isfinite(tick['csi'].cfr).all()
assert greatx_engine.program.is_file() and greatx_engine.lavapipe.is_file()
PYTHON"
case $wheel in
  *-py3-none-*)
    as_user "python3 -c 'import greatx; greatx.Simulation' 2>&1 | tail -n 1 | cut -c1-110"
    ;;
  *)
    timed "Python: Simulation, paths, H(f)" "python3 - <<'PYTHON'
import greatx, numpy as np
tick = greatx.load('run').at(3)
simulation = greatx.Simulation('city')
paths = simulation.paths('csi', tick=3)
assert len(paths) > 0
# The channel of Python is that of the command, bit by bit.
assert paths.cfr().tobytes() == np.ascontiguousarray(tick['csi'].cfr).tobytes()
PYTHON"
    timed "a module that runs beside NumPy's libraries" "python3 -c '
import numpy as np
np.linalg.svd(np.random.rand(200, 200))
import greatx
greatx.Simulation(\"room\").paths()'"
    ;;
esac

# The programs must find all libraries in the wheel or among those of every Linux, wherever it lies.
missing=$(as_user 'find env -name "*.so*" -o -path "*greatx_engine/bin/*" | xargs ldd 2>/dev/null' |
  grep 'not found' || true)
[ -z "$missing" ] || die "libraries are missing: $missing"
as_user 'mv env/lib/python3*/site-packages/greatx_engine moved; moved/bin/greatx info >/dev/null &&
  mv moved "$(echo env/lib/python3*/site-packages)/greatx_engine"' || die "the moved folder does not run"

bundled=$(as_user "greatx info" | grep -m 1 "llvmpipe Mesa")
packages "$name" mesa-vulkan-drivers
[ "$(as_user "greatx info" | grep -c "^[0-9]*: llvmpipe")" -eq 1 ] ||
  die "expected one lavapipe beside the machine's own drivers"
machine=$(as_user "greatx info" | grep -m 1 "llvmpipe Mesa")
[ "$machine" != "$bundled" ] || die "expected the machine's lavapipe in place of the bundled one"
say "bundled:$bundled"
say "the machine's:$machine"
own=$(as_user 'python3 -c "import greatx_engine; print(greatx_engine.lavapipe)"')
timed "the bundled driver in place of the machine's" \
  "VK_DRIVER_FILES=$own greatx info | grep -q 'llvmpipe Mesa'"
say "the wheel works"
