# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Shows a camera's ground truth: optical flow in colours and as Middlebury's .flo, and boxes in the picture.

    greatx generate uav_medium -o out/truth        # a camera with `outputs: [rgb, depth, ids, flow, boxes]`
    python3 python/examples/truth.py out/truth

Writes flow.png, flow.flo, boxes.png for the middle frame of the first camera that has flow and boxes.
"""
import struct
import sys
import zlib

import numpy as np

import greatx


def write_png(path, rgb):
    """Writes a picture, uint8 [h, w, 3]."""

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    h, w, _ = rgb.shape
    rows = np.concatenate([np.zeros((h, 1), np.uint8), rgb.reshape(h, 3 * w)], axis=1).tobytes()
    with open(path, "wb") as file:
        file.write(
            b"\x89PNG\r\n\x1a\n"
            + chunk(b"IHDR", struct.pack(">IIBBBBB", w, h, 8, 2, 0, 0, 0))
            + chunk(b"IDAT", zlib.compress(rows))
            + chunk(b"IEND", b"")
        )


# %% Load the middle record of the first camera with flow and boxes
greatx.print_errors_plainly()
if len(sys.argv) != 2:
    sys.exit(__doc__)
ds = greatx.load(sys.argv[1])
camera = ds.sequences[0].first("camera", ["rgb", "flow", "box_amodal"])
record = camera.record(len(camera) // 2)
flow = record.flow  # [h, w, 2] pixels to the right and down; NaN: not visible in the next picture
speed = np.hypot(flow[..., 0], flow[..., 1])
print(f"{camera.name}, tick {record.tick}: flow up to {np.nanmax(speed):.1f} pixels")

# %% Draw the flow: the hue is its direction, the saturation its length; pixels without flow are black
strength = np.nan_to_num(np.clip(speed / max(np.nanpercentile(speed, 90), 1e-6), 0, 1))
hue = np.nan_to_num(np.arctan2(flow[..., 1], flow[..., 0])) / (2 * np.pi) * 6
wheel = np.clip(np.abs((hue[..., None] + [0, 4, 2]) % 6 - 3) - 1, 0, 1)
color = np.where(np.isnan(speed)[..., None], 0, 1 - strength[..., None] * (1 - wheel))
write_png("flow.png", (255 * color + 0.5).astype(np.uint8))

# %% Write Middlebury's format: magic 202021.25, width, height, then u and v of each pixel, unknown above 1e9
with open("flow.flo", "wb") as file:
    file.write(struct.pack("<fii", 202021.25, flow.shape[1], flow.shape[0]))
    file.write(np.where(np.isnan(flow), np.float32(1e10), flow).astype("<f4").tobytes())

# %% Draw the boxes of visible objects: amodal boxes in yellow, boxes of the visible pixels in green
picture = record.rgb.copy()
for i in np.flatnonzero(record.box_visible_pixels):
    for box, ink in ((record.box_amodal[i], (255, 220, 0)), (record.box_modal[i], (0, 255, 0))):
        u0, v0, u1, v1 = (int(x) for x in box)
        u1, v1 = min(u1, picture.shape[1] - 1), min(v1, picture.shape[0] - 1)
        picture[v0 : v1 + 1, [u0, u1]] = picture[[v0, v1], u0 : u1 + 1] = ink
write_png("boxes.png", picture)
for i in np.argsort(record.box_visible_pixels)[:-6:-1]:
    print(
        f"  {ds.semantic_classes[record.box_semantic[i]]:12} "
        f"{np.linalg.norm(record.box_sensor_center[i]):6.1f} m away, "
        f"{record.box_visible_pixels[i]:6} pixels, visibility {record.box_visibility[i]:.2f}"
    )
