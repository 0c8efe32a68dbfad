# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Lets pycocotools read the data sets of `greatx.convert coco`, and compares with the data set and with
pycocotools' own run lengths.

    python3 tests/peer/exports_coco.py [--scenes FOLDER]

It prints the largest difference of each kind beside its bound, and exits with 1 if one exceeds it.
"""

import contextlib
import io
import sys

from environment import Worst
from exports_setup import DRIVING, main


def check_run_lengths(worst):
    """Compares our letters with those of pycocotools for random, empty, full and large masks."""
    import numpy as np
    from greatx.convert.coco.rle import decode, encode
    from pycocotools import mask as theirs

    rng = np.random.default_rng(11)
    masks = [np.zeros((7, 9), bool), np.ones((7, 9), bool), np.eye(300, dtype=bool)]
    masks += [rng.random(rng.integers(1, 200, 2)) < share for share in rng.random(200)]
    blocks = np.kron(rng.random((12, 16)) < 0.3, np.ones((90, 120), bool)).astype(bool)
    for mask in [*masks, blocks, ~blocks]:
        packed = theirs.encode(np.asfortranarray(mask.astype(np.uint8)))
        ours = encode(mask)
        worst.add("run lengths: letters that differ", float(packed["counts"].decode() != ours["counts"]), 0)
        back = theirs.decode({"size": ours["size"], "counts": ours["counts"].encode()})
        worst.add("run lengths: pixels that pycocotools decodes otherwise", np.sum(back != mask), 0)
        worst.add("run lengths: pixels that we decode otherwise", np.sum(decode(ours) != mask), 0)


def check_one(data, out, worst):
    import json

    import numpy as np
    from greatx.convert import write_coco
    from PIL import Image
    from pycocotools import mask as masks
    from pycocotools.coco import COCO
    from pycocotools.cocoeval import COCOeval

    counts = write_coco(data, out)
    with contextlib.redirect_stdout(io.StringIO()):
        coco = COCO(str(out / "annotations/instances.json"))
    worst.add("pictures", abs(len(coco.getImgIds()) - counts["pictures"]), 0)
    names = {c["id"]: c["name"] for c in coco.loadCats(coco.getCatIds())}
    results = []
    for image in coco.loadImgs(coco.getImgIds()):
        record = data.sequences[image["greatx_sequence"]][image["greatx_camera"]].at(image["greatx_tick"])
        pixels = np.array(Image.open(out / "images" / image["file_name"])).astype(int)
        worst.add("pixels of a picture", np.abs(pixels - record["rgb"]), 0)
        for annotation in coco.loadAnns(coco.getAnnIds(imgIds=image["id"])):
            mask = coco.annToMask(annotation).astype(bool)
            kind = data.instances[annotation["greatx_instance"] - 1]
            ids = [
                i + 1
                for i, other in enumerate(data.instances)
                if i + 1 == annotation["greatx_instance"]
                or ("node" in kind and other.get("node") == kind["node"])
            ]
            worst.add("pixels of a mask", np.sum(mask != np.isin(record["instance"], ids)), 0)
            worst.add("class of a mask", float(names[annotation["category_id"]] != kind["class"]), 0)
            packed = coco.annToRLE(annotation)
            worst.add("area", abs(int(masks.area(packed)) - annotation["area"]), 0)
            worst.add("rectangle", np.abs(masks.toBbox(packed) - annotation["bbox"]), 0)
            results.append(
                {
                    **{k: annotation[k] for k in ("image_id", "category_id", "segmentation", "bbox")},
                    "score": 1.0,
                }
            )
    for kind in ("segm", "bbox"):
        with contextlib.redirect_stdout(io.StringIO()):
            evaluation = COCOeval(coco, coco.loadRes(results), kind)
            evaluation.evaluate()
            evaluation.accumulate()
            evaluation.summarize()
        worst.add(
            f"1 - average precision of the annotations themselves ({kind})", 1 - evaluation.stats[0], 1e-12
        )
    whole = json.loads((out / "annotations/panoptic.json").read_text())
    by_id = {image["id"]: image for image in whole["images"]}
    for annotation in whole["annotations"]:
        image = by_id[annotation["image_id"]]
        record = data.sequences[image["greatx_sequence"]][image["greatx_camera"]].at(image["greatx_tick"])
        rgb = np.array(Image.open(out / "annotations/panoptic" / annotation["file_name"])).astype(int)
        ids = rgb[..., 0] + 256 * rgb[..., 1] + 65536 * rgb[..., 2]
        category = np.zeros_like(ids)
        for segment in annotation["segments_info"]:
            category[ids == segment["id"]] = segment["category_id"]
            worst.add("area of a segment", abs(int((ids == segment["id"]).sum()) - segment["area"]), 0)
        worst.add("pixels of panoptic pictures of another class", np.sum(category != record["semantic"]), 0)
    return counts


def check(folder, data_sets, program):
    import greatx

    worst = Worst()
    check_run_lengths(worst)
    for name, path in data_sets.items():
        print(name, check_one(greatx.load(path), folder / f"coco_{name}", worst))
    return 1 if worst.failed() else 0


if __name__ == "__main__":
    sys.exit(main(__file__, check, "exports", DRIVING, of_rig=False))
