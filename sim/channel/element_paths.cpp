// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/channel/element_paths.h"

#include <fmt/format.h>

#include "core/parallel.h"

namespace greatx::sim {

namespace {

/// Returns each element of an array as an end of its own.
std::vector<ChannelEnd> elements_of(const ArrayEnd& whole) {
  std::vector<ChannelEnd> ends;
  const uint32_t polarizations = whole.array.polarization_count();
  for (uint32_t element = 0; element < whole.array.element_count(); ++element) {
    ChannelEnd end = whole.end;
    end.name += fmt::format(" element {}", element);
    end.mount.position = end.mount.apply(whole.array.element_position(element * polarizations));
    ends.push_back(std::move(end));
  }
  return ends;
}

/// Returns an array of one such element at its own origin.
rf::AntennaArray element_alone(rf::AntennaArray array) {
  array.rows = array.columns = 1;
  array.positions_m.clear();
  return array;
}

}  // namespace

ElementPaths::ElementPaths(scene::GpuScene& gpu_scene, rf::CrossingPass& crossings,
                           const Experiment& experiment, const std::shared_ptr<RadioWorld>& radio,
                           uint32_t channel, ArrayEnd transmitter, ArrayEnd receiver)
    : transmitter_(std::move(transmitter)), receiver_(std::move(receiver)) {
  const std::vector<ChannelEnd> receivers = elements_of(receiver_);
  for (const ChannelEnd& element : elements_of(transmitter_))
    paths_.push_back(std::make_unique<ChannelPaths>(gpu_scene, crossings, experiment, radio, channel,
                                                    ChannelEnds{element, receivers, false, false}));
}

void ElementPaths::record(gpu::TickSlot& slot, const TickContext& context) {
  if (!started_)
    for (const auto& paths : paths_) paths->start(context);
  started_ = true;
  for (const auto& paths : paths_) paths->record(slot, context);
}

void ElementPaths::collect(const gpu::TickSlot& slot) {
  results_.clear();
  for (const auto& paths : paths_) results_.push_back(paths->collect(slot));
}

void ElementPaths::assemble(size_t per_pair, const LinkSum& sum, std::span<std::complex<float>> out) const {
  const rf::AntennaArray from = element_alone(transmitter_.array), to = element_alone(receiver_.array);
  const size_t tx_elements = transmitter_.array.element_count(),
               rx_elements = receiver_.array.element_count();
  const size_t tx_ports = transmitter_.array.port_count(), from_ports = from.port_count(),
               to_ports = to.port_count();
  // One thread suffices, since the caller distributes links over threads.
  parallel_for(tx_elements * rx_elements, 1, [&](size_t index) {
    const size_t s = index / rx_elements, u = index % rx_elements;
    const ChannelPaths::Link& link = results_[s].links[u];
    std::vector<std::complex<float>> block(to_ports * from_ports * per_pair);
    sum(link.paths, *results_[s].world, {from, results_[s].transmitter.orientation},
        {to, link.receiver.orientation}, block, 1);
    for (size_t q = 0; q < to_ports; ++q)
      std::copy_n(
          block.begin() + static_cast<std::ptrdiff_t>(q * from_ports * per_pair), from_ports * per_pair,
          out.begin() +
              static_cast<std::ptrdiff_t>(((u * to_ports + q) * tx_ports + s * from_ports) * per_pair));
  });
}

LinkLeftOut ElementPaths::left_out() const {
  LinkLeftOut all;
  for (const ChannelPaths::Result& result : results_)
    for (const ChannelPaths::Link& link : result.links) all.add(link.left_out);
  return all;
}

void ElementPaths::count(std::map<std::string, uint64_t>& counters) const {
  for (const auto& paths : paths_) {
    std::map<std::string, uint64_t> own;
    paths->count(own);
    for (const auto& [name, value] : own) counters[name] += value;
  }
}

}  // namespace greatx::sim
