# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""The steps from a bare model to one that agrees with the measurement. Each changes one thing."""

import dataclasses

#: names of the media are ITU-R P.2040's
CONCRETE = {"itu": "concrete"}
CEILING = {"itu": "ceiling_board", "thickness_m": 0.02}
HALF_SPACES = {"floor": CONCRETE, "ceiling": {"itu": "ceiling_board"}, "walls": {"itu": "plasterboard"}}


def boards(thickness_m):
    return {
        "floor": CONCRETE,
        "ceiling": CEILING,
        "walls": {"itu": "plasterboard", "thickness_m": thickness_m},
    }


def air(thickness_m):
    return {"relative_permittivity": 1.0, "conductivity": 0.0, "thickness_m": thickness_m}


#: what such houses are built of: partitions of two boards with a cavity, and a ceiling that hangs below a
#: slab. A single board of 25 mm is half a wavelength thick at 3.438 GHz and hardly reflects at normal
#: incidence.
LAYERS = {
    "floor": CONCRETE,
    "ceiling": {"layers": [CEILING, air(0.3), {"itu": "concrete", "thickness_m": 0.2}]},
    "walls": {"layers": [boards(0.0125)["walls"], air(0.075), boards(0.0125)["walls"]]},
}
#: a raised floor: boards on pedestals above a slab
RAISED = {
    "layers": [
        {"itu": "chipboard", "thickness_m": 0.038, "extrapolate": True},
        air(0.2),
        {"itu": "concrete", "thickness_m": 0.2},
    ]
}
PANE = {"itu": "glass", "thickness_m": 0.004}
ENDS = {"north": PANE, "south": PANE}


def scattering(materials, coefficient, floor):
    """Returns the materials with a scattering coefficient; smooth floors and ends scatter less."""
    return {
        name: {
            **wall,
            "scattering_coefficient": floor if name in ("floor", "north", "south") else coefficient,
        }
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


ON_BUDGET = {"scattering_patch_m": 0.5, "scattering_budget": 1000, "max_reflections_before_scattering": 1}
BOARDS, GLAZED = boards(0.0125), {**LAYERS, **ENDS}
BUILT = {**GLAZED, "floor": RAISED}
LATER = {**ON_BUDGET, "max_reflections_before_scattering": 2, "max_reflections_after": 1}
SCATTERING = {"effects": {"scattering": "on"}, "channel": ON_BUDGET, "walls_passed": 3}

STEPS = [
    Step("model", "the model as it is, half-spaces, 3 interactions", HALF_SPACES, 3, floor_m=0.1),
    Step("floor", "the floor at its surveyed height", HALF_SPACES, 3),
    Step("order_5", "5 interactions", HALF_SPACES, 5),
    Step("order_8", "8 interactions", HALF_SPACES, 8),
    Step("itu", "order_5, boards of 12.5 mm that waves pass", BOARDS, walls_passed=3),
    Step("itu_25", "the same, boards of 25 mm", boards(0.025), walls_passed=3),
    Step("itu_100", "the same, boards of 100 mm", boards(0.1), walls_passed=3),
    Step(
        "itu_diffraction", "itu and diffraction, 4 interactions", BOARDS, 4, 2, effects={"diffraction": "on"}
    ),
    Step("itu_scattering", "itu and scattering, S = 0.3", scattering(BOARDS, 0.3, 0.1), **SCATTERING),
    Step("layers", "itu, partitions and ceiling in layers", LAYERS, walls_passed=3),
    Step("ends", "layers, panes of 4 mm at both ends of the corridor", GLAZED, walls_passed=3),
    Step("raised", "ends, and a raised floor", BUILT, walls_passed=3),
    Step("raised_8", "the same, 8 interactions", BUILT, 8, 3),
    Step("raised_4", "the same, 4 interactions", BUILT, 4, 2),
    Step("raised_diffraction", "the same and diffraction", BUILT, 4, 2, effects={"diffraction": "on"}),
    Step("raised_scattering", "raised and scattering, S = 0.3", scattering(BUILT, 0.3, 0.1), **SCATTERING),
    Step(
        "raised_scattering_later",
        "the same, 2 reflections before and 1 behind a scattering",
        scattering(BUILT, 0.3, 0.1),
        **{**SCATTERING, "channel": LATER},
    ),
]
