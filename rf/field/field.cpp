// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/field/field.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/built_effects.h"
#include "core/error.h"
#include "core/units.h"
#include "rf/antenna/field_vector.h"
#include "rf/atmosphere/foliage.h"
#include "rf/edges/corners.h"
#include "rf/edges/diffraction.h"
#include "rf/edges/two_edges.h"
#include "rf/surface/incidence.h"
#include "rf/surface/scattering.h"

namespace greatx::rf {
namespace {

template <typename V>
V mirrored(const V& direction, const dvec3& normal) {
  return direction - 2.0 * dot(direction, normal) * normal;
}

/// A path in numbers of the type R.
template <typename R>
struct Places {
  const GeometricPath& path;
  std::span<const Vec3Of<R>> vertices;
  R length_m;
};

bool bends(InteractionType type) {
  return type == InteractionType::diffraction || type == InteractionType::scattering;
}

/// Holds the straight runs of a path, from the transmitter on.
template <typename R>
struct Runs {
  std::vector<size_t> vertices;       ///< [runs + 1] vertices where the path turns, with both ends
  std::vector<Vec3Of<R>> directions;  ///< [runs] unit vectors
  /// The runs that start at a diffraction or a scattering. They part the path: the longest run of each part
  /// gives its directions.
  size_t bends[2] = {0, 0};
  size_t bend_count = 0;
  R parts_m[3] = {0.0, 0.0, 0.0};  ///< [bends + 1] unfolded lengths of the parts
  /// Which bends are scatterings, from which the wave spreads anew.
  bool scatters[2] = {false, false};
  bool scattered() const { return scatters[0] || scatters[1]; }
  /// The length by which the field's amplitude falls: that of the path, or the product of the lengths between
  /// its ends and its scatterings, m^(scatterings + 1). A patch is a disk to the next one.
  R spreading(const Places<R>& places) const {
    if (!scattered()) return places.length_m;
    R product = 1.0, since_m = 0.0;
    for (size_t part = 0; part <= bend_count; ++part) {
      since_m += parts_m[part];
      if (part < bend_count && !scatters[part]) continue;
      const bool to_another = part == 1 && bend_count == 2 && scatters[0];
      product *= to_another ? between_patches_m<R>(since_m, places.path.patch_area_m2) : since_m;
      since_m = 0.0;
    }
    return product;
  }
};

/// Sets the directions of the runs [first, last), which reflections join. Returns the sum of their lengths.
template <typename R>
R set_directions(const Places<R>& places, const FacetWorld& world, size_t first, size_t last, Runs<R>& runs) {
  const GeometricPath& path = places.path;
  const auto along = [&](size_t run) -> Vec3Of<R> {
    return places.vertices[runs.vertices[run + 1]] - places.vertices[runs.vertices[run]];
  };
  size_t longest = first;
  R longest_m = 0.0, sum_m = 0.0;
  for (size_t run = first; run < last; ++run) {
    const R of_run = length(along(run));
    sum_m += of_run;
    if (of_run > longest_m) longest = run, longest_m = of_run;
  }
  GREATX_CHECK(longest_m > 0.0, "path of {} interactions with no length before or after one",
               path.interactions.size());
  runs.directions[longest] = along(longest) / longest_m;
  const auto normal_before = [&](size_t run) {  // normal of the facet that the run starts from
    return world.facet(path.interactions[runs.vertices[run] - 1].element).normal;
  };
  for (size_t run = longest; run + 1 < last; ++run)
    runs.directions[run + 1] = mirrored(runs.directions[run], normal_before(run + 1));
  for (size_t run = longest; run > first; --run)
    runs.directions[run - 1] = mirrored(runs.directions[run], normal_before(run));
  return sum_m;
}

template <typename R>
Runs<R> runs_of(const Places<R>& places, const FacetWorld& world) {
  const GeometricPath& path = places.path;
  Runs<R> runs;
  runs.vertices.push_back(0);
  for (size_t i = 0; i < path.interactions.size(); ++i) {
    if (path.interactions[i].type == InteractionType::transmission) continue;
    if (bends(path.interactions[i].type)) {
      GREATX_CHECK(runs.bend_count < 2, "path with more than two scatterings and diffractions");
      runs.scatters[runs.bend_count] = path.interactions[i].type == InteractionType::scattering;
      runs.bends[runs.bend_count++] = runs.vertices.size();
    }
    runs.vertices.push_back(i + 1);
  }
  runs.vertices.push_back(path.vertices.size() - 1);
  const size_t count = runs.vertices.size() - 1;
  runs.directions.resize(count);
  for (size_t part = 0, first = 0; part <= runs.bend_count; ++part) {
    const size_t last = part < runs.bend_count ? runs.bends[part] : count;
    runs.parts_m[part] = set_directions(places, world, first, last, runs);
    first = last;
  }
  return runs;
}

/// Holds the field of a path on its way: the images of the unit fields along theta and phi at the
/// transmitter.
template <typename R>
class Travelling {
 public:
  using C = ComplexOf<R>;
  using V = Vec3Of<R>;

  Travelling(const FieldModelOf<R>& model, const V& departure) : model_(model) {
    const AnglesOf<R> at = angles_of<R>(departure);
    columns_[0].add(1.0, at.theta_hat());
    columns_[1].add(1.0, at.phi_hat());
  }
  const FieldVectorOf<R>& column(int index) const { return columns_[index]; }

  void through_air(const V& direction, const R& length_m) {
    if (model_.attenuation.none()) return;
    for (FieldVectorOf<R>& field : columns_) field = model_.attenuation.after(field, direction, length_m);
  }

  void reflect(const PosedFacet& facet, const V& in, const V& out, const C& weight) {
    using std::abs;
    const R towards = dot(in, facet.normal), cosine = std::min(R(1.0), R(abs(towards)));
    const ReflectionCoefficientsOf<R> fresnel =
        model_.surfaces->reflect(facet.material, towards < 0.0, cosine);
    const R kept = specular_share(facet.material, cosine);
    const V s = s_axis(in, facet.normal);
    map(s, cross(in, s), s, cross(out, s), {kept * fresnel.r_te, C(0.0), C(0.0), kept * fresnel.r_tm});
    if (always_zero(C(weight - 1.0))) return;
    for (FieldVectorOf<R>& column : columns_) column.scale(weight);
  }

  void transmit(const PosedFacet& facet, const V& direction) {
    using std::abs;
    const R towards = dot(direction, facet.normal), cosine = std::min(R(1.0), R(abs(towards)));
    const SheetTransmissionOf<R> sheet = model_.surfaces->transmit(facet.material, towards < 0.0, cosine);
    const V s = s_axis(direction, facet.normal), p = cross(direction, s);
    map(s, p, s, p, {sheet.te, C(0.0), C(0.0), sheet.tm});
  }

  void scatter(const PosedFacet& facet, const Interaction& patch, double area_m2, const V& in, const V& out) {
    using std::abs, std::sqrt;
    GREATX_CHECK(area_m2 > 0.0, "patch {} of facet {} has {} m^2", patch.patch, patch.element, area_m2);
    const R towards = dot(in, facet.normal), cosine = std::min(R(1.0), R(abs(towards)));
    const dvec3 normal = towards < 0.0 ? facet.normal : -facet.normal;
    const ReflectionCoefficientsOf<R> fresnel =
        model_.surfaces->reflect(facet.material, towards < 0.0, cosine);
    const DiffuseScatteringOf<R>& surface = model_.surfaces->surface(facet.material).scattering;
    const R amplitude =
        surface.coefficient * sqrt(scattering_pattern<R>(surface, in, out, normal) * cosine * area_m2);
    const ScatteringMatrixOf<R> m =
        scattering_matrix<R>(surface.cross_polarization, model_.effects.seed, patch.element, patch.patch);
    const C te = amplitude * fresnel.r_te, tm = amplitude * fresnel.r_tm;
    const V s_in = s_axis(in, normal), s_out = s_axis(out, normal);
    map(s_in, cross(in, s_in), s_out, cross(out, s_out), {m.ss * te, m.sp * tm, m.ps * te, m.pp * tm});
  }

  /// The results spread by the whole length from there on (edge_dyadic).
  void diffract(const scene::Wedge& wedge, const V& in, const V& out, const R& before_m, const R& after_m,
                const EdgeSides& sides) {
    const auto share = [this](uint32_t material, const R& cosine) {
      return specular_share(material, cosine);
    };
    const EdgeDyadicOf<R> edge =
        edge_dyadic<R>(wedge, in, out, before_m, after_m, *model_.world, *model_.surfaces, share, sides);
    for (FieldVectorOf<R>& field : columns_) field = edge.apply(field);
  }

  void diffract_at(const scene::Wedge& wedge, Corner corner, const V& in, const V& out, const R& before_m,
                   const R& after_m, KellerSide side) {
    const auto share = [this](uint32_t material, const R& cosine) {
      return specular_share(material, cosine);
    };
    const EdgeDyadicOf<R> end = corner_dyadic<R>(wedge, corner, in, out, before_m, after_m, *model_.world,
                                                 *model_.surfaces, share, side);
    for (FieldVectorOf<R>& field : columns_) field = end.apply(field);
  }

  /// Arrives at the first of two edges. What lies between them acts on two unit fields until the second.
  void leave_first_edge(const V& between) {
    at_first_edge_[0] = columns_[0], at_first_edge_[1] = columns_[1];
    const AnglesOf<R> at = angles_of<R>(between);
    axes_[0] = at.theta_hat(), axes_[1] = at.phi_hat();
    for (int i = 0; i < 2; ++i) {
      columns_[i] = {};
      columns_[i].add(1.0, axes_[i]);
    }
  }
  void diffract_at_both(const scene::Wedge& first, const scene::Wedge& second, const TwoEdgeRaysOf<R>& rays) {
    const auto share = [this](uint32_t material, const R& cosine) {
      return specular_share(material, cosine);
    };
    const auto between = [this](const FieldVectorOf<R>& field) {
      FieldVectorOf<R> sum;
      for (int i = 0; i < 2; ++i) {
        FieldVectorOf<R> part = columns_[i];
        part.scale(field.along(axes_[i]));
        sum.re += part.re, sum.im += part.im;
      }
      return sum;
    };
    const TwoEdgeMatrixOf<R> edges =
        two_edge_matrix<R>(first, second, rays, *model_.world, *model_.surfaces, share, between);
    FieldVectorOf<R> behind[2];
    for (int i = 0; i < 2; ++i) behind[i] = edges.apply(at_first_edge_[i]);
    columns_[0] = behind[0], columns_[1] = behind[1];
  }

 private:
  /// Maps components on (s_in, p_in) to components on (s_out, p_out) by the matrix [ss sp; ps pp], out by in.
  void map(const V& s_in, const V& p_in, const V& s_out, const V& p_out, const ScatteringMatrixOf<R>& by) {
    for (FieldVectorOf<R>& field : columns_) {
      const C s = field.along(s_in), p = field.along(p_in);
      field = {};
      field.add(by.ss * s + by.sp * p, s_out);
      field.add(by.ps * s + by.pp * p, p_out);
    }
  }

  R specular_share(uint32_t material, const R& cosine) const {
    const FieldEffects& effects = model_.effects;
    return rf::specular_share<R>(model_.surfaces->surface(material), cosine, model_.surfaces->wavelength_m(),
                                 effects.roughness ? std::optional(effects.roughness_model) : std::nullopt,
                                 effects.scattering);
  }

  const FieldModelOf<R>& model_;
  FieldVectorOf<R> columns_[2];
  FieldVectorOf<R> at_first_edge_[2];
  V axes_[2];  ///< of the ray between two edges
};

template <typename R>
R foliage_amplitude(const FieldModelOf<R>& model, double depth_m) {
  using std::pow;
  if (!model.effects.foliage || depth_m == 0.0) return 1.0;
  GREATX_CHECK(model.foliage.has_value(), "{} m of foliage that the field model does not know", depth_m);
  return pow(10.0, -foliage_db<R>(*model.foliage, model.surfaces->carrier_hz(), depth_m) / 20.0);
}

template <typename R>
const scene::Wedge& wedge_of(const FieldModelOf<R>& model, const Interaction& interaction) {
  GREATX_CHECK(interaction.element < model.wedges.size(), "wedge {} of {}", interaction.element,
               model.wedges.size());
  return model.wedges[interaction.element];
}

/// Returns the weight of the reflection at interaction `i`, between the runs `in` and `out`. The reflection's
/// part of the path, between bends and ends, is `part_m` long and has `before_m` before the reflection.
template <typename R>
ComplexOf<R> reflection_weight(const Places<R>& places, const FieldModelOf<R>& model, size_t i,
                               const Vec3Of<R>& in, const Vec3Of<R>& out, const R& before_m,
                               const R& part_m) {
  if (model.reflectors == nullptr) return 1.0;
  const GeometricPath& path = places.path;
  const ReflectionSightOf<R> sight{places.vertices[i + 1], in, out, before_m, part_m - before_m};
  const R wave_number = 2.0 * pi / model.surfaces->wavelength_m();
  const uint32_t facet = path.interactions[i].element;
  const bool edges_diffract = path.edges_diffract >> i & 1u;
  if constexpr (!std::is_same_v<R, double>) {
    if (all_constant(sight.point, in, out, before_m, sight.after_m, wave_number))
      return model.reflectors->weight(
          *model.world, facet,
          {value_of(sight.point), value_of(in), value_of(out), before_m.value, sight.after_m.value},
          wave_number.value, edges_diffract);
  }
  return model.reflectors->template weight<R>(*model.world, facet, sight, wave_number, edges_diffract);
}

/// Takes the field along a diffraction, the bend `bend` of the path.
template <typename R>
void diffract(const GeometricPath& path, const FieldModelOf<R>& model, const Runs<R>& runs, size_t bend,
              Travelling<R>& field) {
  const auto wedge = [&](size_t which) {
    const Interaction& interaction = path.interactions[runs.vertices[runs.bends[which]] - 1];
    return posed(wedge_of(model, interaction), *model.world);
  };
  const auto before = [&](size_t which) { return runs.directions[runs.bends[which] - 1]; };
  const Vec3Of<R>& out = runs.directions[runs.bends[bend]];
  const uint32_t corner = path.interactions[runs.vertices[runs.bends[bend]] - 1].patch;
  if (corner != 0)
    return field.diffract_at(wedge(bend), static_cast<Corner>(corner), before(bend), out, runs.parts_m[bend],
                             runs.parts_m[bend + 1], path.keller_side);
  if (runs.bend_count == 1 || runs.scattered())
    return field.diffract(wedge(bend), before(bend), out, runs.parts_m[bend], runs.parts_m[bend + 1],
                          path.edge_sides[0]);
  if (bend == 0) return field.leave_first_edge(out);
  field.diffract_at_both(wedge(0), wedge(1),
                         {before(0),
                          before(1),
                          out,
                          runs.parts_m[0],
                          runs.parts_m[1],
                          runs.parts_m[2],
                          {path.edge_sides[0], path.edge_sides[1]}});
}

/// Takes the field along the path, through the air and every interaction.
template <typename R>
void travel(const Places<R>& places, const FieldModelOf<R>& model, const Runs<R>& runs,
            Travelling<R>& field) {
  const GeometricPath& path = places.path;
  const FacetWorld& world = *model.world;
  size_t run = 0, part = 0;
  double patch_m2 = path.patch_area_m2;
  R before_m = 0.0;  // since the transmitter or the last bend
  for (size_t i = 0; i <= path.interactions.size(); ++i) {
    const Vec3Of<R>& in = runs.directions[run];
    const R segment_m = length(places.vertices[i + 1] - places.vertices[i]);
    before_m += segment_m;
    field.through_air(in, segment_m);
    if (i == path.interactions.size()) break;
    const Interaction& interaction = path.interactions[i];
    const Vec3Of<R>& out = interaction.type == InteractionType::transmission ? in : runs.directions[++run];
    switch (interaction.type) {
      case InteractionType::reflection:
        field.reflect(world.facet(interaction.element), in, out,
                      reflection_weight<R>(places, model, i, in, out, before_m, runs.parts_m[part]));
        break;
      case InteractionType::transmission:
        field.transmit(world.facet(interaction.element), in);
        break;
      case InteractionType::scattering:
        field.scatter(world.facet(interaction.element), interaction, patch_m2, in, out);
        patch_m2 = path.second_patch_area_m2;
        break;
      case InteractionType::diffraction:
        diffract(path, model, runs, part, field);
        break;
      case InteractionType::none:
      case InteractionType::target:  // a path over a target is two paths to this function (rf/targets)
        GREATX_CHECK(false, "interaction {} is of type {}", i, static_cast<int>(interaction.type));
    }
    if (bends(interaction.type)) ++part, before_m = 0.0;
  }
}

/// Sets `transfer` to the images of the two unit fields at the transmitter, including the spreading.
template <typename R>
void set_transfer(const Places<R>& places, const FieldModelOf<R>& model, const Runs<R>& runs,
                  ComplexOf<R> (&transfer)[4]) {
  Travelling<R> field(model, runs.directions.front());
  R spreading = 1.0 / runs.spreading(places);
  if constexpr (all_effects_built) {
    travel(places, model, runs, field);
    spreading *= foliage_amplitude(model, places.path.foliage_m);
  }
  const AnglesOf<R> arrival = angles_of<R>(-runs.directions.back());
  const Vec3Of<R> theta = arrival.theta_hat(), phi = arrival.phi_hat();
  for (int column = 0; column < 2; ++column) {
    transfer[column] = field.column(column).along(theta) * spreading;
    transfer[2 + column] = field.column(column).along(phi) * spreading;
  }
}

/// Returns the path as the receiver's wave takes it.
GeometricPath reversed(GeometricPath path) {
  const size_t count = path.interactions.size();
  uint32_t bits = 0;
  for (size_t i = 0; i < count; ++i) bits |= (path.edges_diffract >> i & 1u) << (count - 1 - i);
  path.edges_diffract = bits;
  std::reverse(path.interactions.begin(), path.interactions.end());
  std::reverse(path.vertices.begin(), path.vertices.end());
  const auto edges = std::count_if(path.interactions.begin(), path.interactions.end(),
                                   [](const auto& i) { return i.type == InteractionType::diffraction; });
  if (edges == 2) std::swap(path.edge_sides[0], path.edge_sides[1]);
  return path;
}

/// Returns the velocity of a facet's body at a place that the facet, or its edge, has in common with it.
dvec3 velocity_at(const FacetWorld& world, uint32_t facet, const dvec3& place) {
  return world.velocity(facet, place);
}
Vec3Of<Dual> velocity_at(const FacetWorld& world, uint32_t facet, const Vec3Of<Dual>& place) {
  const dvec3 at = value_of(place);
  return world.velocity(facet, at) +
         cross(world.motion(world.facet(facet).body).angular_velocity, place - at);
}

/// Returns the rate at which the path shortens, m/s: v_0 . k_0 - v_{n+1} . k_n + sum v_i . (k_i - k_{i-1}).
template <typename R>
R closing_rate(const Places<R>& places, const FieldModelOf<R>& model, const Runs<R>& runs,
               const Vec3Of<R>& transmitter_velocity, const Vec3Of<R>& receiver_velocity) {
  const GeometricPath& path = places.path;
  R rate =
      dot(transmitter_velocity, runs.directions.front()) - dot(receiver_velocity, runs.directions.back());
  for (size_t run = 1; run < runs.directions.size(); ++run) {
    const size_t vertex = runs.vertices[run];
    const Interaction& interaction = path.interactions[vertex - 1];
    const uint32_t facet = interaction.type == InteractionType::diffraction
                               ? wedge_of(model, interaction).facet_0
                               : interaction.element;
    rate += dot(velocity_at(*model.world, facet, places.vertices[vertex]),
                runs.directions[run] - runs.directions[run - 1]);
  }
  return rate;
}

void check(const GeometricPath& path) {
  GREATX_CHECK(path.vertices.size() == path.interactions.size() + 2 && path.length_m > 0.0,
               "path of {} interactions, {} vertices, {} m", path.interactions.size(), path.vertices.size(),
               path.length_m);
}

/// Calls `use` with the path as its wave takes it.
template <typename R, typename Use>
void with_wave(const GeometricPath& geometry, std::span<const Vec3Of<R>> vertices, const R& length_m,
               const Use& use) {
  check(geometry);
  if (!geometry.from_receiver) return use(Places<R>{geometry, vertices, length_m});
  const GeometricPath wave = reversed(geometry);
  const std::vector<Vec3Of<R>> places(vertices.rbegin(), vertices.rend());
  use(Places<R>{wave, places, length_m});
}

}  // namespace

template <typename R>
PathValuesOf<R> path_values(const GeometricPath& geometry, const PathPlacesOf<R>& given,
                            const FieldModelOf<R>& model) {
  PathValuesOf<R> values;
  const bool back = geometry.from_receiver;
  with_wave<R>(geometry, given.vertices, given.length_m, [&](const Places<R>& places) {
    const Runs<R> runs = runs_of(places, *model.world);
    values.doppler_hz =
        closing_rate(places, model, runs, back ? given.receiver_velocity : given.transmitter_velocity,
                     back ? given.transmitter_velocity : given.receiver_velocity) /
        model.surfaces->wavelength_m();
    values.departure = runs.directions.front();
    values.arrival = -runs.directions.back();
    set_transfer(places, model, runs, values.transfer);
  });
  if (!back) return values;
  std::swap(values.departure, values.arrival);
  std::swap(values.transfer[1], values.transfer[2]);
  return values;
}
template PathValuesOf<double> path_values<double>(const GeometricPath&, const PathPlacesOf<double>&,
                                                  const FieldModel&);
template PathValuesOf<Dual> path_values<Dual>(const GeometricPath&, const PathPlacesOf<Dual>&,
                                              const FieldModelOf<Dual>&);

PathDirections path_directions(const GeometricPath& geometry, const FacetWorld& world) {
  PathDirections directions;
  with_wave<double>(geometry, geometry.vertices, geometry.length_m, [&](const Places<double>& places) {
    const Runs<double> runs = runs_of(places, world);
    directions = {runs.directions.front(), -runs.directions.back()};
  });
  if (geometry.from_receiver) std::swap(directions.departure, directions.arrival);
  return directions;
}

Path path_field(const GeometricPath& geometry, const FieldModel& model, const dvec3& transmitter_velocity,
                const dvec3& receiver_velocity) {
  const PathValuesOf<double> values = path_values<double>(
      geometry, {geometry.vertices, geometry.length_m, transmitter_velocity, receiver_velocity}, model);
  Path path{geometry};
  path.delay_s = geometry.length_m / speed_of_light;
  path.doppler_hz = values.doppler_hz;
  path.departure = values.departure;
  path.arrival = values.arrival;
  std::copy_n(values.transfer, 4, path.transfer);
  return path;
}

void path_transfer(const GeometricPath& geometry, const FieldModel& model, Complex (&transfer)[4]) {
  with_wave<double>(geometry, geometry.vertices, geometry.length_m, [&](const Places<double>& places) {
    set_transfer(places, model, runs_of(places, *model.world), transfer);
  });
  if (geometry.from_receiver) std::swap(transfer[1], transfer[2]);
}

}  // namespace greatx::rf
