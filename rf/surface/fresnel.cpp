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
Complex less_one(const Complex& z) {
  const double half = std::sin(0.5 * z.imag());
  const double grown = std::exp(z.real());
  return {std::expm1(z.real()) * std::cos(z.imag()) - 2.0 * half * half, grown * std::sin(z.imag())};
}
DualComplex less_one(const DualComplex& z) { return z.mapped(less_one(z.value()), std::exp(z.value())); }

void check(Complex eta, double cos_theta) {
  GREATX_CHECK(cos_theta >= 0.0 && cos_theta <= 1.0, "cosine of the angle of incidence {}", cos_theta);
  GREATX_CHECK(eta.imag() <= 0.0 && std::isfinite(eta.real()) && std::isfinite(eta.imag()),
               "relative permittivity {} + {}j: expected eta' - j eta'' with eta'' >= 0", eta.real(),
               eta.imag());
}

/// Holds what the reflection and the transmission of one face have in common.
template <typename R>
struct Face {
  R c;
  ComplexOf<R> eta, contrast, a, te, tm;

  Face(const ComplexOf<R>& of, const R& cos_theta) : c(cos_theta), eta(of), contrast(of - 1.0) {
    check(value_of(of), value_of(cos_theta));
    a = normal_component<R>(eta, c);
    te = c + a, tm = eta * c + a;
  }
  ReflectionCoefficientsOf<R> reflection() const {
    if (always_zero(contrast)) return {0.0, 0.0};
    if (always_zero(c)) return {-1.0, -1.0};
    return {-(contrast / te) / te, (contrast / tm) * (((eta + 1.0) * (c * c) - 1.0) / tm)};
  }
};

template <typename C>
C ratio(const C& numerator, const C& denominator) {
  return always_zero(numerator) ? C(0.0) : numerator / denominator;
}

/// Holds what the reflection and the transmission of a slab have in common, away from grazing.
template <typename R>
struct Slab {
  Face<R> face;
  ComplexOf<R> through, lost;     ///< e^{-jq}, 1 - e^{-2jq}
  ComplexOf<R> pass_te, pass_tm;  ///< 1 - r^2 of a face
  ComplexOf<R> den_te, den_tm;    ///< 1 - r^2 e^{-2jq}

  Slab(const DielectricLayerOf<R>& layer, const R& wavelength_m, const R& cos_theta)
      : face(layer.eta, cos_theta) {
    using std::exp;
    const R& c = cos_theta;
    const ComplexOf<R>&a = face.a, &te = face.te, &tm = face.tm;
    const ComplexOf<R> phase = 2.0 * pi * layer.thickness_m / wavelength_m * a;  // q
    through = exp(-j * phase);
    lost = -less_one(-2.0 * j * phase);
    const ComplexOf<R> twice = through * through;
    // 1 - r^2 is 4CA/(C + A)^2 for TE and 4 eta C A/(eta C + A)^2 for TM. The denominator 1 - r^2 e^{-2jq} is
    // written as lost + (1 - r^2)e^{-2jq}. Both terms have non-negative real parts, so they do not cancel
    // where r -> -1 and e^{-2jq} -> 1 at once.
    pass_te = 4.0 * c * (a / te) / te, pass_tm = 4.0 * c * (layer.eta / tm) * (a / tm);
    den_te = lost + pass_te * twice, den_tm = lost + pass_tm * twice;
  }
  ReflectionCoefficientsOf<R> reflection() const {
    const ReflectionCoefficientsOf<R> of_face = face.reflection();
    return {ratio(of_face.r_te * lost, den_te), ratio(of_face.r_tm * lost, den_tm)};
  }
};

/// Takes one polarization through all layers. The recursion uses the ratios of P.2040-4, Attachment 1, in the
/// variable p. For TE (E along the face) p is A, for TM (H along the face) p is A/eta, and in vacuum p = C.
/// `sum` and `flow` are the tangential field and its partner up to a common factor, which `decay` keeps.
template <typename R>
struct Ladder {
  using C = ComplexOf<R>;
  C sum{1.0}, flow{0.0}, decay{1.0};

  void add(const DielectricLayerOf<R>& layer, const C& a, const C& p_over_a, const R& wave_number) {
    using std::exp;
    const C phase = wave_number * layer.thickness_m * a;  // q
    const C lost = -less_one(-2.0 * j * phase);           // 1 - e^{-2jq}
    const C kept = 2.0 - lost;                            // 1 + e^{-2jq}
    const C p = p_over_a * a;
    // (1 - e^{-2jq}) / p. A = 0 at the critical angle of a lossless layer.
    const C lost_over_p = a == C(0.0) ? 2.0 * j * wave_number * layer.thickness_m / p_over_a : lost / p;
    const C next_sum = 0.5 * (kept * sum + lost_over_p * flow);
    flow = 0.5 * (kept * flow + lost * p * sum);
    sum = next_sum;
    decay *= exp(-j * phase);
  }
};

/// Returns the root with Im <= 0.
template <typename C>
C decaying_root(const C& z) {
  using std::sqrt;
  const C root = sqrt(z);
  return root.imag() > 0.0 ? -root : root;
}

}  // namespace

template <typename R>
ComplexOf<R> normal_component(const ComplexOf<R>& eta, const Given<R>& cos_theta) {
  return decaying_root<ComplexOf<R>>((eta - 1.0) + cos_theta * cos_theta);
}

template <typename R>
FresnelCoefficientsOf<R> half_space(const ComplexOf<R>& eta, const Given<R>& cos_theta) {
  const Face<R> face(eta, cos_theta);
  if (always_zero(face.contrast)) return {face.reflection(), 1.0, 1.0};
  if (always_zero(cos_theta)) return {face.reflection(), 0.0, 0.0};
  const R& c = cos_theta;
  const ComplexOf<R> root_eta = decaying_root(eta);
  return {face.reflection(), 2.0 * c / face.te, 2.0 * c * (root_eta / face.tm)};
}

template <typename R>
ReflectionCoefficientsOf<R> half_space_reflection(const ComplexOf<R>& eta, const Given<R>& cos_theta) {
  return Face<R>(eta, cos_theta).reflection();
}

template <typename R>
FresnelCoefficientsOf<R> slab(const DielectricLayerOf<Given<R>>& layer, const Given<R>& wavelength_m,
                              const Given<R>& cos_theta) {
  using std::exp;
  check(value_of(layer.eta), value_of(cos_theta));
  const ComplexOf<R> a = normal_component<R>(layer.eta, cos_theta);
  if (always_zero(ComplexOf<R>(layer.eta - 1.0))) {
    const ComplexOf<R> through = exp(-j * (2.0 * pi * layer.thickness_m / wavelength_m * a));
    return {{0.0, 0.0}, through, through};
  }
  if (always_zero(cos_theta)) return half_space<R>(layer.eta, cos_theta);
  // The layered form gives the limit at the critical angle.
  if (a == ComplexOf<R>(0.0)) return multilayer<R>(std::span(&layer, 1), wavelength_m, cos_theta);
  const Slab<R> slab(layer, wavelength_m, cos_theta);
  return {slab.reflection(), ratio<ComplexOf<R>>(slab.pass_te * slab.through, slab.den_te),
          ratio<ComplexOf<R>>(slab.pass_tm * slab.through, slab.den_tm)};
}

template <typename R>
ReflectionCoefficientsOf<R> slab_reflection(const DielectricLayerOf<Given<R>>& layer,
                                            const Given<R>& wavelength_m, const Given<R>& cos_theta) {
  check(value_of(layer.eta), value_of(cos_theta));
  if (always_zero(ComplexOf<R>(layer.eta - 1.0))) return {0.0, 0.0};
  if (always_zero(cos_theta)) return half_space_reflection<R>(layer.eta, cos_theta);
  const Slab<R> slab(layer, wavelength_m, cos_theta);
  // The layered form gives the limit at the critical angle.
  if (slab.face.a == ComplexOf<R>(0.0)) return multilayer<R>(std::span(&layer, 1), wavelength_m, cos_theta);
  return slab.reflection();
}

template <typename R>
FresnelCoefficientsOf<R> multilayer(std::span<const DielectricLayerOf<Given<R>>> layers,
                                    const Given<R>& wavelength_m, const Given<R>& cos_theta) {
  using C = ComplexOf<R>;
  GREATX_CHECK(!layers.empty() && wavelength_m > 0.0, "{} layers, wavelength {} m", layers.size(),
               value_of(wavelength_m));
  for (const DielectricLayerOf<R>& layer : layers) check(value_of(layer.eta), value_of(cos_theta));
  const bool backed = layers.back().thickness_m == 0.0;  // the last layer is a half-space
  if (backed && layers.size() == 1) return half_space<R>(layers[0].eta, cos_theta);
  bool vacuum = true;
  for (const DielectricLayerOf<R>& layer : layers) vacuum = vacuum && always_zero(C(layer.eta - 1.0));
  if (always_zero(cos_theta) && !vacuum) return {{-1.0, -1.0}, 0.0, 0.0};

  const R wave_number = 2.0 * pi / wavelength_m;
  const R& c = cos_theta;
  Ladder<R> te, tm;
  te.flow = tm.flow = c;
  C behind_eta{1.0};
  if (backed) {
    behind_eta = layers.back().eta;
    const C a = normal_component<R>(behind_eta, c);
    te.flow = a;
    tm.flow = a / behind_eta;
    layers = layers.first(layers.size() - 1);
  }
  for (size_t i = layers.size(); i-- > 0;) {
    GREATX_CHECK(layers[i].thickness_m > 0.0, "layer {} has thickness {} m", i,
                 value_of(layers[i].thickness_m));
    const C a = normal_component<R>(layers[i].eta, c);
    te.add(layers[i], a, 1.0, wave_number);
    tm.add(layers[i], a, 1.0 / layers[i].eta, wave_number);
  }
  if (vacuum) return {{0.0, 0.0}, te.decay, tm.decay};
  // Outside, the incident field is 1 and the reflected field is r: sum = 1 + r and flow = C(1 - r), both
  // times a common factor.
  const C den_te = c * te.sum + te.flow, den_tm = c * tm.sum + tm.flow;
  // The TM recursion used H. E = H / sqrt(eta) in units of the impedance of vacuum.
  const C root_eta = decaying_root(behind_eta);
  return {{(c * te.sum - te.flow) / den_te, (c * tm.sum - tm.flow) / den_tm},
          2.0 * c * te.decay / den_te,
          2.0 * c * tm.decay / den_tm / root_eta};
}

template <typename R>
ComplexOf<R> sheet_phase(const Given<R>& thickness_m, const Given<R>& wavelength_m,
                         const Given<R>& cos_theta) {
  using std::polar;
  return polar(R(1.0), R(2.0 * pi * thickness_m * cos_theta / wavelength_m));
}

// The functions that this file defines, for doubles and for dual numbers.
#define GREATX_FOR(R)                                                                                       \
  template ComplexOf<R> normal_component<R>(const ComplexOf<R>&, const R&);                                 \
  template FresnelCoefficientsOf<R> half_space<R>(const ComplexOf<R>&, const R&);                           \
  template ReflectionCoefficientsOf<R> half_space_reflection<R>(const ComplexOf<R>&, const R&);             \
  template FresnelCoefficientsOf<R> slab<R>(const DielectricLayerOf<R>&, const R&, const R&);               \
  template ReflectionCoefficientsOf<R> slab_reflection<R>(const DielectricLayerOf<R>&, const R&, const R&); \
  template FresnelCoefficientsOf<R> multilayer<R>(std::span<const DielectricLayerOf<R>>, const R&,          \
                                                  const R&);                                                \
  template ComplexOf<R> sheet_phase<R>(const R&, const R&, const R&);
GREATX_FOR(double)
GREATX_FOR(Dual)
#undef GREATX_FOR

}  // namespace greatx::rf
