# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Describes the exporter to nuScenes as a command."""

from __future__ import annotations

import argparse

from ..clouds import untwist_argument
from ..common import Command
from ..objects import class_argument
from ..rig import rig_arguments
from .categories import ANNOTATED
from .write import write_nuscenes


def _arguments(parser: argparse.ArgumentParser) -> None:
    rig_arguments(parser)
    parser.add_argument(
        "--sensor",
        action="append",
        metavar="NAME",
        help="sensor to write, once or more; default: all of the node",
    )
    parser.add_argument(
        "--keyframes",
        type=float,
        default=2.0,
        metavar="HZ",
        help="rate of samples; 0: every tick at which all sensors fire (default: %(default)s)",
    )
    parser.add_argument(
        "--range", type=float, default=100.0, metavar="M", help="of annotated objects (default: %(default)s)"
    )
    parser.add_argument(
        "--channel", action="append", metavar="SENSOR=CHANNEL", help="nuScenes' channel of a sensor"
    )
    class_argument(parser, "category", "category of annotations of a class", ANNOTATED)
    parser.add_argument(
        "--scene-name",
        action="append",
        metavar="NAME",
        help="name of a scene, once for each sequence; nuScenes' splits know scenes by their names "
        "(default: scene-0000, ...)",
    )
    parser.add_argument("--without-annotations", action="store_true", help="write sensors alone")
    parser.add_argument("--version", default="v1.0-mini", help="name of the tables' folder (%(default)s)")
    untwist_argument(parser)


COMMAND = Command(
    "nuscenes",
    "nuScenes' tables and files, for nuscenes-devkit",
    lambda dataset, given: write_nuscenes(
        dataset,
        given.OUT,
        node=given.node,
        sequence=given.sequence,
        keyframes_hz=given.keyframes,
        range_m=given.range,
        channels=given.channel,
        categories=given.category,
        without_annotations=given.without_annotations,
        version=given.version,
        link=given.link,
        untwist=given.untwist,
        scene_names=given.scene_name,
        sensors=given.sensor,
    ),
    _arguments,
)
