// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Keeps from frame to frame what the beams of facets at rest have found, as long as the radar stands still.
// Everything at rest answers then as before. A beam asks for what is in its way by cones and rays; if no
// moving body comes near any of them, neither when they were asked nor now, it finds the same again, to the
// bit. Radars on masts and at roadsides look for little else; a radar that moves keeps nothing.
//
//   frame 1 (pose is new) ─► solved   frame 2 (same pose) ─► solved, kept   frame 3 ─► taken back
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <vector>

#include "rf/radar/echoes/echo_sender.h"
#include "rf/radar/echoes/echo_tracer.h"

namespace greatx::rf {

class BeamMemory {
 public:
  /// Facets are kept until their echoes and cones take this much, in bytes.
  static constexpr size_t most_bytes = size_t{64} << 20;

  explicit BeamMemory(size_t facets) : facets_(facets) {}
  /// Begins a search. Forgets everything if an end is elsewhere than in the search before.
  void begin(const Pose& transmitter, const Pose& receiver);
  /// Returns whether the ends are where they were in the search before.
  bool stands_still() const { return still_; }
  /// Returns what a facet at rest sent back when it was kept, if a moving body comes near none of its cones;
  /// else null. `view` hides no moving body that the beams see.
  const RawEchoes* find(uint32_t facet, const EchoTracer& tracer, const EchoTracer::View& view) const;
  /// Keeps what a facet at rest has sent back, if there is room and no moving body comes near the cones by
  /// which it was found. Several threads may keep different facets.
  void keep(uint32_t facet, const RawEchoes& sent, const std::vector<EchoTracer::Reach>& cones,
            const EchoTracer& tracer, const EchoTracer::View& view);

 private:
  struct Kept {
    RawEchoes sent;
    std::vector<EchoTracer::Reach> cones;
  };
  size_t facets_;
  std::vector<std::unique_ptr<Kept>> kept_;  ///< [facets], null for those not kept; or empty
  std::atomic<size_t> bytes_{0};
  Pose transmitter_, receiver_;
  bool began_ = false, still_ = false;
};

}  // namespace greatx::rf
