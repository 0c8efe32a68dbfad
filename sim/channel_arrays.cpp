// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// What a channel delivers: its declaration and the arrays of a record, in the same order.
#include <algorithm>
#include <cmath>
#include <limits>

#include <nlohmann/json.hpp>

#include "sim/channel_antennas.h"
#include "sim/channel_sensor.h"
#include "sim/sensor_metadata.h"

namespace greatx::sim {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

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

/// Rows of one per-path array, filled path by path.
template <typename T>
class PathArray {
 public:
  PathArray(size_t paths, std::vector<int64_t> row_shape) {
    std::vector<int64_t> shape{static_cast<int64_t>(paths)};
    shape.insert(shape.end(), row_shape.begin(), row_shape.end());
    array_ = Array(DTypeOf<T>::value, std::move(shape));
    next_ = array_.as<T>().data();
  }
  void push(T value) { *next_++ = value; }
  Array take() { return std::move(array_); }

 private:
  Array array_;
  T* next_;
};

}  // namespace

void ChannelSensor::describe() {
  const int64_t receivers = static_cast<int64_t>(receiver_arrays_.size());
  const int64_t rx_ports = receiver_arrays_[0].port_count(), tx_ports = transmitter_array_.port_count();
  const int64_t depth = std::max<uint32_t>(1, config_.max_depth);
  spec_.name = config_.name;
  spec_.kind = "csi";
  spec_.rate = config_.rate_hz.str();
  const auto stack = [&](const char* name, DType dtype, std::vector<int64_t> shape, const char* unit,
                         const char* text) {
    spec_.arrays.push_back({name, dtype, std::move(shape), unit, text});
    spec_.outputs.push_back({name, FileFormat::npy_stack, {name}});
  };
  const auto ragged = [&](const char* name, DType dtype, std::vector<int64_t> row, const char* unit,
                          const char* text) {
    row.insert(row.begin(), -1);
    spec_.arrays.push_back({name, dtype, std::move(row), unit, text});
    spec_.outputs.push_back({std::string("paths/") + name, FileFormat::npy_ragged, {name}});
  };
  stack("cfr", DType::complex64,
        {receivers, rx_ports, 1, tx_ports, config_.time_samples, config_.subcarriers}, "1",
        "[rx, rx_ant, tx, tx_ant, time, subcarrier] H(f) at carrier + (k - floor(N/2)) * spacing");
  stack("path_count", DType::i32, {receivers}, "1", "[rx] visible paths");
  stack("line_of_sight", DType::u8, {receivers}, "1", "[rx] 1: the direct path is free");
  stack("path_gain", DType::f64, {receivers}, "1", "[rx] sum over paths of |a|^2, mean over port pairs");
  ragged("rx", DType::i32, {}, "1", "[path] receiver");
  ragged("amplitude", DType::complex64, {rx_ports, tx_ports}, "1",
         "[path, rx_ant, tx_ant] with e^{-j 2 pi f_c tau}");
  ragged("delay", DType::f64, {}, "s", "[path] not normalised");
  ragged("doppler", DType::f64, {}, "Hz", "[path] approaching: positive");
  ragged("departure", DType::f64, {2}, "rad",
         "[path, (zenith, azimuth)] leaving the transmitter, world axes");
  ragged("arrival", DType::f64, {2}, "rad",
         "[path, (zenith, azimuth)] from the receiver back along the path, world axes");
  ragged("transfer", DType::complex64, {2, 2}, "1/m",
         "[path, (theta, phi) at rx, (theta, phi) at tx] without the phase of the delay");
  ragged("id", DType::u64, {}, "1", "[path] its identity across ticks: a function of its interactions alone");
  ragged("foliage", DType::f64, {}, "m", "[path] of its length inside foliage");
  ragged("interaction", DType::u8, {depth}, "1",
         "[path, i] 0: none, 1: reflection, 2: transmission, 3: diffraction, 4: scattering");
  ragged("vertex", DType::f64, {depth, 3}, "m", "[path, i, xyz] of each interaction, world; NaN: none");
  ragged("facet", DType::u32, {depth}, "1",
         "[path, i] facet + 1 (diffraction: the wedge's first face); 0: none");
  ragged("element", DType::u32, {depth}, "1",
         "[path, i] wedge + 1, or the scattering facet's patch + 1; 0: none");
  ragged("object", DType::u32, {depth}, "1", "[path, i] index into instances + 1; 0: none");
  ragged("object_material", DType::u32, {depth}, "1", "[path, i] index into materials + 1; 0: none");

  nlohmann::json metadata;
  metadata["carrier_hz"] = config_.carrier_hz;
  metadata["subcarrier_spacing_hz"] = config_.subcarrier_spacing_hz;
  metadata["subcarriers"] = config_.subcarriers;
  metadata["first_subcarrier"] = -static_cast<int64_t>(config_.subcarriers / 2);
  metadata["time_samples"] = config_.time_samples;
  metadata["time_spacing_s"] = config_.time_spacing_s;
  metadata["max_depth"] = config_.max_depth;
  metadata["non_finite"] = {"vertex"};
  metadata["axes"] = {"batch", "rx", "rx_ant", "tx", "tx_ant", "time", "subcarrier"};
  metadata["time_convention"] = "e^{+j omega t}";
  metadata["transmitter"] = describe_array(transmitter_array_);
  metadata["transmitter"]["name"] = config_.transmitter;
  metadata["transmitter"]["body_from_antenna"] = json_of(paths_.transmitter().mount);
  for (size_t r = 0; r < receiver_arrays_.size(); ++r) {
    metadata["receivers"].push_back(describe_array(receiver_arrays_[r]));
    metadata["receivers"].back()["name"] = config_.receivers[r];
    metadata["receivers"].back()["body_from_antenna"] = json_of(paths_.receivers()[r].mount);
  }
  metadata["doppler_in_time_samples"] = doppler_;  // off: all time samples are those of the tick
  metadata["dispersion"] =
      dispersion_.has_value();  // off: walls and air are the carrier's at every subcarrier
  metadata["walls"] = describe_walls(world_.scene, paths_.model().surfaces);
  for (const auto& [name, text] : paths_.notes()) metadata["candidates"][name] = text;
  spec_.metadata_json = metadata.dump();
}

/// Ids as on disk: index + 1, 0 is none.
ChannelSensor::Where ChannelSensor::where_of(const rf::Interaction& interaction) const {
  Where where;
  where.type = static_cast<uint8_t>(interaction.type);
  uint32_t facet = interaction.element;
  if (interaction.type == rf::InteractionType::diffraction) {
    facet = paths_.model().wedges[interaction.element].facet_0;
    where.element = interaction.element + 1;
  } else if (interaction.type == rf::InteractionType::scattering) {
    where.element = interaction.patch + 1;
  }
  where.facet = facet + 1;
  where.object = world_.scene.facets[facet].instance + 1;
  where.material = world_.scene.facets[facet].material + 1;
  return where;
}

std::vector<Array> ChannelSensor::arrays_of(const ChannelPaths::Result& result) const {
  const size_t receivers = result.links.size();
  const size_t depth = std::max<uint32_t>(1, config_.max_depth);
  const size_t rx_ports = receiver_arrays_[0].port_count(), tx_ports = transmitter_array_.port_count();
  size_t paths = 0;
  for (const ChannelPaths::Link& link : result.links) paths += link.paths.size();
  const auto ports = [](size_t count) { return static_cast<int64_t>(count); };

  Array cfr(DType::complex64, spec_.arrays[0].shape);
  Array counts(DType::i32, {ports(receivers)}), sight(DType::u8, {ports(receivers)}),
      gains(DType::f64, {ports(receivers)});
  PathArray<int32_t> rx(paths, {});
  PathArray<std::complex<float>> amplitude(paths, {ports(rx_ports), ports(tx_ports)}),
      transfer(paths, {2, 2});
  PathArray<double> delay(paths, {}), doppler(paths, {}), departure(paths, {2}), arrival(paths, {2}),
      vertex(paths, {ports(depth), 3}), foliage(paths, {});
  PathArray<uint8_t> interaction(paths, {ports(depth)});
  PathArray<uint64_t> id(paths, {});
  PathArray<uint32_t> facet(paths, {ports(depth)}), element(paths, {ports(depth)}),
      object(paths, {ports(depth)}), material(paths, {ports(depth)});

  const rf::ArrayPose transmitter{transmitter_array_, result.transmitter.orientation};
  size_t cfr_offset = 0;
  for (size_t r = 0; r < receivers; ++r) {
    const ChannelPaths::Link& link = result.links[r];
    const rf::ArrayPose receiver{receiver_arrays_[r], link.receiver.orientation};
    const auto response = dispersion_ ? rf::frequency_response(link.paths, dispersion_->spectra(link.paths),
                                                               transmitter, receiver, grid_)
                                      : rf::frequency_response(link.paths, transmitter, receiver, grid_);
    std::copy(response.begin(), response.end(),
              cfr.as<std::complex<float>>().begin() + static_cast<std::ptrdiff_t>(cfr_offset));
    cfr_offset += response.size();
    const rf::ImpulseResponse impulse =
        rf::impulse_response(link.paths, transmitter, receiver, config_.carrier_hz);
    double gain = 0.0;
    for (const std::complex<float>& a : impulse.amplitude) {
      amplitude.push(a);
      gain += std::norm(std::complex<double>(a));
    }
    counts.as<int32_t>()[r] = static_cast<int32_t>(link.paths.size());
    gains.as<double>()[r] = gain / static_cast<double>(rx_ports * tx_ports);
    for (const rf::Path& path : link.paths) {
      if (path.interactions.empty()) sight.as<uint8_t>()[r] = 1;
      rx.push(static_cast<int32_t>(r));
      delay.push(path.delay_s);
      doppler.push(path.doppler_hz);
      for (const auto& [direction, into] :
           {std::pair(path.departure, &departure), std::pair(path.arrival, &arrival)}) {
        const dvec2 angles = rf::theta_phi(direction);
        into->push(angles.x);
        into->push(angles.y);
      }
      for (const rf::Complex& t : path.transfer) transfer.push(std::complex<float>(t));
      id.push(path.id());
      foliage.push(path.foliage_m);
      for (size_t i = 0; i < depth; ++i) {
        const bool there = i < path.interactions.size();
        const dvec3 point = there ? path.vertices[i + 1] + world_.scene.origin : dvec3(nan);
        for (int c = 0; c < 3; ++c) vertex.push(point[c]);
        const Where where = there ? where_of(path.interactions[i]) : Where{};
        interaction.push(where.type);
        facet.push(where.facet);
        element.push(where.element);
        object.push(where.object);
        material.push(where.material);
      }
    }
  }
  std::vector<Array> arrays;
  arrays.push_back(std::move(cfr));
  arrays.push_back(std::move(counts));
  arrays.push_back(std::move(sight));
  arrays.push_back(std::move(gains));
  arrays.push_back(rx.take());
  arrays.push_back(amplitude.take());
  arrays.push_back(delay.take());
  arrays.push_back(doppler.take());
  arrays.push_back(departure.take());
  arrays.push_back(arrival.take());
  arrays.push_back(transfer.take());
  arrays.push_back(id.take());
  arrays.push_back(foliage.take());
  arrays.push_back(interaction.take());
  arrays.push_back(vertex.take());
  arrays.push_back(facet.take());
  arrays.push_back(element.take());
  arrays.push_back(object.take());
  arrays.push_back(material.take());
  return arrays;
}

}  // namespace greatx::sim
