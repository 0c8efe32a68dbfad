// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "view/world/map_job.h"

#include <chrono>
#include <utility>

#include "core/error.h"
#include "sim/channel/channel_snapshot.h"

namespace greatx::view {

namespace {

using JobClock = std::chrono::steady_clock;
constexpr double publish_s = 0.5;  ///< between parts of a map: each is a copy of its links

double seconds_since(JobClock::time_point begin) {
  return std::chrono::duration<double>(JobClock::now() - begin).count();
}

std::shared_ptr<ShownMap> empty_map(const MapWish& wish, const sim::RadioMapRun& run,
                                    const sim::ChannelConfig& channel) {
  auto map = std::make_shared<ShownMap>();
  map->wish = wish;
  map->cells = run.cells();
  map->power = run.power();
  for (size_t t = 0; t < run.transmitters().size(); ++t)
    map->transmitters.push_back({channel.transmitters[t], dvec2(run.transmitters()[t])});
  return map;
}

}  // namespace

MapJob::MapJob(std::shared_ptr<const sim::Experiment> experiment, MapWish wish, gpu::DeviceOptions device)
    : thread_([this, experiment = std::move(experiment), wish = std::move(wish), device = std::move(device)] {
        work(experiment, wish, device);
      }) {}

MapJob::~MapJob() {
  cancelled_ = true;
  thread_.join();
}

void MapJob::work(const std::shared_ptr<const sim::Experiment>& experiment, const MapWish& wish,
                  const gpu::DeviceOptions& device) {
  try {
    const WatchScope watch(*this);
    compute(experiment, wish, device);
  } catch (const Interrupted&) {
    // Cancelled: what is done stays.
  } catch (const std::exception& error) {
    const std::lock_guard lock(mutex_);
    error_ = error.what();
  }
  finished_ = true;
}

void MapJob::compute(const std::shared_ptr<const sim::Experiment>& shown, const MapWish& wish,
                     const gpu::DeviceOptions& device_options) {
  const JobClock::time_point begin = JobClock::now();
  const sim::ChannelConfig& channel = shown->scenario.channels.at(wish.channel);
  sim::check_map_request(wish.request, channel);
  // The plan depends on where the receivers are, which here are the cells.
  const scene::Bounds bounds = sim::map_bounds(wish.request, channel, shown->scene());
  const sim::Experiment experiment = sim::make_experiment(shown->scenario, shown->world, bounds);
  gpu::Device device(device_options);
  sim::ChannelSnapshot snapshot(device, experiment, wish.channel, {wish.sequence, wish.tick, {}});
  sim::RadioMapRun run(snapshot, wish.request, {});
  const std::shared_ptr<const ShownMap> empty = empty_map(wish, run, channel);
  const size_t cells = run.cells().grid.cells(), transmitters = run.transmitters().size();
  std::vector<sim::MapLink> links;
  links.reserve(cells * transmitters);
  JobClock::time_point published = JobClock::now();
  const auto publish_links = [&] {
    auto map = std::make_shared<ShownMap>(*empty);
    map->done = links.size() / transmitters;
    map->links = links;
    map->links.resize(cells * transmitters, sim::no_link());
    publish(std::move(map));
    published = JobClock::now();
  };
  progress_ = 0.0;
  run.solve(0, [&](std::span<const sim::MapLink> more) {
    links.insert(links.end(), more.begin(), more.end());
    progress_ = static_cast<double>(links.size()) / static_cast<double>(cells * transmitters);
    seconds_ = seconds_since(begin);
    if (seconds_since(published) > publish_s) publish_links();
    return !cancelled_;
  });
  publish_links();
  device.wait_idle();
  seconds_ = seconds_since(begin);
}

void MapJob::publish(std::shared_ptr<const ShownMap> map) {
  const std::lock_guard lock(mutex_);
  map_ = std::move(map);
}

std::shared_ptr<const ShownMap> MapJob::map() const {
  const std::lock_guard lock(mutex_);
  return map_;
}

std::string MapJob::error() const {
  const std::lock_guard lock(mutex_);
  return error_;
}

}  // namespace greatx::view
