// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/radar/echoes/beam_memory.h"

#include <algorithm>

#include "core/same_pose.h"

namespace greatx::rf {
namespace {

bool any_near(const std::vector<EchoTracer::Reach>& cones, const EchoTracer& tracer,
              const EchoTracer::View& view) {
  return std::ranges::any_of(cones,
                             [&](const EchoTracer::Reach& cone) { return tracer.moving_near(view, cone); });
}

}  // namespace

void BeamMemory::begin(const Pose& transmitter, const Pose& receiver) {
  still_ = began_ && same_pose(transmitter, transmitter_) && same_pose(receiver, receiver_);
  began_ = true;
  transmitter_ = transmitter, receiver_ = receiver;
  if (still_ && kept_.empty()) kept_.resize(facets_);
  if (still_ || kept_.empty()) return;
  kept_.clear();
  bytes_ = 0;
}

const RawEchoes* BeamMemory::find(uint32_t facet, const EchoTracer& tracer,
                                  const EchoTracer::View& view) const {
  const Kept* const kept = kept_[facet].get();
  return kept != nullptr && !any_near(kept->cones, tracer, view) ? &kept->sent : nullptr;
}

void BeamMemory::keep(uint32_t facet, const RawEchoes& sent, const std::vector<EchoTracer::Reach>& cones,
                      const EchoTracer& tracer, const EchoTracer::View& view) {
  const size_t bytes = sizeof(Kept) + sent.echoes.size() * sizeof(RawEcho) +
                       sent.chains.size() * sizeof(uint32_t) +
                       sent.rough.parts.size() * sizeof(ClutterParts::Part) +
                       sent.rough.corners.size() * sizeof(dvec2) + cones.size() * sizeof(EchoTracer::Reach);
  if (kept_[facet] || bytes_ + bytes > most_bytes || any_near(cones, tracer, view)) return;
  bytes_ += bytes;
  kept_[facet] = std::make_unique<Kept>();
  kept_[facet]->sent.append(sent);
  kept_[facet]->cones = cones;
}

}  // namespace greatx::rf
