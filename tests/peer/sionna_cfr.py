# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Frequency responses beside each other, with antennas, and what their difference comes from."""
import dataclasses

import mitsuba as mi
import numpy as np

from sionna_match import nmse_db, response
from sionna_paths import C

SUBCARRIERS, BANDWIDTH = 256, 100e6
FREQUENCIES = (np.arange(SUBCARRIERS) - SUBCARRIERS // 2) * BANDWIDTH / SUBCARRIERS


def sionna_response(sionna, receivers, samples, normalize_delays=False, **options):
    """paths.cfr() of each receiver alone: [rx, rx_ant, tx_ant, subcarrier]."""
    out = []
    for position in receivers:
        sionna.place([position])
        paths = sionna.solve(samples=samples, **options)
        re, im = paths.cfr(frequencies=mi.Float(FREQUENCIES.astype(np.float32)), normalize_delays=normalize_delays)
        out.append((np.array(re) + 1j * np.array(im))[0, :, 0, :, 0, :])
    return np.array(out)


def slabs_put_right(case, referee, paths):
    """The paths with the way through walls counted once."""
    out = []
    for path in paths:
        verdict = referee.judge(path) if "T" in path.kinds else {"exists": False}
        turn = np.exp(1j * referee.slab_phase(path, verdict, case)) if verdict["exists"] else 1.0
        out.append(dataclasses.replace(path, transfer=path.transfer * turn))
    return out


def compare(case, greatx, sionna, referee, ours, theirs, receivers, result, report):
    """Isotropic, V and H at both ends."""
    few = receivers[:10]
    theirs = [p for p in theirs if p.receiver < len(few)]
    reference = response([p for p in ours if p.receiver < len(few)], case, FREQUENCIES, len(few))
    in_fp64 = response(theirs, case, FREQUENCIES, len(few))
    data_set = greatx.response(case, few, ", polarization: vh", ", polarization: vh")
    theirs_cfr = sionna_response(sionna, few, 1e6)
    rows = [("greatx's data set beside the sum over greatx's paths", data_set, reference),
            ("Sionna RT's cfr(normalize_delays=False) beside greatx", theirs_cfr, data_set),
            ("the same, from its paths with fp64 phases", in_fp64, data_set),
            ("the same, the way through walls counted once",
             response(slabs_put_right(case, referee, theirs), case, FREQUENCIES, len(few)), data_set),
            ("its cfr() beside its paths with fp64 phases", theirs_cfr, in_fp64),
            ("its cfr() as it comes (normalize_delays=True)", sionna_response(sionna, few, 1e6, True), data_set)]
    report("  H over 256 subcarriers, 100 MHz, V and H at both ends: NMSE, dB       median     worst")
    result["nmse_db"] = {}
    for name, found, expected in rows:
        median, worst = nmse_db(found, expected)
        result["nmse_db"][name] = [median, worst]
        report(f"    {name:62s} {median:10.1f} {worst:9.1f}")
    largest = max((p.delay for p in theirs), default=0.0)
    report(f"    (fp32 phase: 2 pi f tau of up to {2 * np.pi * case.carrier_hz * largest:.0f} rad has a last bit of "
           f"{2 * np.pi * case.carrier_hz * largest * 2**-24:.1e} rad; {C * largest:.0f} m)")
