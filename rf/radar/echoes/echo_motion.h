// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Describes how ends and bodies move during a radar frame, and what a search for echoes counts.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "core/vec.h"

namespace greatx::rf {

/// Describes all motion during a frame. Times are seconds from the start of the frame; poses are in local
/// coordinates.
struct EchoMotion {
  std::function<Pose(double time_s)> transmitter, receiver;
  /// Returns the pose of a body. It is never called for body 0. At `traced_s` it must return the pose with
  /// which the scene was traced. Several threads call it.
  std::function<Pose(uint32_t body, double time_s)> body;
  double traced_s = 0.0;
  uint64_t frame = 0;  ///< number of the frame, for what is drawn afresh in each
  uint32_t first_slot = 0;
  std::vector<double> slot_start_s;  ///< [slots] start times of the slots of this list, ascending
  double slot_s = 0.0;               ///< length of the last slot
  double frame_s() const {
    return slot_start_s.empty() ? 0.0 : slot_start_s.back() + slot_s - slot_start_s.front();
  }
};

/// Holds counts of a search, for summaries.
struct EchoStatistics {
  uint32_t tubes = 0;
  uint32_t facets = 0;          ///< facets with beams of their own
  uint32_t remembered = 0;      ///< of `facets`, those whose echoes were kept from an earlier search
  uint32_t images = 0;          ///< facets with beams over mirrors, counted once for each mirror
  uint64_t contributions = 0;   ///< number of contributions before merging
  uint64_t below_floor = 0;     ///< number of edges, corners and echoes that are left out as too weak
  uint64_t patches = 0;         ///< scatterers of rough surfaces
  uint32_t patch_blocks = 0;    ///< blocks of constant rate that they need
  uint64_t left_out = 0;        ///< number of echoes beyond EchoOptions::max_echoes
  double left_out_power = 0.0;  ///< sum of |amplitude|^2 of the echoes left out
};

}  // namespace greatx::rf
