// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Predicts which joint settings of several knobs are worth measuring. The time of a joint setting is taken to
// be that of the scenario plus what slower settings add to it, times the factors of faster ones. Its error is
// the root of the sum of squares (powers add up for errors in dB). Both are predictions, so whoever reports
// or uses them measures the joint settings. They are wrong where one slow knob multiplies what another one
// costs (diffraction and scattering), or where errors are of one sign.
#pragma once

#include <string>
#include <vector>

namespace greatx::sim {

/// Squares an error so that those of independent knobs add up: 10^(x/10) for dB relative to a power, x^2
/// otherwise. Minus infinity dB is 0.
double error_power(double error, bool relative_db);
double error_of_power(double power, bool relative_db);

struct FrontSetting {
  double ms = 0.0;     ///< time of a tick with this setting alone
  double power = 0.0;  ///< error_power() against the knob's reference
};
struct FrontKnob {
  std::vector<FrontSetting> settings;
  size_t standard = 0;   ///< the scenario's own setting
  size_t reference = 0;  ///< the finest one that may be chosen
  double factor = 1.0;   ///< cost of the reference over that of the scenario's own setting
};

struct FrontPoint {
  std::vector<size_t> choice;           ///< of each knob, the index of its setting
  double added_ms = 0.0, factor = 1.0;  ///< of the prediction of time
  double ms = 0.0;                      ///< predicted
  double power = 0.0;                   ///< predicted
};

/// Returns the point with one more knob at a setting.
FrontPoint joined(FrontPoint point, double own_ms, const FrontSetting& setting, size_t choice);

/// Returns the joint settings that no other one beats in time and error, by ascending time. There are at most
/// `most` of them after each knob; of more, those are kept whose errors are spread most evenly on a
/// logarithmic scale, with both ends. The search goes knob by knob.
std::vector<FrontPoint> front_of(double own_ms, const std::vector<FrontKnob>& knobs, size_t most = 400);

/// Limits knobs to the scenario's own setting and to faster ones, until all references at once cost at most
/// `most` times the scenario. It assumes that factors multiply, since a knob that makes more links or paths
/// makes the others dearer. Of the knobs whose factor is above 2, that goes first whose own error is
/// smallest; a last one may cost four times `most`. Limited settings have infinite power, and the scenario's
/// own setting becomes the reference. Returns the indices of these knobs in the order in which they went.
std::vector<size_t> limit_costly(std::vector<FrontKnob>& knobs, double most);

/// Returns at most `count` points spread over the front, with both ends.
std::vector<FrontPoint> thinned(std::vector<FrontPoint> front, size_t count);

}  // namespace greatx::sim
