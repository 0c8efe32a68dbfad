// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Declares the arrays of a channel and fills them for each record, in the same order.
#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "core/budget.h"
#include "core/parallel.h"
#include "core/units.h"
#include "rf/channel/coherence.h"
#include "rf/channel/received.h"
#include "sim/channel/channel_sensor.h"
#include "sim/plan/antennas.h"
#include "sim/plan/array_plan.h"
#include "sim/sensors/sensor_metadata.h"

namespace greatx::sim {

namespace {

/// Describes layers at the carrier, outermost first; null if there are none. `range_hz` is that of the row
/// that the medium has at the carrier, and missing where a medium holds at every frequency.
nlohmann::json describe_layers(const std::vector<rf::DielectricLayer>& front,
                               const std::vector<scene::RadioLayer>& of, const std::string& material,
                               double carrier_hz) {
  nlohmann::json layers;
  for (size_t i = 0; i < front.size(); ++i) {
    const scene::RadioMedium& medium = of[i].medium;
    const scene::RadioRow& row = scene::row_at(medium, carrier_hz, material);
    layers.push_back({{"relative_permittivity", {front[i].eta.real(), front[i].eta.imag()}},
                      {"thickness_m", front[i].thickness_m},
                      {"source", medium.source},
                      {"extrapolated", carrier_hz < row.min_hz || carrier_hz > row.max_hz}});
    if (std::isfinite(row.max_hz)) layers.back()["range_hz"] = {row.min_hz, row.max_hz};
  }
  return layers;
}

/// Describes each material at the carrier: its layers, null if no facet has the material, and its windows, if
/// it has any.
nlohmann::json describe_walls(const scene::Scene& scene, const rf::RadioSurfaces& surfaces,
                              double carrier_hz) {
  nlohmann::json walls = nlohmann::json::array();
  for (uint32_t material = 0; material < scene.materials.size(); ++material) {
    const rf::RadioSurface& surface = surfaces.surface(material);
    const std::string& name = scene.materials[material].name;
    const std::optional<scene::RadioMaterial>& radio = scene.materials[material].radio;
    nlohmann::json wall{{"material", name}, {"layers", nullptr}};
    if (!surface.front.empty())
      wall["layers"] = describe_layers(surface.front, radio->layers, name, carrier_hz);
    if (surface.windows.share > 0.0)
      wall["windows"] = {
          {"share", surface.windows.share},
          {"layers", describe_layers(surface.windows.front, radio->windows->layers, name, carrier_hz)}};
    walls.push_back(std::move(wall));
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

nlohmann::json describe_surface(const TargetSurface& surface, double carrier_hz) {
  const double wavelength_m = speed_of_light / carrier_hz;
  nlohmann::json json{{"rows", surface.rows},
                      {"columns", surface.columns},
                      {"row_spacing_m", surface.row_spacing_wl * wavelength_m},
                      {"column_spacing_m", surface.column_spacing_wl * wavelength_m},
                      {"amplitude", surface.amplitude},
                      {"bits", surface.bits}};
  const auto end = [](const SurfaceEnd& aim) {
    const dvec3& u = aim.direction;
    return aim.antenna.empty() ? nlohmann::json({u.x, u.y, u.z}) : nlohmann::json(aim.antenna);
  };
  if (surface.steer)
    json["steer"] = {{"from", end(surface.steer->first)}, {"to", end(surface.steer->second)}};
  if (!surface.phases.empty())
    for (const double phase : surface.phases) json["phases_deg"].push_back(degrees(phase));
  else if (!surface.steer)
    json["phase_deg"] = degrees(surface.phase);
  return json;
}

/// Describes the targets with their models; instances as on disk, index + 1.
nlohmann::json describe_targets(const Experiment& experiment, const ChannelConfig& config) {
  nlohmann::json targets = nlohmann::json::array();
  for (const TargetConfig& target : config.targets) {
    nlohmann::json json{{"node", experiment.scenario.nodes[target.node].name},
                        {"instance", target_instance(experiment, target) + 1}};
    if (const auto* kind = std::get_if<rf::Tr38901Kind>(&target.model))
      json["tr38901"] = rf::tr38901_kinds[static_cast<size_t>(*kind)];
    else if (const auto* tubes = std::get_if<TargetTubes>(&target.model))
      json["tubes"] = {
          {"width_m", tubes->tube_m}, {"budget", tubes->budget}, {"max_bounces", tubes->max_bounces}};
    else if (const auto* surface = std::get_if<TargetSurface>(&target.model))
      json["surface"] = describe_surface(*surface, config.carrier_hz);
    else {
      const rf::RcsTable& table = *std::get<std::shared_ptr<const rf::RcsTable>>(target.model);
      json["table"] = table.name();
      json["sha256"] = table.sha256();
    }
    targets.push_back(std::move(json));
  }
  return targets;
}

/// Returns an array with one row for each of `rows`. `leading` holds the dimensions before those of a row.
template <typename View>
Array filled(const Column<View>& column, std::vector<int64_t> leading, std::span<const View> rows) {
  leading.insert(leading.end(), column.row.begin(), column.row.end());
  Array array(column.dtype, std::move(leading));
  const size_t step = column.row_bytes();
  for (size_t i = 0; i < rows.size(); ++i) column.fill(rows[i], array.bytes.data() + i * step);
  return array;
}

/// Adds the echoes among `paths` to a block of a link that was solved element by element, whose own paths
/// they are not. Targets are seen from the arrays' origins.
void add_echoes_to(const PortBlock& block, std::span<const rf::Path> paths, const rf::FacetWorld& world,
                   const LinkEnds& ends, std::span<std::complex<float>> out) {
  std::vector<rf::Path> echoes;
  for (const rf::Path& path : paths)
    if (path.echo) echoes.push_back(path);
  std::vector<std::complex<float>> sum(out.size());
  block.sum(echoes, world, ends.transmitter, ends.receiver, sum, 1);
  for (size_t i = 0; i < out.size(); ++i) out[i] += sum[i];
}

}  // namespace

/// Holds everything that the arrays of a link need.
struct ChannelSensor::LinkFacts {
  LinkView view;  ///< its pointer is set later, since this struct moves
  rf::LinkStatistics statistics;
  std::vector<std::complex<float>> amplitudes;  ///< [paths, rx_ant, tx_ant]
  std::vector<std::complex<float>> fields;      ///< [paths, tx_ant, 2]; empty without a power
};

void ChannelSensor::describe() {
  const int64_t receivers = static_cast<int64_t>(receiver_arrays_.size()),
                transmitters = static_cast<int64_t>(transmitter_arrays_.size());
  columns_ = {&experiment_.scene(), &radio_->model(), &config_, receiver_arrays_[0].port_count(),
              transmitter_arrays_[0].port_count()};
  link_columns_ = link_columns(columns_);
  if (config_.outputs.paths) path_columns_ = path_columns(columns_);
  blocks_ = port_blocks(config_, grid_, dispersion_ ? &*dispersion_ : nullptr);
  spec_.name = config_.name;
  spec_.kind = "csi";
  spec_.rate = config_.rate_hz.str();
  uint64_t planned = 0;
  for (const PortBlock& block : blocks_) {
    planned = saturating_sum(
        planned,
        saturating_product({static_cast<uint64_t>(receivers), static_cast<uint64_t>(columns_.rx_ports),
                            static_cast<uint64_t>(transmitters), static_cast<uint64_t>(columns_.tx_ports),
                            static_cast<uint64_t>(block.time), static_cast<uint64_t>(block.last),
                            sizeof(std::complex<float>)}));
    require_within(fmt::format("channel '{}': {}: {} x {} ports, {} x {} ports, {} x {} values each",
                               config_.name, block.name, receivers, columns_.rx_ports, transmitters,
                               columns_.tx_ports, block.time, block.last),
                   planned, budget::channel_record);
    spec_.arrays.push_back(
        {block.name,
         DType::complex64,
         {receivers, columns_.rx_ports, transmitters, columns_.tx_ports, block.time, block.last},
         "1",
         block.description});
    spec_.outputs.push_back({block.name, FileFormat::npy_stack, {block.name}});
  }
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
  if (sensing_) sensing_->describe(spec_);
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
  metadata["max_depth"] = config_.limits.max_depth;
  if (targets_) metadata["targets"] = describe_targets(experiment_, config_);
  metadata["non_finite"] = {"vertex"};
  for (const LinkColumn& column : link_columns_)
    if (column.dtype == DType::f64) metadata["non_finite"].push_back(column.name);
  if (sensing_) sensing_->describe(metadata);
  metadata["axes"] = {"batch", "rx", "rx_ant", "tx", "tx_ant", "time", "subcarrier"};
  if (config_.taps)
    metadata["taps"] = {{"bandwidth_hz", config_.taps->bandwidth_hz}, {"first", config_.taps->first}};
  if (config_.power_dbm) {
    metadata["power_dbm"] = *config_.power_dbm;
    metadata["resistance_ohm"] = config_.resistance_ohm;
  }
  metadata["time_convention"] = "e^{+j omega t}";
  std::vector<ChannelEnd> transmitters;
  for (const auto& paths : paths_) transmitters.push_back(paths->transmitter());
  // For links nearer than 2 (D_tx + D_rx)^2 / lambda, or for all links.
  metadata["every_element"] = !near_links_.empty();
  metadata["transmitters"] = describe_ends(transmitter_arrays_, transmitters);
  metadata["receivers"] = describe_ends(receiver_arrays_, paths_[0]->receivers());
  metadata["pattern_tables"] = describe_pattern_tables({transmitter_arrays_, receiver_arrays_});
  metadata["doppler_in_time_samples"] = doppler_;  // off: all time samples are equal
  // On: link by link, if the phase over the arrays matters.
  metadata["wave_curvature"] = experiment_.plan.wave_curvature.on;
  metadata["beam_squint"] = experiment_.plan.beam_squint.on;
  // Off: walls and air have their values at the carrier for every subcarrier.
  metadata["dispersion"] = dispersion_.has_value();
  metadata["walls"] = describe_walls(experiment_.scene(), radio_->model().surfaces, config_.carrier_hz);
  for (const auto& [name, text] : paths_[0]->notes({})) metadata["candidates"][name] = text;
  metadata["candidates"]["bounds"] =
      "sequences_left_out and paths_left_out count at every tick what the guarantee does not hold for";
  return metadata.dump();
}

LinkEnds ChannelSensor::ends_of(const Results& results, size_t receiver, size_t transmitter) const {
  return link_ends(experiment_.scenario, config_, transmitter_arrays_[transmitter],
                   results[transmitter].transmitter, receiver_arrays_[receiver],
                   results[transmitter].links[receiver].receiver, half_band_hz(config_));
}

/// Returns a block for all links, [rx, rx_ant, tx, tx_ant, time, last].
Array ChannelSensor::block_of(const PortBlock& block, const Results& results, uint32_t slot) const {
  const size_t transmitters = results.size(), receivers = results[0].links.size();
  const size_t rx_ports = static_cast<size_t>(columns_.rx_ports),
               row = static_cast<size_t>(columns_.tx_ports) * block.per_pair();
  Array array(DType::complex64,
              {static_cast<int64_t>(receivers), columns_.rx_ports, static_cast<int64_t>(transmitters),
               columns_.tx_ports, block.time, block.last});
  const std::span<std::complex<float>> out = array.as<std::complex<float>>();
  const uint32_t threads = threads_of_each(receivers * transmitters);
  parallel_for(receivers * transmitters, 0, [&](size_t index) {
    const size_t r = index / transmitters, t = index % transmitters;
    // With one transmitter the values of a link are contiguous, and no copy is needed.
    std::vector<std::complex<float>> apart(transmitters == 1 ? 0 : rx_ports * row);
    const std::span<std::complex<float>> h =
        transmitters == 1 ? out.subspan(r * rx_ports * row, rx_ports * row) : std::span(apart);
    const std::vector<rf::Path>& paths = results[t].links[r].paths;
    const LinkEnds ends = ends_of(results, r, t);
    if (const ElementPaths* elements = elements_of(r, t, slot)) {
      elements->assemble(block.per_pair(), block.sum, h);
      if (targets_) add_echoes_to(block, paths, *results[t].world, ends, h);
    } else {
      block.sum(paths, *results[t].world, ends.transmitter, ends.receiver, h, threads);
    }
    for (size_t port = 0; !apart.empty() && port < rx_ports; ++port)
      std::copy_n(
          h.begin() + static_cast<std::ptrdiff_t>(port * row), row,
          out.begin() + static_cast<std::ptrdiff_t>(((r * rx_ports + port) * transmitters + t) * row));
  });
  return array;
}

ChannelSensor::LinkFacts ChannelSensor::facts_of(const Results& results, size_t receiver, size_t transmitter,
                                                 uint32_t slot) const {
  const std::vector<rf::Path>& paths = results[transmitter].links[receiver].paths;
  const auto [from, to] = ends_of(results, receiver, transmitter);
  const std::vector<double> powers = rf::path_powers(paths, from, to, config_.carrier_hz);
  LinkFacts facts;
  facts.statistics = rf::link_statistics(paths, powers);
  facts.view.receiver = static_cast<int32_t>(receiver);
  facts.view.transmitter = static_cast<int32_t>(transmitter);
  const ElementPaths* elements = elements_of(receiver, transmitter, slot);
  facts.view.every_element = elements != nullptr;
  LinkLeftOut left_out = results[transmitter].links[receiver].left_out;
  if (elements != nullptr) left_out.add(elements->left_out());
  facts.view.sequences_left_out = left_out.searched.sequences;
  facts.view.paths_left_out = left_out.paths;
  if (config_.outputs.coherence) {
    facts.view.coherence_bandwidth_hz = rf::coherence_bandwidth_hz(paths, powers, 0.5);
    facts.view.coherence_time_s = rf::coherence_time_s(paths, powers, 0.5);
  }
  if (config_.taps)
    facts.view.taps_power_outside = rf::tap_coverage(paths, powers, tap_grid(config_, grid_)).power_outside;
  if (!config_.outputs.paths) return facts;
  facts.amplitudes = rf::impulse_response(paths, from, to, config_.carrier_hz).amplitude;
  if (config_.power_dbm) {
    facts.fields.resize(paths.size() * from.array.port_count() * 2);
    rf::arriving_fields(paths, from, config_.carrier_hz, rf::watts(*config_.power_dbm), facts.fields);
  }
  return facts;
}

std::vector<Array> ChannelSensor::arrays_of(const Results& results, uint32_t slot) const {
  const size_t transmitters = results.size(), receivers = results[0].links.size();
  std::vector<LinkFacts> facts(receivers * transmitters);
  parallel_for(facts.size(), 0, [&](size_t index) {
    facts[index] = facts_of(results, index / transmitters, index % transmitters, slot);
    facts[index].view.statistics = &facts[index].statistics;
  });

  std::vector<LinkView> links;
  for (const LinkFacts& of : facts) links.push_back(of.view);
  std::vector<PathView> paths;
  const size_t pairs = static_cast<size_t>(columns_.rx_ports * columns_.tx_ports),
               fields = config_.power_dbm ? static_cast<size_t>(columns_.tx_ports * 2) : 0;
  for (size_t index = 0; !path_columns_.empty() && index < facts.size(); ++index) {
    const std::vector<rf::Path>& own = results[index % transmitters].links[index / transmitters].paths;
    for (size_t i = 0; i < own.size(); ++i)
      paths.push_back({&links[index], &own[i], std::span(facts[index].amplitudes).subspan(i * pairs, pairs),
                       std::span(facts[index].fields).subspan(i * fields, fields)});
  }
  std::vector<Array> arrays;
  const int64_t rx = static_cast<int64_t>(receivers), tx = static_cast<int64_t>(transmitters);
  for (const PortBlock& block : blocks_) arrays.push_back(block_of(block, results, slot));
  for (const LinkColumn& column : link_columns_) arrays.push_back(filled<LinkView>(column, {rx, tx}, links));
  for (const PathColumn& column : path_columns_)
    arrays.push_back(filled<PathView>(column, {static_cast<int64_t>(paths.size())}, paths));
  if (sensing_) add_sensed(results, slot, arrays);
  return arrays;
}

void ChannelSensor::add_sensed(const Results& results, uint32_t slot, std::vector<Array>& arrays) const {
  const size_t transmitters = results.size(), receivers = results[0].links.size();
  const auto rx_ports = static_cast<size_t>(columns_.rx_ports),
             tx_ports = static_cast<size_t>(columns_.tx_ports);
  Array own;
  if (!config_.outputs.cfr)
    own = block_of(cfr_block(grid_, dispersion_ ? &*dispersion_ : nullptr), results, slot);
  const std::span<const std::complex<float>> all =
      std::as_const(config_.outputs.cfr ? arrays[0] : own).as<std::complex<float>>();
  const size_t row = tx_ports * grid_.size_per_pair();
  std::vector<std::vector<std::complex<float>>>
      gathered;  // with several transmitters a link is not contiguous
  std::vector<SensedLink> links;
  for (size_t r = 0; r < receivers; ++r)
    for (size_t t = 0; t < transmitters; ++t) {
      std::vector<std::complex<float>>& h = gathered.emplace_back();
      for (size_t port = 0; port < rx_ports; ++port) {
        const auto from = all.subspan(((r * rx_ports + port) * transmitters + t) * row, row);
        h.insert(h.end(), from.begin(), from.end());
      }
    }
  for (size_t index = 0; index < receivers * transmitters; ++index) {
    const size_t r = index / transmitters, t = index % transmitters;
    LinkEnds ends = ends_of(results, r, t);
    links.push_back({gathered[index], results[t].links[r].paths, std::move(ends.transmitter),
                     std::move(ends.receiver), results[t].transmitter, results[t].links[r].receiver});
  }
  const std::span<const TargetState> targets =
      targets_ ? std::span(targets_->states()) : std::span<const TargetState>();
  for (Array& array : sensing_->arrays_of(links, targets, moments_[slot].sequence, moments_[slot].tick))
    arrays.push_back(std::move(array));
}

}  // namespace greatx::sim
