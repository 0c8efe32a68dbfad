// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/check/look.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/array_numbers.h"
#include "sim/run/simulator.h"

namespace greatx::sim {
namespace {

/// Looks at the records of a run.
class Looker : public RecordSink {
 public:
  Looker(const Scenario& scenario, const std::vector<SensorSpec>& specs, LookFigures& figures)
      : specs_(specs), figures_(figures) {
    for (const ChannelConfig& channel : scenario.channels)
      for (const std::string& receiver : channel.receivers)
        for (const std::string& transmitter : channel.transmitters)
          figures_.links.push_back({channel.name, transmitter, receiver});
  }

  void write(Packet packet) override {
    for (const Record& record : packet.records) {
      const SensorSpec& spec = specs_[record.sensor];
      for (size_t i = 0; i < spec.arrays.size(); ++i) {
        if (spec.kind == "camera" && spec.arrays[i].name == "rgb") see(spec.name, record.arrays[i]);
        if (spec.kind == "csi" && spec.arrays[i].name == "path_count") count(spec, record, record.arrays[i]);
      }
    }
  }

 private:
  void see(const std::string& name, const Array& picture) {
    auto found = std::ranges::find(figures_.pictures, name, &PictureFigures::name);
    if (found == figures_.pictures.end()) {
      figures_.pictures.emplace_back().name = name;
      found = figures_.pictures.end() - 1;
    }
    const auto values = picture.as<uint8_t>();
    size_t white = 0, black = 0;
    for (size_t i = 0; i + 2 < values.size(); i += 3) {
      const auto [least, most] = std::minmax({values[i], values[i + 1], values[i + 2]});
      white += least == 255;
      black += most < 3;
    }
    const auto pixels = static_cast<double>(values.size() / 3);
    const double of_white = static_cast<double>(white) / pixels,
                 of_black = static_cast<double>(black) / pixels;
    ++found->moments;
    found->white += of_white, found->black += of_black;
    found->all_white += of_white > 0.95, found->all_black += of_black > 0.95;
  }

  void count(const SensorSpec& spec, const Record& record, const Array& counts) {
    const auto sight = std::ranges::find(spec.arrays, "line_of_sight", &ArraySpec::name);
    const Array* direct = sight == spec.arrays.end()
                              ? nullptr
                              : &record.arrays[static_cast<size_t>(sight - spec.arrays.begin())];
    size_t link = 0;
    for (LinkFigures& figures : figures_.links) {
      if (figures.channel != spec.name) continue;
      ++figures.moments;
      figures.without_path += number_at(counts, link) == 0.0;
      figures.line_of_sight += direct != nullptr && number_at(*direct, link) != 0.0;
      ++link;
    }
  }

  const std::vector<SensorSpec>& specs_;
  LookFigures& figures_;
};

Scenario without_event_cameras(Scenario scenario) {
  for (NodeConfig& node : scenario.nodes)
    std::erase_if(node.sensors, [](const SensorConfig& sensor) {
      return std::holds_alternative<EventCameraConfig>(sensor.config);
    });
  return scenario;
}

void find_links(const std::vector<LinkFigures>& links, std::vector<Finding>& findings) {
  for (const LinkFigures& link : links)
    if (link.without_path > 0)
      findings.push_back({link.without_path == link.moments ? Severity::fault : Severity::doubt, "no_path",
                          link.channel,
                          fmt::format("has no path from {} to {} at {} of {} moments", link.transmitter,
                                      link.receiver, link.without_path, link.moments)});
}

void find_pictures(std::vector<PictureFigures>& pictures, std::vector<Finding>& findings) {
  for (PictureFigures& picture : pictures) {
    picture.white /= static_cast<double>(picture.moments);
    picture.black /= static_cast<double>(picture.moments);
    for (const auto& [count, what] :
         {std::pair(picture.all_white, "white"), std::pair(picture.all_black, "black")})
      if (count > 0)
        findings.push_back({count == picture.moments ? Severity::fault : Severity::doubt, "exposure",
                            picture.name,
                            fmt::format("is {} at {} of {} moments", what, count, picture.moments)});
  }
}

}  // namespace

std::vector<Finding> look(const Experiment& experiment, gpu::Device& device, uint32_t moments,
                          LookFigures& figures, const std::function<void(uint32_t)>& moment_done) {
  const Scenario& scenario = experiment.scenario;
  const Experiment seen = make_experiment(without_event_cameras(scenario), experiment.world);
  std::vector<Finding> findings;
  Simulator simulator(device, seen);
  Looker looker(seen.scenario, simulator.sensors(), figures);
  for (uint32_t i = 0; i < moments; ++i) {
    const uint64_t sequence = uint64_t{i} * scenario.sequences / moments;
    const int64_t tick = std::min(scenario.ticks - 1, (2 * int64_t{i} + 1) * scenario.ticks / (2 * moments));
    simulator.start(static_cast<uint32_t>(sequence), tick);
    simulator.step(looker);
    simulator.drain(looker);
    moment_done(i + 1);
  }
  device.wait_idle();
  find_links(figures.links, findings);
  find_pictures(figures.pictures, findings);
  return findings;
}

}  // namespace greatx::sim
