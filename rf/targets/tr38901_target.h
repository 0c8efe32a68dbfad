// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Targets as 3GPP TR 38.901 (V19, clause 7.9.2) describes them: statistics of a kind of target in place of
// its surfaces. The parameters were taken from two transcriptions of the report that agree, not from the
// report itself (docs/targets.md).
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "rf/targets/target_model.h"

namespace greatx::rf {

/// human: RCS model 1, without angles; human_2: model 2. vehicle and agv have a single scattering point.
enum class Tr38901Kind : uint8_t { uav_small, uav_large, human, human_2, vehicle, agv };
inline constexpr std::array<std::string_view, 6> tr38901_kinds = {"uav_small", "uav_large", "human",
                                                                  "human_2",   "vehicle",   "agv"};

/// Holds the spread of sigma_S and the cross-polarization ratio of a kind, dB.
struct Tr38901Spread {
  double small_scale_db;                 ///< standard deviation of 10 lg sigma_S
  double xpr_mean_db, xpr_deviation_db;  ///< of 10 lg kappa
  double small_scale_mean_db() const;    ///< -(ln 10/20) small_scale_db^2 (eq. 7.9.2-1)
  double small_scale_most_db() const;    ///< mean + 3 deviations, where the draw ends (eq. 7.9.4-1)
};
Tr38901Spread tr38901_spread(Tr38901Kind kind);

/// Returns 10 lg(sigma_M sigma_D), dBsm (eq. 7.9.2-2 without angles, else 7.9.2-3), for directions in the
/// target's frame, whose front faces +x and whose top faces +z.
double tr38901_pattern_dbsm(Tr38901Kind kind, const Aspect& aspect);

/// Draws sigma_S, the cross-polarization ratio and the phases of each pair of legs once for a sequence: they
/// are functions of (seed, sequence, legs) and stay as the target moves, as within a drop of the report.
/// Pairs with source and receiver exchanged have the transposed matrix, and a pair of one leg with itself a
/// symmetric one.
class Tr38901Target : public TargetModel {
 public:
  /// `number` tells the targets of a channel apart.
  Tr38901Target(Tr38901Kind kind, uint64_t seed, uint64_t number)
      : kind_(kind), seed_(seed), number_(number) {}
  ScatterMatrix scatter(const Aspect& aspect, const EchoKey& key) const override;
  /// Returns the drawn 10 lg sigma_S of a pair of legs, dB.
  double small_scale_db(const EchoKey& key) const;

 private:
  struct Draw;
  Draw draw(const EchoKey& key) const;

  Tr38901Kind kind_;
  uint64_t seed_, number_;
};

}  // namespace greatx::rf
