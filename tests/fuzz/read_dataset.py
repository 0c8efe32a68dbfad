# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""read_dataset.py DIR [incomplete]: reads all of a data set through the Python package. Ends as the program
does: with 0, with 1 if the data set is refused, and with a traceback if anything but a greatx.Error is
raised."""
import sys
import warnings

import greatx
import numpy


def touch(value: object) -> int:
    """Reads every byte of an array, of the records of a ragged array, and of dicts of arrays."""
    if isinstance(value, numpy.ndarray):
        return int(numpy.asarray(value).tobytes()[-1:] != b"")
    if isinstance(value, dict):
        return sum(map(touch, value.values()))
    return 1


def read(folder: str, incomplete: bool) -> int:
    count = 0
    dataset = greatx.load(folder, incomplete=incomplete)
    count += (
        len(repr(dataset)) + len(dataset.materials) + len(dataset.instances) + len(dataset.semantic_classes)
    )
    count += float(dataset.tick_rate_hz) > 0
    for sequence in dataset.sequences:
        for tick in sequence:
            for sensor, record in tick.items():
                count += len(sensor) + (record.time_s >= 0)
                for name in record.sensor.arrays if hasattr(record, "sensor") else sequence[sensor].arrays:
                    count += touch(record[name])
    return count


def main() -> int:
    warnings.simplefilter("ignore")
    try:
        read(sys.argv[1], len(sys.argv) > 2)
    except greatx.Error as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
