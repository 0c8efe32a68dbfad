// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The scene as the waves of one channel meet it: facets with their kinds and materials at the carrier, and
// the edges that diffract.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "rf/paths/radio_model.h"
#include "sim/experiment/experiment.h"
#include "view/overlay/path_story.h"

namespace greatx::view {

/// Made once for a channel and not changed afterwards, so that any thread may read it. Making it takes as
/// long as finding the scene's edges does, which is seconds in a huge scene.
class RadioFacts {
 public:
  /// `channel`: place among the channels of the scenario. Throws UserError like rf::RadioModel.
  RadioFacts(std::shared_ptr<const sim::Experiment> experiment, uint32_t channel);

  const sim::Experiment& experiment() const { return *experiment_; }
  const scene::Scene& scene() const { return experiment_->scene(); }
  uint32_t channel() const { return channel_; }
  double carrier_hz() const { return model_.surfaces.carrier_hz(); }
  const rf::RadioModel& model() const { return model_; }
  /// The edges that diffract; where diffraction is off, those that would.
  const std::vector<scene::Wedge>& wedges() const { return model_.wedges.empty() ? wedges_ : model_.wedges; }
  bool diffracts() const { return model_.effects.diffraction; }
  /// "itu_concrete: er 5.24, sigma 0.0987 S/m, 0.3 m thick", one line for each layer.
  std::string material_text(uint32_t material) const;

 private:
  std::shared_ptr<const sim::Experiment> experiment_;
  uint32_t channel_ = 0;
  rf::RadioModel model_;
  std::vector<scene::Wedge> wedges_;  ///< only if diffraction is off
};

/// "opaque", "wall that lets waves pass", ...
const char* name_of(rf::FacetKind kind);

/// Adds to a path what the scene knows of its interactions: angles, losses and what the surfaces are.
/// `bodies` are the poses of all bodies (local coordinates) at the record's tick. Stops that name no facet of
/// the scene stay as they are.
void explain(PathStory& story, const RadioFacts& facts, std::span<const Pose> bodies);

}  // namespace greatx::view
