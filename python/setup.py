# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Builds CMake's target greatx_python in the project's build folder and puts the compiled module into the
wheel.

With GREATX_NATIVE=1, the module must be built. With 0, it is left out, nothing is compiled, and the package
only reads data sets. If the variable is not set, the module is built if the project has been built before, or
if CMake, Ninja and the shader compiler are installed. Nothing is written into python/.
"""
import contextlib
import os
import pathlib
import shutil
import subprocess
import sys
import sysconfig

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

HERE = pathlib.Path(__file__).resolve().parent
PROJECT = HERE.parent
SUFFIX = sysconfig.get_config_var("EXT_SUFFIX")


RELEASE = PROJECT / "build" / "release"
#: Build folder for a Python other than the one that the release build serves.
OWN = PROJECT / "build" / ("release" + SUFFIX.rsplit(".", 1)[0])


def wanted() -> bool:
    wish = os.environ.get("GREATX_NATIVE", "")
    if wish not in ("", "0", "1"):
        sys.exit(f"GREATX_NATIVE: expected 0, 1 or nothing, found {wish!r}")
    if wish == "0" or not (PROJECT / "CMakePresets.json").is_file():
        if wish == "1":
            sys.exit(f"GREATX_NATIVE=1: expected greatx's sources around {HERE}, found none")
        return False
    tools = all(shutil.which(tool) for tool in ("cmake", "ninja", "glslangValidator"))
    return wish == "1" or tools or (RELEASE / "build.ninja").is_file()


@contextlib.contextmanager
def progress_output():
    """Yields where the progress of a build goes.

    It is the terminal, since pip keeps standard output to itself, or None (standard output) without one.
    """
    try:
        terminal = open("/dev/tty", "w")
    except OSError:
        yield None
        return
    with terminal:
        terminal.write(
            "\nbuilding greatx's compiled module, which takes some minutes if nothing is built yet\n"
        )
        terminal.flush()
        yield terminal


class CMakeBuild(build_ext):
    def build_extension(self, extension):
        target = pathlib.Path(self.get_ext_fullpath(extension.name))
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(self.built(), target)

    def built(self) -> pathlib.Path:
        for folder in (RELEASE, OWN):
            module = folder / "python" / "greatx" / ("_native" + SUFFIX)
            others = [path for path in module.parent.glob("_native.*.so") if path != module]
            configured = (folder / "build.ninja").is_file()
            if folder == RELEASE and (others or not configured):
                continue
            if not configured:
                self.run_cmake(
                    "cmake",
                    "--preset",
                    "release",
                    "-B",
                    folder,
                    "-DGREATX_TESTS=OFF",
                    f"-DGREATX_PYTHON={sys.executable}",
                )
            self.run_cmake("cmake", "--build", folder, "--target", "greatx_python")
            if module.is_file():
                return module
        sys.exit(
            f"{OWN}: built no _native{SUFFIX}: expected pybind11 and the headers of this Python "
            "(scripts/setup.sh), or GREATX_NATIVE=0 to install what reads data sets alone"
        )

    def run_cmake(self, *command):
        try:
            with progress_output() as output:
                subprocess.run([str(part) for part in command], cwd=PROJECT, check=True, stdout=output)
        except (OSError, subprocess.CalledProcessError) as error:
            sys.exit(
                f"the compiled module was not built: {error}; scripts/setup.sh installs what it needs, "
                "GREATX_NATIVE=0 installs what reads data sets alone"
            )


# setuptools writes its temporary files into the project's build folder, too.
scratch = PROJECT / "build" / "pip" if (PROJECT / "CMakePresets.json").is_file() else HERE / "build"
scratch.mkdir(parents=True, exist_ok=True)
setup(
    ext_modules=[Extension("greatx._native", sources=[])] if wanted() else [],
    cmdclass={"build_ext": CMakeBuild},
    options={"build": {"build_base": str(scratch)}, "egg_info": {"egg_base": str(scratch)}},
)
