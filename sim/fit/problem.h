// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Describes a fit of materials to measurements, as plain data (docs/fit.md).
//
//   FIT.yaml, CSV, NumPy ─► FitProblem (apps/fit) ─► solve_links: all paths, once ─► FitModel
//     ─► FitSolver: iterations of Levenberg and Marquardt ─► assess: uncertainties, what cannot be told apart
#pragma once

#include <complex>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/vec.h"

namespace greatx::sim {

/// The properties of a material that a fit may change. They are those at the carrier of the channel.
enum class FitProperty : uint8_t {
  permittivity,        ///< real part, 1 or more
  conductivity,        ///< S/m
  thickness,           ///< m
  roughness,           ///< rms height, m
  scattering,          ///< S, below 1
  cross_polarization,  ///< K_x
  backscatter_share    ///< 1 - Lambda
};
/// Returns the name in files, e.g. "permittivity".
const char* name_of(FitProperty property);
/// Returns the unit, e.g. "S/m"; "1" for a ratio.
const char* unit_of(FitProperty property);

/// A normal distribution of a variable that is known beforehand.
struct FitPrior {
  double mean = 0.0;
  double sigma = 1.0;  ///< in the unit of the variable; of its logarithm if the variable is logarithmic
};

/// Describes what a fit knows of a variable beforehand.
struct FitRange {
  double low = 0.0, high = 0.0;
  std::optional<double> start;  ///< none: the value of the scene, or of no effect
  std::optional<FitPrior> prior;
  bool logarithmic = false;  ///< the fit works on the logarithm of the variable
};

/// A property of materials that the fit determines. Several materials share one value.
struct FitParameter {
  std::vector<std::string> materials;  ///< names; at least one
  FitProperty property = FitProperty::permittivity;
  uint32_t layer = 0;    ///< of the wall or of its windows, the outermost is 0
  bool windows = false;  ///< the layer is one of the windows
  FitRange range;
  SourceLocation where;
};

/// Properties of the measurement that the fit determines beside the materials.
enum class FitUnknownKind : uint8_t { scale_db, clock_s, orientation_deg, antenna_offset_m };
const char* name_of(FitUnknownKind kind);

struct FitUnknown {
  enum class Each : uint8_t { all, file, position };
  enum class End : uint8_t { receiver, transmitter };
  FitUnknownKind kind = FitUnknownKind::scale_db;
  /// Whether one value stands for all measurements, for those of a file, or for one position.
  Each each = Each::file;
  End end = End::receiver;  ///< of orientation and offset
  FitRange range;
  SourceLocation where;
};

enum class FitQuantity : uint8_t { power_db, delay_spread_ns, cir, cfr };
const char* name_of(FitQuantity quantity);

/// The frequencies at which the band is sampled, and how an impulse response is made of them.
struct FitBand {
  uint32_t subcarriers = 1;
  double spacing_hz = 0.0;
  bool hann = false;  ///< a Hann window over the band, of mean 1; otherwise the band has sharp edges
  int32_t first_tap = 0;
  uint32_t taps = 1;  ///< taps from first_tap on, modulo `subcarriers`
};

/// Measurements of one kind, with the places where they were made.
struct FitSet {
  std::string name;
  uint32_t transmitter = 0;  ///< index in the channel
  std::string receiver;  ///< antenna of the scenario that stands at the positions; empty: isotropic, vertical
  FitQuantity quantity = FitQuantity::power_db;
  /// Fields of different paths add, and the power is the mean over the subcarriers and the pairs of ports;
  /// otherwise the powers of the paths add.
  bool coherent = false;
  /// The delay spread is that of the impulse response in the band; otherwise that of the paths.
  bool from_response = false;
  bool complex_values = false;  ///< real and imaginary parts are compared; otherwise levels in dB
  bool phase_known = false;     ///< of complex values; otherwise each position has a phase of its own
  FitBand band;
  uint32_t transmit_port = 0, receive_port = 0;  ///< of cir and cfr
  double floor_db = 30.0;  ///< levels are compared down to this far below the highest of a position
  /// Deviation of one value, in its unit (complex: of real and imaginary part, relative to the rms of the
  /// position); none: it is estimated.
  std::optional<double> sigma;
  std::vector<dvec3> points;        ///< world, m
  std::vector<dquat> orientations;  ///< of the receivers' nodes; empty: that of the antenna in the scenario
  uint32_t width = 1;               ///< values of a position
  std::vector<double> values;  ///< [points, width] in the unit of the quantity, dB for cir and cfr; NaN: none
  std::vector<std::complex<double>> responses;  ///< [points, width], if complex_values: over subcarriers
};

enum class FitLossKind : uint8_t { squares, huber, cauchy };

/// How much a residual counts, over its deviation x: x^2/2; Huber's, which grows linearly beyond `scale`; or
/// Cauchy's, scale^2/2 ln(1 + (x/scale)^2).
struct FitLoss {
  FitLossKind kind = FitLossKind::huber;
  double scale = 1.345;
  double cost(double x) const;
  double slope(double x) const;      ///< psi, the derivative of the cost
  double weight(double x) const;     ///< psi(x)/x
  double curvature(double x) const;  ///< psi'
};

/// Which positions are held out: whole blocks of the plan, so that neighbours are not on both sides.
struct FitSplit {
  double block_m = 2.0;
  double held_out = 0.25;  ///< share of the blocks
  uint64_t seed = 1;
};

struct FitProblem {
  std::vector<FitSet> sets;
  std::vector<FitParameter> parameters;
  std::vector<FitUnknown> unknowns;
  FitLoss loss;
  FitSplit split;
  uint64_t seed = 1;    ///< of the starts
  uint32_t starts = 8;  ///< runs of the search for the best minimum; the first starts from the scene's values
  uint32_t iterations = 100;  ///< at most, of each run
};

}  // namespace greatx::sim
