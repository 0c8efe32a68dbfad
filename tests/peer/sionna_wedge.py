# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Computes the exact field of a point source near an infinite, perfectly conducting wedge, and compares the
diffraction of both tools with it.

J. J. Bowman, T. B. A. Senior, P. L. E. Uslenghi, Electromagnetic and Acoustic Scattering by Simple Shapes,
ch. 6: for an exterior angle n pi the part that is not geometrical optics is

    u_d = -1/(4 pi n) sum over psi of (+1 for phi - phi0, -+1 for phi + phi0) and both signs of
          int e^{-jkR(y)}/R(y) sin((pi +- psi)/n) / (cosh(y/n) - cos((pi +- psi)/n)) dy,
    R(y)^2 = r^2 + r0^2 + 2 r r0 cosh y + (z - z0)^2,

where the upper sign holds for E along the edge (Dirichlet) and the lower for E across it (Neumann). The
integral is taken along y = t e^{-j pi/4}, where the integrand decays like a Gaussian."""
import numpy as np
import scipy.special


def diffracted(k, n, source, receiver, sign):
    """Returns u_d for source and receiver (r, phi, z), with phi from the lit face. sign -1: Dirichlet, +1:
    Neumann."""
    (r0, phi0, z0), (r, phi, z) = source, receiver
    reach = np.sqrt(60 * (r + r0) / (k * r * r0))
    t = np.linspace(-reach, reach, 200001)
    y = t * np.exp(-0.25j * np.pi)
    distance = np.sqrt(r * r + r0 * r0 + 2 * r * r0 * np.cosh(y) + (z - z0) ** 2)
    total = np.zeros(len(t), complex)
    for weight, psi in ((1, phi - phi0), (sign, phi + phi0)):
        for angle in ((np.pi + psi) / n, (np.pi - psi) / n):
            total += weight * np.sin(angle) / (np.cosh(y / n) - np.cos(angle))
    value = np.trapezoid(total * np.exp(-1j * k * distance) / distance, t) * np.exp(-0.25j * np.pi)
    return -value / (4 * np.pi * n)


def cylindrical(p):
    """Returns (r, phi, z) about the edge of Sionna RT's simple_wedge, which is the z axis. The solid is at x
    > 0, y < 0, and phi counts from the face at y = 0."""
    return np.hypot(p[0], p[1]), np.arctan2(p[1], p[0]) % (2 * np.pi), p[2]


def exact_transfer(path, case):
    """Returns (lambda/4 pi) diag(T_theta theta, T_phi phi) of a path over the edge of simple_wedge."""
    k = 2 * np.pi / case.wavelength
    source, receiver = cylindrical(path.points[0]), cylindrical(path.points[-1])
    turn = np.exp(1j * k * np.hypot(source[0] + receiver[0], receiver[2] - source[2]))
    soft, hard = (diffracted(k, 1.5, source, receiver, sign) * turn for sign in (-1, 1))
    return case.wavelength / (4 * np.pi) * np.array([soft, -hard])


def transition(x):
    """Returns F of UTD (R. G. Kouyoumjian, P. H. Pathak, Proc. IEEE 62(11), 1974, eq. 26)."""
    s, c = scipy.special.fresnel(np.sqrt(2 * x / np.pi))
    return 2j * np.sqrt(x) * np.exp(1j * x) * np.sqrt(np.pi / 2) * ((0.5 - c) - 1j * (0.5 - s))


def utd_terms(path, case, n=1.5):
    """Returns (lambda/4 pi) times the four terms of eq. 25 with spreading: (+, -) of phi - phi0, (+, -) of
    phi + phi0. For a conductor E along the edge adds them with (1, 1, -1, -1), and E across it with (1, 1, 1,
    1)."""
    (r0, phi0, z0), (r, phi, z) = cylindrical(path.points[0]), cylindrical(path.points[-1])
    k, sine = 2 * np.pi / case.wavelength, (r + r0) / np.hypot(r + r0, z - z0)
    s0, s = r0 / sine, r / sine
    length = s0 * s / (s0 + s) * sine**2
    front = -np.exp(-0.25j * np.pi) / (2 * n * np.sqrt(2 * np.pi * k) * sine) / np.sqrt(s0 * s * (s0 + s))
    out = []
    for psi in (phi - phi0, phi + phi0):
        for sign in (1, -1):
            whole = round((psi + sign * np.pi) / (2 * np.pi * n))
            a = 2 * np.cos((2 * np.pi * n * whole - psi) / 2) ** 2
            out.append(front / np.tan((np.pi + sign * psi) / (2 * n)) * transition(k * length * a))
    return case.wavelength / (4 * np.pi) * np.array(out)


def fit(paths, case, end, sign):
    """Returns the factors with which a tool adds the four terms, and the relative rest."""
    terms = np.array([utd_terms(p, case) for p in paths])
    values = np.array([sign * p.transfer[end, end] for p in paths])
    weight = 1 / np.abs(terms).max(axis=1)
    factors = np.linalg.lstsq(terms * weight[:, None], values * weight, rcond=None)[0]
    rest = np.linalg.norm((terms @ factors - values) * weight) / np.linalg.norm(values * weight)
    return factors, rest


def compare(case, pairs, result, report):
    rows = []
    for ours, theirs in pairs:
        if ours.kinds != "D":
            continue
        exact = exact_transfer(ours, case)
        rows.append(
            [np.abs(np.diag(p.transfer) / exact - 1).max() for p in (ours, theirs)]
            + [
                20 * np.log10(np.abs(np.diag(p.transfer) / exact)).flat[i]
                for p in (ours, theirs)
                for i in (0, 1)
            ]
        )
    if not rows:
        return
    rows = np.array(rows)
    report(
        f"  {len(rows)} paths over the edge beside the exact field of a conducting wedge "
        f"(UTD is asymptotic: some 1/kL):"
    )
    for name, error, soft, hard in (
        ("greatx", rows[:, 0], rows[:, 2], rows[:, 3]),
        ("Sionna RT", rows[:, 1], rows[:, 4], rows[:, 5]),
    ):
        report(
            f"    {name:10s} relative: median {np.median(error):.1e}, worst {error.max():.1e};  "
            f"median |dB|: E along the edge "
            f"{np.median(np.abs(soft)):.2f} (worst {np.abs(soft).max():.2f}), "
            f"across {np.median(np.abs(hard)):.2f} "
            f"(worst {np.abs(hard).max():.2f})"
        )
        result[f"wedge_{name}"] = [float(np.median(error)), float(error.max())]
    report(
        "    factors of UTD's four terms that fit best "
        "(a conductor: 1 1 -1 -1 along the edge, 1 1 1 1 across), and the rest:"
    )
    for name, which in (("greatx", 0), ("Sionna RT", 1)):
        paths = [pair[which] for pair in pairs if pair[0].kinds == "D"]
        for title, end, sign in (("along", 0, 1), ("across", 1, -1)):
            factors, rest = fit(paths, case, end, sign)
            report(
                f"      {name:10s} {title:7s} "
                + " ".join(f"{f.real:+.3f}" for f in factors)
                + f"   {rest:.0e}"
            )
