// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Plane waves on half-spaces and layered walls. Time convention e^{+j omega t}: eta = eta' - j eta'', eta''
// >= 0. cos_theta is measured from the normal, 0 (grazing) to 1 (normal incidence); outside is vacuum.
//
// Signs as in ITU-R P.2040-4: r_TE refers to the field along s = k x n, r_TM to the field along k x s, taken
// with the incident k before and the reflected k after; at normal incidence r_TE = -r_TM is one and the same
// reflection.
#pragma once

#include <complex>
#include <span>

namespace greatx::rf {

using Complex = std::complex<double>;

struct FresnelCoefficients {
  Complex r_te{0.0}, r_tm{0.0};  ///< reflected over incident field, at the outer face
  Complex t_te{0.0},
      t_tm{0.0};  ///< transmitted over incident field: behind the face, or behind the last layer
};

struct DielectricLayer {
  Complex eta{1.0};
  double thickness_m = 0.0;
};

/// A = sqrt(eta - 1 + C^2), Im A <= 0 (P.2040-4, 2.2.1): the normal component of the wave vector inside, over
/// k_0.
Complex normal_component(Complex eta, double cos_theta);

/// One face, the medium fills the space behind it (P.2040-4, 2.2.1):
/// r_TE = (C - A)/(C + A), r_TM = (eta C - A)/(eta C + A), t_TE = 2C/(C + A), t_TM = 2 sqrt(eta) C/(eta C +
/// A), evaluated without cancellation: r_TE = -(eta - 1)/(C + A)^2, r_TM = (eta - 1)((eta + 1)C^2 - 1)/(eta C
/// + A)^2, so that r keeps its relative accuracy as eta -> 1 and at grazing. At cos_theta = 0: r = -1, t = 0;
/// eta = 1: r = 0, t = 1.
FresnelCoefficients half_space(Complex eta, double cos_theta);

/// A slab with vacuum on both sides (P.2040-4, 2.2.2, eq. 43 and 44), q = 2 pi d A / lambda:
/// R = r(1 - e^{-2jq})/(1 - r^2 e^{-2jq}), T = (1 - r^2)e^{-jq}/(1 - r^2 e^{-2jq}).
/// T is the field at the rear face over that at the front face, both at the foot of the same normal.
FresnelCoefficients slab(const DielectricLayer& layer, double wavelength_m, double cos_theta);

/// Any number of layers, the outermost first, with vacuum behind (P.2040-4, 2.2.2 and Attachment 1: the
/// transfer-matrix recursion, each matrix divided by its growing exponential: a thick lossy layer underflows,
/// nothing overflows). A last layer of thickness 0 is the half-space behind the others; t is then the field
/// at its face.
FresnelCoefficients multilayer(std::span<const DielectricLayer> layers, double wavelength_m,
                               double cos_theta);

/// The factor that turns `t` of a wall of thickness d into that of a sheet without geometric thickness: the
/// path's length already counts the phase e^{-jk d C} once (P.2040-4, 2.2.2; a vacuum slab is invisible).
Complex sheet_phase(double thickness_m, double wavelength_m, double cos_theta);

}  // namespace greatx::rf
