// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// How far the records of a sensor are from those of a reference, in the units that users of the modality
// think in. An ErrorSum takes the records of one sensor, tick by tick, under one setting and under the
// reference, and keeps sums or samples; it does not keep the records.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/record.h"

namespace greatx::sim {

/// Holds one figure of error. It is 0 (or minus infinity in dB relative to a power) for equal records, and
/// larger for worse ones.
struct ErrorFigure {
  std::string name;  ///< "nmse", "flip"
  std::string unit;  ///< "dB", "m", "%", "1"
  double value = 0.0;
  std::string meaning;  ///< one line, e.g. "error of H(f) relative to its power"
};

/// Whether a figure is in dB relative to a power, so that errors add up as powers: `nmse` and `map`.
bool relative_db(std::string_view figure);

class ErrorSum {
 public:
  virtual ~ErrorSum() = default;
  /// Takes the records of one tick. The specs of both may differ in shapes (another resolution). Arrays that
  /// one of them lacks are left out.
  virtual void add(const SensorSpec& reference_spec, const Record& reference, const SensorSpec& spec,
                   const Record& record) = 0;
  /// Returns the figures of all records so far; the first one is the one to judge by. Figures without
  /// anything to compare are left out.
  virtual std::vector<ErrorFigure> figures() const = 0;
};

/// Returns the sum for a sensor of this SensorSpec::kind. `camera`, `event_camera`, `lidar`, `radar`, `csi`
/// and `map` have figures; null for others.
///
/// - csi: `nmse` dB (sum |H - H_ref|^2 / sum |H_ref|^2 over all records); `path_gain` dB, `path_gain_p95` dB
///   and `path_gain_most` dB (median, 95th percentile and largest |difference| over links that have a path in
///   both); `changed` % (links whose path gain differs by more than 0.1 dB, or with a path in one only);
///   `links` % (of links with a path in one of the two only); `delay_spread` ns (median); `paths` % (by `id`:
///   1 - |both| / |either|).
/// - camera: `flip` 1 (mean of FLIP at 67 pixels per degree; the smaller picture is enlarged bilinearly to
///   the reference's size); `ssim` 1 (1 - mean structural similarity, ssim.h); `depth` m (mean of
///   |difference| where both are finite), `depth_p95` m, `depth_other` % (pixels
///   finite in one only); `ids` % (pixels of another instance); `flow` px (mean end-point error).
/// - event_camera: `voxels` 1 (relative L1 of a voxel grid of 15 bins in time, each record for itself, events
///   shared bilinearly between bins, polarity as sign); `count` % (|n - n_ref| / n_ref); `time` us (median
///   over events that have a partner: the k-th event of a pixel and polarity); `unmatched` % (events of
///   either without a partner, of all).
/// - lidar: `range` m (mean of |difference| over returns that both have, by ring, azimuth and number of the
///   return); `range_p95` m; `intensity` 1 (mean of |difference|); `missed` % (returns of one only, of the
///   reference's).
/// - radar: `map` dB (sum |P - P_ref| / sum P_ref over the range-Doppler map, 10 log10); `missed` % (of the
///   reference's detections, within a bin of range and of velocity); `false` % (detections without a partner,
///   of the reference's number); `power` dB (median of |difference| of the partners' received powers).
/// - map (a radio map, map_study.h): `path_gain` dB and `path_gain_p95` dB (median and 95th percentile of
///   |difference| at the centres of the reference's cells, against the cell of the other map that contains
///   them, where both have a path); `coverage` % (of all cells of the reference, for each transmitter: a path
///   in one of the two only; a cell without a value, for example inside a solid, has no path).
std::unique_ptr<ErrorSum> make_error_sum(const std::string& kind);

}  // namespace greatx::sim
