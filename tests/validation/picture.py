# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Draws curves as SVG, with nothing but the standard library and NumPy."""
import dataclasses
import html
import math
from typing import List, Tuple

import numpy as np

# Okabe and Ito's colours, which can be told apart with protanopia, deuteranopia and tritanopia.
BLUE, ORANGE, GREEN, RED, PURPLE, SKY, BLACK, GREY = (
    "#0072b2",
    "#e69f00",
    "#009e73",
    "#d55e00",
    "#cc79a7",
    "#56b4e9",
    "#1a1a1a",
    "#8a8a8a",
)
FONT = "DejaVu Sans, Verdana, Arial, sans-serif"
LEFT, RIGHT, TOP, BOTTOM = 58, 16, 34, 46


@dataclasses.dataclass
class Panel:
    """Holds the curves of one diagram. Limits are (low, high); `log_x` makes the abscissa logarithmic, and
    `down` lets the ordinate grow downwards, as for losses. `legend` is the corner of the legend: "tl", "tr",
    "bl" or "br"."""

    title: str
    x_label: str
    y_label: str
    x_limits: Tuple[float, float]
    y_limits: Tuple[float, float]
    log_x: bool = False
    down: bool = False
    legend: str = "tr"
    marks: List[dict] = dataclasses.field(default_factory=list)

    def line(self, x, y, label="", color=BLUE, width=1.6, dash=""):
        self.marks.append(dict(kind="line", x=x, y=y, label=label, color=color, width=width, dash=dash))

    def dots(self, x, y, label="", color=BLUE, radius=1.7):
        self.marks.append(dict(kind="dots", x=x, y=y, label=label, color=color, radius=radius))

    def band(self, x, low, high, label="", color=GREY):
        x, low, high = map(np.asarray, (x, low, high))
        self.marks.append(
            dict(
                kind="band",
                x=np.concatenate([x, x[::-1]]),
                y=np.concatenate([low, high[::-1]]),
                label=label,
                color=color,
            )
        )

    def upright(self, x, label, color=GREY):
        self.marks.append(dict(kind="upright", x=x, label=label, color=color))


def round_ticks(low, high, most=8):
    """Returns the multiples of 1, 2 or 5 times a power of ten between two limits, at most `most`."""
    step = 10.0 ** math.floor(math.log10((high - low) / most))
    while (high - low) / step > most:
        step *= 2.0 if str(step).strip("0.")[:1] in ("1", "5") else 2.5
    first = math.ceil(low / step - 1e-9)
    return [
        first * step + i * step
        for i in range(int((high - low) / step + 1 + 1e-9))
        if (first + i) * step <= high + 1e-9
    ]


def log_ticks(low, high):
    """Returns (value, label) of the ticks of a logarithmic axis, with labels at 1, 2 and 5."""
    ticks = []
    for decade in range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1):
        for digit in range(1, 10):
            value = digit * 10.0**decade
            if low * 0.999 <= value <= high * 1.001:
                ticks.append((value, f"{value:g}" if digit in (1, 2, 5) else ""))
    return ticks


class _Frame:
    """Maps the values of a panel to pixels."""

    def __init__(self, panel: Panel, x: float, y: float, width: float, height: float):
        self.panel = panel
        self.left, self.top = x + LEFT, y + TOP
        self.width, self.height = width - LEFT - RIGHT, height - TOP - BOTTOM

    def x(self, value):
        low, high = self.panel.x_limits
        value = np.asarray(value, float)
        if self.panel.log_x:
            low, high, value = math.log10(low), math.log10(high), np.log10(np.maximum(value, 1e-30))
        return self.left + (value - low) / (high - low) * self.width

    def y(self, value):
        low, high = self.panel.y_limits
        share = (np.asarray(value, float) - low) / (high - low)
        return self.top + (share if self.panel.down else 1 - share) * self.height


def _text(x, y, text, anchor="middle", size=12, color=BLACK, turn=None, bold=False):
    turned = f' transform="rotate({turn} {x:.1f} {y:.1f})"' if turn is not None else ""
    weight = ' font-weight="bold"' if bold else ""
    attributes = f'font-size="{size}" text-anchor="{anchor}" fill="{color}"{weight}{turned}'
    return f'<text x="{x:.1f}" y="{y:.1f}" {attributes}>{html.escape(text)}</text>'


def _points(frame, x, y):
    return " ".join(f"{a:.1f},{b:.1f}" for a, b in zip(frame.x(x), frame.y(y)))


def _runs(x, y):
    """Cuts a curve where a value is not finite."""
    x, y = np.asarray(x, float), np.asarray(y, float)
    good = np.isfinite(x) & np.isfinite(y)
    edges = np.flatnonzero(np.diff(np.concatenate([[False], good, [False]]).astype(int)))
    return [(x[a:b], y[a:b]) for a, b in zip(edges[::2], edges[1::2])]


def _mark(frame, mark) -> List[str]:
    color = mark["color"]
    if mark["kind"] == "line":
        dash = f' stroke-dasharray="{mark["dash"]}"' if mark["dash"] else ""
        return [
            f'<polyline points="{_points(frame, x, y)}" fill="none" stroke="{color}" '
            f'stroke-width="{mark["width"]}" stroke-linejoin="round"{dash}/>'
            for x, y in _runs(mark["x"], mark["y"])
        ]
    if mark["kind"] == "band":
        return [
            f'<polygon points="{_points(frame, mark["x"], mark["y"])}" fill="{color}" fill-opacity="0.18"/>'
        ]
    if mark["kind"] == "dots":
        return [
            f'<circle cx="{a:.1f}" cy="{b:.1f}" r="{mark["radius"]}" fill="{color}" fill-opacity="0.75"/>'
            for a, b in zip(frame.x(mark["x"]), frame.y(mark["y"]))
            if math.isfinite(b)
        ]
    x = float(frame.x(mark["x"]))
    bottom = frame.top + frame.height
    return [
        f'<line x1="{x:.1f}" y1="{frame.top:.1f}" x2="{x:.1f}" y2="{bottom:.1f}" stroke="{color}" '
        'stroke-width="1" stroke-dasharray="2 3"/>',
        _text(x - 4, frame.top + 6, mark["label"], "end", 11, color, turn=-90),
    ]


def _grid(frame) -> List[str]:
    panel, parts = frame.panel, []
    right, bottom = frame.left + frame.width, frame.top + frame.height
    ticks = (
        log_ticks(*panel.x_limits) if panel.log_x else [(v, f"{v:.6g}") for v in round_ticks(*panel.x_limits)]
    )
    for value, label in ticks:
        x = float(frame.x(value))
        parts.append(f'<line x1="{x:.1f}" y1="{frame.top}" x2="{x:.1f}" y2="{bottom}" stroke="#e4e4e4"/>')
        if label:
            parts.append(_text(x, bottom + 16, label.replace("-", "−"), size=11))
    for value in round_ticks(*panel.y_limits):
        y = float(frame.y(value))
        parts.append(f'<line x1="{frame.left}" y1="{y:.1f}" x2="{right}" y2="{y:.1f}" stroke="#e4e4e4"/>')
        parts.append(_text(frame.left - 6, y + 4, f"{value:.6g}".replace("-", "−"), "end", 11))
    parts.append(_text(frame.left + frame.width / 2, bottom + 34, panel.x_label))
    parts.append(_text(frame.left - 44, frame.top + frame.height / 2, panel.y_label, turn=-90))
    parts.append(_text(frame.left, frame.top - 12, panel.title, "start", 13, bold=True))
    return parts


def _legend(frame) -> List[str]:
    shown = [m for m in frame.panel.marks if m["label"] and m["kind"] != "upright"]
    if not shown:
        return []
    width = 40 + 6.4 * max(len(m["label"]) for m in shown)
    height = 8 + 16 * len(shown)
    x = frame.left + 8 if "l" in frame.panel.legend else frame.left + frame.width - width - 8
    y = frame.top + 8 if "t" in frame.panel.legend else frame.top + frame.height - height - 8
    parts = [
        f'<rect x="{x:.1f}" y="{y:.1f}" width="{width:.1f}" height="{height}" fill="white" '
        'fill-opacity="0.85" stroke="#cccccc"/>'
    ]
    for i, mark in enumerate(shown):
        at = y + 15 + 16 * i
        if mark["kind"] == "line":
            dash = f' stroke-dasharray="{mark["dash"]}"' if mark["dash"] else ""
            parts.append(
                f'<line x1="{x + 6:.1f}" y1="{at - 4:.1f}" x2="{x + 28:.1f}" y2="{at - 4:.1f}" '
                f'stroke="{mark["color"]}" stroke-width="{max(mark["width"], 1.6)}"{dash}/>'
            )
        elif mark["kind"] == "band":
            parts.append(
                f'<rect x="{x + 6:.1f}" y="{at - 9:.1f}" width="22" height="10" fill="{mark["color"]}" '
                'fill-opacity="0.18"/>'
            )
        else:
            parts.append(
                f'<circle cx="{x + 17:.1f}" cy="{at - 4:.1f}" r="{max(mark["radius"], 2.5)}" '
                f'fill="{mark["color"]}"/>'
            )
        parts.append(_text(x + 34, at, mark["label"], "start", 11))
    return parts


def svg(panels: List[Panel], columns: int = 1, width: int = 560, height: int = 380) -> str:
    """Returns a picture of panels in rows of `columns`, each of `width` x `height` pixels."""
    rows = -(-len(panels) // columns)
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{columns * width}" height="{rows * height}" '
        f'viewBox="0 0 {columns * width} {rows * height}" font-family="{FONT}">',
        '<rect width="100%" height="100%" fill="white"/>',
    ]
    for i, panel in enumerate(panels):
        frame = _Frame(panel, i % columns * width, i // columns * height, width, height)
        box = f'x="{frame.left}" y="{frame.top}" width="{frame.width}" height="{frame.height}"'
        parts.append(f'<clipPath id="panel{i}"><rect {box}/></clipPath>')
        parts += _grid(frame)
        parts.append(f'<g clip-path="url(#panel{i})">')
        for mark in panel.marks:
            parts += _mark(frame, mark)
        parts.append("</g>")
        parts.append(f'<rect {box} fill="none" stroke="{BLACK}"/>')
        parts += _legend(frame)
    return "\n".join([*parts, "</svg>", ""])
