# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""html_report.py [PROGRAM] [BROWSER]: loads reports of `greatx inspect --html` in headless Chromium.

Data sets are made, and their reports are loaded without a network. Nothing may be requested, nothing may
fail or be reported on the console, and no page may be wider than its window (400 to 3840 pixels). Every
canvas must show something, the slider and the keys must change the panels of every sensor, and the pointer
must be told values. The page's numbers are compared with the data set by code that the page does not share:
unpacked blobs (zlib), the pixels of the paths' vertices (Brown-Conrady by its formula), the places
of LiDAR points, and a delay profile. Names that are HTML must stay text. Each check is then tried on pages
that are spoilt on purpose. Exit code 1: a fault; 77: there is no browser.
"""

import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import zlib
from base64 import b64decode

import numpy

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests" / "support"))
from page_browser import LISTENER, SKIPPED, Browser, console_of, outside  # noqa: E402

HOSTILE = "</script><img src=x onerror=document.title=1>'\"&amp;"
SMALL = """greatx: 1
name: small
ticks: 24
tick_rate_hz: 60
sequences: 2
scene: {generate: {kind: city, seed: 3, size_m: 120}}
nodes:
  - name: drone
    trajectory: {type: bezier, control_points_m: [[-30, -3, 20], [-10, -3, 18], [10, 3, 22], [30, 3, 20]]}
    sensors:
      - {name: wide, type: camera, rate_hz: 30, width: 320, height: 240, fov_deg: 80,
         outputs: [rgb, depth, ids, flow, normals, boxes, hdr],
         distortion: {k1: -0.25, k2: 0.05, p1: 0.001, p2: -0.0005}}
      - {name: lidar, type: lidar, rate_hz: 7, channels: 16, azimuth_steps: 360, elevation_min_deg: -40,
         elevation_max_deg: 10}
      - {name: antenna, type: antenna}
      - {name: pair, type: antenna, columns: 2}
  - name: mast
    trajectory: {type: static, position_m: [13, 13, 25]}
    sensors: [{name: panel, type: antenna, rows: 2, columns: 2}]
channels:
  - {name: csi, tx: mast/panel, rx: [drone/antenna], rate_hz: 20, carrier_hz: 3.5e9, bandwidth_hz: 100e6,
     subcarriers: 64}
  - {name: other, tx: mast/panel, rx: [drone/pair], rate_hz: 10, carrier_hz: 28e9, bandwidth_hz: 400e6}
"""

# Uses the page as a person does, and writes down what it shows.
PROBE = """<script>
window.addEventListener("load", async () => {
  const wait = ms => new Promise(done => setTimeout(done, ms));
  const boards = () => greatx.panels().flatMap(panel => [panel.board, panel.frequency, panel.delay])
    .filter(board => board && board.node.clientWidth > 0);
  const scratch = document.createElement("canvas");
  const read = canvas => {
    [scratch.width, scratch.height] = [canvas.width, canvas.height];
    const context = scratch.getContext("2d", {willReadFrequently: true});
    context.drawImage(canvas, 0, 0);
    return new Uint32Array(context.getImageData(0, 0, canvas.width, canvas.height).data.buffer);
  };
  const look = async () => {
    await wait(100);
    greatx.drawAll();
    while (!greatx.ready()) await wait(20);  // pictures are decoded by another clock than the page's
    greatx.drawAll();
    return boards().map(board => {
      const words = read(board.canvas);
      let hash = 7;
      for (const word of words) hash = (hash * 31 + word) | 0;
      return {name: board.canvas.getAttribute("aria-label"), colours: new Set(words).size, hash};
    });
  };
  const result = {faults: greatxFaults};
  try {
    const sequence = greatx.data.sequences[0], last = sequence.moments.length - 1;
    const slider = document.querySelector("input[type=range]");
    const press = key =>
      document.body.dispatchEvent(new KeyboardEvent("keydown", {key, bubbles: true}));
    result.first = await look();
    slider.value = last;
    slider.dispatchEvent(new Event("input"));
    result.atLast = greatx.state.moment;
    result.last = await look();
    press("ArrowLeft");
    result.afterLeft = greatx.state.moment;
    press("Home");
    result.afterHome = greatx.state.moment;
    const views = [];
    for (const select of document.querySelectorAll(".camera select"))
      for (const option of [...select.options]) {
        select.value = option.value;
        select.dispatchEvent(new Event("change"));
        const seen = await look();
        const board = select.closest(".camera").querySelector("canvas").getAttribute("aria-label");
        views.push([option.value, seen.find(entry => entry.name === board)]);
      }
    result.views = views;
    result.readouts = boards().map(board => {
      const box = board.canvas.getBoundingClientRect();
      board.canvas.dispatchEvent(new PointerEvent("pointermove", {clientX: box.left + box.width * 0.53,
        clientY: box.top + box.height * 0.5, bubbles: true}));
      const place = board.node.closest(".panel").querySelector(".readout");
      return [board.canvas.getAttribute("aria-label"), place ? place.textContent : ""];
    });
    const sensors = sequence.sensors, camera = sensors.find(s => s.kind === "camera" && s.about.fx);
    result.pixels = [];
    for (const channel of sensors.filter(s => s.kind === "csi"))
      for (const record of channel.records) {
        const eye = camera && camera.records.find(r => r.tick === record.tick);
        if (!eye || !record.paths || !eye.pose) continue;
        const blob = document.getElementById("b" + record.paths.blob).textContent;
        result.pixels.push({channel: channel.name, tick: record.tick, blob, camera: camera.name,
          places: greatx.textOf(record.paths.blob).map(row => {
            const places = [];
            for (let i = 0; i + 2 < row[6].length; i += 3)
              places.push(greatx.project(camera, eye, row[6].slice(i, i + 3)));
            return places;
          })});
      }
    result.clouds = sensors.filter(s => s.kind === "lidar").map(lidar => {
      const record = lidar.records[lidar.records.length - 1], cloud = greatx.cloudOf(record);
      return {lidar: lidar.name, tick: record.tick, all: record.points.all, count: cloud.count,
              step: record.points.step, places: Array.from(cloud.places.slice(0, 300)),
              instances: cloud.instances ? Array.from(cloud.instances.slice(0, 100)) : null};
    });
    const respond = sensors.filter(s => s.kind === "csi" && s.records[0] && s.records[0].links);
    result.profiles = respond.map(channel => {
      const pair = greatx.responseOf(channel, channel.records[0], {rx: 0, tx: 0}).pairs[0];
      return {channel: channel.name, re: Array.from(pair.re), im: Array.from(pair.im),
              profile: greatx.delayProfile(pair.re, pair.im)};
    });
    result.sums = [...document.querySelectorAll("script[type='text/plain']")].slice(0, 400).map(node => {
      if (node.textContent.startsWith("UklGR")) return null;  // RIFF: a picture
      let sum = 7;
      for (const byte of greatx.inflate(greatx.bytesOfBase64(node.textContent)))
        sum = (sum * 33 + byte) >>> 0;
      return [node.id, sum];
    }).filter(Boolean);
    const dark = () => getComputedStyle(document.body).backgroundColor;
    const before = dark();
    [...document.querySelectorAll("button")].find(node => node.textContent.includes("dark")).click();
    result.themes = [before, dark()];
  } catch (error) { result.faults.push("fault: " + error.stack); }
  const main = document.querySelector("#app");
  const named = node => node.getAttribute("aria-label") || node.closest("label") || node.textContent.trim();
  Object.assign(result, {text: main ? main.innerText : "", title: document.title,
    images: document.images.length,
    loaded: performance.getEntriesByType("resource").map(entry => entry.name),
    unlabelled: [...document.querySelectorAll("select, input, button, canvas[role]")]
      .filter(node => !named(node)).map(node => node.outerHTML),
    width: Math.max(main.scrollWidth, document.documentElement.scrollWidth - innerWidth),
    sections: [...document.querySelectorAll("section")].map(s => s.id)});
  const place = document.createElement("pre");
  place.id = "greatx-probe";
  place.textContent = JSON.stringify(result);
  document.body.append(place);
});
</script>"""
POLICY = re.compile(r'<meta http-equiv="Content-Security-Policy"[^>]*>\n')


class Faults(list):
    def expect(self, holds: bool, words: str) -> None:
        if not holds:
            self.append(words)


def report_of(program: str, data: pathlib.Path, *options: str) -> str:
    page = data.parent / (data.name + ".html")
    command = [program, "inspect", data, "--html", page, "--picture", data.parent / "sheet.png", *options]
    subprocess.run(command, check=True, capture_output=True)
    return page.read_text()


def data_of(page: str) -> dict:
    return json.loads(
        re.search(r'<script type="application/json" id="data">(.*?)</script>', page, re.DOTALL)[1]
    )


def check_pixels(seen: dict, data: dict, faults: Faults) -> int:
    """Projects the vertices of the page's paths by the formulas of docs/camera.md and docs/film.md."""
    sensors = {sensor["name"]: sensor for sensor in data["sequences"][0]["sensors"]}
    compared = 0
    for entry in seen["pixels"]:
        camera = sensors[entry["camera"]]
        record = next(r for r in camera["records"] if r["tick"] == entry["tick"])
        about, position, (w, x, y, z) = camera["about"], record["pose"][:3], record["pose"][3:]
        rotation = numpy.array(
            [
                [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
            ]
        )
        k1, k2, p1, p2, k3 = about.get("distortion", [0.0] * 5)
        paths = json.loads(zlib.decompress(b64decode(entry["blob"])))
        for path, places in zip(paths, entry["places"]):
            for vertex, found in zip(numpy.reshape(path[6], (-1, 3)), places):
                forward, left, up = rotation.T @ (vertex - position)
                if forward < 0.06:
                    faults.expect(found is None, f"expected no pixel behind the camera, found {found}")
                    continue
                if found is None:
                    continue  # beyond the radius at which the lens folds
                a, b = -left / forward, -up / forward
                s = a * a + b * b
                radial = 1 + k1 * s + k2 * s**2 + k3 * s**3
                u = about["cx"] + about["fx"] * (a * radial + 2 * p1 * a * b + p2 * (s + 2 * a * a))
                v = about["cy"] + about["fy"] * (b * radial + p1 * (s + 2 * b * b) + 2 * p2 * a * b)
                error = max(abs(u - found[0]), abs(v - found[1])) / max(1.0, abs(u), abs(v))
                faults.expect(
                    error < 1e-9 and abs(found[2] - forward) < 1e-9 * forward,
                    f"expected pixel {u, v}, found {found}",
                )
                compared += 1
    return compared


def check_arrays(seen: dict, data: dict, folder: pathlib.Path, faults: Faults) -> None:
    """Compares LiDAR points and H(f) with the files of the data set."""
    sequence, base = data["sequences"][0], folder / "sequence_0000"
    described = json.loads((folder / "dataset.json").read_text())["sensors"]
    numbers = {sensor["name"]: i for i, sensor in enumerate(described)}
    for cloud in seen["clouds"]:
        sensor = next(s for s in sequence["sensors"] if s["name"] == cloud["lidar"])
        pose = next(r for r in sensor["records"] if r["tick"] == cloud["tick"])["pose"]
        files = sorted((base / cloud["lidar"] / "points").glob("*.npy"))
        if not files or cloud["count"] != cloud["all"]:
            continue
        index = numpy.load(base / "index.npy")
        row = index[(index[:, 2] == numbers[cloud["lidar"]]) & (index[:, 0] == cloud["tick"])][0]
        points = numpy.load(base / cloud["lidar"] / "points" / f"{row[3]:06d}.npy")[:100, :3].astype(float)
        w, v = pose[3], numpy.array(pose[4:])
        turned = points + 2 * numpy.cross(v, numpy.cross(v, points) + w * points) + pose[:3]
        error = numpy.abs(turned - numpy.reshape(cloud["places"], (-1, 3))[: len(points)]).max()
        faults.expect(
            error < cloud["step"],
            f"{cloud['lidar']}: expected points within {cloud['step']} m, found {error}",
        )
    for entry in seen["profiles"]:
        h = numpy.load(base / entry["channel"] / "cfr.npy")[0].squeeze()
        h = h.reshape(-1, h.shape[-1])[0] if h.ndim > 1 else h
        mine = numpy.array(entry["re"]) + 1j * numpy.array(entry["im"])
        error = numpy.abs(mine - h).max() / numpy.abs(h).max()
        faults.expect(
            error < 1e-3, f"{entry['channel']}: expected the data set's H(f), found a difference of {error}"
        )
        window = 0.5 - 0.5 * numpy.cos(2 * numpy.pi * (numpy.arange(len(h)) + 0.5) / len(h))
        profile = (
            numpy.abs(numpy.fft.ifft(h * window, len(entry["profile"])) * len(entry["profile"]))
            / window.sum()
        )
        found, top = numpy.array(entry["profile"]), 20 * numpy.log10(profile.max())
        strong = profile > 1e-2 * profile.max()
        error = numpy.abs(20 * numpy.log10(profile[strong]) - found[strong]).max()
        faults.expect(
            error < 0.05,
            f"{entry['channel']}: expected the delay profile within 0.05 dB, found {error} of {top}",
        )


def faults_of(page: str, browser: Browser, folder: pathlib.Path, width: int = 1280) -> tuple[Faults, dict]:
    faults, data = Faults(), data_of(page)
    for address in outside(page):
        faults.append(f"expected nothing from outside of the page, found {address}")
    faults.expect(POLICY.search(page) is not None, "expected a content security policy")
    probed = POLICY.sub("", page).replace("<head>", "<head>" + LISTENER, 1)
    probed = probed.replace("</body>", PROBE + "</body>")
    if width < 500:  # Chromium's windows are not narrower
        probed = probed.replace("</style>", f"html {{ width: {width}px }}</style>")
    seen, console = browser.probe(probed, f"--window-size={width},1000")
    faults.extend(seen["faults"] + [f"console: {line}" for line in console])
    if "themes" not in seen:
        return faults, seen
    faults.extend(f"expected no request, found {a[:80]}" for a in seen["loaded"] if not a.startswith("data:"))
    faults.extend(f"expected a label of {node[:120]}" for node in seen["unlabelled"])
    faults.expect(seen["width"] <= width, f"expected a page of {width} pixels, found {seen['width']}")
    last = len(data["sequences"][0]["moments"]) - 1
    faults.expect(seen["atLast"] == last, "expected the slider to go to the last moment")
    faults.expect(seen["afterLeft"] == max(0, last - 1), "expected the left arrow to go back")
    faults.expect(seen["afterHome"] == 0, "expected Home to go to the first moment")
    for entry in seen["last"]:
        faults.expect(entry["colours"] > 2, f"expected something on '{entry['name']}', found it blank")
    # Nothing is drawn of a quantity without values; a channel of targets may have the same paths for ever.
    constant = {"delay profile"} | {
        f"{line['title']} over time"
        for part in data["sequences"][0]["series"]
        for line in part["lines"]
        if all(value is None for value in line["values"])
    }
    for first, then in zip(seen["first"], seen["last"]):
        faults.expect(
            last == 0 or first["hash"] != then["hash"] or first["name"] in constant,
            f"expected '{first['name']}' to change with the slider",
        )
    most = {}
    for view, entry in seen["views"]:
        # A camera may see a single object.
        most[view] = max(most.get(view, 0), entry["colours"])
        faults.expect(entry["colours"] > 0, f"expected view {view} of '{entry['name']}', found it blank")
    for view, colours in most.items():
        faults.expect(colours > 2, f"expected view {view} of some camera, found it blank")
    for name, text in seen["readouts"]:
        if name.startswith(("picture", "magnitude", "map", "uav/radar")) or name.endswith("over time"):
            faults.expect(
                bool(re.search(r"\d", text)), f"expected values under the pointer on '{name}', found '{text}'"
            )
    faults.expect(seen["themes"][0] != seen["themes"][1], "expected two themes")
    sums = dict(seen["sums"])
    for name, text in re.findall(r'<script type="text/plain" id="(b\d+)">([^<]*)</script>', page):
        if name in sums:
            mine = 7
            for byte in zlib.decompress(b64decode(text)):
                mine = (mine * 33 + byte) & 0xFFFFFFFF
            faults.expect(mine == sums[name], f"expected blob {name} as zlib unpacks it")
    seen["compared"] = check_pixels(seen, data, faults)
    check_arrays(seen, data, folder, faults)
    return faults, seen


def check_policy(page: str, browser: Browser, faults: Faults) -> None:
    """The page as it is must work under its own policy, which must stop a foreign script."""
    done = browser.run(page, "--dump-dom", "--window-size=1280,1000")
    faults.expect(
        "<section" in done.stdout and not console_of(done),
        f"expected the page to run, found {console_of(done)}",
    )
    foreign = page.replace("</body>", "<script>document.title = 'foreign';</script></body>")
    done = browser.run(foreign, "--dump-dom", "--window-size=1280,1000")
    faults.expect("<title>foreign" not in done.stdout, "expected the policy to stop a foreign script")


def check_names(program: str, data: pathlib.Path, browser: Browser, faults: Faults) -> None:
    """Names that are HTML must be shown as text."""
    other = data.parent / "hostile"
    shutil.copytree(data, other)
    info = json.loads((other / "dataset.json").read_text())
    info["run"]["scenario"] = HOSTILE
    for instance in info["run"]["instances"]:
        instance["name"] = HOSTILE
    info["run"]["materials"] = [HOSTILE] * len(info["run"]["materials"])
    info["run"]["semantic_classes"] = [HOSTILE] * len(info["run"]["semantic_classes"])
    (other / "dataset.json").write_text(json.dumps(info))
    page = report_of(program, other)
    found, seen = faults_of(page, browser, other)
    faults.extend(f"hostile names: {fault}" for fault in found)
    faults.expect(seen["images"] == 0, "expected no picture from a name")
    faults.expect(HOSTILE in seen["title"], f"expected the name as title, found {seen['title']}")
    faults.expect(HOSTILE in seen["text"], "expected the name in the text of the page")


def spoilt(page: str) -> list[tuple[str, str, str]]:
    """Returns (what is wrong, the page with it, a part of the words that must be found)."""
    end = "</body>"
    blob = re.search(r'id="b\d+">(e[AFJN][A-Za-z0-9+/]{60})', page)[1]  # a zlib header
    return [
        ("a picture from outside", page.replace(end, '<img src="https://a.test/x.png"/>' + end), "outside"),
        ("no policy", POLICY.sub("", page), "policy"),
        ("a script that fails", page.replace(end, "<script>undefinedName();</script>" + end), "fault"),
        ("a script that complains", page.replace(end, "<script>console.error(1);</script>" + end), "console"),
        ("a damaged blob", page.replace(blob, blob[:8] + "A" * 56), "fault"),
        (
            "a slider that does nothing",
            page.replace("input: event => goTo", "inputs: event => goTo"),
            "slider",
        ),
        (
            "a lens of the other sign",
            page.replace("2 * p1 * x * y + p2", "2 * p1 * x * y - p2"),
            "expected pixel",
        ),
        ("blank canvases", page.replace("this.draw(context, width, height);\n  }", "}"), "blank"),
        ("a page too wide", page.replace("</style>", "#app { min-width: 2000px }</style>"), "pixels"),
        (
            "one theme",
            page.replace("setTheme(isDark() ?", "setTheme(true ?").replace(
                "'light' : 'dark'", "'light' : 'light'"
            ),
            "themes",
        ),
        ("a delay profile without a window", page.replace("re[k] * window", "re[k]"), "delay profile"),
    ]


def main(program: str, chromium: str) -> int:
    if not chromium:
        print("skipped: no Chromium is installed (Debian: chromium), so no page is loaded")
        return SKIPPED
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as name:
        folder, wrong = pathlib.Path(name), Faults()
        browser = Browser(chromium, folder, budget_ms=10_000_000)
        (folder / "small.yaml").write_text(SMALL)
        sets = {
            "small": [folder / "small.yaml"],
            "city": ["city", "--ticks", "3"],
            "isac": ["city_isac", "--ticks", "3"],
            "rig": ["city_rig", "--ticks", "2"],
            "room": ["room", "--ticks", "4"],
        }
        pages = {}
        for key, arguments in sets.items():
            command = [program, "generate", *arguments, "-o", folder / key, "-q"]
            subprocess.run(command, check=True, capture_output=True)
            pages[key] = report_of(program, folder / key)
            for width in [400, 1280, 3840] if key in ("small", "city") else [1280]:
                faults, seen = faults_of(pages[key], browser, folder / key, width)
                wrong.extend(f"{key}, {width} pixels wide: {fault}" for fault in faults)
            print(
                f"{key}: {len(pages[key]) / 1e6:.2f} MB, sections {', '.join(seen['sections'])}, "
                f"{len(seen.get('first', []))} canvases, {seen.get('compared', 0)} vertices compared"
            )
        wrong.expect(seen is not None and len(pages) == len(sets), "expected all pages")
        check_policy(pages["small"], browser, wrong)
        check_names(program, folder / "small", browser, wrong)
        for what, changed, words in spoilt(pages["small"]):
            found, _ = faults_of(changed, browser, folder / "small")
            if changed == pages["small"] or not any(words in fault for fault in found):
                wrong.append(f"{what}: expected a fault with '{words}', found {found[:3]}")
    for words in wrong:
        print(words[:600])
    print(f"{len(pages)} pages, {len(wrong)} faults")
    return 1 if wrong else 0


if __name__ == "__main__":
    arguments = sys.argv[1:]
    if len(arguments) > 2 or "--help" in arguments:
        sys.exit(__doc__)
    program = arguments[0] if arguments else str(ROOT / "build" / "release" / "greatx")
    browsers = [arguments[1]] if len(arguments) > 1 else ["chromium", "chromium-browser", "google-chrome"]
    sys.exit(main(program, next(filter(None, map(shutil.which, browsers)), "")))
