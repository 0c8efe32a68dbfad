// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// What a channel delivers: its declaration and the arrays of a record, in the same order.
#include <algorithm>

#include <nlohmann/json.hpp>

#include "core/parallel.h"
#include "sim/channel_antennas.h"
#include "sim/channel_sensor.h"
#include "sim/sensor_metadata.h"

namespace greatx::sim {

namespace {

/// What a wave at the carrier meets, outermost layer first: null for materials that no facet has.
nlohmann::json describe_walls(const scene::Scene& scene, const rf::RadioSurfaces& surfaces) {
  nlohmann::json walls = nlohmann::json::array();
  for (uint32_t material = 0; material < scene.materials.size(); ++material) {
    nlohmann::json layers;
    for (const rf::DielectricLayer& layer : surfaces.surface(material).front)
      layers.push_back({{"relative_permittivity", {layer.eta.real(), layer.eta.imag()}},
                        {"thickness_m", layer.thickness_m}});
    walls.push_back({{"material", scene.materials[material].name}, {"layers", std::move(layers)}});
  }
  return walls;
}

nlohmann::json describe_ends(const std::vector<rf::AntennaArray>& arrays, std::span<const ChannelEnd> ends) {
  nlohmann::json json = nlohmann::json::array();
  for (size_t i = 0; i < arrays.size(); ++i) {
    json.push_back(describe_array(arrays[i]));
    json.back()["name"] = ends[i].name;
    json.back()["body_from_antenna"] = json_of(ends[i].mount);
  }
  return json;
}

/// Everything of a link that its arrays need.
struct LinkFacts {
  LinkView view;
  rf::LinkStatistics statistics;
  rf::ImpulseResponse impulse;
};

/// An array with a row for each of `rows`, one below the other; `leading`: the shape before the row's.
template <typename View>
Array filled(const Column<View>& column, std::vector<int64_t> leading, std::span<const View> rows) {
  leading.insert(leading.end(), column.row.begin(), column.row.end());
  Array array(column.dtype, std::move(leading));
  const size_t step = column.row_bytes();
  for (size_t i = 0; i < rows.size(); ++i) column.fill(rows[i], array.bytes.data() + i * step);
  return array;
}

}  // namespace

void ChannelSensor::describe() {
  const int64_t receivers = static_cast<int64_t>(receiver_arrays_.size()),
                transmitters = static_cast<int64_t>(transmitter_arrays_.size());
  columns_ = {&world_.scene, &radio_->model, &config_, receiver_arrays_[0].port_count(),
              transmitter_arrays_[0].port_count()};
  link_columns_ = link_columns(columns_);
  path_columns_ = path_columns(columns_);
  spec_.name = config_.name;
  spec_.kind = "csi";
  spec_.rate = config_.rate_hz.str();
  spec_.arrays.push_back(
      {"cfr",
       DType::complex64,
       {receivers, columns_.rx_ports, transmitters, columns_.tx_ports, config_.time_samples,
        config_.subcarriers},
       "1",
       "[rx, rx_ant, tx, tx_ant, time, subcarrier] H(f) at carrier + (k - floor(N/2)) * spacing"});
  spec_.outputs.push_back({"cfr", FileFormat::npy_stack, {"cfr"}});
  for (const LinkColumn& column : link_columns_) {
    spec_.arrays.push_back(
        {column.name, column.dtype, {receivers, transmitters}, column.unit, column.description});
    spec_.outputs.push_back({column.name, FileFormat::npy_stack, {column.name}});
  }
  for (const PathColumn& column : path_columns_) {
    std::vector<int64_t> shape{-1};
    shape.insert(shape.end(), column.row.begin(), column.row.end());
    spec_.arrays.push_back({column.name, column.dtype, std::move(shape), column.unit, column.description});
    spec_.outputs.push_back({"paths/" + column.name, FileFormat::npy_ragged, {column.name}});
  }
  spec_.metadata_json = metadata();
}

std::string ChannelSensor::metadata() const {
  nlohmann::json metadata;
  metadata["carrier_hz"] = config_.carrier_hz;
  metadata["subcarrier_spacing_hz"] = config_.subcarrier_spacing_hz;
  metadata["subcarriers"] = config_.subcarriers;
  metadata["first_subcarrier"] = -static_cast<int64_t>(config_.subcarriers / 2);
  metadata["time_samples"] = config_.time_samples;
  metadata["time_spacing_s"] = config_.time_spacing_s;
  metadata["max_depth"] = config_.max_depth;
  metadata["non_finite"] = {"vertex"};
  for (const LinkColumn& column : link_columns_)
    if (column.dtype == DType::f64) metadata["non_finite"].push_back(column.name);
  metadata["axes"] = {"batch", "rx", "rx_ant", "tx", "tx_ant", "time", "subcarrier"};
  metadata["time_convention"] = "e^{+j omega t}";
  std::vector<ChannelEnd> transmitters;
  for (const auto& paths : paths_) transmitters.push_back(paths->transmitter());
  metadata["every_element"] =
      !near_links_.empty();  // of links nearer than 2 (D_tx + D_rx)^2 / lambda, or all
  metadata["transmitters"] = describe_ends(transmitter_arrays_, transmitters);
  metadata["receivers"] = describe_ends(receiver_arrays_, paths_[0]->receivers());
  metadata["pattern_tables"] = describe_pattern_tables({transmitter_arrays_, receiver_arrays_});
  metadata["doppler_in_time_samples"] = doppler_;  // off: all time samples are those of the tick
  metadata["dispersion"] =
      dispersion_.has_value();  // off: walls and air are the carrier's at every subcarrier
  metadata["walls"] = describe_walls(world_.scene, radio_->model.surfaces);
  for (const auto& [name, text] : paths_[0]->notes()) metadata["candidates"][name] = text;
  return metadata.dump();
}

/// [rx_ant, tx_ant, time, subcarrier] of one link.
std::vector<std::complex<float>> ChannelSensor::response(const Results& results, size_t receiver,
                                                         size_t transmitter, uint32_t slot) const {
  if (const ElementPaths* elements = elements_of(receiver, transmitter, slot))
    return elements->response(grid_, dispersion_ ? &*dispersion_ : nullptr);
  const ChannelPaths::Link& link = results[transmitter].links[receiver];
  const rf::ArrayPose from{transmitter_arrays_[transmitter], results[transmitter].transmitter.orientation};
  const rf::ArrayPose to{receiver_arrays_[receiver], link.receiver.orientation};
  return dispersion_ ? rf::frequency_response(link.paths, dispersion_->spectra(link.paths), from, to, grid_)
                     : rf::frequency_response(link.paths, from, to, grid_);
}

/// Of all links, [rx, rx_ant, tx, tx_ant, time, subcarrier].
void ChannelSensor::write_responses(const Results& results, uint32_t slot, Array& cfr) const {
  const size_t transmitters = results.size(), receivers = results[0].links.size();
  const size_t rx_ports = static_cast<size_t>(columns_.rx_ports),
               row = static_cast<size_t>(columns_.tx_ports) * grid_.size_per_pair();
  const std::span<std::complex<float>> out = cfr.as<std::complex<float>>();
  parallel_for(receivers * transmitters, 0, [&](size_t index) {
    const size_t r = index / transmitters, t = index % transmitters;
    const std::vector<std::complex<float>> h = response(results, r, t, slot);
    for (size_t port = 0; port < rx_ports; ++port)
      std::copy_n(
          h.begin() + static_cast<std::ptrdiff_t>(port * row), row,
          out.begin() + static_cast<std::ptrdiff_t>(((r * rx_ports + port) * transmitters + t) * row));
  });
}

std::vector<Array> ChannelSensor::arrays_of(const Results& results, uint32_t slot) const {
  const size_t transmitters = results.size(), receivers = results[0].links.size();
  std::vector<LinkFacts> facts(receivers * transmitters);
  parallel_for(facts.size(), 0, [&](size_t index) {
    const size_t r = index / transmitters, t = index % transmitters;
    const ChannelPaths::Link& link = results[t].links[r];
    const rf::ArrayPose transmitter{transmitter_arrays_[t], results[t].transmitter.orientation};
    const rf::ArrayPose receiver{receiver_arrays_[r], link.receiver.orientation};
    LinkFacts& of = facts[index];
    of.statistics = rf::link_statistics(
        link.paths, rf::path_powers(link.paths, transmitter, receiver, config_.carrier_hz));
    of.impulse = rf::impulse_response(link.paths, transmitter, receiver, config_.carrier_hz);
    of.view = {static_cast<int32_t>(r), static_cast<int32_t>(t), &of.statistics,
               elements_of(r, t, slot) != nullptr};
  });

  std::vector<LinkView> links;
  std::vector<PathView> paths;
  const size_t pairs = static_cast<size_t>(columns_.rx_ports * columns_.tx_ports);
  for (const LinkFacts& of : facts) {
    links.push_back(of.view);
    const std::vector<rf::Path>& own =
        results[static_cast<size_t>(of.view.transmitter)].links[static_cast<size_t>(of.view.receiver)].paths;
    for (size_t i = 0; i < own.size(); ++i)
      paths.push_back({&of.view, &own[i], std::span(of.impulse.amplitude).subspan(i * pairs, pairs)});
  }
  std::vector<Array> arrays;
  arrays.emplace_back(DType::complex64, spec_.arrays[0].shape);
  write_responses(results, slot, arrays[0]);
  const int64_t rx = static_cast<int64_t>(receivers), tx = static_cast<int64_t>(transmitters);
  for (const LinkColumn& column : link_columns_) arrays.push_back(filled<LinkView>(column, {rx, tx}, links));
  for (const PathColumn& column : path_columns_)
    arrays.push_back(filled<PathView>(column, {static_cast<int64_t>(paths.size())}, paths));
  return arrays;
}

}  // namespace greatx::sim
