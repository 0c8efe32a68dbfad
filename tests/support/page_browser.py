# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Loads pages that have everything in themselves in headless Chromium, without a network.

A test puts LISTENER before everything else in a page and a probe at its end. The probe writes JSON into an
element <pre id="greatx-probe">, which Browser.probe() returns.
"""

import base64
import html
import json
import pathlib
import re
import subprocess
import sys
from dataclasses import dataclass

SKIPPED = 77  # the exit code that ctest counts as skipped
HIGHEST = 16000  # pixels; beyond some height Chromium's screenshots are blank

# Sees every fault of the page.
LISTENER = """<script>
window.greatxFaults = [];
window.addEventListener("error", event => greatxFaults.push(
  "fault: " + (event.message || "cannot load " + (event.target.src || event.target.href))), true);
window.addEventListener("unhandledrejection", event => greatxFaults.push("fault: " + event.reason));
</script>"""

# Counts the colours of rectangles of a screenshot. Chromium itself decodes the picture.
COUNTER = """<!DOCTYPE html><img id="shot" src="data:image/png;base64,{png}"/><script>
window.addEventListener("load", () => {{
  const shot = document.getElementById("shot"), canvas = document.createElement("canvas");
  [canvas.width, canvas.height] = [shot.naturalWidth, shot.naturalHeight];
  const context = canvas.getContext("2d");
  context.drawImage(shot, 0, 0);
  const counts = {boxes}.map(([x, y, width, height]) => {{
    const bytes = context.getImageData(x, y, Math.max(1, width), Math.max(1, height)).data;
    return new Set(new Uint32Array(bytes.buffer)).size;
  }});
  document.body.innerHTML = '<pre id="greatx-probe"></pre>';
  document.getElementById("greatx-probe").textContent = JSON.stringify(counts);
}});
</script>"""


@dataclass
class Browser:
    """Runs the browser on files of one folder, without a network."""

    program: str
    folder: pathlib.Path
    budget_ms: int = 5000  # of the page's own clock

    def run(self, page: str, *options: str) -> subprocess.CompletedProcess:
        file = self.folder / "page.html"
        file.write_text(page)
        command = [self.program, "--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars"]
        command += ["--enable-logging=stderr", "--host-resolver-rules=MAP * ~NOTFOUND"]
        command += [f"--user-data-dir={self.folder / 'profile'}", f"--virtual-time-budget={self.budget_ms}"]
        return subprocess.run(
            [*command, *options, file.as_uri()], capture_output=True, text=True, timeout=120
        )

    def probe(self, page: str, *options: str) -> tuple[object, list[str]]:
        """Returns what a script of the page has written into #greatx-probe, and the lines of the console."""
        done = self.run(page, "--dump-dom", *options)
        found = re.search(r'<pre id="greatx-probe">(.*?)</pre>', done.stdout, re.DOTALL)
        if found is None:
            sys.exit(f"expected a rendered page, exit code {done.returncode}:\n{done.stderr}")
        return json.loads(html.unescape(found[1])), console_of(done)

    def colours(self, page: str, boxes: list[list[int]], width: int, height: int) -> list[int]:
        """Returns how many colours each rectangle of a screenshot of the page has."""
        if height > HIGHEST:
            sys.exit(f"expected a page of at most {HIGHEST} pixels for a screenshot, found {height}")
        picture = self.folder / "shot.png"
        picture.unlink(missing_ok=True)
        done = self.run(page, f"--screenshot={picture}", f"--window-size={width},{height}")
        if not picture.exists():
            sys.exit(f"expected a screenshot, exit code {done.returncode}:\n{done.stderr}")
        counter = COUNTER.format(png=base64.b64encode(picture.read_bytes()).decode(), boxes=json.dumps(boxes))
        return self.probe(counter)[0]


def console_of(done: subprocess.CompletedProcess) -> list[str]:
    return [line for line in done.stderr.splitlines() if "CONSOLE" in line]


def outside(page: str) -> list[str]:
    """Returns addresses in the text of the page that would be loaded and are not within the page."""
    attribute = r'(?:src|href|srcset)\s*=\s*["\']?([^"\'\s>]+)'
    loaded = re.findall(r"<(?:[^a\s>][^\s>]*|a[^\s>]+)\s[^>]*?" + attribute, page)  # of all tags but <a>
    loaded += re.findall(r'url\(\s*["\']?([^"\')]+)', page) + re.findall(r'@import\s+["\']?([^"\';]+)', page)
    return [address for address in loaded if not address.startswith(("data:", "#"))]
