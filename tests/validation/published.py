# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Published models and measured figures. Each has its document, edition, and table or equation."""
import numpy as np

C = 299792458.0


def free_space(f_hz, d):
    """Returns the free-space loss in dB (Friis) between isotropic antennas."""
    return 20 * np.log10(4 * np.pi * f_hz * np.asarray(d, float) / C)


# Rec. ITU-R P.1411-12, Annex 1, 4.1.1, Table 4: both stations below the rooftops. Loss = 10 alpha lg d + beta
# + 10 gamma lg f (m, GHz), with a standard deviation of sigma dB.
P1411_TABLE_4 = {
    "LOS": {"alpha": 2.12, "beta": 29.2, "gamma": 2.11, "sigma": 5.06, "range_m": (5, 660)},
    "NLOS": {"alpha": 4.00, "beta": 10.2, "gamma": 2.36, "sigma": 7.60, "range_m": (30, 715)},  # high-rise
}


def p1411_site_general(sight, f_hz, d):
    """Returns the median loss in dB of P.1411-12, 4.1.1, Table 4, for urban streets (NLOS: high-rise)."""
    row = P1411_TABLE_4[sight]
    return 10 * row["alpha"] * np.log10(d) + row["beta"] + 10 * row["gamma"] * np.log10(f_hz / 1e9)


def breakpoint(f_hz, h1, h2):
    """Returns R_bp = 4 h1 h2/lambda (P.1411-12, 4.1.2), m."""
    return 4 * h1 * h2 * f_hz / C


def fresnel_clearance(f_hz, h1, h2):
    """Returns the distance at which the first Fresnel zone touches the ground, in m: the ground path is half
    a wavelength longer than the direct one (Feuerstein et al., IEEE Trans. VT 43(3), 1994)."""
    half = C / f_hz / 2
    sum2, difference2 = (h1 + h2) ** 2, (h1 - h2) ** 2
    # sqrt(d^2 + sum2) - sqrt(d^2 + difference2) = half, solved for d.
    return np.sqrt((((sum2 - difference2) / half - half) / 2) ** 2 - difference2)


def p1411_street(f_hz, h1, h2, d):
    """Returns (median, lower bound, upper bound) of the loss in a street in sight, dB (P.1411-12, Annex 1,
    4.1.2, UHF propagation)."""
    wavelength = C / f_hz
    ratio = np.log10(np.asarray(d, float) / breakpoint(f_hz, h1, h2))
    at_break = abs(20 * np.log10(wavelength**2 / (8 * np.pi * h1 * h2)))
    slope = np.where(ratio <= 0, 20, 40)
    return (
        at_break + 6 + slope * ratio,
        at_break + slope * ratio,
        at_break + 20 + np.where(ratio <= 0, 25, 40) * ratio,
    )


def p1411_corner_uhf(f_hz, x1, x2, w1, w2):
    """Returns the loss in dB round a right-angled corner of two streets (P.1411-12, Annex 1, 4.1.3.1: 0.8 to
    2 GHz). x1 and x2 are the stations' distances from the crossing, w1 and w2 the widths of their streets."""
    corner = np.pi / 2
    turns = 20 * np.log10(4 * np.pi * f_hz / C)
    reflected = 20 * np.log10(x1 + x2) + x1 * x2 * 3.86 / corner**3.5 / (w1 * w2) + turns
    angle = 20 / np.pi * (np.arctan(x2 / w2) + np.arctan(x1 / w1) - np.pi / 2)
    diffracted = 10 * np.log10(x1 * x2 * (x1 + x2)) + 2 * angle + turns  # 0.1 (90 - 90) is left out
    return -10 * np.log10(10 ** (-reflected / 10) + 10 ** (-diffracted / 10))


def p1411_corner_shf(f_hz, x1, x2, w1, h1, h2):
    """Returns the loss in dB round a right-angled corner (P.1411-12, Annex 1, 4.1.3.2: 2 to 38 GHz, urban,
    wedge-shaped buildings): 20 dB within the 30 m behind the corner, then 60 dB a decade of x1 + x2. The loss
    to the crossing is that of the UHF street, with which the SHF street agrees at 2 GHz."""
    x2 = np.asarray(x2, float)
    near = np.clip(x2 - w1 / 2, 1, 31)
    bend = 20 / np.log10(31) * np.log10(near)
    beyond = 60 * np.log10(np.maximum((x1 + x2) / (x1 + w1 / 2 + 30), 1))
    return p1411_street(f_hz, h1, h2, x1)[0] + bend + beyond


def umi_loss(sight, f_hz, d, h_station=10.0, h_user=1.5):
    """Returns the loss in dB of 3GPP TR 38.901, Table 7.4.1-1, UMi street canyon, over the distance d in
    space. The effective height of the surroundings is 1 m."""
    d, ghz = np.asarray(d, float), f_hz / 1e9
    near = 32.4 + 21 * np.log10(d) + 20 * np.log10(ghz)
    far_from = 4 * (h_station - 1) * (h_user - 1) * f_hz / C
    far = (
        32.4
        + 40 * np.log10(d)
        + 20 * np.log10(ghz)
        - 9.5 * np.log10(far_from**2 + (h_station - h_user) ** 2)
    )
    flat = np.sqrt(np.maximum(d**2 - (h_station - h_user) ** 2, 0))
    seen = np.where(flat <= far_from, near, far)
    if sight == "LOS":
        return seen
    return np.maximum(seen, 35.3 * np.log10(d) + 22.4 + 21.3 * np.log10(ghz) - 0.3 * (h_user - 1.5))


UMI_SIGMA = {"LOS": 4.0, "NLOS": 7.82}  # TR 38.901, Table 7.4.1-1


def umi_delay_spread(sight, f_hz):
    """Returns (mean, standard deviation) of lg(delay spread/s) (TR 38.901, Table 7.5-6 part 1)."""
    lg = np.log10(1 + max(2.0, f_hz / 1e9))
    return (-0.24 * lg - 7.14, 0.38) if sight == "LOS" else (-0.24 * lg - 6.83, 0.16 * lg + 0.28)


# Feuerstein et al., IEEE Trans. VT 43(3), 1994: 1900 MHz, streets in the San Francisco Bay area, in sight,
# mobile at 1.7 m. Per height of the base station (m): exponents before and behind the point of Fresnel
# clearance, and the standard deviation in dB. The heights and the break point are in the abstract; exponents
# and deviations are quoted from Rappaport, Wireless Communications, "Wideband PCS Microcell Model".
FEUERSTEIN = {3.7: (2.18, 3.29, 8.76), 8.5: (2.17, 3.36, 7.88), 13.3: (2.07, 4.16, 8.77)}


def knife_edge(v):
    """Returns the loss in dB of a knife edge at the parameter v > -0.78, approximately (Rec. ITU-R P.526-15,
    eq. 31)."""
    v = np.asarray(v, float)
    return 6.9 + 20 * np.log10(np.sqrt((v - 0.1) ** 2 + 1) + v - 0.1)


def knife_edge_exact(v):
    """Returns the loss in dB of a knife edge: -20 lg |(1 + j)/2 times the integral of exp(-j pi t^2/2) from v
    to infinity|, by rotating the path of integration to where the integrand decays."""
    s = np.linspace(0, 12, 24001)
    t = np.asarray(v, float)[..., None] + s * np.exp(-1j * np.pi / 4)
    integrand = np.exp(-1j * np.pi / 2 * t**2) * np.exp(-1j * np.pi / 4)
    step = s[1] - s[0]
    simpson = (
        step
        / 3
        * (
            integrand[..., 0]
            + integrand[..., -1]
            + 4 * integrand[..., 1::2].sum(-1)
            + 2 * integrand[..., 2:-1:2].sum(-1)
        )
    )
    return -20 * np.log10(np.abs((1 + 1j) / 2 * simpson))


def penetration(kind, f_hz):
    """Returns the loss in dB through a material (TR 38.901, Table 7.4.3-1). The table gives no thickness."""
    ghz = np.asarray(f_hz, float) / 1e9
    constant, slope = {"glass": (2, 0.2), "irr_glass": (23, 0.3), "concrete": (5, 4), "wood": (4.85, 0.12)}[
        kind
    ]
    return constant + slope * ghz


# Measured losses of single samples at normal incidence: (name, medium of P.2040, thickness in m, frequency in
# GHz, least and greatest measured loss in dB). The values were read from the tables of the file docs/MODEL.md
# of the open-source project SignalPlan (github.com/NC4321/SignalPlan), which evaluates NIST's polynomials and
# Muqaibel's lines. Sources: W. C. Stone, NISTIR 6055, 1997; A. Muqaibel, dissertation, Virginia Tech, 2003,
# Table 4.3; D. Shakya et al., IEEE GLOBECOM 2024, Table II.
NIST, SHAKYA, MUQAIBEL = "NISTIR 6055", "Shakya 2024", "Muqaibel 2003"
MEASURED_WALLS = [
    (NIST, "plasterboard", 0.01252, 2.0, 0.6, 0.6),
    (SHAKYA, "plasterboard", 0.030, 6.75, 0.6, 0.6),
    (NIST, "glass", 0.00568, 2.0, 1.4, 1.4),
    (NIST, "glass", 0.01252, 2.0, 3.3, 3.3),
    (NIST, "glass", 0.01860, 2.0, 3.9, 3.9),
    (SHAKYA, "glass", 0.010, 6.75, 3.6, 3.6),
    (NIST, "wood", 0.03695, 2.0, 3.3, 3.3),
    (NIST, "wood", 0.07542, 2.0, 4.8, 4.8),
    (SHAKYA, "wood", 0.045, 6.75, 5.8, 5.8),
    (NIST, "brick", 0.0904, 2.0, 5.4, 5.4),
    (NIST, "brick", 0.178, 2.0, 7.6, 7.6),
    (MUQAIBEL, "brick", 0.0871, 3.0, 4.2, 4.2),
    (MUQAIBEL, "brick", 0.0871, 6.0, 7.4, 7.4),
    (NIST, "concrete", 0.102, 2.0, 12.6, 18.0),
    (NIST, "concrete", 0.203, 2.0, 28.6, 34.9),
]
