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

dvec3 mirrored(const dvec3& direction, const dvec3& normal) {
  return direction - 2.0 * glm::dot(direction, normal) * normal;
}

bool bends(InteractionType type) {
  return type == InteractionType::diffraction || type == InteractionType::scattering;
}

/// Holds the straight runs of a path, from the transmitter on.
struct Runs {
  std::vector<size_t> vertices;   ///< [runs + 1] vertices where the path turns, with both ends
  std::vector<dvec3> directions;  ///< [runs] unit vectors
  /// The runs that start at a diffraction or a scattering. They part the path: the longest run of each part
  /// gives its directions.
  size_t bends[2] = {0, 0};
  size_t bend_count = 0;
  double parts_m[3] = {0.0, 0.0, 0.0};  ///< [bends + 1] unfolded lengths of the parts
  /// Which bends are scatterings, from which the wave spreads anew.
  bool scatters[2] = {false, false};
  bool scattered() const { return scatters[0] || scatters[1]; }
  /// The length by which the field's amplitude falls: that of the path, or the product of the lengths between
  /// its ends and its scatterings, m^(scatterings + 1). A patch is a disk to the next one.
  double spreading(const GeometricPath& path) const {
    if (!scattered()) return path.length_m;
    double product = 1.0, since_m = 0.0;
    for (size_t part = 0; part <= bend_count; ++part) {
      since_m += parts_m[part];
      if (part < bend_count && !scatters[part]) continue;
      const bool to_another = part == 1 && bend_count == 2 && scatters[0];
      product *= to_another ? between_patches_m(since_m, path.patch_area_m2) : since_m;
      since_m = 0.0;
    }
    return product;
  }
};

/// Sets the directions of the runs [first, last), which reflections join. Returns the sum of their lengths.
double set_directions(const GeometricPath& path, const FacetWorld& world, size_t first, size_t last,
                      Runs& runs) {
  const auto along = [&](size_t run) {
    return path.vertices[runs.vertices[run + 1]] - path.vertices[runs.vertices[run]];
  };
  size_t longest = first;
  double longest_m = 0.0, sum_m = 0.0;
  for (size_t run = first; run < last; ++run) {
    const double length = glm::length(along(run));
    sum_m += length;
    if (length > longest_m) longest = run, longest_m = length;
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

Runs runs_of(const GeometricPath& path, const FacetWorld& world) {
  Runs runs;
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
    runs.parts_m[part] = set_directions(path, world, first, last, runs);
    first = last;
  }
  return runs;
}

/// Holds the field of a path on its way: the images of the unit fields along theta and phi at the
/// transmitter.
class Travelling {
 public:
  Travelling(const FieldModel& model, const dvec3& departure) : model_(model) {
    columns_[0].add(1.0, theta_hat(departure));
    columns_[1].add(1.0, phi_hat(departure));
  }
  const FieldVector& column(int index) const { return columns_[index]; }

  void through_air(const dvec3& direction, double length_m) {
    if (model_.attenuation.none()) return;
    for (FieldVector& field : columns_) field = model_.attenuation.after(field, direction, length_m);
  }

  void reflect(const PosedFacet& facet, const dvec3& in, const dvec3& out, Complex weight) {
    const double towards = glm::dot(in, facet.normal), cosine = std::min(1.0, std::abs(towards));
    const ReflectionCoefficients fresnel = model_.surfaces->reflect(facet.material, towards < 0.0, cosine);
    const double kept = specular_share(facet.material, cosine);
    const dvec3 s = s_axis(in, facet.normal);
    map(s, glm::cross(in, s), s, glm::cross(out, s),
        {kept * fresnel.r_te, Complex(0.0), Complex(0.0), kept * fresnel.r_tm});
    if (weight == 1.0) return;
    for (FieldVector& column : columns_) column.scale(weight);
  }

  void transmit(const PosedFacet& facet, const dvec3& direction) {
    const double towards = glm::dot(direction, facet.normal), cosine = std::min(1.0, std::abs(towards));
    const SheetTransmission sheet = model_.surfaces->transmit(facet.material, towards < 0.0, cosine);
    const dvec3 s = s_axis(direction, facet.normal), p = glm::cross(direction, s);
    map(s, p, s, p, {sheet.te, Complex(0.0), Complex(0.0), sheet.tm});
  }

  void scatter(const PosedFacet& facet, const Interaction& patch, double area_m2, const dvec3& in,
               const dvec3& out) {
    GREATX_CHECK(area_m2 > 0.0, "patch {} of facet {} has {} m^2", patch.patch, patch.element, area_m2);
    const double towards = glm::dot(in, facet.normal), cosine = std::min(1.0, std::abs(towards));
    const dvec3 normal = towards < 0.0 ? facet.normal : -facet.normal;
    const ReflectionCoefficients fresnel = model_.surfaces->reflect(facet.material, towards < 0.0, cosine);
    const DiffuseScattering& surface = model_.surfaces->surface(facet.material).scattering;
    const double amplitude =
        surface.coefficient * std::sqrt(scattering_pattern(surface, in, out, normal) * cosine * area_m2);
    const ScatteringMatrix m =
        scattering_matrix(surface.cross_polarization, model_.effects.seed, patch.element, patch.patch);
    const Complex te = amplitude * fresnel.r_te, tm = amplitude * fresnel.r_tm;
    const dvec3 s_in = s_axis(in, normal), s_out = s_axis(out, normal);
    map(s_in, glm::cross(in, s_in), s_out, glm::cross(out, s_out),
        {m.ss * te, m.sp * tm, m.ps * te, m.pp * tm});
  }

  /// The results spread by the whole length from there on (edge_dyadic).
  void diffract(const scene::Wedge& wedge, const dvec3& in, const dvec3& out, double before_m, double after_m,
                const EdgeSides& sides) {
    const auto share = [this](uint32_t material, double cosine) { return specular_share(material, cosine); };
    const EdgeDyadic edge =
        edge_dyadic(wedge, in, out, before_m, after_m, *model_.world, *model_.surfaces, share, sides);
    for (FieldVector& field : columns_) field = edge.apply(field);
  }

  void diffract_at(const scene::Wedge& wedge, Corner corner, const dvec3& in, const dvec3& out,
                   double before_m, double after_m, KellerSide side) {
    const auto share = [this](uint32_t material, double cosine) { return specular_share(material, cosine); };
    const EdgeDyadic end = corner_dyadic(wedge, corner, in, out, before_m, after_m, *model_.world,
                                         *model_.surfaces, share, side);
    for (FieldVector& field : columns_) field = end.apply(field);
  }

  /// Arrives at the first of two edges. What lies between them acts on two unit fields until the second.
  void leave_first_edge(const dvec3& between) {
    at_first_edge_[0] = columns_[0], at_first_edge_[1] = columns_[1];
    axes_[0] = theta_hat(between), axes_[1] = phi_hat(between);
    for (int i = 0; i < 2; ++i) {
      columns_[i] = {};
      columns_[i].add(1.0, axes_[i]);
    }
  }
  void diffract_at_both(const scene::Wedge& first, const scene::Wedge& second, const TwoEdgeRays& rays) {
    const auto share = [this](uint32_t material, double cosine) { return specular_share(material, cosine); };
    const auto between = [this](const FieldVector& field) {
      FieldVector sum;
      for (int i = 0; i < 2; ++i) {
        FieldVector part = columns_[i];
        part.scale(field.along(axes_[i]));
        sum.re += part.re, sum.im += part.im;
      }
      return sum;
    };
    const TwoEdgeMatrix edges =
        two_edge_matrix(first, second, rays, *model_.world, *model_.surfaces, share, between);
    FieldVector behind[2];
    for (int i = 0; i < 2; ++i) behind[i] = edges.apply(at_first_edge_[i]);
    columns_[0] = behind[0], columns_[1] = behind[1];
  }

 private:
  /// Maps components on (s_in, p_in) to components on (s_out, p_out) by the matrix [ss sp; ps pp], out by in.
  void map(const dvec3& s_in, const dvec3& p_in, const dvec3& s_out, const dvec3& p_out,
           const ScatteringMatrix& by) {
    for (FieldVector& field : columns_) {
      const Complex s = field.along(s_in), p = field.along(p_in);
      field = {};
      field.add(by.ss * s + by.sp * p, s_out);
      field.add(by.ps * s + by.pp * p, p_out);
    }
  }

  double specular_share(uint32_t material, double cosine) const {
    const FieldEffects& effects = model_.effects;
    return rf::specular_share(model_.surfaces->surface(material), cosine, model_.surfaces->wavelength_m(),
                              effects.roughness ? std::optional(effects.roughness_model) : std::nullopt,
                              effects.scattering);
  }

  const FieldModel& model_;
  FieldVector columns_[2];
  FieldVector at_first_edge_[2];
  dvec3 axes_[2];  ///< of the ray between two edges
};

double foliage_amplitude(const FieldModel& model, double depth_m) {
  if (!model.effects.foliage || depth_m == 0.0) return 1.0;
  GREATX_CHECK(model.foliage.has_value(), "{} m of foliage that the field model does not know", depth_m);
  return std::pow(10.0, -foliage_db(*model.foliage, model.surfaces->carrier_hz(), depth_m) / 20.0);
}

const scene::Wedge& wedge_of(const FieldModel& model, const Interaction& interaction) {
  GREATX_CHECK(interaction.element < model.wedges.size(), "wedge {} of {}", interaction.element,
               model.wedges.size());
  return model.wedges[interaction.element];
}

/// Returns the weight of the reflection at interaction `i`, between the runs `in` and `out`. The reflection's
/// part of the path, between bends and ends, is `part_m` long and has `before_m` before the reflection.
Complex reflection_weight(const GeometricPath& path, const FieldModel& model, size_t i, const dvec3& in,
                          const dvec3& out, double before_m, double part_m) {
  if (model.reflectors == nullptr) return 1.0;
  const ReflectionSight sight{path.vertices[i + 1], in, out, before_m, part_m - before_m};
  return model.reflectors->weight(*model.world, path.interactions[i].element, sight,
                                  2.0 * pi / model.surfaces->wavelength_m(), path.edges_diffract >> i & 1u);
}

/// Takes the field along a diffraction, the bend `bend` of the path.
void diffract(const GeometricPath& path, const FieldModel& model, const Runs& runs, size_t bend,
              Travelling& field) {
  const auto wedge = [&](size_t which) {
    const Interaction& interaction = path.interactions[runs.vertices[runs.bends[which]] - 1];
    return posed(wedge_of(model, interaction), *model.world);
  };
  const auto before = [&](size_t which) { return runs.directions[runs.bends[which] - 1]; };
  const dvec3& out = runs.directions[runs.bends[bend]];
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
void travel(const GeometricPath& path, const FieldModel& model, const Runs& runs, Travelling& field) {
  const FacetWorld& world = *model.world;
  size_t run = 0, part = 0;
  double patch_m2 = path.patch_area_m2;
  double before_m = 0.0;  // since the transmitter or the last bend
  for (size_t i = 0; i <= path.interactions.size(); ++i) {
    const dvec3& in = runs.directions[run];
    const double segment_m = glm::length(path.vertices[i + 1] - path.vertices[i]);
    before_m += segment_m;
    field.through_air(in, segment_m);
    if (i == path.interactions.size()) break;
    const Interaction& interaction = path.interactions[i];
    const dvec3& out = interaction.type == InteractionType::transmission ? in : runs.directions[++run];
    switch (interaction.type) {
      case InteractionType::reflection:
        field.reflect(world.facet(interaction.element), in, out,
                      reflection_weight(path, model, i, in, out, before_m, runs.parts_m[part]));
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
void set_transfer(const GeometricPath& path, const FieldModel& model, const Runs& runs,
                  Complex (&transfer)[4]) {
  Travelling field(model, runs.directions.front());
  double spreading = 1.0 / runs.spreading(path);
  if constexpr (all_effects_built) {
    travel(path, model, runs, field);
    spreading *= foliage_amplitude(model, path.foliage_m);
  }
  const dvec3 arrival = -runs.directions.back(), theta = theta_hat(arrival), phi = phi_hat(arrival);
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

/// Returns the rate at which the path shortens, m/s: v_0 . k_0 - v_{n+1} . k_n + sum v_i . (k_i - k_{i-1}).
double closing_rate(const GeometricPath& path, const FieldModel& model, const Runs& runs,
                    const dvec3& transmitter_velocity, const dvec3& receiver_velocity) {
  double rate = glm::dot(transmitter_velocity, runs.directions.front()) -
                glm::dot(receiver_velocity, runs.directions.back());
  for (size_t run = 1; run < runs.directions.size(); ++run) {
    const size_t vertex = runs.vertices[run];
    const Interaction& interaction = path.interactions[vertex - 1];
    const uint32_t facet = interaction.type == InteractionType::diffraction
                               ? wedge_of(model, interaction).facet_0
                               : interaction.element;
    rate += glm::dot(model.world->velocity(facet, path.vertices[vertex]),
                     runs.directions[run] - runs.directions[run - 1]);
  }
  return rate;
}

void check(const GeometricPath& path) {
  GREATX_CHECK(path.vertices.size() == path.interactions.size() + 2 && path.length_m > 0.0,
               "path of {} interactions, {} vertices, {} m", path.interactions.size(), path.vertices.size(),
               path.length_m);
}

}  // namespace

Path path_field(const GeometricPath& geometry, const FieldModel& model, const dvec3& transmitter_velocity,
                const dvec3& receiver_velocity) {
  check(geometry);
  const bool back = geometry.from_receiver;
  const GeometricPath turned = back ? reversed(geometry) : GeometricPath{};
  const GeometricPath& wave = back ? turned : geometry;
  const Runs runs = runs_of(wave, *model.world);
  Path path;
  path.interactions = geometry.interactions;
  path.vertices = geometry.vertices;
  path.length_m = geometry.length_m;
  path.foliage_m = geometry.foliage_m;
  path.patch_area_m2 = geometry.patch_area_m2;
  path.edges_diffract = geometry.edges_diffract;
  path.edge_sides = geometry.edge_sides;
  path.keller_side = geometry.keller_side;
  path.from_receiver = back;
  path.stratum = geometry.stratum;
  path.second_patch_area_m2 = geometry.second_patch_area_m2;
  path.draw_variance = geometry.draw_variance;
  path.delay_s = geometry.length_m / speed_of_light;
  path.doppler_hz = closing_rate(wave, model, runs, back ? receiver_velocity : transmitter_velocity,
                                 back ? transmitter_velocity : receiver_velocity) /
                    model.surfaces->wavelength_m();
  path.departure = runs.directions.front();
  path.arrival = -runs.directions.back();
  set_transfer(wave, model, runs, path.transfer);
  if (!back) return path;
  std::swap(path.departure, path.arrival);
  std::swap(path.transfer[1], path.transfer[2]);
  return path;
}

void path_transfer(const GeometricPath& geometry, const FieldModel& model, Complex (&transfer)[4]) {
  check(geometry);
  if (!geometry.from_receiver)
    return set_transfer(geometry, model, runs_of(geometry, *model.world), transfer);
  const GeometricPath wave = reversed(geometry);
  set_transfer(wave, model, runs_of(wave, *model.world), transfer);
  std::swap(transfer[1], transfer[2]);
}

}  // namespace greatx::rf
