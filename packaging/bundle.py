#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Makes a wheel with the engine from the wheel of the Python package and an installed prefix.

usage: bundle.py BASE_WHEEL PREFIX --driver ICD_JSON [--replace FOLDER] [--any-python]
                 --out FOLDER

    BASE_WHEEL ─► greatx/ with _native ┐
    PREFIX     ─► bin/, share/         ├─► libraries that they need (ldd), without those of every Linux
    ICD_JSON   ─► lavapipe             ┘     ─► copies with names of their own (patchelf) ─► greatx-…whl

A library that every Linux of the tag has stays outside: the C and C++ runtimes. In particular the drivers of
the machine's own GPU need its own libstdc++. All others come along. Each gets a name that no other package
has, because a process has one library of a name only, and may need another version of it: NumPy's, OpenCV's,
or that of a driver. Some keep their names (KEPT).

With --any-python, the wheel has no compiled module and fits every Python: the command and all that reads data
sets. pip prefers the other one where it fits, too.

The tag states the newest version of glibc of which a symbol is used. The files are sorted and have one date,
so the same input gives the same bytes. It runs on Debian, whose packages say under which licence a library
is; the wheel has the text of each.
"""

import argparse
import base64
import hashlib
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import zipfile

#: Libraries of the machine (PEP 600: every Linux with that glibc has them).
OUTSIDE = re.compile(
    r"^(linux-vdso|ld-linux.*|libc|libm|libdl|librt|libpthread|libresolv|libutil|libgcc_s|libstdc\+\+)\.so"
)
#: GLFW and the machine's drivers load these by name, or pass their objects to each other; one process must
#: have one of them. Their interfaces are old and stable.
KEPT = {"libvulkan.so.1", "libX11.so.6", "libxcb.so.1", "libXau.so.6", "libXdmcp.so.6"}
DATE = (2026, 1, 1, 0, 0, 0)


def run(*command):
    return subprocess.run([str(part) for part in command], check=True, capture_output=True, text=True).stdout


def is_elf(path):
    return path.is_file() and not path.is_symlink() and path.open("rb").read(4) == b"\x7fELF"


def needed(path):
    """Returns the names of the libraries that a file itself needs."""
    names = re.findall(r"\(NEEDED\).*\[(.+)\]", run("readelf", "--wide", "--dynamic", path))
    return [name for name in names if not OUTSIDE.match(name)]


def places_of(path):
    """Returns where the loader finds each library that a file needs, directly or not, by name."""
    places = {}
    for line in run("ldd", path).splitlines():
        match = re.match(r"\s*(\S+) => (.+?) \(0x", line)
        if match:
            places[match.group(1)] = pathlib.Path(match.group(2))
        elif "not found" in line:
            sys.exit(f"{path}: expected {line.split()[0]} to be installed, found none")
    return places


def own_name(name, file):
    """Returns the name of a library in the wheel: libpng16.so.16 becomes libpng16-1f2e3d4c.so.16."""
    if name in KEPT:
        return name
    digest = hashlib.sha256(file.read_bytes()).hexdigest()[:8]
    stem, dot, version = name.partition(".so")
    return f"{stem}-{digest}{dot}{version}"


class Engine:
    """The folder greatx_engine of the wheel, and the files whose names and places in it are not those of the
    machine."""

    def __init__(self, root):
        self.root = root
        self.lib = root / "greatx_engine" / "lib"
        self.lib.mkdir(parents=True)
        self.sources = {}  # name in the wheel: file on this machine
        self.built = set()  # names in the wheel of those that small_libraries.sh has built instead
        self.names = {}  # name on this machine: name in the wheel

    def add_libraries(self, of, replaced, places=None):
        """Adds what a file needs, directly or not, with `replaced` in place of the libraries of these
        names."""
        places = places_of(of) if places is None else places
        for name in needed(of):
            if name in self.names:
                continue
            file = replaced.get(name, places.get(name))
            self.names[name] = own_name(name, file)
            self.sources[self.names[name]] = places[name].resolve()
            if name in replaced:
                self.built.add(self.names[name])
            shutil.copy(file, self.lib / self.names[name])
            self.add_libraries(file, replaced, places_of(file) if name in replaced else places)

    def patch(self, path, rpath):
        """Makes a file look for the libraries in the wheel, by their names in it."""
        path.chmod(0o755)
        before = run("patchelf", "--print-needed", path).split()
        after = [self.names.get(name, name) for name in before]
        changes = [("--replace-needed", *pair) for pair in zip(before, after) if pair[0] != pair[1]]
        # One kind of change in each call: patchelf 0.14 of Debian 12 forgets some of several kinds.
        run("patchelf", "--set-rpath", rpath, path)
        if changes:
            run("patchelf", *(word for change in changes for word in change), path)
        if path.parent == self.lib:
            run("patchelf", "--set-soname", path.name, path)
        if run("patchelf", "--print-needed", path).split() != after:
            sys.exit(f"{path.name}: expected patchelf to write {after}, found others")


def glibc_of(path):
    """Returns the newest version of glibc of which a file uses a symbol, as (2, 36)."""
    versions = re.findall(r"\bGLIBC_(\d+)\.(\d+)", run("readelf", "--wide", "--version-info", path))
    return max(((int(a), int(b)) for a, b in versions), default=(2, 0))


def owners_of(files):
    """Returns the package of each file, by one call of dpkg-query. A library may be known to it by its place
    before /lib became a link to /usr/lib."""
    places = {place: file for file in files for place in (str(file), str(file).removeprefix("/usr"))}
    found = subprocess.run(["dpkg-query", "-S", *places], capture_output=True, text=True).stdout
    pairs = [line.rsplit(": ", 1) for line in found.splitlines()]
    return {places[place]: package for package, place in pairs}


def licences(engine, into):
    """Writes the licence of every bundled library, and a table of them."""
    into.mkdir(parents=True)
    owners = owners_of(engine.sources.values())
    names = sorted(set(owners.values()))
    form = "${Package},${Version},${source:Package},${source:Version}\n"
    fields = {line.split(",")[0]: line for line in run("dpkg-query", "-W", "-f", form, *names).splitlines()}
    rows = ["file,package,version,source package,source version,how"]
    for name, file in sorted(engine.sources.items()):
        row = fields[owners[file].split(":")[0]]
        how = "built from this source with less in it" if name in engine.built else "as it is"
        rows.append(f"{name},{row},{how}")
        package = row.split(",")[0]
        text = pathlib.Path("/usr/share/doc") / package / "copyright"
        if not text.is_file():
            sys.exit(f"{file}: expected its licence in {text}, found none")
        shutil.copy(text, into / (package + ".txt"))
    # Copyright files of Debian name these texts instead of repeating them.
    for text in pathlib.Path("/usr/share/common-licenses").iterdir():
        if not text.is_symlink():
            shutil.copy(text, into / f"common-{text.name}.txt")
    (into / "LIBRARIES.csv").write_text("\n".join(rows) + "\n")


def write_wheel(root, info, tag, out):
    """Writes the wheel: PEP 427."""
    wheel = info / "WHEEL"
    wheel.write_text(re.sub(r"(?m)^Tag: .*$", f"Tag: {tag}", wheel.read_text()))
    (info / "entry_points.txt").write_text("[console_scripts]\ngreatx = greatx_engine:main\n")
    (info / "top_level.txt").write_text("greatx\ngreatx_engine\n")
    files = sorted(f for f in root.rglob("*") if f.is_file() and f != info / "RECORD")
    rows = []
    out = out / f"{info.name.removesuffix('.dist-info')}-{tag}.whl"
    part = out.with_suffix(".part")
    with zipfile.ZipFile(part, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        for file in files:
            data, name = file.read_bytes(), str(file.relative_to(root))
            digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
            rows.append(f"{name},sha256={digest},{len(data)}")
            write_file(archive, name, data, file.stat().st_mode)
        record = str(info.relative_to(root) / "RECORD")
        write_file(archive, record, ("\n".join([*rows, f"{record},,"]) + "\n").encode(), 0o644)
    part.rename(out)
    return out


def write_file(archive, name, data, mode):
    entry = zipfile.ZipInfo(name, DATE)
    entry.compress_type = zipfile.ZIP_DEFLATED
    entry.external_attr = (0o100755 if mode & 0o100 else 0o100644) << 16
    archive.writestr(entry, data)


def fill(engine, base, prefix, driver, replaced, any_python):
    """Puts the wheel's files into the engine's root. Returns the folder of the metadata."""
    root = engine.root
    with zipfile.ZipFile(base) as archive:
        archive.extractall(root)
    folder = root / "greatx_engine"
    shutil.copy(pathlib.Path(__file__).parent / "greatx_engine" / "__init__.py", folder)
    shutil.copytree(prefix / "bin", folder / "bin")
    shutil.copytree(prefix / "share", folder / "share", ignore=shutil.ignore_patterns("images"))
    programs = [*(folder / "bin").iterdir()]
    modules = [path for path in (root / "greatx").iterdir() if is_elf(path)]
    if not modules:
        sys.exit(f"{base}: expected the compiled module greatx._native, found none")
    while any_python and modules:
        modules.pop().unlink()

    description = json.loads(driver.read_text())
    library = pathlib.Path(description["ICD"]["library_path"])
    if not library.is_absolute():
        cache = run("ldconfig", "-p")
        place = re.search(rf"^\s*{re.escape(library.name)} .*=> (.*)$", cache, re.MULTILINE)
        library = pathlib.Path(place.group(1))
    for file in [*programs, *modules, library]:
        engine.add_libraries(file, replaced)
    # The machine's own description of lavapipe may name its library without a folder. The loader would then
    # find a bundled one of that name first.
    name = own_name(library.name, library)
    engine.sources[name] = library.resolve()
    shutil.copy(library, engine.lib / name)
    description["ICD"]["library_path"] = f"../lib/{name}"
    (folder / "vulkan").mkdir()
    (folder / "vulkan" / "lavapipe.json").write_text(json.dumps(description, indent=2) + "\n")
    if any(name.startswith("libproj") for name in engine.names):  # PROJ looks for it beside its own folder
        (folder / "share" / "proj").mkdir()
        shutil.copy("/usr/share/proj/proj.db", folder / "share" / "proj")

    for path in programs:
        engine.patch(path, "$ORIGIN/../lib")
    for path in modules:
        engine.patch(path, "$ORIGIN/../greatx_engine/lib")
    for path in engine.lib.iterdir():
        engine.patch(path, "$ORIGIN")
    info = next(root.glob("*.dist-info"))
    licences(engine, info / "licenses" / "bundled")
    shutil.copy(prefix / "share" / "doc" / "greatx" / "LICENSE", info / "licenses")
    return info


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("base", type=pathlib.Path)
    parser.add_argument("prefix", type=pathlib.Path)
    parser.add_argument("--driver", type=pathlib.Path, required=True)
    parser.add_argument("--replace", type=pathlib.Path, help="libraries that take the place of Debian's")
    parser.add_argument("--any-python", action="store_true")
    parser.add_argument("--out", type=pathlib.Path, required=True)
    options = parser.parse_args()
    replaced = {file.name: file for file in (options.replace.iterdir() if options.replace else ())}
    options.out.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        engine = Engine(pathlib.Path(folder))
        info = fill(engine, options.base, options.prefix, options.driver, replaced, options.any_python)
        glibc = max(glibc_of(path) for path in engine.root.rglob("*") if is_elf(path))
        python, abi = ("py3", "none") if options.any_python else options.base.stem.split("-")[-3:-1]
        tag = f"{python}-{abi}-manylinux_{glibc[0]}_{glibc[1]}_x86_64"
        wheel = write_wheel(engine.root, info, tag, options.out)
        sizes = {path: path.stat().st_size for path in engine.root.rglob("*") if path.is_file()}
    print(f"{wheel}: {wheel.stat().st_size / 1e6:.1f} MB, installed {sum(sizes.values()) / 1e6:.1f} MB")
    for path in sorted(sizes, key=lambda path: -sizes[path])[:8]:
        print(f"  {sizes[path] / 1e6:6.1f} MB  {path.name}")


if __name__ == "__main__":
    main()
