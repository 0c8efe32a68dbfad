# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""An independent channel model, from ITU-R P.2040-4, TR 38.901 section 7 and docs/channel.md, not from
rf/."""
import numpy as np

from dataset import C

EPSILON_0 = 8.8541878128e-12
# P.2040-4, Table 3: (a, b, c, d, from GHz, to GHz). Only the rows that hold below 100 GHz.
ITU = {
    "concrete": (5.24, 0, 0.0462, 0.7822, 1, 100),
    "brick": (3.91, 0, 0.0238, 0.16, 1, 40),
    "plasterboard": (2.73, 0, 0.0085, 0.9395, 1, 100),
    "wood": (1.99, 0, 0.0047, 1.0718, 0.001, 100),
    "glass": (6.31, 0, 0.0036, 1.3394, 0.1, 100),
    "ceiling_board": (1.48, 0, 0.0011, 1.075, 1, 100),
    "chipboard": (2.58, 0, 0.0217, 0.78, 1, 100),
    "plywood": (2.71, 0, 0.33, 0, 1, 40),
    "marble": (7.074, 0, 0.0055, 0.9262, 1, 60),
    "metal": (1, 0, 1e7, 0, 1, 100),
    "asphalt_concrete": (4.83, 0, 0.0108, 1.3969, 1, 40),
    "very_dry_ground": (3, 0, 0.00015, 2.52, 1, 10),
    "medium_dry_ground": (15, -0.1, 0.035, 1.63, 1, 10),
    "wet_ground": (30, -0.4, 0.15, 1.30, 1, 10),
}


def permittivity(itu_name, frequency):
    a, b, c, d, low, high = ITU[itu_name]
    ghz = frequency / 1e9
    assert low <= ghz <= high
    return a * ghz**b - 1j * c * ghz**d / (2 * np.pi * frequency * EPSILON_0)


def unit(v):
    return v / np.linalg.norm(v, axis=-1, keepdims=True)


def direction(zenith_azimuth):
    t, p = zenith_azimuth[..., 0], zenith_azimuth[..., 1]
    return np.stack([np.sin(t) * np.cos(p), np.sin(t) * np.sin(p), np.cos(t)], -1)


def basis(d):
    """Returns theta-hat and phi-hat at a direction [3]. At the poles phi is 0, whatever the sign of the
    zeros."""
    d = np.where(np.abs(d) < 1e-15, 0.0, d)
    t, p = np.arctan2(np.hypot(d[0], d[1]), d[2]), np.arctan2(d[1], d[0])
    return (
        np.array([np.cos(t) * np.cos(p), np.cos(t) * np.sin(p), -np.sin(t)]),
        np.array([-np.sin(p), np.cos(p), 0.0]),
    )


def fresnel(wall, cosine, wavelength):
    """Returns (r_TE, r_TM) of a wall [(eta, thickness), ...] by the impedance of a chain of lines (Pozar,
    2.5). This is independent of eq. 43 of P.2040 and of its recursion. If the last layer has thickness 0, it
    is a half-space. Otherwise vacuum lies behind it."""

    def admittances(eta):
        n = np.sqrt(complex(eta) - 1 + cosine**2)
        n = -n if n.imag > 0 else n
        # The normal component, and the TE and TM admittances relative to vacuum.
        return n, n, eta / n if n != 0 else 0j

    layers = [(complex(e), t) for e, t in wall]
    if layers[-1][1] > 0:
        layers.append((1 + 0j, 0.0))
    _, y_te, y_tm = admittances(layers[-1][0])
    for eta, thickness in reversed(layers[:-1]):
        n, line_te, line_tm = admittances(eta)
        tan = np.tan(2 * np.pi / wavelength * n * thickness)
        y_te = line_te * (y_te + 1j * line_te * tan) / (line_te + 1j * y_te * tan)
        y_tm = line_tm * (y_tm + 1j * line_tm * tan) / (line_tm + 1j * y_tm * tan)
    # TM by the convention of P.2040: the reflected field has the sign on k x s, which is that of H.
    return (cosine - y_te) / (cosine + y_te), -(1 / cosine - y_tm) / (1 / cosine + y_tm)


def passed(wall, cosine, wavelength):
    """Returns (t_TE, t_TM) of a wall as a sheet, by the chain (ABCD) matrices of its layers. The phase of the
    same way in vacuum is taken off, because the path's length contains it. A half-space lets nothing pass."""
    if wall[-1][1] == 0:
        return [0.0, 0.0]
    te = np.eye(2, dtype=complex)
    tm = np.eye(2, dtype=complex)
    for eta, thickness in wall:
        n = np.sqrt(complex(eta) - 1 + cosine**2)
        n = -n if n.imag > 0 else n
        angle = 2 * np.pi / wavelength * n * thickness
        if angle.imag < -300:
            return [0.0, 0.0]  # less than 1e-130 of the field: metal
        for matrix, y in ((te, n), (tm, complex(eta) / n)):
            matrix[:] = matrix @ np.array(
                [[np.cos(angle), 1j * np.sin(angle) / y], [1j * y * np.sin(angle), np.cos(angle)]]
            )
    way = np.exp(2j * np.pi / wavelength * cosine * sum(thickness for _, thickness in wall))
    return [
        way * 2 * y / (y * m[0, 0] + y * y * m[0, 1] + m[1, 0] + y * m[1, 1])
        for m, y in ((te, cosine), (tm, 1 / cosine))
    ]


REFLECTION, TRANSMISSION, DIFFRACTION, SCATTERING = 1, 2, 3, 4


def bisectors(points, types):
    """Returns the normals of the facets that reflect a path, by interaction. Other interactions have NaN."""
    turning = np.concatenate([[True], np.asarray(types) != TRANSMISSION, [True]])
    k = unit(np.diff(points[turning], axis=0))  # transmissions do not bend the path
    normals = np.full((len(types), 3), np.nan)
    for i, at in enumerate(np.flatnonzero(turning)[1:-1] - 1):
        if types[at] == REFLECTION:
            normals[at] = unit(k[i + 1] - k[i])
    return normals


def transfer(points, types, walls, normals, wavelength):
    """Returns the 2x2 transfer matrix of a path through points [n + 2, 3] with n interactions (reflections
    and transmissions), in the world basis of departure and arrival. The normals of reflections are the
    bisectors. `normals` [n, 3] gives those of the walls passed, and nothing else of the scene is needed. A
    wall is a list of (share of the area, layers), and has the mean of the fields of its parts."""
    own = bisectors(points, types)
    turning = np.concatenate([[True], np.asarray(types) != TRANSMISSION, [True]])
    k = unit(np.diff(points[turning], axis=0))
    dyad = np.eye(3, dtype=complex)
    run = 0
    for i, wall in enumerate(walls):
        through = types[i] == TRANSMISSION
        normal = normals[i] if through else own[i]
        before, after = k[run], k[run if through else run + 1]
        run += not through
        cosine = abs(before @ normal)
        of = passed if through else fresnel
        fields = [(share, of(layers, cosine, wavelength)) for share, layers in wall]
        te, tm = (sum(share * field[i] for share, field in fields) for i in (0, 1))
        across = np.cross(before, normal)
        if np.linalg.norm(across) < 1e-8:
            across = np.cross(before, [1, 0, 0] if abs(before[0]) < 0.5 else [0, 1, 0])
        s = unit(across)
        dyad = (te * np.outer(s, s) + tm * np.outer(np.cross(after, s), np.cross(before, s))) @ dyad
    length = np.linalg.norm(np.diff(points, axis=0), axis=1).sum()
    return np.array(basis(-k[-1])) @ dyad @ np.array(basis(k[0])).T / length


def table_field(table, zenith, azimuth):
    """Returns (F_theta, F_phi) of an imported pattern, bilinear in zenith and azimuth."""
    rows, columns = table["zeniths"], table["azimuths"]
    part = (
        lambda name: np.array(table[name].split(), float).reshape(rows, columns)
        if name in table
        else np.zeros((rows, columns))
    )
    row = np.degrees(zenith) / 180 * (rows - 1)
    column = (np.degrees(azimuth) - table["first_azimuth_deg"]) / 360 * columns % columns
    i, j = min(int(row), rows - 2), int(column) % columns
    weights = np.outer([1 - (row - i), row - i], [1 - (column - j), column - j])
    at = np.ix_([i, i + 1], [j, (j + 1) % columns])
    return [
        np.sum(weights * (part(f"{name}_re")[at] + 1j * part(f"{name}_im")[at]))
        for name in ("f_theta", "f_phi")
    ]


def element_field(antenna, tables, zenith, azimuth):
    """Returns (F_theta, F_phi) without slant in the antenna frame (docs/scenario.md)."""
    shape = antenna["pattern"]
    if shape == "isotropic":
        return 1.0, 0.0
    if shape == "short_dipole":
        return np.sqrt(1.5) * np.sin(zenith), 0.0
    if shape == "half_wave_dipole":
        return np.sqrt(1.6409223770) * np.cos(np.pi / 2 * np.cos(zenith)) / np.sin(zenith), 0.0
    if shape == "tr38901":  # Table 7.3-1
        vertical = -min(12 * ((np.degrees(zenith) - 90) / 65) ** 2, 30)
        horizontal = -min(12 * (np.degrees(azimuth) / 65) ** 2, 30)
        return 10 ** ((8 - min(-(vertical + horizontal), 30)) / 20), 0.0
    assert shape == "imported"
    return table_field(tables[antenna["pattern_table"]], zenith, azimuth)


def element_positions(antenna):
    """Returns the positions of the elements, [elements, 3], in the array frame."""
    if "elements_m" in antenna:
        return np.array(antenna["elements_m"], float)
    along = [np.eye(3)["xyz".index(axis)] for axis in antenna["plane"]]  # direction of columns, of rows
    offset = lambda n, spacing: (np.arange(n) - (n - 1) / 2) * spacing
    across, up = offset(antenna["columns"], antenna["column_spacing_m"]), offset(
        antenna["rows"], antenna["row_spacing_m"]
    )
    return np.array([c * along[0] + r * along[1] for r in up for c in across])


def array_response(antenna, tables, turn, d, wavelength):
    """Returns [ports, 2]: the field pattern on the world's (theta, phi) at the world direction d, with the
    element's phase."""
    own = turn.T @ d
    own_theta, own_phi = basis(own)
    zenith, azimuth = np.arctan2(np.hypot(own[0], own[1]), own[2]), np.arctan2(own[1], own[0])
    f_theta, f_phi = element_field(antenna, tables, zenith, azimuth)
    to_world = np.array(basis(d)) @ turn
    fields = []
    for slant in np.radians(antenna["slants_deg"]):
        if antenna["polarization_model"] == 2:
            lead = np.cos(slant) * own_theta + np.sin(slant) * own_phi
        else:  # eq. 7.3-3: theta-hat of an axis that is rolled by the slant
            axis = np.array([0, -np.sin(slant), np.cos(slant)])
            lead = (axis @ own) * own - axis
            lead = unit(lead) if np.linalg.norm(lead) > 1e-12 else own_theta
        fields.append(to_world @ (f_theta * lead + f_phi * np.cross(own, lead)))
    phases = np.exp(2j * np.pi / wavelength * element_positions(antenna) @ own)
    return (phases[:, None, None] * np.array(fields)).reshape(-1, 2)


def amplitudes(meta, tx, tx_turn, rx, rx_turn, transfers, departures, arrivals, delays):
    """Returns the amplitudes [paths, rx_ant, tx_ant] at the carrier, with e^{-j 2 pi f_c tau}. `tx` and `rx`
    are the descriptions of the ends."""
    wavelength = C / meta["carrier_hz"]
    tables = meta["pattern_tables"]
    out = []
    for t, d, a, tau in zip(transfers, departures, arrivals, delays):
        from_tx = array_response(tx, tables, tx_turn, direction(d), wavelength)
        # C_R^H: by reciprocity a port receives with the pattern with which it radiates, transposed and not
        # conjugated.
        at_rx = array_response(rx, tables, rx_turn, direction(a), wavelength)
        out.append(
            wavelength
            / (4 * np.pi)
            * (at_rx @ t @ from_tx.T)
            * np.exp(-2j * np.pi * (meta["carrier_hz"] * tau % 1))
        )
    return np.array(out) if out else np.zeros((0, rx["ports"], tx["ports"]), complex)


def response(meta, amplitude, delays, dopplers):
    """Returns H [rx_ant, tx_ant, time, subcarrier]."""
    f = (np.arange(meta["subcarriers"]) + meta["first_subcarrier"]) * meta["subcarrier_spacing_hz"]
    t = np.arange(meta["time_samples"]) * (meta["time_spacing_s"] if meta["doppler_in_time_samples"] else 0)
    over_f = np.exp(-2j * np.pi * np.outer(delays, f))
    over_t = np.exp(2j * np.pi * np.outer(dopplers, t))
    return np.einsum("prs,pt,pk->rstk", amplitude, over_t, over_f, optimize=True)
