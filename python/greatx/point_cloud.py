# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Makes heights for `greatx scene build` from point clouds (LAS and LAZ).

    python3 -m greatx.point_cloud TILE.laz... --terrain dtm.asc --surface dsm.asc --cell 0.5

The terrain of a cell is the mean height of its points of the class ground (2). The surface is its highest
point that is no noise. Both are ESRI ASCII grids in the cloud's own coordinates; cells without points hold
-9999, and nothing is filled here. laspy reads the files (`pip install laspy lazrs`); nothing else needs it.

Data flow: files -> chunks of points -> Grid, which keeps sums and maxima of cells -> ASCII grids. The classes
are those of the ASPRS LAS specification 1.4 R15, table 17.
"""

from __future__ import annotations

import argparse
import math
import os
import pathlib
import sys
from typing import Any, Iterator, List, NamedTuple, Optional, Sequence, Tuple, Union

import numpy as np

from .errors import Error

#: Class of points on the ground.
GROUND = 2
#: Classes of points that are no object: low noise and high noise.
NOISE = (7, 18)
#: What a grid holds where it has no height.
NO_DATA = -9999.0
#: More cells than this would take more than 1 GiB.
MOST_CELLS = 40_000_000
#: Points read at a time.
CHUNK = 1_000_000


class Bounds(NamedTuple):
    """A rectangle in the coordinates of a cloud."""

    west: float
    south: float
    east: float
    north: float


class Grid:
    """Collects points in square cells whose edges are multiples of `cell`. Row 0 is the northernmost. A point
    on an edge between two cells belongs to the one east or north of it.

    Raises Error if the cell is not positive or if there were more cells than MOST_CELLS.
    """

    def __init__(self, bounds: Bounds, cell: float):
        if not (cell > 0 and math.isfinite(cell)):
            raise Error(f"cell: expected a positive size, found {cell}")
        if not all(math.isfinite(value) for value in bounds):
            raise Error(f"bounds: expected finite numbers, found {tuple(bounds)}")
        self.cell = cell
        self.first_column = math.floor(bounds.west / cell)
        self.first_row = math.floor(bounds.south / cell)
        self.columns = math.floor(bounds.east / cell) - self.first_column + 1
        self.rows = math.floor(bounds.north / cell) - self.first_row + 1
        if self.columns * self.rows > MOST_CELLS:
            raise Error(
                f"cell: {self.columns} x {self.rows} cells of {cell}, more than the {MOST_CELLS} that fit: "
                "take larger cells or fewer files"
            )
        shape = self.rows * self.columns
        self._ground_sum = np.zeros(shape)
        self._ground_count = np.zeros(shape, np.int64)
        self._highest = np.full(shape, -np.inf)
        self.points = self.ground_points = self.noise_points = 0

    @property
    def west(self) -> float:
        return self.first_column * self.cell

    @property
    def south(self) -> float:
        return self.first_row * self.cell

    def add(self, x: np.ndarray, y: np.ndarray, z: np.ndarray, classes: np.ndarray) -> None:
        """Adds points. Raises Error if one is outside the bounds or not finite."""
        if not (np.isfinite(x).all() and np.isfinite(y).all() and np.isfinite(z).all()):
            raise Error("points: expected finite coordinates")
        column = np.floor(x / self.cell).astype(np.int64) - self.first_column
        row = np.floor(y / self.cell).astype(np.int64) - self.first_row
        outside = (column < 0) | (column >= self.columns) | (row < 0) | (row >= self.rows)
        if outside.any():
            raise Error(f"points: {int(outside.sum())} lie outside the bounds that the header states")
        index = (self.rows - 1 - row) * self.columns + column
        ground = classes == GROUND
        self._ground_sum += np.bincount(index[ground], z[ground], len(self._ground_sum))
        self._ground_count += np.bincount(index[ground], minlength=len(self._ground_count))
        good = ~np.isin(classes, NOISE)
        np.maximum.at(self._highest, index[good], z[good])
        self.points += len(x)
        self.ground_points += int(ground.sum())
        self.noise_points += len(x) - int(good.sum())

    def terrain(self) -> np.ndarray:
        """Returns the mean height of ground points [row, column]; NaN where there is none."""
        count = np.where(self._ground_count > 0, self._ground_count, 1)
        heights = np.where(self._ground_count > 0, self._ground_sum / count, np.nan)
        return heights.reshape(self.rows, self.columns)

    def surface(self) -> np.ndarray:
        """Returns the height of the highest point [row, column]; NaN where there is none."""
        heights = np.where(np.isfinite(self._highest), self._highest, np.nan)
        return heights.reshape(self.rows, self.columns)


def ascii_grid(heights: np.ndarray, west: float, south: float, cell: float) -> str:
    """Returns an ESRI ASCII grid: heights [row, column] to a millimetre, NaN as NO_DATA."""
    head = (
        f"ncols {heights.shape[1]}\nnrows {heights.shape[0]}\nxllcorner {west!r}\nyllcorner {south!r}\n"
        f"cellsize {cell!r}\nNODATA_value {NO_DATA:g}\n"
    )
    lines = (
        " ".join(f"{NO_DATA:g}" if math.isnan(value) else f"{value:.3f}" for value in row) for row in heights
    )
    return head + "\n".join(lines) + "\n"


def _laspy() -> Any:
    try:
        import laspy
    except ImportError:
        raise Error(
            "point clouds need the package laspy, and lazrs for LAZ: pip install laspy lazrs"
        ) from None
    return laspy


def _crs_text(header: Any) -> Tuple[Optional[str], Optional[str]]:
    """Returns a cloud's coordinate system: its WKT, or else the name of its EPSG code; None if unknown."""
    for record in header.vlrs:
        if type(record).__name__ == "WktCoordinateSystemVlr" and record.string.strip("\0 \n"):
            return record.string.strip("\0 \n"), None
    for record in header.vlrs:
        for key in getattr(record, "geo_keys", []):
            # ProjectedCRSGeoKey and GeodeticCRSGeoKey (OGC GeoTIFF 1.1, section 7.1); 32767: user-defined.
            if key.id in (3072, 2048) and key.tiff_tag_location == 0 and key.value_offset != 32767:
                return None, f"EPSG:{key.value_offset}"
    return None, None


def _chunks(reader: Any) -> Iterator[Tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]]:
    """Yields x, y, z and classes of points that are not withheld."""
    for points in reader.chunk_iterator(CHUNK):
        keep = np.asarray(points.withheld) == 0
        classes = np.asarray(points.classification)
        yield (
            np.asarray(points.x)[keep],
            np.asarray(points.y)[keep],
            np.asarray(points.z)[keep],
            classes[keep],
        )


class Cloud(NamedTuple):
    """The grid of some files, and their coordinate system (see _crs_text)."""

    grid: Grid
    wkt: Optional[str]
    epsg: Optional[str]


def read_clouds(files: Sequence[Union[str, "os.PathLike[str]"]], cell: float) -> Cloud:
    """Reads LAS and LAZ files of one coordinate system into one grid. Raises Error that names the file."""
    laspy = _laspy()
    corners, systems = [], []
    for file in files:
        try:
            with laspy.open(file) as reader:
                corners.append((*reader.header.mins[:2], *reader.header.maxs[:2]))
                systems.append(_crs_text(reader.header))
        except Exception as error:  # laspy raises many kinds
            raise Error(f"{file}: expected a LAS or LAZ file: {error}") from None
    for file, system in zip(files, systems):
        if system != systems[0]:
            raise Error(f"{file}: expected the coordinate system of {files[0]}, found another one")
    low, high = np.min(corners, axis=0), np.max(corners, axis=0)
    grid = Grid(Bounds(low[0], low[1], high[2], high[3]), cell)
    for file in files:
        try:
            with laspy.open(file) as reader:
                for chunk in _chunks(reader):
                    grid.add(*chunk)
        except Error as error:
            raise Error(f"{file}: {error}") from None
        except Exception as error:
            raise Error(f"{file}: the points cannot be read: {error}") from None
    return Cloud(grid, *systems[0])


def write_grid(file: Union[str, "os.PathLike[str]"], heights: np.ndarray, cloud: Cloud) -> None:
    """Writes an ASCII grid, and beside it a .prj if the cloud states its system as WKT."""
    path = pathlib.Path(file)
    path.write_text(ascii_grid(heights, cloud.grid.west, cloud.grid.south, cloud.grid.cell))
    if cloud.wkt is not None:
        path.with_suffix(".prj").write_text(cloud.wkt + "\n")


def main(arguments: Optional[List[str]] = None) -> int:
    parser = argparse.ArgumentParser(
        prog="python3 -m greatx.point_cloud",
        description="Makes heights for greatx scene build from point clouds (LAS, LAZ).",
    )
    parser.add_argument("FILE", nargs="+", help="clouds of one coordinate system")
    parser.add_argument("--terrain", help="ESRI ASCII grid to write: mean height of ground points (class 2)")
    parser.add_argument(
        "--surface", help="ESRI ASCII grid to write: highest point but noise (classes 7 and 18)"
    )
    parser.add_argument(
        "--cell", type=float, default=0.5, help="size of cells in the cloud's unit (default: %(default)s)"
    )
    given = parser.parse_args(arguments)
    try:
        if given.terrain is None and given.surface is None:
            raise Error("expected --terrain, --surface or both")
        cloud = read_clouds(given.FILE, given.cell)
        grid = cloud.grid
        if given.terrain is not None and grid.ground_points == 0:
            raise Error(
                f"{given.FILE[0]}: no point has the class ground ({GROUND}): the cloud is not classified"
            )
        print(f"{grid.points} points, {grid.ground_points} on the ground, {grid.noise_points} noise")
        for out, heights in ((given.terrain, grid.terrain), (given.surface, grid.surface)):
            if out is None:
                continue
            values = heights()
            write_grid(out, values, cloud)
            void = int(np.isnan(values).sum())
            print(f"{out}: {grid.columns} x {grid.rows} cells, {void} without a height")
    except (Error, OSError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    if cloud.wkt is None:
        print(
            f'place.yaml needs crs: "{cloud.epsg}" for these files'
            if cloud.epsg
            else "the cloud states no coordinate system: place.yaml needs crs for these files"
        )
    return 0


if __name__ == "__main__":
    sys.exit(main())
