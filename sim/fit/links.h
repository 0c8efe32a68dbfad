// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Holds the paths to all positions of a fit. They are solved once, with the materials of the scene; a fit
// changes their fields and nothing else.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "gpu/device.h"
#include "rf/channel/frequency_response.h"
#include "rf/geometry/path.h"
#include "sim/channel/channel_snapshot.h"
#include "sim/fit/materials.h"

namespace greatx::sim {

/// The paths from the transmitter of a set to one of its positions.
struct FitLink {
  uint32_t set = 0, position = 0;  ///< index in the problem, index in the set
  dvec3 place{0.0};                ///< world, m
  rf::ArrayPose transmitter, receiver;
  std::vector<rf::Path> paths;
  /// The facets for which the paths were solved, and the models that their fields need.
  std::shared_ptr<const rf::FacetWorld> world;
  std::shared_ptr<const RadioWorld> radio;
  rf::FieldModel fields;  ///< of `radio` and `world`, with endless reflectors

  /// A path whose field depends on parameters.
  struct Touched {
    uint32_t path = 0;
    std::vector<uint32_t> parameters;  ///< ascending
    /// The weights of its finite reflectors, which no material changes: a factor of the whole field, which
    /// `fields` leave out.
    rf::Complex weight = 1.0;
  };
  std::vector<Touched> touched;
};

/// Returns the world-space box of all positions, which decides which effects are on.
scene::Bounds bounds_of(std::span<const FitSet> sets);

/// Solves the paths to all positions, in the order of the sets, at the first tick of the scenario. Beams keep
/// their shape over the band (beam squint is not modelled). `go_on` is called with the number of positions
/// that are done and returns false to stop; nothing is returned then. Throws UserError if the scenario's
/// effect plan has dispersion.
std::optional<std::vector<FitLink>> solve_links(gpu::Device& device, const Experiment& experiment,
                                                uint32_t channel, const FitProblem& problem,
                                                const FitMaterials& materials,
                                                const std::function<bool(size_t done)>& go_on);

/// Lists the paths of a link whose field depends on a parameter: those that meet a facet or an edge of one of
/// its materials. Also moves the weights of finite reflectors from `fields` to the paths.
void find_touched(FitLink& link, const FitMaterials& materials);

}  // namespace greatx::sim
