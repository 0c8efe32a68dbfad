// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/paths/cfr.h"

#include <spdlog/spdlog.h>

#include "io/formats/npy.h"
#include "sim/channel/blocks.h"
#include "sim/channel/link_ends.h"
#include "sim/plan/antennas.h"
#include "sim/plan/array_plan.h"

namespace greatx::apps {

CfrFile::CfrFile(const std::filesystem::path& file, const sim::ChannelSnapshot& snapshot,
                 uint32_t transmitter, std::optional<size_t> points)
    : path_(file),
      scenario_(snapshot.experiment().scenario),
      config_(scenario_.channels[snapshot.channel()]) {
  const sim::Experiment& experiment = snapshot.experiment();
  transmitter_ = sim::antenna_array(scenario_, config_.transmitters[transmitter], config_.carrier_hz);
  if (points)
    receivers_.emplace_back();
  else
    for (const std::string& name : config_.receivers)
      receivers_.push_back(sim::antenna_array(scenario_, name, config_.carrier_hz));
  for (const rf::AntennaArray& receiver : receivers_)
    if (receiver.port_count() != receivers_[0].port_count())
      throw_user_error("--cfr: channel '{}': expected receivers with one number of ports, found {} and {}",
                       config_.name, receivers_[0].port_count(), receiver.port_count());
  count_ = points.value_or(receivers_.size());
  grid_ = sim::channel_grid(config_, experiment.plan);
  if (experiment.plan.dispersion.on) {
    const rf::RadioModel& model = snapshot.model();
    dispersion_.emplace(experiment.scene(), model.field_model(), model.effects.weather, grid_);
  }

  io::create_folder_of(path_);
  file_ = io::File::open_for_writing(io::part_name(path_));
  file_.truncate(0);
  file_.write_at(0, io::npy_header(DType::complex64,
                                   {static_cast<int64_t>(count_), receivers_[0].port_count(), 1,
                                    transmitter_.port_count(), grid_.time_samples, grid_.subcarriers}));
}

CfrFile::~CfrFile() {
  std::error_code ignored;
  if (!finished_) std::filesystem::remove(io::part_name(path_), ignored);
}

void CfrFile::add(const sim::ChannelSnapshot::Link& link) {
  const auto [transmitter, receiver] =
      sim::link_ends(scenario_, config_, transmitter_, link.transmitter_state,
                     receivers_[receivers_.size() == 1 ? 0 : link.receiver], link.receiver_state,
                     sim::half_band_hz(config_));
  response_.resize(rf::response_size(transmitter, receiver, grid_));
  std::vector<rf::TransferSpectrum> spectra;
  if (dispersion_) spectra = dispersion_->spectra(link.paths, *link.world);
  rf::frequency_response_into(link.paths, spectra, transmitter, receiver, grid_, response_);
  const std::span<const std::byte> bytes = std::as_bytes(std::span(response_));
  file_.write_at(io::npy_header_bytes + link.receiver * bytes.size(), bytes);
  ++added_;
  near_ += link.distance_m < sim::every_element_within_m(scenario_, config_, transmitter_, receiver.array);
}

void CfrFile::finish() {
  if (added_ != count_)
    throw_user_error("{}: expected the responses of {} receivers, found {}", path_.string(), count_, added_);
  const bool forced = sim::every_element_asked(scenario_) == sim::Switch::on;
  if (near_ > 0)
    spdlog::warn(
        "{}: {} of {} receivers {}: one path stands for all elements here; a run solves every element",
        path_.string(), near_, count_,
        forced ? "have arrays and every_element is on"
               : "are nearer than the far field of the arrays, 2 D^2/lambda");
  file_.close();
  io::rename_file(io::part_name(path_), path_);
  finished_ = true;
}

}  // namespace greatx::apps
