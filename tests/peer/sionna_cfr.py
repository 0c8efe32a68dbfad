# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Compares frequency responses, with several antennas, and finds the cause of differences."""
import dataclasses

import mitsuba as mi
import numpy as np

from sionna_match import nmse_db, response
from sionna_paths import C

SUBCARRIERS, BANDWIDTH = 256, 100e6
FREQUENCIES = (np.arange(SUBCARRIERS) - SUBCARRIERS // 2) * BANDWIDTH / SUBCARRIERS


def sionna_response(sionna, receivers, samples, normalize_delays=False, **options):
    """Returns paths.cfr() of each receiver alone: [rx, rx_ant, tx_ant, subcarrier]."""
    out = []
    for position in receivers:
        sionna.place([position])
        paths = sionna.solve(samples=samples, **options)
        re, im = paths.cfr(
            frequencies=mi.Float(FREQUENCIES.astype(np.float32)), normalize_delays=normalize_delays
        )
        out.append((np.array(re) + 1j * np.array(im))[0, :, 0, :, 0, :])
    return np.array(out)


def slabs_put_right(case, referee, paths):
    """Returns the paths with the phase of the way through walls counted once."""
    out = []
    for path in paths:
        verdict = referee.judge(path) if "T" in path.kinds else {"exists": False}
        turn = np.exp(1j * referee.slab_phase(path, verdict, case)) if verdict["exists"] else 1.0
        out.append(dataclasses.replace(path, transfer=path.transfer * turn))
    return out


def compare(case, greatx, sionna, referee, ours, theirs, receivers, result, report):
    """Compares H of isotropic antennas with polarizations V and H at both ends."""
    few = receivers[:10]
    theirs = [p for p in theirs if p.receiver < len(few)]
    reference = response([p for p in ours if p.receiver < len(few)], case, FREQUENCIES, len(few))
    in_fp64 = response(theirs, case, FREQUENCIES, len(few))
    data_set = greatx.response(case, few, ", polarization: vh", ", polarization: vh")
    theirs_cfr = sionna_response(sionna, few, 1e6)
    rows = [
        ("greatx's data set beside the sum over greatx's paths", data_set, reference),
        ("Sionna RT's cfr(normalize_delays=False) beside greatx", theirs_cfr, data_set),
        ("the same, from its paths with fp64 phases", in_fp64, data_set),
        (
            "the same, the way through walls counted once",
            response(slabs_put_right(case, referee, theirs), case, FREQUENCIES, len(few)),
            data_set,
        ),
        ("its cfr() beside its paths with fp64 phases", theirs_cfr, in_fp64),
        ("its cfr() as it comes (normalize_delays=True)", sionna_response(sionna, few, 1e6, True), data_set),
    ]
    report("  H over 256 subcarriers, 100 MHz, V and H at both ends: NMSE, dB       median     worst")
    result["nmse_db"] = {}
    for name, found, expected in rows:
        median, worst = nmse_db(found, expected)
        result["nmse_db"][name] = [median, worst]
        report(f"    {name:62s} {median:10.1f} {worst:9.1f}")
    largest = max((p.delay for p in theirs), default=0.0)
    report(
        f"    (fp32 phase: 2 pi f tau of up to {2 * np.pi * case.carrier_hz * largest:.0f} rad "
        f"has a last bit of "
        f"{2 * np.pi * case.carrier_hz * largest * 2**-24:.1e} rad; {C * largest:.0f} m)"
    )


# Columns: name; Sionna RT's pattern and polarization; greatx's fields; rows, columns and their spacing in
# wavelengths; synthetic_array.
ANTENNAS = [
    ("isotropic, V", "iso", "V", "pattern: isotropic, polarization: v", (1, 1, 0.5, 0.5), True),
    (
        "short dipole, V and H",
        "dipole",
        "VH",
        "pattern: short_dipole, polarization: vh",
        (1, 1, 0.5, 0.5),
        True,
    ),
    (
        "half-wave dipole, V and H",
        "hw_dipole",
        "VH",
        "pattern: half_wave_dipole, polarization: vh",
        (1, 1, 0.5, 0.5),
        True,
    ),
    (
        "TR 38.901, +-45 deg",
        "tr38901",
        "cross",
        "pattern: tr38901, polarization: slant",
        (1, 1, 0.5, 0.5),
        True,
    ),
    (
        "panel 4 x 8, TR 38.901, +-45 deg, as a plane wave",
        "tr38901",
        "cross",
        "pattern: tr38901, polarization: slant",
        (4, 8, 2.0, 0.5),
        True,
    ),
    (
        "the same, every element traced",
        "tr38901",
        "cross",
        "pattern: tr38901, polarization: slant",
        (4, 8, 2.0, 0.5),
        False,
    ),
]


def port_order(array, rows, columns, vertical, horizontal, polarizations):
    """Returns the number of Sionna RT's port for each of greatx's ports. greatx numbers its ports by (row *
    columns + column) * polarizations + polarization, with rows upwards, columns towards +y and +45 deg before
    -45 deg. In Sionna RT patterns are outermost, rows go downwards and -45 deg comes first."""
    y, z = np.array(array.normalized_positions.y), np.array(array.normalized_positions.z)
    column = np.round(y / horizontal + (columns - 1) / 2).astype(int)
    row = np.round(z / vertical + (rows - 1) / 2).astype(int)
    element = np.empty(rows * columns, int)
    element[row * columns + column] = np.arange(rows * columns)
    order = {"cross": (1, 0), "VH": (0, 1), "V": (0,)}[polarizations]
    return np.array([p * rows * columns + e for e in element for p in order])


def arrays(case, greatx, sionna, receivers, result, report):
    """Compares H port by port: antennas at the transmitter, isotropic V and H at the receivers, opaque
    walls."""
    case = dataclasses.replace(case, name=case.name + "_arrays", walls=0)
    sionna.case = case
    few = receivers[:6]
    report("  antennas at the transmitter (walls opaque, 6 receivers): NMSE of H, dB    median     worst")
    result["arrays_db"] = {}
    for name, pattern, polarization, fields, (rows, columns, vertical, horizontal), synthetic in ANTENNAS:
        sionna.antennas(pattern, polarization, rows, columns, vertical, horizontal)
        theirs = sionna_response(sionna, few, 1e6, synthetic_array=synthetic)
        order = port_order(sionna.scene.tx_array, rows, columns, vertical, horizontal, polarization)
        text = (
            f", {fields}, rows: {rows}, columns: {columns}, "
            f"row_spacing_wl: {vertical}, column_spacing_wl: {horizontal}"
        )
        ours = greatx.response(
            case,
            few,
            text,
            ", polarization: vh",
            f", beam_squint: off, wave_curvature: off, every_element: {'off' if synthetic else 'on'}",
        )
        median, worst = nmse_db(theirs[:, :, order], ours)
        report(f"    {name:62s} {median:10.1f} {worst:9.1f}")
        result["arrays_db"][name] = [median, worst]
