# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Recomputes a data set's channels from its paths, and the fields of its paths from their vertices. Prints
the largest differences and fails if one exceeds its bound. Usage: check_channel.py DATASET [CHANNEL]"""

import sys

import numpy as np

import model
from dataset import C, Channel


class Worst:
    """Keeps the largest value of each named difference, its bound and where it occurred."""

    def __init__(self):
        self.rows = {}

    def add(self, name, value, bound, where):
        value = float(np.max(value, initial=0.0))
        count, worst, least, at = self.rows.get(name, (0, -1.0, bound, ""))
        # Bounds may differ between comparisons. The value nearest to its bound, or farthest beyond it, is
        # shown.
        nearer = not value * least <= worst * bound if bound > 0 else not value <= worst
        self.rows[name] = (count + 1, *((value, bound, where) if nearer else (worst, least, at)))

    def failed(self):
        bad = 0
        for name, (count, worst, bound, at) in self.rows.items():
            wrong = not worst <= bound
            bad += wrong
            print(
                f"{'FAIL' if wrong else 'ok':4} {name:48} "
                f"{worst:9.2e} <= {bound:.0e}  ({count} compared; {at})"
            )
        return bad


def wall_of(channel, material):
    """Returns the parts of a wall by area: (share, its layers). A wall with windows has two."""

    def stack(layers):
        return [(complex(*layer["relative_permittivity"]), layer["thickness_m"]) for layer in layers]

    wall = channel.meta["walls"][material]
    windows = wall.get("windows", {"share": 0.0, "layers": []})
    parts = [(1.0 - windows["share"], stack(wall["layers"])), (windows["share"], stack(windows["layers"]))]
    return [part for part in parts if part[0] > 0.0]


def check_walls(channel, worst):
    for wall in channel.meta["walls"]:
        name = wall["material"].removeprefix("itu_")
        if wall["layers"] and wall["material"].startswith("itu_") and name in model.ITU:
            eta = complex(*wall["layers"][0]["relative_permittivity"])
            ours = model.permittivity(name, channel.meta["carrier_hz"])
            worst.add(
                "permittivity of ITU materials, relative", abs(eta - ours) / abs(ours), 1e-9, wall["material"]
            )


def types_of(p, i):
    return p["interaction"][i][: np.count_nonzero(p["interaction"][i])]


def points_of(p, i, tx, rx):
    return np.vstack([tx, p["vertex"][i][: np.count_nonzero(p["interaction"][i])], rx])


def known_normals(channel):
    """Returns the normal of every facet that reflects some path. Paths that pass through the facet need
    it."""
    normals = {}
    for record in range(len(channel)):
        p = channel.paths(record)
        for i in range(len(p["rx"])):
            types = types_of(p, i)
            tx, _ = channel.end(record, channel.meta["transmitters"][p["tx"][i]])
            points = points_of(p, i, tx, channel.end(record, channel.meta["receivers"][p["rx"][i]])[0])
            if (
                not (types == model.REFLECTION).any()
                or np.linalg.norm(np.diff(points, axis=0), axis=1).min() < 1e-2
            ):
                continue
            for facet, normal in zip(p["facet"][i], model.bisectors(points, types)):
                if np.isfinite(normal).all():
                    normals.setdefault(int(facet), normal)
    return normals


def check_identity(p, worst, known, where):
    """Checks that ids and sequences of interactions correspond one to one, at all ticks."""
    names = [name for name in ("interaction", "facet", "element", "end") if name in p]
    for i in range(len(p["rx"])):
        sequence = tuple(tuple(p[name][i]) for name in names)
        by_id = known.setdefault(int(p["id"][i]), sequence)
        by_sequence = known.setdefault(sequence, int(p["id"][i]))
        worst.add(
            "id and sequence of interactions, both ways",
            not (by_id == sequence and by_sequence == int(p["id"][i])),
            0,
            where,
        )
        middle = np.isin(p["interaction"][i], (model.DIFFRACTION, model.SCATTERING))
        worst.add(
            "element at diffractions and scatterings alone", ((p["element"][i] > 0) != middle).any(), 0, where
        )


def check_foliage(channel, p, i, length, worst, where):
    depth = p["foliage"][i]
    worst.add("foliage within 0 and the length, m", max(0.0, -depth, depth - length), 1e-3, where)
    if not channel.effects["foliage"]:
        worst.add("foliage while it is off, m", depth, 0, where)


def check_transfer(channel, p, i, points, normals, worst, where):
    """Checks the transfer matrix of a path of reflections and transmissions if the data set says enough. It
    does not for rough or scattering walls, whose losses it lacks, nor for a wall that reflects no path of the
    data set. Gas, fog and leaves attenuate all polarizations alike. With one of them a factor is fitted,
    which must not exceed 1. The weights of finite reflectors multiply all polarizations by one complex
    number, which is fitted, too."""
    types = types_of(p, i)
    effects = channel.effects
    if not np.isin(types, (model.REFLECTION, model.TRANSMISSION)).all() or effects["rain"]:
        return
    if len(types) > 0 and (effects["roughness"] or effects["scattering"]):
        return
    own = np.array([normals.get(int(f), np.full(3, np.nan)) for f in p["facet"][i][: len(types)]]).reshape(
        -1, 3
    )
    if not np.isfinite(own[types == model.TRANSMISSION]).all():
        return
    walls = [wall_of(channel, m - 1) for m in p["object_material"][i][: len(types)]]
    ours = model.transfer(points, types, walls, own, C / channel.meta["carrier_hz"])
    stored = p["transfer"][i].astype(complex)
    scale = 1.0
    if (types == model.REFLECTION).any() and effects.get("finite_reflectors"):
        scale = np.vdot(ours, stored) / np.vdot(ours, ours).real
    elif effects["gas"] or effects["fog"] or effects["foliage"]:
        scale = abs(np.vdot(ours, stored)) / np.vdot(ours, ours).real
        worst.add("strength beside that in vacuum, above 1", max(0.0, scale - 1), 1e-6, where)
    through = int((types == model.TRANSMISSION).sum())
    name = f"transfer, {len(types) - through} reflections, {through} walls, relative"
    worst.add(
        name,
        np.abs(stored - scale * ours).max() / np.abs(scale * ours).max(),
        2e-6 if through else 1e-6,
        where,
    )


def check_path(channel, p, i, tx, rx, normals, worst, where):
    count = np.count_nonzero(p["interaction"][i])
    points = points_of(p, i, tx, rx)
    segments = np.diff(points, axis=0)
    length = np.linalg.norm(segments, axis=1).sum()
    worst.add(
        "no vertex beyond the last interaction", 0 if np.isnan(p["vertex"][i][count:]).all() else 1, 0, where
    )
    worst.add(
        "delay * c over the polyline's length, relative",
        abs(p["delay"][i] * C - length) / length,
        1e-12,
        where,
    )
    if count == 0:
        worst.add(
            "line of sight: delay * c over the poses' distance",
            abs(p["delay"][i] * C - length) / length,
            1e-12,
            where,
        )
    check_foliage(channel, p, i, length, worst, where)
    if np.linalg.norm(segments, axis=1).min() < 1e-3:
        return  # two reflections in a corner: the direction between them is rounding error
    for name, d in (("departure", segments[0]), ("arrival", -segments[-1])):
        error = np.linalg.norm(model.direction(p[name][i]) - model.unit(d))
        worst.add(f"{name} over the vertices, rad", error, 1e-9 * max(1, 100 / np.linalg.norm(d)), where)
    check_transfer(channel, p, i, points, normals, worst, where)


def check_record(channel, record, worst, normals, known):
    meta, p = channel.meta, channel.paths(record)
    tick, row, _ = channel.records[record]
    stored = channel.response(record)
    check_identity(p, worst, known, f"tick {tick}")
    worst.add("path_count", abs(channel.path_count[row].sum() - len(p["rx"])), 0, f"tick {tick}")
    for r, rx in enumerate(meta["receivers"]):
        for t, tx in enumerate(meta["transmitters"]):
            mine = np.flatnonzero((p["rx"] == r) & (p["tx"] == t))
            q = {name: array[mine] for name, array in p.items()}
            where = f"tick {tick}, {tx['name']} to {rx['name']}"
            worst.add("path_count", abs(channel.path_count[row, r, t] - len(mine)), 0, where)
            # Paths lead between the origins of the arrays. If every element has its own paths or delays, H is
            # not their sum.
            several = meta["dispersion"] or meta["beam_squint"] or meta["wave_curvature"]
            same = not several and not channel.every_element[row, r, t]
            link = channel.path_gain[row, r, t], channel.line_of_sight[row, r, t], same
            check_link(channel, record, tx, rx, q, stored[r][:, t], link, normals, worst, where)


def check_link(channel, record, tx, rx, q, stored, link, normals, worst, where):
    """Checks the link of one transmitter and one receiver. `q` holds its paths, `stored` is H [rx_ant,
    tx_ant, time, subcarrier], `link` is (path_gain, line_of_sight, whether H is the sum of the paths)."""
    meta = channel.meta
    tx_place, tx_turn = channel.end(record, tx)
    rx_place, rx_turn = channel.end(record, rx)
    for i in range(len(q["rx"])):
        check_path(channel, q, i, tx_place, rx_place, normals, worst, f"{where}, path {i}")
    a = model.amplitudes(
        meta,
        tx,
        tx_turn,
        rx,
        rx_turn,
        q["transfer"].astype(complex),
        q["departure"],
        q["arrival"],
        q["delay"],
    )
    h = model.response(meta, a, q["delay"], q["doppler"])
    energy = np.sum(np.abs(h) ** 2)
    if len(q["rx"]) == 0:
        worst.add("no path: |H|", np.abs(stored), 0, where)
        return
    if link[2]:
        worst.add("NMSE of H", np.sum(np.abs(h - stored) ** 2) / energy, 1e-12, where)
    scale = np.abs(a).max()
    worst.add("amplitude, over the largest", np.abs(a - q["amplitude"]).max() / scale, 1e-6, where)
    gain = np.sum(np.abs(a) ** 2) / (a.shape[1] * a.shape[2])
    worst.add("path_gain, relative", abs(gain - link[0]) / gain, 1e-6, where)
    direct = (q["interaction"].sum(1) == 0).any()  # no interaction at all
    worst.add("line_of_sight flag", abs(int(direct) - int(link[1])), 0, where)
    worst.add("paths with the same id", len(q["rx"]) - len(set(q["id"])), 0, where)


def check_doppler(channel, worst):
    """Compares Doppler shifts with differences of the delay (fourth order). Ids match the paths of different
    ticks. The bound is 1 mHz, plus four times the deviation from central differences of second order, plus
    the jump between the one-sided differences. This jump occurs at way-points, where a lever turns with the
    velocity.
    """
    tables = []
    for record in range(len(channel)):
        p = channel.paths(record)
        ids = zip(p["rx"], p["tx"], p["id"])
        tables.append(
            {tuple(map(int, key)): values for key, values in zip(ids, zip(p["delay"], p["doppler"]))}
        )
    carrier = channel.meta["carrier_hz"]
    for record in range(2, len(channel) - 2):
        ticks = [channel.records[record + o][0] for o in (-2, -1, 0, 1, 2)]
        if len(set(np.diff(ticks))) != 1:
            continue
        step = (ticks[1] - ticks[0]) / channel.tick_rate
        for key, (tau, nu) in tables[record].items():
            if all(key in tables[record + o] for o in (-2, -1, 1, 2)):
                m2, m1, p1, p2 = (tables[record + o][key][0] for o in (-2, -1, 1, 2))
                slope = (8 * (p1 - m1) - (p2 - m2)) / (12 * step)
                kink = (-3 * tau + 4 * p1 - p2) - (3 * tau - 4 * m1 + m2)
                uncertain = (4 * abs(slope - (p1 - m1) / (2 * step)) + abs(kink) / (2 * step)) * carrier
                where = f"tick {ticks[2]}, {nu:.3f} Hz, path {key[2]:016x}"
                worst.add(
                    "Doppler over differences of the delay, Hz",
                    abs(nu + carrier * slope),
                    1e-3 + uncertain,
                    where,
                )


def main():
    channel = Channel(sys.argv[1], sys.argv[2] if len(sys.argv) > 2 else None)
    worst = Worst()
    check_walls(channel, worst)
    normals, known = known_normals(channel), {}
    for record in range(len(channel)):
        check_record(channel, record, worst, normals, known)
    check_doppler(channel, worst)
    return 1 if worst.failed() else 0


if __name__ == "__main__":
    sys.exit(main())
