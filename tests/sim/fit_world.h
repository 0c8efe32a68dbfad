// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// A closed world for fits: ground, a wall that reflects, two panes in the way, and a plate that no path
// meets. Measurements are made by the model itself with other materials, so that the truth is known.
#pragma once

#include <cmath>
#include <memory>
#include <numbers>
#include <numeric>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "core/random.h"
#include "sim/fit/assess.h"
#include "sim/fit/split.h"
#include "tests/sim/radio_run.h"
#include "tests/support/gpu_fixture.h"

namespace greatx::sim::testing {

inline constexpr double fit_carrier_hz = 3.5e9;

inline scene::Material flat_material(const std::string& name, double permittivity, double conductivity,
                                     double thickness_m = 0.0) {
  scene::Material material;
  material.name = name;
  scene::RadioMaterial radio;
  radio.layers.push_back(
      {{"test", {{permittivity, 0.0, conductivity, 0.0, 0.0, INFINITY}}, false}, thickness_m});
  material.radio = radio;
  return material;
}

/// Returns the world, with or without panes; the wall is a half-space, or a slab.
inline scene::Scene fit_scene(bool panes, bool slab = false) {
  test::TinyScene tiny;
  const uint32_t ground = tiny.material_as(flat_material("ground", 5.0, 0.05)),
                 wall = tiny.material_as(slab ? flat_material("wall", 5.0, 0.02, 0.12)
                                              : flat_material("wall", 4.0, 0.02)),
                 first = tiny.material_as(flat_material("first pane", 4.0, 0.05, 0.02)),
                 second = tiny.material_as(flat_material("second pane", 4.0, 0.05, 0.02)),
                 away = tiny.material_as(flat_material("away", 3.0, 0.01));
  tiny.object("ground", 0, ground).quad({-100, -100, 0}, {100, -100, 0}, {100, 100, 0}, {-100, 100, 0});
  tiny.object("wall", 0, wall).quad({-100, 20, 0}, {100, 20, 0}, {100, 20, 30}, {-100, 20, 30});
  tiny.object("away", 0, away).quad({-100, -100, -5}, {-100, 100, -5}, {100, 100, -5}, {100, -100, -5});
  if (panes) {
    tiny.object("first", 0, first).quad({-60, -100, 0}, {-60, 20, 0}, {-60, 20, 30}, {-60, -100, 30});
    tiny.object("second", 0, second).quad({-59, -100, 0}, {-59, 20, 0}, {-59, 20, 30}, {-59, -100, 30});
  }
  return tiny.build();
}

inline std::string fit_scenario(const std::string& antenna = "") {
  return fmt::format(
      "greatx: 1\nname: test\nticks: 1\ntick_rate_hz: 100\nnodes:\n"
      "  - name: bs\n    trajectory: {{type: static, position_m: [-70, 0, 10]}}\n"
      "    sensors: [{{name: antenna, type: antenna}}]\n"
      "  - name: ue\n    trajectory: {{type: static, position_m: [0, 0, 1.5]}}\n"
      "    sensors: [{{name: antenna, type: antenna{}}}]\n"
      "channels:\n  - {{name: csi, tx: [bs/antenna], rx: [ue/antenna], rate_hz: 100, subcarriers: 32, "
      "bandwidth_hz: 80e6, carrier_hz: {}, max_depth: 3}}\n"
      "effects: {{gas: off, finite_reflectors: off, diffraction: off, wave_curvature: off}}\n",
      antenna, fit_carrier_hz);
}

/// Returns places that are drawn over the street.
inline std::vector<dvec3> fit_points(size_t count) {
  std::vector<dvec3> points;
  RandomStream random(9, 1);
  for (size_t i = 0; i < count; ++i)
    points.emplace_back(random.uniform(-50.0, 60.0), random.uniform(-30.0, 15.0), random.uniform(1.0, 3.0));
  return points;
}

/// Returns a normal number of unit deviation (G. E. P. Box, M. E. Muller, Ann. Math. Stat. 29, 1958).
inline double normal(RandomStream& random) {
  const double radius = std::sqrt(-2.0 * std::log(1.0 - random.uniform()));
  return radius * std::cos(2.0 * std::numbers::pi * random.uniform());
}

inline FitParameter parameter(const std::string& material, FitProperty property, double low, double high) {
  FitParameter one;
  one.materials = {material};
  one.property = property;
  one.range.low = low, one.range.high = high;
  one.range.logarithmic = property == FitProperty::conductivity;
  return one;
}

inline FitSet fit_set(FitQuantity quantity, size_t points) {
  FitSet set;
  set.name = name_of(quantity);
  set.quantity = quantity;
  set.points = fit_points(points);
  set.band = {32, 2.5e6, false, 0, 32};
  set.width = quantity == FitQuantity::cir || quantity == FitQuantity::cfr ? 32 : 1;
  set.values.assign(set.points.size() * set.width, 0.0);
  return set;
}

/// A problem in the world, with its paths.
class FitWorld {
 public:
  FitWorld(FitProblem problem, const scene::Scene& scene, const std::string& scenario = fit_scenario())
      : problem_(std::move(problem)),
        experiment_(experiment_in(scenario, scene, bounds_of(problem_.sets))),
        materials_(experiment_.scene(), fit_carrier_hz, problem_.parameters),
        links_(
            *solve_links(test::device(), experiment_, 0, problem_, materials_, [](size_t) { return true; })) {
    make_model();
  }
  FitProblem& problem() { return problem_; }
  const FitModel& model() const { return *model_; }
  const FitMaterials& materials() const { return materials_; }
  /// Makes the model anew after a change of the problem's measurements.
  void make_model() { model_ = std::make_unique<FitModel>(problem_, materials_, fit_carrier_hz, links_); }
  std::vector<uint32_t> all() const {
    std::vector<uint32_t> links;
    for (uint32_t l = 0; l < links_.size(); ++l)
      if (model_->usable(l)) links.push_back(l);
    return links;
  }
  std::vector<double> coordinates(const std::vector<double>& values) const {
    std::vector<double> all;
    for (size_t v = 0; v < values.size(); ++v) all.push_back(model_->variables()[v].coordinate(values[v]));
    return all;
  }
  /// Gives single-valued sets the measurements of the model with `values` and noise of this deviation.
  void measure(const std::vector<double>& values, double deviation, uint64_t seed) {
    for (FitSet& set : problem_.sets) std::ranges::fill(set.values, 0.0);
    make_model();
    RandomStream random(seed, 2);
    const std::vector<uint32_t> links = all();
    const std::vector<FitBlock> blocks = model_->blocks(coordinates(values), links, false);
    for (size_t i = 0; i < links.size(); ++i) {
      const FitLink& link = links_[links[i]];
      problem_.sets[link.set].values[link.position] = blocks[i].residuals[0] + deviation * normal(random);
    }
    make_model();
  }
  /// Runs the fit over all positions.
  FitState fitted(const std::vector<uint32_t>& links) const {
    const FitSolver solver(*model_, links);
    FitState state = solver.begin();
    while (!state.done) solver.step(state);
    return state;
  }
  FitAssessment assessed(const FitState& state, const std::vector<uint32_t>& links) const {
    std::vector<uint32_t> blocks(links.size());
    std::iota(blocks.begin(), blocks.end(), 0u);
    return assess(*model_, FitSolver(*model_, links), state, blocks);
  }

 private:
  FitProblem problem_;
  Experiment experiment_;
  FitMaterials materials_;
  std::vector<FitLink> links_;
  std::unique_ptr<FitModel> model_;
};

}  // namespace greatx::sim::testing
