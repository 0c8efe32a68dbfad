// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/session/varied_paths.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "rf/atmosphere/fog.h"
#include "rf/atmosphere/gas.h"
#include "rf/atmosphere/rain.h"
#include "rf/edges/corners.h"
#include "rf/gradient/changed_surfaces.h"
#include "rf/gradient/path_continuation.h"

namespace greatx::engine {
namespace {

using Role = PathParameter::Role;
using Json = nlohmann::ordered_json;

std::string expected_values(const PathParameter& parameter) {
  if (parameter.shape.empty()) return "one number";
  std::string text;
  for (const int64_t count : parameter.shape) text += fmt::format("{}{}", text.empty() ? "" : ", ", count);
  return fmt::format("numbers [{}]", text);
}

/// Returns the turn by a vector, rad.
dquat turn_by(const dvec3& vector) {
  const double angle = glm::length(vector);
  return angle == 0.0 ? dquat(1.0, 0.0, 0.0, 0.0) : glm::angleAxis(angle, vector / angle);
}

std::vector<rf::Complex> complex_row(std::span<const double> values) {
  std::vector<rf::Complex> row;
  for (size_t i = 0; i + 1 < values.size(); i += 2) row.emplace_back(values[i], values[i + 1]);
  return row;
}

}  // namespace

VariedPaths::VariedPaths(std::shared_ptr<const PathSet> set, const std::vector<ParameterValues>& values)
    : set_(std::move(set)), carrier_hz_(set_->config_.carrier_hz) {
  check_known();
  set_values(values);
  set_surfaces();
  solve();
}

/// Refuses what has no derivatives.
void VariedPaths::check_known() const {
  if (set_->experiment_->plan.dispersion.on)
    throw_user_error(
        "channel '{}': parameters: the effect dispersion is on, and its derivatives are not known: expected "
        "effects={{\"dispersion\": \"off\"}}",
        set_->config_.name);
  for (const PathSet::Link& link : set_->links_)
    for (const rf::Path& path : link.solved.paths)
      if (path.echo)
        throw_user_error(
            "channel '{}': parameters: a path leads over a target, and the derivatives of its echo are not "
            "known: expected effects={{\"target_echoes\": \"off\"}}",
            set_->config_.name);
}

void VariedPaths::check_foliage(const rf::Path& path) const {
  if (path.foliage_m > 0.0)
    throw_user_error(
        "channel '{}': position: a path passes {} m of foliage, and how this length changes with the place "
        "is "
        "not known: expected effects={{\"foliage\": \"off\"}}",
        set_->config_.name, path.foliage_m);
}

/// A value at the carrier says nothing about another carrier.
void VariedPaths::check_carrier() const {
  for (size_t i = 0; i < changed_.size(); ++i) {
    const PathParameter& parameter = set_->parameters()[i];
    const auto kind = parameter.of_material.kind;
    if (changed_[i] && parameter.role == Role::material &&
        (kind == rf::ChannelParameter::Kind::permittivity ||
         kind == rf::ChannelParameter::Kind::conductivity))
      throw_user_error(
          "carrier: expected materials with their own permittivity and conductivity, found {} = {}: a value "
          "at "
          "the carrier says nothing about another one",
          parameter.name, values_[i][0]);
  }
}

void VariedPaths::set_values(const std::vector<ParameterValues>& values) {
  const std::vector<PathParameter>& parameters = set_->parameters();
  for (const PathParameter& parameter : parameters) {
    indices_[parameter.name] = values_.size();
    values_.push_back(parameter.values);
  }
  changed_.assign(parameters.size(), false);
  for (const auto& [name, given] : values) {
    const PathParameter& parameter = find_parameter(parameters, name);
    const size_t index = index_of(name);
    if (given.size() != parameter.values.size())
      throw_user_error("{}: expected {}, found {} of them", name, expected_values(parameter), given.size());
    for (const double value : given)
      if (!std::isfinite(value)) throw_user_error("{}: expected finite numbers, found {}", name, value);
    values_[index] = given;
    changed_[index] = given != parameter.values;
  }
}

size_t VariedPaths::index_of(const std::string& name) const {
  const auto at = indices_.find(name);
  GREATX_CHECK(at != indices_.end(), "no parameter '{}'", name);
  return at->second;
}

/// A parameter that is not listed, such as a slant where antennas differ, has no other value.
bool VariedPaths::is_changed(const std::string& name) const {
  const auto at = indices_.find(name);
  return at != indices_.end() && changed_[at->second];
}

std::span<const double> VariedPaths::row_of(const std::string& name, size_t end) const {
  const size_t index = index_of(name), row = set_->parameters()[index].row();
  return std::span(values_[index]).subspan(end * row, row);
}

dvec3 VariedPaths::vector_of(const std::string& name, size_t end) const {
  const std::span<const double> row = row_of(name, end);
  return {row[0], row[1], row[2]};
}

void VariedPaths::set_surfaces() {
  const rf::RadioModel& model = set_->radio_->model();
  std::vector<rf::MaterialValue> values;
  for (size_t i = 0; i < changed_.size(); ++i) {
    const PathParameter& parameter = set_->parameters()[i];
    if (!changed_[i] || parameter.role != Role::material) continue;
    values.push_back({parameter.of_material, values_[i][0]});
  }
  if (is_changed("carrier")) {
    carrier_hz_ = row_of("carrier", 0)[0];
    if (!(carrier_hz_ > 0.0))
      throw_user_error("carrier: expected a frequency above 0 Hz, found {}", carrier_hz_);
    check_carrier();
    surfaces_.emplace(*model.scene, carrier_hz_);
    attenuation_ = rf::path_attenuation(model.effects.weather, carrier_hz_, weather_effects());
  }
  if (values.empty()) return;
  const auto name_of = [&](const rf::ChannelParameter& wanted) {
    for (const PathParameter& parameter : set_->parameters())
      if (parameter.role == Role::material && parameter.of_material == wanted) return parameter.name;
    return std::string("a material");
  };
  const rf::RadioSurfaces& surfaces = surfaces_ ? *surfaces_ : model.surfaces;
  surfaces_ = rf::changed_surfaces(surfaces, model.scene->materials.size(), values, name_of);
}

/// As in RadioModel::field_model, an effect is left out where its model does not hold.
rf::WeatherEffects VariedPaths::weather_effects() const {
  const rf::FieldEffects& on = set_->radio_->model().effects.field;
  return {on.gas && rf::gas_model_covers(carrier_hz_), on.rain && rf::rain_model_covers(carrier_hz_),
          on.fog && rf::fog_model_covers(carrier_hz_)};
}

rf::FieldModel VariedPaths::field_model(const Link& link) const {
  rf::FieldModel model = set_->radio_->model().field_model();
  model.world = link.from->solved.world.get();
  if (surfaces_) model.surfaces = &*surfaces_;
  if (attenuation_) model.attenuation = *attenuation_;
  return model;
}

void VariedPaths::solve() {
  for (const PathSet::Link& from : set_->links_) links_.push_back({&from});
  set_->for_links({}, [this](const PathSet::Link&, size_t number) { solve_link(links_[number]); });
  for (const Link& link : links_) {
    paths_ += link.from->solved.paths.size();
    beyond_ += link.beyond;
    blocked_ += link.blocked;
    lost_ += link.lost;
  }
}

void VariedPaths::solve_link(Link& link) const {
  const sim::ChannelSnapshot::Link& solved = link.from->solved;
  const dvec3& origin = set_->experiment_->scene().origin;
  const auto place = [&](const char* name, size_t end, const dvec3& before) {
    const dvec3 world = vector_of(name, end);
    return world == before + origin ? before : world - origin;  // the same bits if nothing has changed
  };
  link.transmitter = place("transmitter.position", solved.transmitter, solved.transmitter_state.position);
  link.receiver = place("receiver.position", solved.receiver, solved.receiver_state.position);
  link.transmitter_velocity = vector_of("transmitter.velocity", solved.transmitter);
  link.receiver_velocity = vector_of("receiver.velocity", solved.receiver);
  const bool moved = link.transmitter != solved.transmitter_state.position ||
                     link.receiver != solved.receiver_state.position;
  link.own = moved || surfaces_ || link.transmitter_velocity != solved.transmitter_state.velocity ||
             link.receiver_velocity != solved.receiver_state.velocity;
  if (!link.own) return;
  const rf::FieldModel model = field_model(link);
  for (size_t i = 0; i < solved.paths.size(); ++i) {
    const rf::Path& path = solved.paths[i];
    if (moved) check_foliage(path);
    rf::ContinuedPath continued =
        rf::continued_path(path, *model.world, model.wedges, link.transmitter, link.receiver);
    if (continued.state == rf::Continuation::lost) {
      ++link.lost;
      continue;
    }
    if (continued.state == rf::Continuation::beyond)
      ++link.beyond;
    else if (moved && !is_clear(continued.path, link))
      ++link.blocked;
    link.solved.push_back(
        rf::path_field(continued.path, model, link.transmitter_velocity, link.receiver_velocity));
    link.numbers.push_back(i);
  }
}

/// Tells whether no segment of a path is blocked and each passes the walls of the path.
bool VariedPaths::is_clear(const rf::GeometricPath& path, const Link& link) const {
  const auto none = shared::rf_none;
  const rf::FacetWorld& world = *link.from->solved.world;
  const std::vector<scene::Wedge>& wedges = set_->radio_->model().wedges;
  const auto end_at = [&](size_t vertex, dvec3& place, uint32_t& facet, uint32_t& other) {
    place = path.vertices[vertex];
    if (vertex == 0 || vertex + 1 == path.vertices.size()) return;
    const rf::Interaction& at = path.interactions[vertex - 1];
    facet = at.element;
    if (at.type != rf::InteractionType::diffraction) return;
    const scene::Wedge& wedge = wedges[at.element];
    facet = wedge.facet_0, other = wedge.facet_n;
    if (at.patch != 0) place = rf::seen_corner(rf::posed(wedge, world), static_cast<rf::Corner>(at.patch));
  };
  const auto body = [&](uint32_t carrier) { return carrier == 0 ? none : carrier; };
  size_t from = 0;
  std::vector<uint32_t> walls;
  for (size_t to = 1; to < path.vertices.size(); ++to) {
    if (to + 1 < path.vertices.size() &&
        path.interactions[to - 1].type == rf::InteractionType::transmission) {
      walls.push_back(path.interactions[to - 1].element);
      continue;
    }
    rf::Segment segment;
    end_at(from, segment.a, segment.facet_a, segment.other_a);
    end_at(to, segment.b, segment.facet_b, segment.other_b);
    if (from == 0) segment.body_a = body(link.from->solved.transmitter_state.body);
    if (to + 1 == path.vertices.size()) segment.body_b = body(link.from->solved.receiver_state.body);
    segment.walls = static_cast<uint32_t>(walls.size());
    rf::Crossing crossing;
    set_->crossings().settle(world, segment, crossing);
    std::ranges::sort(walls);
    if (crossing.blocked || crossing.walls != walls) return false;
    walls.clear();
    from = to;
  }
  return true;
}

std::string VariedPaths::facts() const {
  return Json{{"paths", paths_}, {"beyond", beyond_}, {"blocked", blocked_}, {"lost", lost_}}.dump();
}

bool VariedPaths::for_links(const GoOn& go_on, const std::function<void(const Link&, size_t)>& of) const {
  return set_->for_links(go_on, [&](const PathSet::Link&, size_t number) { of(links_[number], number); });
}

rf::ChannelGrid VariedPaths::grid(const ResponseRequest& request) const {
  return set_->grid(request, carrier_hz_);
}

rf::ResponseLink VariedPaths::response_link(const Link& link, double half_band_hz) const {
  // Whether waves are curved and arrays squint is decided where the paths were solved, so that nothing jumps.
  sim::LinkEnds ends = set_->ends(*link.from, half_band_hz);
  const size_t tx = link.from->solved.transmitter, rx = link.from->solved.receiver;
  const auto turn = [&](const std::string& name, size_t end, rf::ArrayPose& pose) {
    if (is_changed(name)) pose.orientation = turn_by(vector_of(name, end)) * pose.orientation;
  };
  turn("transmitter.attitude", tx, ends.transmitter);
  turn("receiver.attitude", rx, ends.receiver);
  rf::ResponseLink out{link.paths(), std::move(ends.transmitter), std::move(ends.receiver)};
  if (is_changed("transmitter.gain")) out.transmitter_gains = complex_row(row_of("transmitter.gain", tx));
  if (is_changed("receiver.gain")) out.receiver_gains = complex_row(row_of("receiver.gain", rx));
  const auto slants = [&](const std::string& name, size_t end) {
    if (!is_changed(name)) return std::vector<double>{};
    const std::span<const double> row = row_of(name, end);
    return std::vector<double>(row.begin(), row.end());
  };
  out.transmitter_slants = slants("transmitter.slant", tx);
  out.receiver_slants = slants("receiver.slant", rx);
  return out;
}

rf::ResponseGradient VariedPaths::response_gradient(const Link& link, const rf::ChannelGrid& grid,
                                                    const ResponseRequest& request) const {
  return {response_link(link, grid.subcarriers / 2 * grid.subcarrier_spacing_hz), grid, request.selection};
}

/// Returns an f64 array [rx, rx_ant, tx, tx_ant, columns..., 2]. Calls of(link, block) for each link, which
/// must fill the link's block [rx_ant, tx_ant, columns...].
Array VariedPaths::blocks(std::vector<int64_t> columns, const GoOn& go_on,
                          const std::function<void(const Link&, std::span<rf::Complex>)>& of) const {
  const size_t rx_ports = set_->receivers_[0].port_count(), tx_count = set_->transmitters();
  size_t row = set_->transmitters_[0].port_count();
  std::vector<int64_t> shape{static_cast<int64_t>(set_->receivers()), static_cast<int64_t>(rx_ports),
                             static_cast<int64_t>(tx_count), static_cast<int64_t>(row)};
  for (const int64_t count : columns) {
    shape.push_back(count);
    row *= static_cast<size_t>(count);
  }
  shape.push_back(2);
  Array array(DType::f64, std::move(shape));
  const std::span<double> out = array.as<double>();
  for_links(go_on, [&](const Link& link, size_t number) {
    std::vector<rf::Complex> block(rx_ports * row);
    of(link, block);
    for (size_t port = 0; port < rx_ports; ++port) {
      const size_t first = ((number / tx_count * rx_ports + port) * tx_count + number % tx_count) * row;
      for (size_t i = 0; i < row; ++i) {
        out[2 * (first + i)] = block[port * row + i].real();
        out[2 * (first + i) + 1] = block[port * row + i].imag();
      }
    }
  });
  return array;
}

Array VariedPaths::response(const ResponseRequest& request, const GoOn& go_on) const {
  const rf::ChannelGrid grid = this->grid(request);
  return blocks({grid.time_samples, grid.subcarriers}, go_on,
                [&](const Link& link, std::span<rf::Complex> out) {
                  const std::vector<rf::Complex> h = response_gradient(link, grid, request).response();
                  std::ranges::copy(h, out.begin());
                });
}

}  // namespace greatx::engine
