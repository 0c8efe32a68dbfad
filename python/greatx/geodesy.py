# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Places on the Earth (WGS 84), and the x, y, z of a scene that has a georeference.

    frame = greatx.geodesy.LocalFrame.of(greatx.load("out/delft"))
    xyz = frame.local([[52.0116, 4.3571, 45.0]])
    places = frame.place(xyz)

Formulas and digits are those of core/geodesy.h: EPSG Guidance Note 7-2, methods 9602 and 9837. Arrays have
any leading axes; the last axis is latitude and longitude in degrees and height in metres, or x, y, z in
metres.
"""

from __future__ import annotations

from typing import Any, Optional

import numpy as np

from .errors import Error

# WGS 84 (NGA.STND.0036, Table 3.1).
SEMI_MAJOR_M = 6378137.0
FLATTENING = 1.0 / 298.257223563
_SEMI_MINOR = SEMI_MAJOR_M * (1.0 - FLATTENING)
_ECCENTRICITY_2 = FLATTENING * (2.0 - FLATTENING)
_SECOND_ECCENTRICITY_2 = _ECCENTRICITY_2 / (1.0 - _ECCENTRICITY_2)


def _triples(values: Any, what: str) -> np.ndarray:
    array = np.asarray(values, np.float64)
    if array.ndim < 1 or array.shape[-1] != 3:
        raise Error(f"{what}: expected an array [..., 3], found the shape {list(array.shape)}")
    return array


def geocentric(places: Any) -> np.ndarray:
    """Returns the Earth-centred positions [..., 3] m of places [..., 3]: latitude and longitude in degrees,
    height above the ellipsoid in m. Raises Error if the array has another shape."""
    places = _triples(places, "geocentric()")
    latitude, longitude = np.radians(places[..., 0]), np.radians(places[..., 1])
    height = places[..., 2]
    sine, cosine = np.sin(latitude), np.cos(latitude)
    normal = SEMI_MAJOR_M / np.sqrt(1.0 - _ECCENTRICITY_2 * sine * sine)
    return np.stack(
        [
            (normal + height) * cosine * np.cos(longitude),
            (normal + height) * cosine * np.sin(longitude),
            (normal * (1.0 - _ECCENTRICITY_2) + height) * sine,
        ],
        axis=-1,
    )


def geodetic(positions: Any) -> np.ndarray:
    """Returns the places [..., 3] of Earth-centred positions [..., 3] m, the inverse of geocentric(). It is
    exact to some nanometres from 5000 km below the ellipsoid outwards. At a pole the longitude is 0. Raises
    Error if the array has another shape."""
    positions = _triples(positions, "geodetic()")
    x, y, z = positions[..., 0], positions[..., 1], positions[..., 2]
    across = np.hypot(x, y)
    sine, cosine = z / _SEMI_MINOR, across / SEMI_MAJOR_M
    latitude = np.zeros_like(across)
    for step in range(50):
        length = np.hypot(sine, cosine)
        length = np.where(length > 0.0, length, 1.0)
        sine, cosine = sine / length, cosine / length
        before = latitude
        latitude = np.arctan2(
            z + _SECOND_ECCENTRICITY_2 * _SEMI_MINOR * sine**3,
            across - _ECCENTRICITY_2 * SEMI_MAJOR_M * cosine**3,
        )
        if step > 0 and np.all(~(np.abs(latitude - before) >= 1e-16)):
            break
        sine, cosine = _SEMI_MINOR * np.sin(latitude), SEMI_MAJOR_M * np.cos(latitude)
    s, c = np.sin(latitude), np.cos(latitude)
    height = across * c + z * s - SEMI_MAJOR_M * np.sqrt(1.0 - _ECCENTRICITY_2 * s * s)
    longitude = np.where(across > 0.0, np.arctan2(y, x), 0.0)
    return np.stack([np.degrees(latitude), np.degrees(longitude), height], axis=-1)


class LocalFrame:
    """Converts between places on the Earth and the x (east), y (north), z (up) of a scene, whose plane
    touches the ellipsoid at the scene's origin.

    height_m is the height of the origin above the ellipsoid. A height above the vertical datum is less than
    that above the ellipsoid by undulation_m. Raises Error if a number is out of its range.
    """

    def __init__(
        self,
        latitude_deg: float,
        longitude_deg: float,
        height_m: float,
        undulation_m: float = 0.0,
        vertical_datum: str = "",
    ):
        for name, value, most in (
            ("latitude_deg", latitude_deg, 90.0),
            ("longitude_deg", longitude_deg, 180.0),
            ("height_m", height_m, 1e6),
            ("undulation_m", undulation_m, 1e4),
        ):
            if not abs(float(value)) <= most:
                raise Error(f"LocalFrame: {name}: expected {-most:g} to {most:g}, found {value}")
        self.latitude_deg, self.longitude_deg = float(latitude_deg), float(longitude_deg)
        self.height_m, self.undulation_m = float(height_m), float(undulation_m)
        self.vertical_datum = vertical_datum
        self._origin = geocentric([latitude_deg, longitude_deg, height_m])
        latitude, longitude = np.radians(self.latitude_deg), np.radians(self.longitude_deg)
        sl, cl, so, co = np.sin(latitude), np.cos(latitude), np.sin(longitude), np.cos(longitude)
        self._local_from_earth = np.array([[-so, co, 0.0], [-sl * co, -sl * so, cl], [cl * co, cl * so, sl]])

    @staticmethod
    def of(source: Any) -> "LocalFrame":
        """Returns the frame of a Dataset or a Simulation. Raises Error if its scene has no georeference."""
        reference: Optional[Any] = getattr(source, "georeference", None)
        if reference is None:
            raise Error(f"{source!r}: expected a scene with a georeference, found none")
        return LocalFrame(**reference)

    def local(self, places: Any, heights: str = "ellipsoid") -> np.ndarray:
        """Returns the positions [..., 3] m of places [..., 3]. heights says where their heights begin:
        "ellipsoid" or "datum". Raises Error for another word or another shape."""
        places = _triples(places, "LocalFrame.local()") + [0.0, 0.0, self._above(heights)]
        return (geocentric(places) - self._origin) @ self._local_from_earth.T

    def place(self, positions: Any, heights: str = "ellipsoid") -> np.ndarray:
        """Returns the places [..., 3] of positions [..., 3] m, the inverse of local()."""
        positions = _triples(positions, "LocalFrame.place()")
        return geodetic(self._origin + positions @ self._local_from_earth) - [0.0, 0.0, self._above(heights)]

    def _above(self, heights: str) -> float:
        if heights not in ("ellipsoid", "datum"):
            raise Error(f"heights: expected 'ellipsoid' or 'datum', found {heights!r}")
        return self.undulation_m if heights == "datum" else 0.0

    def __repr__(self) -> str:
        return (
            f"<greatx.geodesy.LocalFrame at latitude {self.latitude_deg}, longitude {self.longitude_deg}, "
            f"{self.height_m} m above the ellipsoid>"
        )
