# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""check_arrows.py ROOT: fails on an #include against the direction of dependencies that OVERVIEW.md draws."""
import pathlib
import re
import sys

# What each folder may include besides itself. shaders/ is the leaf that both languages read.
ARROWS = {
    "shaders": set(),
    "core": {"shaders"},
    "gpu": {"core", "shaders"},
    "scene": {"gpu", "core", "shaders"},
    "renderer": {"scene", "gpu", "core", "shaders"},
    "rf": {"scene", "gpu", "core", "shaders"},
    "io": {"core"},
    "sim": {"renderer", "rf", "scene", "gpu", "core", "shaders"},
    "assets": set(),
    "apps": {"sim", "io", "assets", "renderer", "rf", "scene", "gpu", "core"},
    "python": {"sim", "assets", "renderer", "rf", "scene", "gpu", "core"},
}
INCLUDE = re.compile(r'^\s*#include\s+"([^"]+)"', re.MULTILINE)


def main(root: pathlib.Path) -> int:
    faults, seen = [], 0
    for folder, allowed in ARROWS.items():
        for file in sorted((root / folder).rglob("*")):
            if file.suffix not in {".h", ".cpp"}:
                continue
            for include in INCLUDE.findall(file.read_text()):
                target = include.split("/")[0]
                seen += 1
                if "/" in include and target in ARROWS and target != folder and target not in allowed:
                    faults.append(f"{file.relative_to(root)}: includes {include}, but {folder} may not depend on {target}")
    print("\n".join(faults) or f"{seen} includes, all along the arrows")
    return 1 if faults or seen == 0 else 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1])))
