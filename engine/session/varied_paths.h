// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes responses of the paths of a PathSet at other values of its parameters, and their derivatives
// there. The set of paths stays: the same sequences of interactions are solved again.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/session/path_parameters.h"
#include "engine/session/path_set.h"
#include "rf/gradient/response_gradient.h"

namespace greatx::engine {

/// Gives a parameter other values, C order, as many as PathParameter::values.
struct ParameterValues {
  std::string name;
  std::vector<double> values;
};

class VariedPaths {
 public:
  /// Throws UserError for an unknown parameter, a wrong number of values, a value out of range, and where
  /// derivatives are not known: with dispersion, over targets, of paths through foliage whose ends move, and
  /// for another carrier together with given permittivities or conductivities.
  VariedPaths(std::shared_ptr<const PathSet> set, const std::vector<ParameterValues>& values);

  /// Returns as JSON: `paths`, and of those `beyond` (a point lies beyond its facet or edge, the field is a
  /// continuation), `blocked` (a surface stands in the way, or other walls do) and `lost` (there is no such
  /// path, and it is left out of the sums).
  std::string facts() const;

  // Complex arrays are float64 with a last axis of (re, im).

  /// Returns H, [rx, rx_ant, tx, tx_ant, time, subcarrier, 2].
  Array response(const ResponseRequest& request, const GoOn& go_on) const;
  /// Returns `jacobian` [rx, rx_ant, tx, tx_ant, time, subcarrier, column, 2], the derivatives of H, with the
  /// columns of these parameters one after the other.
  Array jacobian(const ResponseRequest& request, const std::vector<std::string>& names,
                 const GoOn& go_on) const;
  /// Returns the derivatives of `power` and `delay` [path, column], and of `path_gain`, `mean_delay` and
  /// `delay_spread` [rx, tx, column]. The paths are those of the PathSet. A column of a complex gain holds
  /// the derivative by its real part.
  NamedArrays quantity_slopes(const std::vector<std::string>& names) const;
  /// Returns the values of these quantities, without the last axis. A path that is lost has power 0 and the
  /// delay NaN.
  NamedArrays quantities() const;
  /// Returns for each name the gradient of a real loss, in the shape of the parameter. `cotangent` is dL/d Re
  /// H + j dL/d Im H in the shape of the response; the gradient of a complex gain is dL/d Re g + j dL/d Im g.
  NamedArrays gradient(const ResponseRequest& request, const std::vector<std::string>& names,
                       std::span<const double> cotangent, const GoOn& go_on) const;

 private:
  struct Link {
    const PathSet::Link* from = nullptr;
    dvec3 transmitter{0.0}, receiver{0.0};  ///< places of the ends, local coordinates
    dvec3 transmitter_velocity{0.0}, receiver_velocity{0.0};
    bool own = false;              ///< the paths differ from those of the set
    std::vector<rf::Path> solved;  ///< if `own`; without lost paths
    std::vector<size_t> numbers;   ///< [solved] their numbers in the set's link
    size_t beyond = 0, blocked = 0, lost = 0;
    const std::vector<rf::Path>& paths() const { return own ? solved : from->solved.paths; }
    size_t number(size_t path) const { return own ? numbers[path] : path; }
    size_t end(bool of_receiver) const {
      return of_receiver ? from->solved.receiver : from->solved.transmitter;
    }
  };
  /// The columns of a Jacobian.
  struct Columns {
    struct Column {
      size_t parameter = 0;  ///< index in `parameters`
      size_t axis = 0;
      /// Index in `of_paths`; none: the paths do not depend on it.
      std::optional<size_t> slope;
    };
    std::vector<const PathParameter*> parameters;
    std::vector<Column> columns;
    std::vector<rf::ChannelParameter> of_paths;
    std::optional<rf::CarrierSlopes> carrier;  ///< if the carrier is among them
  };
  void set_values(const std::vector<ParameterValues>& values);
  void set_surfaces();
  void check_known() const;
  void check_foliage(const rf::Path& path) const;
  void check_carrier() const;
  rf::ChannelGrid grid(const ResponseRequest& request) const;
  void solve();
  void solve_link(Link& link) const;
  bool is_clear(const rf::GeometricPath& path, const Link& link) const;
  rf::WeatherEffects weather_effects() const;
  rf::FieldModel field_model(const Link& link) const;
  Columns columns_of(const std::vector<std::string>& names) const;
  std::vector<std::vector<rf::PathSlope>> slopes_of(const Link& link, const Columns& columns) const;
  std::vector<rf::LinkTangent> tangents_of(const Link& link, const Columns& columns) const;
  rf::ResponseLink response_link(const Link& link, double half_band_hz = 0.0) const;
  rf::ResponseGradient response_gradient(const Link& link, const rf::ChannelGrid& grid,
                                         const ResponseRequest& request) const;
  std::vector<std::vector<double>> gradient_rows(const Link& link, const Columns& columns,
                                                 const rf::LinkCotangent& cotangent) const;
  bool for_links(const GoOn& go_on, const std::function<void(const Link&, size_t)>& of) const;
  Array blocks(std::vector<int64_t> columns, const GoOn& go_on,
               const std::function<void(const Link&, std::span<rf::Complex>)>& of) const;
  size_t index_of(const std::string& name) const;
  /// The values of a parameter for an end: all of a number, one row of an array.
  std::span<const double> row_of(const std::string& name, size_t end) const;
  dvec3 vector_of(const std::string& name, size_t end) const;
  bool is_changed(const std::string& name) const;

  std::shared_ptr<const PathSet> set_;
  std::map<std::string, size_t> indices_;    ///< of the parameters of the set, by name
  std::vector<std::vector<double>> values_;  ///< [parameters of the set]
  std::vector<bool> changed_;                ///< [parameters of the set]
  double carrier_hz_ = 0.0;
  std::optional<rf::RadioSurfaces> surfaces_;       ///< if a material or the carrier differs
  std::optional<rf::PathAttenuation> attenuation_;  ///< if the carrier differs
  std::vector<Link> links_;
  size_t paths_ = 0, beyond_ = 0, blocked_ = 0, lost_ = 0;
};

}  // namespace greatx::engine
