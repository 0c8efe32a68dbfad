# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""check_page.py PROGRAM BROWSER: loads the page of `greatx tradeoff` in headless Chromium.

Small studies of the program are made, and their index.html is loaded. The page must show every knob of
tradeoff.json: its section, a row of the table for each setting, its plot, and its pictures. Nothing may come
from outside of the page, nothing may fail or be reported on the console, and a screenshot must have every
plot and every picture. Each check is then tried on pages that are spoilt on purpose. Without a browser
(BROWSER is empty or ends in NOTFOUND) the exit code is 77, which ctest counts as skipped.
"""

import html
import json
import pathlib
import re
import subprocess
import sys
import tempfile
from dataclasses import dataclass, field

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from page_browser import LISTENER, SKIPPED, Browser, outside  # noqa: E402

# The first one is also spoilt.
STUDIES = [["city", "--only", "lidar", "--knob", "beam.rings"], ["canyon", "--only", "map"]]
WIDTH = 1160

# Describes what is rendered, as JSON in the last element.
PROBE = """<script>
window.addEventListener("load", () => {
  const boxOf = node => {
    const box = node.getBoundingClientRect();
    return [box.left + scrollX, box.top + scrollY, box.width, box.height].map(Math.round);
  };
  const sections = [...document.querySelectorAll("section")].map(node => ({
    id: node.id,
    title: (node.querySelector("h3") || {}).innerText || "",
    rows: [...node.querySelectorAll("tr")].map(row => [...row.children].map(cell => cell.innerText)),
    plots: [...node.querySelectorAll("svg")].map(svg => ({
      box: boxOf(svg), text: [...svg.querySelectorAll("text")].map(text => text.textContent).join(" | "),
      marks: svg.querySelectorAll("circle").length})),
    images: [...node.querySelectorAll("img")].map(image => ({
      alt: image.alt, width: image.naturalWidth, box: boxOf(image)}))}));
  const result = document.createElement("pre");
  result.id = "greatx-probe";
  result.textContent = JSON.stringify({
    faults: greatxFaults, sections, text: document.body.innerText,
    loaded: performance.getEntriesByType("resource").map(entry => entry.name),
    links: [...document.querySelectorAll("a")].map(link => link.getAttribute("href")),
    width: document.documentElement.scrollWidth, height: document.documentElement.scrollHeight});
  document.body.append(result);
});
</script>"""


@dataclass
class Faults:
    """What is wrong with a page."""

    found: list[str] = field(default_factory=list)

    def expect(self, holds: bool, words: str) -> None:
        if not holds:
            self.found.append(words)


def check_knob(knob: dict, report: dict, section: dict, faults: Faults) -> None:
    name = f"{knob['modality']} {knob['name']}"
    faults.expect(section["title"] == knob["name"], f"{name}: expected its name as title: {section['title']}")
    if not knob["settings"]:
        return
    rows = {row[0]: row[1:] for row in section["rows"]}
    width = max(len(setting["errors"]) for setting in knob["settings"])
    for setting in knob["settings"]:
        row = rows.get(setting["label"], [])
        faults.expect(
            len(row) == 4 + width and all(row[:4]) and (width == 0 or row[4] != ""),
            f"{name}: expected a full row of {setting['label']} in the table, found {row}",
        )
    faults.expect(len(section["plots"]) == 1, f"{name}: expected one plot, found {len(section['plots'])}")
    for plot in section["plots"]:
        faults.expect(
            plot["marks"] == len(knob["settings"]),
            f"{name}: expected a mark of each setting in the plot, found {plot['marks']}",
        )
        for words in [f"{report['device']}, {report['cores']} cores", f"reference {knob['reference']}"]:
            faults.expect(words in plot["text"], f"{name}: expected '{words}' in the plot: {plot['text']}")
    pictures = sum(setting["picture"] != "" for setting in knob["settings"])
    faults.expect(
        len(section["images"]) >= min(2, pictures),
        f"{name}: expected pictures of {pictures} settings, found {len(section['images'])}",
    )


def faults_of(page: str, report: dict, browser: Browser, look: bool = True) -> list[str]:
    """Returns in words what is wrong with the page, or nothing. `look` takes a screenshot, too."""
    faults = Faults()
    for address in outside(page):
        faults.expect(False, f"expected nothing from outside of the page, found {address}")
    probed = page.replace("<head>", "<head>" + LISTENER, 1).replace("</body>", PROBE + "</body>", 1)
    seen, console = browser.probe(probed, f"--window-size={WIDTH},1000")
    faults.found += seen["faults"] + [f"console: {line}" for line in console]
    for address in seen["loaded"]:
        faults.expect(address.startswith("data:"), f"expected no request, found one of {address[:80]}")
    faults.expect(report["device"] in seen["text"], f"expected the device {report['device']} in the text")
    faults.expect(seen["width"] <= WIDTH, f"expected a page that is not wider than {WIDTH}: {seen['width']}")
    sections = {section["id"]: section for section in seen["sections"]}
    for knob in report["knobs"]:
        anchor = f"{knob['modality']}-{knob['name']}".replace(" ", "_")
        faults.expect("#" + anchor in seen["links"], f"{anchor}: expected a link to it")
        if anchor in sections:
            check_knob(knob, report, sections[anchor], faults)
        else:
            faults.expect(False, f"{anchor}: expected a section, found {', '.join(sections)}")
    drawn = [item for section in seen["sections"] for item in section["plots"] + section["images"]]
    for image in [item for item in drawn if "alt" in item]:
        faults.expect(image["width"] > 0, f"expected a picture of '{image['alt']}', found none in its data")
    if not look:
        return faults.found
    boxes = [[0, 0, WIDTH, seen["height"]]] + [item["box"] for item in drawn]
    names = ["the page"] + [f"'{item.get('alt', item.get('text'))[:60]}'" for item in drawn]
    for name, colours in zip(names, browser.colours(page, boxes, WIDTH, seen["height"])):
        faults.expect(colours > 2, f"expected {name} in the screenshot, found it blank")
    return faults.found


def spoilt(page: str, report: dict) -> list[tuple[str, str, str]]:
    """Returns (what is wrong, the page with it, a part of the words that must be found)."""
    knob = report["knobs"][0]
    first, device = knob["settings"][0]["label"], html.escape(report["device"])
    plot = page.rindex("<svg")
    without_plot = page[:plot] + page[page.index("</svg>", plot) + 6 :]
    broken = re.sub(r"base64,[A-Za-z0-9+/]{200}", "base64,", page, count=1)
    end, loading = "</body>", "new Image().src = 'https://a.test/x.png'"
    return [
        ("a picture from outside", page.replace(end, '<img src="https://a.test/x.png"/>' + end), "outside"),
        ("a style that loads a font", page.replace("</style>", "b { src: url(x.woff) }</style>"), "outside"),
        ("a script that fails", page.replace(end, "<script>undefinedName();</script>" + end), "fault"),
        ("a script that complains", page.replace(end, "<script>console.error(1);</script>" + end), "console"),
        ("a script that loads", page.replace(end, f"<script>{loading}</script>" + end), "no request"),
        ("a knob without a section", page.replace('<section id="', '<section id="x'), "expected a section"),
        ("a knob without a row", page.replace(f"<td>{first}</td>", "<td>x</td>", 1), "full row"),
        ("a knob without a plot", without_plot, "one plot"),
        ("a plot without the device", page[:plot] + page[plot:].replace(device, "cpu"), "in the plot"),
        ("a plot in the colour of the paper", page.replace("<svg", '<svg opacity="0"'), "blank"),
        ("a damaged picture", broken, "found none in its data"),
        ("an empty page", page.replace("</style>", "body > * { visibility: hidden }</style>"), "blank"),
    ]


def main(program: str, chromium: str) -> int:
    if not chromium or chromium.endswith("NOTFOUND"):
        print("skipped: no Chromium is installed (Debian: chromium), so the page is not loaded")
        return SKIPPED
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as name:
        folder = pathlib.Path(name)
        browser = Browser(chromium, folder)
        studies, wrong = [], []
        for number, study in enumerate(STUDIES):
            output = folder / str(number)
            command = [program, "tradeoff", *study, "--quick", "--quiet", "-o", output]
            subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
            page = (output / "index.html").read_text()
            studies.append((page, json.loads((output / "tradeoff.json").read_text())))
            wrong += [f"the page of {study}: {fault}" for fault in faults_of(*studies[-1], browser)]
        page, report = studies[0]
        for what, changed, words in spoilt(page, report):
            found = faults_of(changed, report, browser, look=words == "blank")
            if changed == page or not any(words in fault for fault in found):
                wrong.append(f"{what}: expected a fault with '{words}', found {found}")
    for words in wrong:
        print(words)
    print(f"{len(studies)} pages, {len(wrong)} faults")
    return 1 if wrong else 0


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    sys.exit(main(sys.argv[1], sys.argv[2]))
