// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/surface/fresnel.h"

#include <cmath>

#include "core/error.h"
#include "core/units.h"

namespace greatx::rf {
namespace {

constexpr Complex j{0.0, 1.0};

/// Returns e^z - 1 without cancellation near 0.
Complex expm1(Complex z) {
  const double half = std::sin(0.5 * z.imag());
  const double grown = std::exp(z.real());
  return {std::expm1(z.real()) * std::cos(z.imag()) - 2.0 * half * half, grown * std::sin(z.imag())};
}

void check(Complex eta, double cos_theta) {
  GREATX_CHECK(cos_theta >= 0.0 && cos_theta <= 1.0, "cosine of the angle of incidence {}", cos_theta);
  GREATX_CHECK(eta.imag() <= 0.0 && std::isfinite(eta.real()) && std::isfinite(eta.imag()),
               "relative permittivity {} + {}j: expected eta' - j eta'' with eta'' >= 0", eta.real(),
               eta.imag());
}

/// Holds what the reflection and the transmission of one face have in common.
struct Face {
  double c;
  Complex eta, contrast, a, te, tm;

  Face(Complex of, double cos_theta) : c(cos_theta), eta(of), contrast(of - 1.0) {
    check(of, cos_theta);
    a = normal_component(eta, c);
    te = c + a, tm = eta * c + a;
  }
  ReflectionCoefficients reflection() const {
    if (contrast == Complex(0.0)) return {0.0, 0.0};
    if (c == 0.0) return {-1.0, -1.0};
    return {-(contrast / te) / te, (contrast / tm) * (((eta + 1.0) * (c * c) - 1.0) / tm)};
  }
};

Complex ratio(Complex numerator, Complex denominator) {
  return numerator == Complex(0.0) ? Complex(0.0) : numerator / denominator;
}

/// Holds what the reflection and the transmission of a slab have in common, away from grazing.
struct Slab {
  Face face;
  Complex through, lost;     ///< e^{-jq}, 1 - e^{-2jq}
  Complex pass_te, pass_tm;  ///< 1 - r^2 of a face
  Complex den_te, den_tm;    ///< 1 - r^2 e^{-2jq}

  Slab(const DielectricLayer& layer, double wavelength_m, double cos_theta) : face(layer.eta, cos_theta) {
    const double c = cos_theta;
    const Complex a = face.a, te = face.te, tm = face.tm;
    const Complex phase = 2.0 * pi * layer.thickness_m / wavelength_m * a;  // q
    through = std::exp(-j * phase);
    lost = -expm1(-2.0 * j * phase);
    const Complex twice = through * through;
    // 1 - r^2 is 4CA/(C + A)^2 for TE and 4 eta C A/(eta C + A)^2 for TM. The denominator 1 - r^2 e^{-2jq} is
    // written as lost + (1 - r^2)e^{-2jq}. Both terms have non-negative real parts, so they do not cancel
    // where r -> -1 and e^{-2jq} -> 1 at once.
    pass_te = 4.0 * c * (a / te) / te, pass_tm = 4.0 * c * (layer.eta / tm) * (a / tm);
    den_te = lost + pass_te * twice, den_tm = lost + pass_tm * twice;
  }
  ReflectionCoefficients reflection() const {
    const ReflectionCoefficients of_face = face.reflection();
    return {ratio(of_face.r_te * lost, den_te), ratio(of_face.r_tm * lost, den_tm)};
  }
};

/// Takes one polarization through all layers. The recursion uses the ratios of P.2040-4, Attachment 1, in the
/// variable p. For TE (E along the face) p is A, for TM (H along the face) p is A/eta, and in vacuum p = C.
/// `sum` and `flow` are the tangential field and its partner up to a common factor, which `decay` keeps.
struct Ladder {
  Complex sum{1.0}, flow{0.0}, decay{1.0};

  void add(const DielectricLayer& layer, Complex a, Complex p_over_a, double wave_number) {
    const Complex phase = wave_number * layer.thickness_m * a;  // q
    const Complex lost = -expm1(-2.0 * j * phase);              // 1 - e^{-2jq}
    const Complex kept = 2.0 - lost;                            // 1 + e^{-2jq}
    const Complex p = p_over_a * a;
    // (1 - e^{-2jq}) / p. A = 0 at the critical angle of a lossless layer.
    const Complex lost_over_p =
        a == Complex(0.0) ? 2.0 * j * wave_number * layer.thickness_m / p_over_a : lost / p;
    const Complex next_sum = 0.5 * (kept * sum + lost_over_p * flow);
    flow = 0.5 * (kept * flow + lost * p * sum);
    sum = next_sum;
    decay *= std::exp(-j * phase);
  }
};

}  // namespace

Complex normal_component(Complex eta, double cos_theta) {
  const Complex root = std::sqrt((eta - 1.0) + cos_theta * cos_theta);
  return root.imag() > 0.0 ? -root : root;
}

FresnelCoefficients half_space(Complex eta, double cos_theta) {
  const Face face(eta, cos_theta);
  if (face.contrast == Complex(0.0)) return {face.reflection(), 1.0, 1.0};
  if (cos_theta == 0.0) return {face.reflection(), 0.0, 0.0};
  const double c = cos_theta;
  Complex root_eta = std::sqrt(eta);
  if (root_eta.imag() > 0.0) root_eta = -root_eta;
  return {face.reflection(), 2.0 * c / face.te, 2.0 * c * (root_eta / face.tm)};
}

ReflectionCoefficients half_space_reflection(Complex eta, double cos_theta) {
  return Face(eta, cos_theta).reflection();
}

FresnelCoefficients slab(const DielectricLayer& layer, double wavelength_m, double cos_theta) {
  check(layer.eta, cos_theta);
  const Complex a = normal_component(layer.eta, cos_theta);
  if (layer.eta == Complex(1.0)) {
    const Complex through = std::exp(-j * (2.0 * pi * layer.thickness_m / wavelength_m * a));
    return {{0.0, 0.0}, through, through};
  }
  if (cos_theta == 0.0) return half_space(layer.eta, cos_theta);
  // The layered form gives the limit at the critical angle.
  if (a == Complex(0.0)) return multilayer(std::span(&layer, 1), wavelength_m, cos_theta);
  const Slab slab(layer, wavelength_m, cos_theta);
  return {slab.reflection(), ratio(slab.pass_te * slab.through, slab.den_te),
          ratio(slab.pass_tm * slab.through, slab.den_tm)};
}

ReflectionCoefficients slab_reflection(const DielectricLayer& layer, double wavelength_m, double cos_theta) {
  check(layer.eta, cos_theta);
  if (layer.eta == Complex(1.0)) return {0.0, 0.0};
  if (cos_theta == 0.0) return half_space_reflection(layer.eta, cos_theta);
  const Slab slab(layer, wavelength_m, cos_theta);
  // The layered form gives the limit at the critical angle.
  if (slab.face.a == Complex(0.0)) return multilayer(std::span(&layer, 1), wavelength_m, cos_theta);
  return slab.reflection();
}

FresnelCoefficients multilayer(std::span<const DielectricLayer> layers, double wavelength_m,
                               double cos_theta) {
  GREATX_CHECK(!layers.empty() && wavelength_m > 0.0, "{} layers, wavelength {} m", layers.size(),
               wavelength_m);
  for (const DielectricLayer& layer : layers) check(layer.eta, cos_theta);
  const bool backed = layers.back().thickness_m == 0.0;  // the last layer is a half-space
  if (backed && layers.size() == 1) return half_space(layers[0].eta, cos_theta);
  bool vacuum = true;
  for (const DielectricLayer& layer : layers) vacuum = vacuum && layer.eta == Complex(1.0);
  if (cos_theta == 0.0 && !vacuum) return {{-1.0, -1.0}, 0.0, 0.0};

  const double wave_number = 2.0 * pi / wavelength_m;
  const double c = cos_theta;
  Ladder te, tm;
  te.flow = tm.flow = c;
  Complex behind_eta{1.0};
  if (backed) {
    behind_eta = layers.back().eta;
    const Complex a = normal_component(behind_eta, c);
    te.flow = a;
    tm.flow = a / behind_eta;
    layers = layers.first(layers.size() - 1);
  }
  for (size_t i = layers.size(); i-- > 0;) {
    GREATX_CHECK(layers[i].thickness_m > 0.0, "layer {} has thickness {} m", i, layers[i].thickness_m);
    const Complex a = normal_component(layers[i].eta, c);
    te.add(layers[i], a, 1.0, wave_number);
    tm.add(layers[i], a, 1.0 / layers[i].eta, wave_number);
  }
  if (vacuum) return {{0.0, 0.0}, te.decay, tm.decay};
  // Outside, the incident field is 1 and the reflected field is r: sum = 1 + r and flow = C(1 - r), both
  // times a common factor.
  const Complex den_te = c * te.sum + te.flow, den_tm = c * tm.sum + tm.flow;
  // The TM recursion used H. E = H / sqrt(eta) in units of the impedance of vacuum.
  Complex root_eta = std::sqrt(behind_eta);
  if (root_eta.imag() > 0.0) root_eta = -root_eta;
  return {{(c * te.sum - te.flow) / den_te, (c * tm.sum - tm.flow) / den_tm},
          2.0 * c * te.decay / den_te,
          2.0 * c * tm.decay / den_tm / root_eta};
}

Complex sheet_phase(double thickness_m, double wavelength_m, double cos_theta) {
  return std::polar(1.0, 2.0 * pi * thickness_m * cos_theta / wavelength_m);
}

}  // namespace greatx::rf
