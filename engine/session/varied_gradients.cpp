// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes the derivatives of VariedPaths.
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "core/units.h"
#include "engine/session/varied_paths.h"
#include "rf/channel/statistics.h"

namespace greatx::engine {
namespace {

using Role = PathParameter::Role;
using Kind = rf::ChannelParameter::Kind;

/// Returns J with exp(v + dv) = exp(J dv) exp(v) for small dv, the left Jacobian of the rotations (J. Solà et
/// al., "A micro Lie theory for state estimation in robotics", 2018, eq. 145). Column x is the turn that a
/// change of component x makes.
dmat3 turns_of_components(const dvec3& v) {
  const double squared = glm::dot(v, v), angle = std::sqrt(squared);
  const bool small = squared < 1e-6;
  const double a = small ? 0.5 - squared / 24.0 : (1.0 - std::cos(angle)) / squared;
  const double b = small ? 1.0 / 6.0 - squared / 120.0 : (angle - std::sin(angle)) / (squared * angle);
  dmat3 columns;
  for (int x = 0; x < 3; ++x) {
    dvec3 axis(0.0);
    axis[x] = 1.0;
    const dvec3 once = glm::cross(v, axis);
    columns[x] = axis + a * once + b * glm::cross(v, once);
  }
  return columns;
}

Kind kind_at(const PathParameter& parameter) {
  switch (parameter.role) {
    case Role::position:
      return parameter.of_receiver ? Kind::receiver_position : Kind::transmitter_position;
    case Role::velocity:
      return parameter.of_receiver ? Kind::receiver_velocity : Kind::transmitter_velocity;
    case Role::carrier:
      return Kind::carrier;
    default:
      return parameter.of_material.kind;
  }
}

bool acts_on_paths(Role role) {
  return role == Role::material || role == Role::carrier || role == Role::position || role == Role::velocity;
}

}  // namespace

VariedPaths::Columns VariedPaths::columns_of(const std::vector<std::string>& names) const {
  Columns out;
  const std::vector<PathParameter>& parameters = set_->parameters();
  for (const std::string& name : names) {
    const PathParameter& parameter = find_parameter(parameters, name);
    if (parameter.role == Role::carrier) {
      check_carrier();
      const rf::RadioModel& model = set_->radio_->model();
      out.carrier = rf::carrier_slopes(*model.scene, model.effects.weather, weather_effects(), carrier_hz_);
    }
    for (size_t axis = 0; axis < parameter.columns(); ++axis) {
      Columns::Column column{out.parameters.size(), axis, std::nullopt};
      if (acts_on_paths(parameter.role)) {
        column.slope = out.of_paths.size();
        rf::ChannelParameter of = parameter.of_material;
        of.kind = kind_at(parameter);
        of.axis = static_cast<uint32_t>(axis);
        out.of_paths.push_back(of);
      }
      out.columns.push_back(column);
    }
    out.parameters.push_back(&parameter);
  }
  return out;
}

/// Returns the slopes of each path, [paths][Columns::of_paths].
std::vector<std::vector<rf::PathSlope>> VariedPaths::slopes_of(const Link& link,
                                                               const Columns& columns) const {
  std::vector<std::vector<rf::PathSlope>> slopes(link.paths().size());
  if (columns.of_paths.empty()) return slopes;
  const rf::FieldModel model = field_model(link);
  const bool moves = std::ranges::any_of(columns.of_paths, [](const rf::ChannelParameter& parameter) {
    return parameter.kind == Kind::transmitter_position || parameter.kind == Kind::receiver_position;
  });
  for (size_t i = 0; i < slopes.size(); ++i) {
    const rf::Path& path = link.paths()[i];
    if (moves) check_foliage(path);
    slopes[i] = rf::path_slopes(path, model, link.transmitter_velocity, link.receiver_velocity,
                                columns.of_paths, columns.carrier ? &*columns.carrier : nullptr);
  }
  return slopes;
}

namespace {

/// Where waves are curved, an end that moves comes nearer to the patch that it sees, or to an image.
rf::PathTangent path_tangent(const rf::PathSlope& slope, Kind kind) {
  return {slope, kind == Kind::transmitter_position ? slope.length_m : 0.0,
          kind == Kind::receiver_position ? slope.length_m : 0.0};
}

}  // namespace

/// Returns one tangent for each column.
std::vector<rf::LinkTangent> VariedPaths::tangents_of(const Link& link, const Columns& columns) const {
  const std::vector<std::vector<rf::PathSlope>> slopes = slopes_of(link, columns);
  std::vector<rf::LinkTangent> tangents;
  for (const Columns::Column& column : columns.columns) {
    const PathParameter& parameter = *columns.parameters[column.parameter];
    rf::LinkTangent tangent;
    tangent.paths.resize(link.paths().size());
    if (column.slope)
      for (size_t i = 0; i < slopes.size(); ++i)
        tangent.paths[i] = path_tangent(slopes[i][*column.slope], columns.of_paths[*column.slope].kind);
    rf::EndTangent& end = parameter.of_receiver ? tangent.receiver : tangent.transmitter;
    if (parameter.role == Role::carrier) tangent.carrier_hz = 1.0;
    if (parameter.role == Role::slant) end.slants = {1.0, 1.0};
    if (parameter.role == Role::gain) end.gains.assign(static_cast<size_t>(parameter.shape[1]), 1.0);
    if (parameter.role == Role::attitude)
      end.attitude = turns_of_components(
          vector_of(parameter.name, link.end(parameter.of_receiver)))[static_cast<int>(column.axis)];
    tangents.push_back(std::move(tangent));
  }
  return tangents;
}

Array VariedPaths::jacobian(const ResponseRequest& request, const std::vector<std::string>& names,
                            const GoOn& go_on) const {
  const rf::ChannelGrid grid = this->grid(request);
  const Columns columns = columns_of(names);
  const size_t count = columns.columns.size();
  return blocks({grid.time_samples, grid.subcarriers, static_cast<int64_t>(count)}, go_on,
                [&](const Link& link, std::span<rf::Complex> out) {
                  const rf::ResponseGradient gradient = response_gradient(link, grid, request);
                  const std::vector<rf::LinkTangent> tangents = tangents_of(link, columns);
                  std::vector<rf::Complex> changes(count * gradient.size());
                  gradient.push_forward(tangents, changes);
                  for (size_t i = 0; i < gradient.size(); ++i)
                    for (size_t n = 0; n < count; ++n) out[i * count + n] = changes[n * gradient.size() + i];
                });
}

NamedArrays VariedPaths::quantities() const {
  std::vector<size_t> offsets{0};
  for (const PathSet::Link& link : set_->links_) offsets.push_back(offsets.back() + link.solved.paths.size());
  const auto rows = static_cast<int64_t>(offsets.back());
  const std::vector<int64_t> links{static_cast<int64_t>(set_->receivers()),
                                   static_cast<int64_t>(set_->transmitters())};
  NamedArrays arrays{
      {"power", "1", "[path] mean of |a|^2 over the pairs of ports", Array(DType::f64, {rows})},
      {"delay", "s", "[path] NaN for a path that is lost", Array(DType::f64, {rows})},
      {"path_gain", "1", "[rx, tx] sum of the powers", Array(DType::f64, links)},
      {"mean_delay", "s", "[rx, tx] weighted by power", Array(DType::f64, links)},
      {"delay_spread", "s", "[rx, tx] rms", Array(DType::f64, links)}};
  std::ranges::fill(arrays[1].array.as<double>(), std::numeric_limits<double>::quiet_NaN());
  for_links({}, [&](const Link& link, size_t number) {
    const std::vector<double> powers = rf::power_slopes(response_link(link), carrier_hz_, {}).powers;
    for (size_t i = 0; i < powers.size(); ++i) {
      arrays[0].array.as<double>()[offsets[number] + link.number(i)] = powers[i];
      arrays[1].array.as<double>()[offsets[number] + link.number(i)] = link.paths()[i].delay_s;
    }
    const rf::LinkStatistics statistics = rf::link_statistics(link.paths(), powers);
    arrays[2].array.as<double>()[number] = statistics.path_gain;
    arrays[3].array.as<double>()[number] = statistics.mean_delay_s;
    arrays[4].array.as<double>()[number] = statistics.delay_spread_s;
  });
  return arrays;
}

NamedArrays VariedPaths::quantity_slopes(const std::vector<std::string>& names) const {
  const Columns columns = columns_of(names);
  const auto count = static_cast<int64_t>(columns.columns.size());
  std::vector<size_t> offsets{0};
  for (const PathSet::Link& link : set_->links_) offsets.push_back(offsets.back() + link.solved.paths.size());
  const auto rows = static_cast<int64_t>(offsets.back());
  const std::vector<int64_t> links{static_cast<int64_t>(set_->receivers()),
                                   static_cast<int64_t>(set_->transmitters()), count};
  NamedArrays arrays{
      {"power", "1", "[path, column] mean of |a|^2 over the pairs of ports",
       Array(DType::f64, {rows, count})},
      {"delay", "s", "[path, column]", Array(DType::f64, {rows, count})},
      {"path_gain", "1", "[rx, tx, column] sum of the powers", Array(DType::f64, links)},
      {"mean_delay", "s", "[rx, tx, column] weighted by power", Array(DType::f64, links)},
      {"delay_spread", "s", "[rx, tx, column] rms; NaN where the spread is 0", Array(DType::f64, links)}};
  for_links({}, [&](const Link& link, size_t number) {
    const std::vector<rf::LinkTangent> tangents = tangents_of(link, columns);
    const rf::PowerSlopes found = rf::power_slopes(response_link(link), carrier_hz_, tangents);
    const size_t paths = link.paths().size(), width = columns.columns.size();
    std::vector<double> delays;
    for (const rf::Path& path : link.paths()) delays.push_back(path.delay_s);
    for (size_t n = 0; n < width; ++n) {
      std::vector<double> power_slopes, delay_slopes;
      for (size_t i = 0; i < paths; ++i) {
        power_slopes.push_back(found.slopes[i * width + n]);
        delay_slopes.push_back(tangents[n].paths[i].slope.length_m / speed_of_light);
        const size_t at = (offsets[number] + link.number(i)) * width + n;
        arrays[0].array.as<double>()[at] = power_slopes[i];
        arrays[1].array.as<double>()[at] = delay_slopes[i];
      }
      const rf::DelaySlopes slopes = rf::delay_slopes(found.powers, power_slopes, delays, delay_slopes);
      arrays[2].array.as<double>()[number * width + n] = slopes.path_gain;
      arrays[3].array.as<double>()[number * width + n] = slopes.mean_delay_s;
      arrays[4].array.as<double>()[number * width + n] = slopes.delay_spread_s;
    }
  });
  return arrays;
}

/// Returns the share of a link in the gradient: for each parameter the row of the link's end.
std::vector<std::vector<double>> VariedPaths::gradient_rows(const Link& link, const Columns& columns,
                                                            const rf::LinkCotangent& cotangent) const {
  std::vector<std::vector<double>> rows;
  for (const PathParameter* parameter : columns.parameters) rows.emplace_back(parameter->row());
  const std::vector<std::vector<rf::PathSlope>> slopes = slopes_of(link, columns);
  for (const Columns::Column& column : columns.columns) {
    const PathParameter& parameter = *columns.parameters[column.parameter];
    const rf::EndCotangent& end = parameter.of_receiver ? cotangent.receiver : cotangent.transmitter;
    std::vector<double>& out = rows[column.parameter];
    if (column.slope)
      for (size_t i = 0; i < slopes.size(); ++i)
        out[column.axis] += cotangent.paths[i].along(
            path_tangent(slopes[i][*column.slope], columns.of_paths[*column.slope].kind));
    if (parameter.role == Role::carrier) out[0] += cotangent.carrier_hz;
    if (parameter.role == Role::attitude)
      out[column.axis] += glm::dot(
          end.attitude, turns_of_components(vector_of(
                            parameter.name, link.end(parameter.of_receiver)))[static_cast<int>(column.axis)]);
    if (parameter.role == Role::slant)
      for (size_t p = 0; p < out.size(); ++p) out[p] += end.slants[p];
    if (parameter.role == Role::gain)
      for (size_t port = 0; port < end.gains.size(); ++port) {
        out[2 * port] += end.gains[port].real();
        out[2 * port + 1] -= end.gains[port].imag();
      }
  }
  return rows;
}

NamedArrays VariedPaths::gradient(const ResponseRequest& request, const std::vector<std::string>& names,
                                  std::span<const double> cotangent, const GoOn& go_on) const {
  const rf::ChannelGrid grid = this->grid(request);
  const Columns columns = columns_of(names);
  const size_t rx_ports = set_->receivers_[0].port_count(), tx_count = set_->transmitters();
  const size_t row = set_->transmitters_[0].port_count() * grid.size_per_pair();
  if (cotangent.size() != 2 * links_.size() * rx_ports * row)
    throw_user_error("cotangent: expected {} complex numbers, as many as the response has, found {}",
                     links_.size() * rx_ports * row, cotangent.size() / 2);
  std::vector<std::vector<std::vector<double>>> of_links(links_.size());
  const bool all = for_links(go_on, [&](const Link& link, size_t number) {
    std::vector<rf::Complex> block;
    block.reserve(rx_ports * row);
    for (size_t port = 0; port < rx_ports; ++port) {
      const size_t first = ((number / tx_count * rx_ports + port) * tx_count + number % tx_count) * row;
      for (size_t i = first; i < first + row; ++i) block.emplace_back(cotangent[2 * i], cotangent[2 * i + 1]);
    }
    of_links[number] = gradient_rows(link, columns, response_gradient(link, grid, request).pull_back(block));
  });
  if (!all) return {};  // the caller has stopped the work
  // The sum over links does not depend on the threads.
  NamedArrays arrays;
  for (size_t p = 0; p < columns.parameters.size(); ++p) {
    const PathParameter& parameter = *columns.parameters[p];
    Array sum(DType::f64, parameter.shape);
    for (size_t number = 0; number < links_.size(); ++number) {
      const std::vector<double>& share = of_links[number][p];
      const size_t end = parameter.shape.empty() ? 0 : links_[number].end(parameter.of_receiver);
      for (size_t i = 0; i < share.size(); ++i) sum.as<double>()[end * share.size() + i] += share[i];
    }
    arrays.push_back({parameter.name, parameter.unit, parameter.description, std::move(sum)});
  }
  return arrays;
}

}  // namespace greatx::engine
