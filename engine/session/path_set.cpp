// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/session/path_set.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>

#include <nlohmann/json.hpp>

#include "core/parallel.h"
#include "core/units.h"
#include "rf/channel/coherence.h"
#include "rf/channel/dispersion.h"
#include "rf/channel/received.h"
#include "rf/channel/taps.h"
#include "sim/channel/columns.h"
#include "sim/plan/antennas.h"
#include "sim/plan/array_plan.h"

namespace greatx::engine {

namespace {

using Complex64 = std::complex<float>;

/// Number of links that are computed between two calls of GoOn.
constexpr size_t links_at_once = 64;
/// Largest number of subcarriers, taps or time samples, as in scenarios.
constexpr uint32_t most_samples = 1u << 20;

uint32_t one_number_of_ports(std::span<const rf::AntennaArray> arrays, const char* ends,
                             const std::string& channel) {
  for (const rf::AntennaArray& array : arrays)
    if (array.port_count() != arrays[0].port_count())
      throw_user_error(
          "channel '{}': {}: expected antennas with one number of ports, found {} and {}; give each its own "
          "channel",
          channel, ends, arrays[0].port_count(), array.port_count());
  return arrays[0].port_count();
}

void check_above_0(const char* name, double value) {
  if (!(value > 0.0) || !std::isfinite(value))
    throw_user_error("{}: expected a finite number greater than 0, found {}", name, value);
}

void check_count(const char* name, uint32_t count) {
  if (count < 1 || count > most_samples)
    throw_user_error("{}: expected an integer from 1 to {}, found {}", name, most_samples, count);
}

rf::ChannelGrid grid_of(const ResponseRequest& request, const sim::ChannelConfig& config, double carrier_hz,
                        bool doppler) {
  // A caller that asks for time samples wants their phases to turn with time, even if the scenario's own
  // samples do not.
  const bool turns = doppler || request.time_samples || request.time_spacing_s;
  const rf::ChannelGrid grid{carrier_hz, request.subcarrier_spacing_hz.value_or(config.subcarrier_spacing_hz),
                             request.subcarriers.value_or(config.subcarriers),
                             request.time_samples.value_or(config.time_samples),
                             turns ? request.time_spacing_s.value_or(config.time_spacing_s) : 0.0};
  check_above_0("subcarrier_spacing_hz", grid.subcarrier_spacing_hz);
  check_count("subcarriers", grid.subcarriers);
  check_count("time_samples", grid.time_samples);
  if (request.time_spacing_s) check_above_0("time_spacing_s", *request.time_spacing_s);
  const double lowest_hz = grid.carrier_hz + grid.subcarrier_number(0) * grid.subcarrier_spacing_hz;
  if (!(lowest_hz > 0.0))
    throw_user_error("subcarriers: expected every one above 0 Hz, found the lowest at {} Hz", lowest_hz);
  return grid;
}

}  // namespace

PathSet::PathSet(std::shared_ptr<const sim::Experiment> experiment, uint32_t channel,
                 std::vector<rf::AntennaArray> receiver_arrays)
    : experiment_(std::move(experiment)),
      channel_(channel),
      config_(experiment_->scenario.channels[channel]),
      receivers_(std::move(receiver_arrays)) {
  for (const std::string& name : config_.transmitters)
    transmitters_.push_back(sim::antenna_array(experiment_->scenario, name, config_.carrier_hz));
  one_number_of_ports(transmitters_, "transmitters", config_.name);
  one_number_of_ports(receivers_, "receivers", config_.name);
}

void PathSet::add(sim::ChannelSnapshot::Link solved) {
  Link link{std::move(solved), false};
  link.near = link.solved.distance_m < sim::every_element_within_m(experiment_->scenario, config_,
                                                                   transmitters_[link.solved.transmitter],
                                                                   receiver_array(link));
  links_.push_back(std::move(link));
}

void PathSet::finish(const sim::ChannelSnapshot& snapshot, const std::map<std::string, uint64_t>& before) {
  radio_ = snapshot.radio();
  fill_arrays(snapshot);
  describe(snapshot, before);
}

const rf::AntennaArray& PathSet::receiver_array(const Link& link) const {
  return receivers_.size() == 1 ? receivers_[0] : receivers_[link.solved.receiver];
}

sim::LinkEnds PathSet::ends(const Link& link, double half_band_hz) const {
  return sim::link_ends(experiment_->scenario, config_, transmitters_[link.solved.transmitter],
                        link.solved.transmitter_state, receiver_array(link), link.solved.receiver_state,
                        std::max(half_band_hz, sim::half_band_hz(config_)));
}

std::vector<double> PathSet::powers(const Link& link) const {
  const auto [transmitter, receiver] = ends(link);
  return rf::path_powers(link.solved.paths, transmitter, receiver, config_.carrier_hz);
}

void PathSet::fill_arrays(const sim::ChannelSnapshot& snapshot) {
  // The default configuration leaves out the optional columns, because functions of this class compute them.
  sim::ChannelConfig config;
  config.limits.max_depth = config_.limits.max_depth;
  const int64_t rx_ports = receivers_[0].port_count(), tx_ports = transmitters_[0].port_count();
  const sim::ColumnContext context{&experiment_->scene(), &snapshot.model(), &config, rx_ports, tx_ports};
  const std::vector<sim::PathColumn> columns = sim::path_columns(context);

  std::vector<int64_t> offsets{0};
  for (const Link& link : links_)
    offsets.push_back(offsets.back() + static_cast<int64_t>(link.solved.paths.size()));
  for (const sim::PathColumn& column : columns) {
    std::vector<int64_t> shape{offsets.back()};
    shape.insert(shape.end(), column.row.begin(), column.row.end());
    arrays_.push_back({column.name, column.unit, column.description, Array(column.dtype, std::move(shape))});
  }
  const size_t pairs = static_cast<size_t>(rx_ports * tx_ports);
  for_links({}, [&](const Link& link, size_t number) {
    const std::vector<rf::Path>& paths = link.solved.paths;
    const auto [transmitter, receiver] = ends(link);
    const rf::ImpulseResponse impulse =
        rf::impulse_response(paths, transmitter, receiver, config_.carrier_hz);
    sim::LinkView of;
    of.receiver = static_cast<int32_t>(link.solved.receiver);
    of.transmitter = static_cast<int32_t>(link.solved.transmitter);
    for (size_t i = 0; i < paths.size(); ++i) {
      sim::PathView view;
      view.link = &of;
      view.path = &paths[i];
      view.amplitude = std::span(impulse.amplitude).subspan(i * pairs, pairs);
      const size_t row = static_cast<size_t>(offsets[number]) + i;
      for (size_t c = 0; c < columns.size(); ++c)
        columns[c].fill(view, arrays_[c].array.bytes.data() + row * columns[c].row_bytes());
    }
  });
  arrays_.push_back({"offsets", "1",
                     "[rx * tx + 1] paths of link rx * transmitters + tx are offsets[link]:offsets[link + 1]",
                     Array::of<int64_t>({static_cast<int64_t>(offsets.size())}, offsets)});
}

NamedArray PathSet::table(const char* name, const char* unit, const char* description,
                          std::vector<int64_t> width) const {
  std::vector<int64_t> shape{static_cast<int64_t>(receivers()), static_cast<int64_t>(transmitters())};
  shape.insert(shape.end(), width.begin(), width.end());
  return {name, unit, description, Array(DType::f64, std::move(shape))};
}

void PathSet::describe(const sim::ChannelSnapshot& snapshot, const std::map<std::string, uint64_t>& before) {
  using Json = nlohmann::ordered_json;
  NamedArray distance = table("distance", "m", "[rx, tx] between the ends' reference points");
  NamedArray from{"transmitter_position", "m", "[tx, xyz] world",
                  Array(DType::f64, {static_cast<int64_t>(transmitters()), 3})};
  NamedArray to{"receiver_position", "m", "[rx, xyz] world",
                Array(DType::f64, {static_cast<int64_t>(receivers()), 3})};
  const dvec3& origin = experiment_->scene().origin;
  uint64_t near = 0;
  sim::LinkLeftOut left_out;
  for (size_t i = 0; i < links_.size(); ++i) {
    const sim::ChannelSnapshot::Link& link = links_[i].solved;
    distance.array.as<double>()[i] = link.distance_m;
    for (int c = 0; c < 3; ++c) {
      const size_t axis = static_cast<size_t>(c);
      from.array.as<double>()[3 * (i % transmitters()) + axis] =
          link.transmitter_state.position[c] + origin[c];
      to.array.as<double>()[3 * (i / transmitters()) + axis] = link.receiver_state.position[c] + origin[c];
    }
    near += links_[i].near;
    left_out.add(link.left_out);
  }
  for (NamedArray* more : {&distance, &from, &to}) arrays_.push_back(std::move(*more));

  const sim::TickContext& moment = snapshot.moment().context;
  Json json{
      {"channel", config_.name},
      {"tick", moment.tick},
      {"time_s", moment.time_s},
      {"carrier_hz", config_.carrier_hz},
      {"subcarrier_spacing_hz", config_.subcarrier_spacing_hz},
      {"subcarriers", config_.subcarriers},
      {"time_samples", config_.time_samples},
      {"time_spacing_s", config_.time_spacing_s},
      {"transmitters", config_.transmitters},
      {"every_element",
       std::array{"auto", "on", "off"}[static_cast<size_t>(sim::every_element_asked(experiment_->scenario))]},
      {"near_links", near},
      {"counters", Json::object()},
      {"notes", Json::object()}};
  std::map<std::string, uint64_t> counters;
  snapshot.count(counters);
  // Counters of candidates describe the candidates of these paths, whenever they were searched, and are not
  // differences. Births and deaths of paths have a meaning only in a run.
  for (const auto& [name, count] : counters)
    if (name.starts_with("candidate"))
      json["counters"][name] = count;
    else if (name != "path_births" && name != "path_deaths")
      json["counters"][name] = count - (before.contains(name) ? before.at(name) : 0);
  for (const auto& [name, text] : snapshot.notes(left_out)) json["notes"][name] = text;
  facts_ = json.dump();
}

bool PathSet::for_links(const GoOn& go_on, const std::function<void(const Link&, size_t)>& of) const {
  for (size_t first = 0; first < links_.size(); first += links_at_once) {
    parallel_for(std::min(links_at_once, links_.size() - first), 0,
                 [&](size_t i) { of(links_[first + i], first + i); });
    if (go_on && !go_on(first)) return false;
  }
  return true;
}

Array PathSet::blocks(std::vector<int64_t> columns, const GoOn& go_on,
                      const std::function<void(const Link&, std::span<Complex64>)>& of) const {
  const size_t rx_ports = receivers_[0].port_count(), tx_count = transmitters();
  size_t row = transmitters_[0].port_count();  // elements for one port of a receiver and one transmitter
  std::vector<int64_t> shape{static_cast<int64_t>(receivers()), static_cast<int64_t>(rx_ports),
                             static_cast<int64_t>(tx_count), static_cast<int64_t>(row)};
  for (const int64_t count : columns) {
    shape.push_back(count);
    row *= static_cast<size_t>(count);
  }
  Array array(DType::complex64, std::move(shape));
  const std::span<Complex64> out = array.as<Complex64>();
  for_links(go_on, [&](const Link& link, size_t number) {
    if (tx_count == 1) return of(link, out.subspan(number * rx_ports * row, rx_ports * row));
    std::vector<Complex64> block(rx_ports * row);
    of(link, block);
    for (size_t port = 0; port < rx_ports; ++port)
      std::copy_n(
          block.begin() + static_cast<std::ptrdiff_t>(port * row), row,
          out.begin() + static_cast<std::ptrdiff_t>(
                            ((number / tx_count * rx_ports + port) * tx_count + number % tx_count) * row));
  });
  return array;
}

rf::ChannelGrid PathSet::grid(const ResponseRequest& request, double carrier_hz) const {
  return grid_of(request, config_, carrier_hz, experiment_->plan.doppler.on);
}

Array PathSet::response(const ResponseRequest& request, const GoOn& go_on) const {
  const rf::ChannelGrid grid = this->grid(request, config_.carrier_hz);
  std::optional<rf::Dispersion> dispersion;
  if (experiment_->plan.dispersion.on)
    dispersion.emplace(experiment_->scene(), radio_->model().field_model(), radio_->model().effects.weather,
                       grid);
  return blocks(
      {grid.time_samples, grid.subcarriers}, go_on, [&](const Link& link, std::span<Complex64> out) {
        const std::vector<rf::Path>& paths = link.solved.paths;
        const std::vector<rf::TransferSpectrum> spectra =
            dispersion ? dispersion->spectra(paths, *link.solved.world) : std::vector<rf::TransferSpectrum>{};
        const auto [transmitter, receiver] = ends(link, grid.subcarriers / 2 * grid.subcarrier_spacing_hz);
        rf::frequency_response_into(paths, spectra, transmitter, receiver, grid, out, request.selection);
      });
}

NamedArrays PathSet::taps(const TapsRequest& request, const GoOn& go_on) const {
  check_above_0("bandwidth_hz", request.bandwidth_hz);
  check_above_0("time_spacing_s", request.time_spacing_s);
  check_count("taps", request.taps);
  check_count("time_samples", request.time_samples);
  const rf::TapGrid grid{config_.carrier_hz, request.bandwidth_hz, request.first,
                         request.taps,       request.time_samples, request.time_spacing_s};
  NamedArrays arrays;
  arrays.push_back(
      {"taps", "1", "[rx, rx_ant, tx, tx_ant, time, tap]",
       blocks({request.time_samples, request.taps}, go_on, [&](const Link& link, std::span<Complex64> out) {
         const auto [transmitter, receiver] = ends(link, 0.5 * grid.bandwidth_hz);
         rf::channel_taps_into(link.solved.paths, transmitter, receiver, grid, out);
       })});
  arrays.push_back(table("power_outside", "1", "[rx, tx] share of the power that the window leaves out"));
  arrays.push_back(table("paths_outside", "1", "[rx, tx] paths whose delay is not in the window"));
  for_links({}, [&](const Link& link, size_t number) {
    const rf::TapCoverage coverage = rf::tap_coverage(link.solved.paths, powers(link), grid);
    arrays[1].array.as<double>()[number] = coverage.power_outside;
    arrays[2].array.as<double>()[number] = coverage.paths_outside;
  });
  return arrays;
}

NamedArrays PathSet::statistics() const {
  const sim::ChannelConfig config;
  const sim::ColumnContext context{&experiment_->scene(), nullptr, &config, receivers_[0].port_count(),
                                   transmitters_[0].port_count()};
  const std::vector<sim::LinkColumn> columns = sim::link_columns(context);
  NamedArrays arrays;
  for (const sim::LinkColumn& column : columns)
    arrays.push_back(
        {column.name, column.unit, column.description,
         Array(column.dtype, {static_cast<int64_t>(receivers()), static_cast<int64_t>(transmitters())})});
  for_links({}, [&](const Link& link, size_t number) {
    const rf::LinkStatistics statistics = rf::link_statistics(link.solved.paths, powers(link));
    sim::LinkView view;
    view.receiver = static_cast<int32_t>(link.solved.receiver);
    view.transmitter = static_cast<int32_t>(link.solved.transmitter);
    view.statistics = &statistics;
    view.sequences_left_out = link.solved.left_out.searched.sequences;
    view.paths_left_out = link.solved.left_out.paths;
    for (size_t c = 0; c < columns.size(); ++c)
      columns[c].fill(view, arrays[c].array.bytes.data() + number * columns[c].row_bytes());
  });
  return arrays;
}

NamedArrays PathSet::received(const ReceivedRequest& request) const {
  check_above_0("resistance_ohm", request.resistance_ohm);
  check_above_0("power_w", request.transmit_power_w);
  const auto check_port = [](const char* name, uint32_t port, uint32_t ports) {
    if (port >= ports) throw_user_error("{}: expected 0 to {}, found {}", name, ports - 1, port);
  };
  check_port("transmit_port", request.transmit_port, transmitters_[0].port_count());
  check_port("receive_port", request.receive_port, receivers_[0].port_count());
  NamedArrays arrays{
      table("power_w", "W", "[rx, tx] at a matched load, fields added: at this very place"),
      table("mean_power_w", "W", "[rx, tx] powers of the paths added: the mean over some wavelengths"),
      table("amplitude", "1", "[rx, tx] complex, fields added", {2}),
      table("open_circuit_v", "V", "[rx, tx] complex, rms", {2}),
      table("field_v_per_m", "V/m", "[rx, tx, xyz] complex, rms, world axes, before the receiver", {3, 2})};
  const rf::RadioLink radio{config_.carrier_hz, request.transmit_power_w, request.resistance_ohm,
                            request.transmit_port, request.receive_port};
  for_links({}, [&](const Link& link, size_t number) {
    const auto [transmitter, receiver] = ends(link);
    const rf::Received received = rf::received(link.solved.paths, transmitter, receiver, radio);
    const auto put = [&](size_t array, size_t index, rf::Complex value) {
      const std::span<double> out = arrays[array].array.as<double>();
      out[2 * index] = value.real();
      out[2 * index + 1] = value.imag();
    };
    arrays[0].array.as<double>()[number] = received.power_w;
    arrays[1].array.as<double>()[number] = received.mean_power_w;
    put(2, number, received.amplitude);
    put(3, number, received.open_circuit_v);
    for (int c = 0; c < 3; ++c)
      put(4, 3 * number + static_cast<size_t>(c),
          {received.field_v_per_m.re[c], received.field_v_per_m.im[c]});
  });
  return arrays;
}

const std::vector<PathParameter>& PathSet::parameters() const {
  std::call_once(parameters_made_, [this] {
    const dvec3& origin = experiment_->scene().origin;
    ChannelEndsAt ends;
    for (size_t i = 0; i < links_.size(); ++i) {
      const sim::ChannelSnapshot::Link& link = links_[i].solved;
      if (i < transmitters()) {
        ends.transmitter_positions.push_back(link.transmitter_state.position + origin);
        ends.transmitter_velocities.push_back(link.transmitter_state.velocity);
        ends.transmitter_arrays.push_back(transmitters_[i]);
      }
      if (i % transmitters() > 0) continue;
      ends.receiver_positions.push_back(link.receiver_state.position + origin);
      ends.receiver_velocities.push_back(link.receiver_state.velocity);
      ends.receiver_arrays.push_back(receiver_array(links_[i]));
    }
    parameters_ = path_parameters(radio_->model(), ends);
  });
  return parameters_;
}

const rf::ExactCrossings& PathSet::crossings() const {
  std::call_once(crossings_made_, [this] {
    crossings_ = std::make_unique<const rf::ExactCrossings>(experiment_->scene(), radio_->model().kinds);
  });
  return *crossings_;
}

NamedArrays PathSet::coherence(double level) const {
  if (!(level > 0.0 && level < 1.0))
    throw_user_error("level: expected a number between 0 and 1, found {}", level);
  NamedArrays arrays{table("bandwidth", "Hz", "[rx, tx] inf: it does not fall so far"),
                     table("time", "s", "[rx, tx] inf: it does not fall so far")};
  for_links({}, [&](const Link& link, size_t number) {
    const std::vector<double> of = powers(link);
    arrays[0].array.as<double>()[number] = rf::coherence_bandwidth_hz(link.solved.paths, of, level);
    arrays[1].array.as<double>()[number] = rf::coherence_time_s(link.solved.paths, of, level);
  });
  return arrays;
}

}  // namespace greatx::engine
