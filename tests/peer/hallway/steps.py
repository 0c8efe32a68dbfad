# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""The steps from a bare model to one that agrees with the measurement. Each changes one thing."""

import dataclasses

#: names of the media are ITU-R P.2040's. A board is 12.5 mm thick, and a partition has one on each side of
#: a cavity; as a single slab of 25 mm it is half a wavelength thick at 3.438 GHz and reflects hardly at all
#: at normal incidence.
CONCRETE = {"itu": "concrete"}
CEILING = {"itu": "ceiling_board", "thickness_m": 0.02}
HALF_SPACES = {"floor": CONCRETE, "ceiling": {"itu": "ceiling_board"}, "walls": {"itu": "plasterboard"}}


def boards(thickness_m, **fields):
    return {
        "floor": CONCRETE,
        "ceiling": CEILING,
        "walls": {"itu": "plasterboard", "thickness_m": thickness_m, **fields},
    }


def ends(medium, thickness_m=None):
    wall = {"itu": medium, **({} if thickness_m is None else {"thickness_m": thickness_m})}
    return {"north": wall, "south": wall}


def scattering(materials, coefficient, floor):
    """Returns the materials with a scattering coefficient; smooth floors and ends scatter less."""
    return {
        name: {**wall, "scattering_coefficient": floor if name in ("floor", "north", "south") else coefficient}
        for name, wall in materials.items()
    }


@dataclasses.dataclass
class Step:
    name: str
    words: str
    materials: dict
    max_depth: int = 5
    walls_passed: int = 0
    floor_m: float = 0.0
    effects: dict = dataclasses.field(default_factory=dict)
    channel: dict = dataclasses.field(default_factory=dict)


ROOM = {"scattering_patch_m": 0.5, "scattering_budget": 1000, "max_reflections_before_scattering": 1}
BOARDS, PARTITION = boards(0.0125), boards(0.025)
GLAZED = {**PARTITION, **ends("glass", 0.004)}

STEPS = [
    Step("model", "the model as it is, half-spaces, 3 interactions", HALF_SPACES, 3, floor_m=0.1),
    Step("floor", "the floor at its surveyed height", HALF_SPACES, 3),
    Step("order_5", "5 interactions", HALF_SPACES, 5),
    Step("order_8", "8 interactions", HALF_SPACES, 8),
    Step("itu", "boards of 12.5 mm, walls passed", BOARDS, walls_passed=3),
    Step("itu_25", "partitions of 25 mm, walls passed", PARTITION, walls_passed=3),
    Step("itu_100", "walls of 100 mm, walls passed", boards(0.1), walls_passed=3),
    Step("itu_diffraction", "itu_25 and diffraction", PARTITION, 4, 2, effects={"diffraction": "on"}),
    Step(
        "itu_scattering",
        "itu_25 and scattering, S = 0.3 (floor and ends 0.1)",
        scattering(PARTITION, 0.3, 0.1),
        walls_passed=3,
        effects={"scattering": "on"},
        channel=ROOM,
    ),
    Step(
        "itu_scattering_later",
        "the same, two reflections before and one behind a scattering",
        scattering(PARTITION, 0.3, 0.1),
        walls_passed=3,
        effects={"scattering": "on"},
        channel={**ROOM, "max_reflections_before_scattering": 2, "max_reflections_after": 1},
    ),
    Step("ends", "itu_25 and glass of 4 mm at both ends of the corridor", GLAZED, walls_passed=3),
    Step("ends_8", "the same, 8 interactions", GLAZED, 8, 3),
    Step("ends_diffraction", "ends and diffraction", GLAZED, 4, 2, effects={"diffraction": "on"}),
    Step(
        "ends_scattering",
        "ends and scattering",
        scattering(GLAZED, 0.3, 0.1),
        walls_passed=3,
        effects={"scattering": "on"},
        channel=ROOM,
    ),
]
