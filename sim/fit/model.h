// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Predicts the measurements of a fit from the values of its variables, on a fixed set of paths.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sim/fit/signal.h"

namespace greatx::sim {

/// A number that the fit determines: a parameter of materials, or an unknown of the measurement.
struct FitVariable {
  std::string name;  ///< "wall: permittivity", "walk: scale_db"
  std::string unit;
  double start = 0.0, low = 0.0, high = 0.0;
  bool logarithmic = false;
  std::optional<FitPrior> prior;  ///< of the coordinate
  bool of_material = false;
  bool estimated = false;  ///< its start follows from the measurements and the other variables
  /// The fit works on coordinates: the value, or its logarithm.
  double coordinate(double value) const;
  double value(double coordinate) const;
};

/// What one position says: differences of the model from the measurement.
struct FitBlock {
  std::vector<uint32_t> columns;  ///< the variables that the rows depend on, ascending
  Eigen::VectorXd residuals;      ///< modelled - measured, in the unit of the set
  Eigen::MatrixXd slopes;         ///< [rows, columns] by the coordinates; empty if not asked for
  /// Unknowns of the position alone (phase, clock) that were chosen for the best agreement. The slopes are
  /// those that remain when these follow (variable projection: G. H. Golub, V. Pereyra, SIAM J. Numer. Anal.
  /// 10(2), 1973; without the second-order term of L. Kaufman, BIT 15, 1975).
  uint32_t own_unknowns = 0;
};

/// Throws UserError, at the unknown, if no measurement depends on an unknown, if an unknown of each position
/// has a measurement without phases, or if the search for the clock of a position has too many steps.
void check_unknowns(const FitProblem& problem);

class FitModel {
 public:
  /// `problem` and `materials` outlive this. Throws UserError like check_unknowns().
  FitModel(const FitProblem& problem, const FitMaterials& materials, double carrier_hz,
           std::vector<FitLink> links);

  const FitProblem& problem() const { return problem_; }
  const FitMaterials& materials() const { return materials_; }
  const std::vector<FitLink>& links() const { return links_; }
  /// The parameters of materials first, in their order.
  const std::vector<FitVariable>& variables() const { return variables_; }
  /// Whether a link has a path with power and a measured value.
  bool usable(size_t link) const { return usable_[link]; }
  /// Returns the coordinates before the fit. Scales and clocks without a start are estimated from the
  /// medians over the positions in `links`.
  std::vector<double> start(std::span<const uint32_t> links) const;
  /// Does the same with the other variables as in `coordinates`.
  std::vector<double> estimated(std::span<const double> coordinates, std::span<const uint32_t> links) const;
  std::vector<double> values(std::span<const double> coordinates) const;

  /// Returns the blocks of `links` (indices of usable ones), in their order. The result does not depend on
  /// the number of threads. Without `of_materials` the slopes by parameters of materials are 0.
  std::vector<FitBlock> blocks(std::span<const double> coordinates, std::span<const uint32_t> links,
                               bool slopes, bool of_materials = true) const;
  /// Returns the share of a link's power on paths that depend on a parameter, [parameters].
  std::vector<double> shares(std::span<const double> coordinates, uint32_t link) const;

 private:
  /// The variables of a set; negative: it has none.
  struct SetVariables {
    int scale = -1, clock = -1, orientation = -1, offset = -1;
    FitUnknown::End orientation_end = FitUnknown::End::receiver, offset_end = FitUnknown::End::receiver;
    std::optional<FitRange> own_clock;  ///< of each position
  };
  struct Columns;
  int add_variable(const FitUnknown& unknown, const std::string& of, const char* axis);
  void bind(const FitUnknown& unknown);
  PathTerms terms_of(uint32_t link, const TransferSlopes& fields, std::span<const double> values,
                     const Columns& columns, bool slopes) const;
  Signal band_response(const PathTerms& terms, const FitSet& set, std::span<const double> values,
                       const Columns& columns, bool slopes) const;
  FitBlock block(uint32_t link, const TransferSlopes& fields, std::span<const double> values,
                 bool slopes) const;
  FitBlock complex_block(uint32_t link, Signal response, std::span<const double> values,
                         const Columns& columns, bool slopes) const;
  double best_scale_db(uint32_t link, const TransferSlopes& fields, std::span<const double> values) const;
  double best_clock_s(uint32_t link, const TransferSlopes& fields, std::span<const double> values) const;

  const FitProblem& problem_;
  const FitMaterials& materials_;
  double carrier_hz_;
  std::vector<FitLink> links_;
  std::vector<FitVariable> variables_;
  std::vector<SetVariables> sets_;
  std::vector<uint8_t> estimated_;   ///< [variables] 1: a scale, 2: a clock without a start
  std::vector<uint8_t> usable_;      ///< [links]
  std::vector<FitWeights> weights_;  ///< [links]; empty where an orientation is unknown
};

}  // namespace greatx::sim
