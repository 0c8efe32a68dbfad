# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""check_docs_scenarios.py PROGRAM FILE...: checks that `greatx explain` accepts every whole scenario in the
documentation. A whole scenario is a block of YAML that begins with the format's version. The check fails on
the first one that is refused, and if there is none."""
import pathlib
import re
import subprocess
import sys
import tempfile


def main(program: str, files: list[str]) -> int:
    count = 0
    with tempfile.TemporaryDirectory() as folder:
        for file in map(pathlib.Path, files):
            text = file.read_text(encoding="utf-8")
            for block in re.finditer(r"^```yaml\n(greatx: .*?)^```$", text, re.DOTALL | re.MULTILINE):
                line = text[: block.start()].count("\n") + 2
                scenario = pathlib.Path(folder, f"{file.stem}_{line}.yaml")
                scenario.write_text(block[1], encoding="utf-8")
                run = subprocess.run(
                    [program, "explain", scenario], capture_output=True, text=True, check=False
                )
                if run.returncode != 0:
                    print(f"{file}:{line}: greatx explain ends with {run.returncode}\n{run.stderr}")
                    return 1
                count += 1
    print(f"{count} scenarios")
    return 0 if count > 0 else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], sys.argv[2:]))
