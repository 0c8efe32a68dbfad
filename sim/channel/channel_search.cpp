// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/channel/channel_search.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <spdlog/spdlog.h>

#include "core/units.h"
#include "rf/search/search_cache.h"
#include "rf/search/search_key.h"

namespace greatx::sim {

namespace {

rf::CandidateSearchOptions ray_options(const ChannelConfig& config, uint32_t walls, bool moving_bodies) {
  rf::CandidateSearchOptions options;
  options.rays = config.rays;
  options.max_depth = config.limits.max_depth;
  options.max_transmissions = walls;
  options.moving_bodies = moving_bodies;
  return options;
}

rf::MovingSearchOptions moving_options(const ChannelConfig& config, uint32_t walls, bool moving_bodies) {
  rf::MovingSearchOptions options;
  options.max_depth = config.limits.max_depth;
  options.max_transmissions = walls;
  options.moving_bodies = moving_bodies;
  return options;
}

}  // namespace

ChannelSearch::ChannelSearch(scene::GpuScene* gpu_scene, const rf::RadioModel& model, const EffectPlan& plan,
                             const ChannelConfig& config, const Ends& ends)
    : model_(model),
      config_(config),
      move_facets_(plan.moving_reflectors.on),
      walls_(plan.transmission.on ? config.walls() : 0),
      transmitter_body_(ends.transmitter_body) {
  choose(plan, ends);
  if (plan.diffraction.on && config_.candidates == ChannelConfig::Candidates::rays)
    throw_user_error_at(
        config_.where,
        "channel '{}': candidates: expected beams, since diffraction is on and rays meet no edges; "
        "found rays",
        config_.name);
  if (way_ == Way::none) return;
  if (config_.candidates != ChannelConfig::Candidates::rays)
    make_beams();
  else if (gpu_scene != nullptr)
    rays_.emplace(*gpu_scene, ray_options(config_, walls_, move_facets_), model_.kinds);
}

void ChannelSearch::choose(const EffectPlan& plan, const Ends& ends) {
  const bool bounces = plan.reflection.on || plan.diffraction.on || plan.scattering.on;
  if (!bounces || config_.limits.max_depth == 0) return;
  // Diffraction, scattering and rays need everything that the transmitter reaches, not only sequences that
  // lead to the receivers.
  const bool whole =
      config_.candidates == ChannelConfig::Candidates::rays || plan.diffraction.on || plan.scattering.on;
  if (config_.search == ChannelConfig::Search::every_tick || (move_facets_ && whole))
    way_ = Way::every_tick;
  else if (ends.transmitter_rests)
    way_ = Way::once_from_transmitter;
  else if (ends.receivers_rest)
    way_ = Way::once_from_receivers;
  else if (config_.search == ChannelConfig::Search::once)
    throw_user_error_at(config_.where,
                        "channel '{}': search: expected auto or every_tick, since both ends move; found once",
                        config_.name);
  else
    way_ = whole ? Way::every_tick : Way::between_ends;
}

void ChannelSearch::make_beams() {
  rf::BeamSearchOptions options;
  options.max_depth = config_.limits.max_depth;
  options.max_transmissions = walls_;
  if (way_ == Way::every_tick) {
    options.moving_bodies = move_facets_;
    options.source_body = transmitter_body_;
  }
  // The last two reflections are cheaper to find backwards from known receivers than forwards for any
  // receiver.
  if (way_ == Way::between_ends) options.stop_depth = std::max(config_.limits.max_depth, 2u) - 2;
  beams_.emplace(model_.facets, model_.kinds, model_.wedges, options);
  moving_searches_.clear();
  if (way_ == Way::between_ends || (once() && move_facets_))
    moving_searches_.emplace_back(model_.facets, model_.kinds, moving_options(config_, walls_, move_facets_));
}

/// One search from the transmitter serves all points, of which there may be thousands.
void ChannelSearch::set_points() {
  if (rays_ && way_ == Way::once_from_receivers) way_ = Way::every_tick;
  if (!beams_ || way_ == Way::every_tick || (way_ == Way::once_from_transmitter && !move_facets_)) return;
  way_ = Way::every_tick;
  make_beams();
}

void ChannelSearch::record_ahead(gpu::TickSlot& slot, const dvec3& transmitter) {
  searching_ = rays_->record(slot, transmitter);
}

void ChannelSearch::grow_solvers(size_t count) {
  rf::PathLimits limits = config_.limits;
  limits.max_transmissions = config_.walls();
  const bool reflect = move_facets_ && way_ == Way::every_tick;
  while (fixed_.size() < count) fixed_.emplace_back(model_, limits, reflect);
  left_out_.resize(fixed_.size());
  while (!moving_searches_.empty() && moving_searches_.size() < count)
    moving_searches_.push_back(moving_searches_[0]);
  if (once() && move_facets_ && beams_)
    while (moving_.size() < count) moving_.emplace_back(model_, limits, true);
}

void ChannelSearch::start(const dvec3& transmitter, std::span<const dvec3> receivers,
                          std::span<const Pose> bodies) {
  searching_.reset();
  renewed_tick_ = -1;
  seams_.reset();
  if (once() && !fixed_.empty()) return;
  fixed_.clear();
  moving_.clear();
  const bool from_receivers = way_ == Way::once_from_receivers;
  grow_solvers(from_receivers ? receivers.size() : 1);
  if (from_receivers)
    for (size_t r = 0; r < receivers.size(); ++r) search_from(r, receivers[r], bodies, rf::Source::receiver);
  else if (!beams_ || way_ == Way::once_from_transmitter)  // otherwise renew() searches
    search_from(0, transmitter, bodies, rf::Source::transmitter);
}

void ChannelSearch::search_from(size_t index, const dvec3& source, std::span<const Pose> bodies,
                                rf::Source end) {
  if (rays_) {
    rf::CandidateSearchResult result = rays_->search(bodies, source);
    const rf::LeftOut left_out{result.overflow()};
    return take(index, std::move(result.list), left_out, source, end);
  }
  if (!beams_) return take(index, {}, {}, source, end);
  rf::BeamSearchResult result = beams(source);
  if (once() && move_facets_) moving_searches_[index].set_tree(result, source);
  const rf::LeftOut left_out{result.overflow(), result.complete_depth()};
  take(index, std::move(result.list), left_out, source, end);
}

rf::BeamSearchResult ChannelSearch::beams(const dvec3& source) {
  // Results for moving bodies are not worth caching: the next run has other poses.
  if (!once()) return beams_->search(source);
  const rf::SearchCache cache = rf::SearchCache::standard();
  const std::string key =
      rf::search_key(model_.facets, model_.kinds, model_.wedges, source, beams_->options());
  const rf::SearchExtent extent{model_.facets.facet_count(), static_cast<uint32_t>(model_.wedges.size())};
  if (auto known = cache.load(key, extent)) {
    ++cache_hits_;
    return std::move(*known);
  }
  if (model_.scene->facets.size() > 1000)
    spdlog::info("channel '{}': searching {} facets to depth {}{}", config_.name, model_.scene->facets.size(),
                 config_.limits.max_depth, cache.folder().empty() ? "" : "; kept for the next run");
  rf::BeamSearchResult result = beams_->search(source);
  cache.store(key, result);
  return result;
}

/// Turns a list of candidates into images of the source, and counts what the search left out.
void ChannelSearch::take(size_t index, rf::CandidateList list, const rf::LeftOut& left_out,
                         const dvec3& source, rf::Source end) {
  if (left_out.sequences > 0 && overflow_ == 0)
    spdlog::warn("channel '{}': {} candidates beyond the bound were left out; more in the counters",
                 config_.name, left_out.sequences);
  overflow_ += left_out.sequences;
  left_out_[index] = left_out;
  if (list.size() == 0 || !list.sequence(0).empty()) {  // the list from rays lacks the line of sight
    list.add({});
    list.make_canonical();
  }
  fixed_count_ = std::max<uint64_t>(fixed_count_, list.size());
  candidates_ = std::max(candidates_, fixed_count_);
  fixed_[index].set_candidates(list, source, end);
}

void ChannelSearch::renew(int64_t tick, const dvec3& transmitter, std::span<const dvec3> receivers) {
  if (!moving_searches_.empty()) seams_.emplace(moving_searches_[0].seams());
  if (way_ == Way::between_ends) return renew_between(transmitter, receivers);
  if (once()) return renew_moving(transmitter, receivers);
  if (way_ == Way::every_tick && beams_) {
    if (tick == renewed_tick_) return;  // further points at the same tick
    renewed_tick_ = tick;
    search_from(0, transmitter, {}, rf::Source::transmitter);
  } else if (searching_) {
    rf::CandidateSearchResult result = rays_->collect(*searching_);
    const rf::LeftOut left_out{result.overflow()};
    take(0, std::move(result.list), left_out, transmitter, rf::Source::transmitter);
    searching_.reset();
  } else {
    fixed_[0].move_source(transmitter);
  }
}

void ChannelSearch::renew_between(const dvec3& transmitter, std::span<const dvec3> receivers) {
  const rf::BeamSearchResult tree = beams(transmitter);
  moving_searches_[0].set_tree(tree, transmitter);
  take(0, moving_searches_[0].all(receivers), {tree.overflow(), tree.complete_depth()}, transmitter,
       rf::Source::transmitter);
}

void ChannelSearch::renew_moving(const dvec3& transmitter, std::span<const dvec3> receivers) {
  for (size_t s = 0; s < moving_.size(); ++s) {
    const bool outwards = way_ == Way::once_from_transmitter;
    const rf::CandidateList list =
        moving_searches_[s].moving(outwards ? receivers : std::span(&transmitter, 1));
    candidates_ = std::max<uint64_t>(candidates_, fixed_count_ + list.size());
    moving_[s].set_candidates(list, outwards ? transmitter : receivers[s],
                              outwards ? rf::Source::transmitter : rf::Source::receiver);
  }
}

rf::LinkGeometry ChannelSearch::geometry(size_t index, const rf::EndState& transmitter,
                                         const rf::EndState& receiver) const {
  const bool from_receivers = way_ == Way::once_from_receivers;
  const size_t source = from_receivers ? index : 0;
  const rf::EndState& target = from_receivers ? transmitter : receiver;
  rf::LinkGeometry link = fixed_[source].geometry(target);
  link.searched.add(left_out_[source]);
  if (way_ == Way::between_ends) seams_->drop_behind(link.paths, rf::Source::transmitter, transmitter.body);
  if (moving_.empty()) return link;
  rf::LinkGeometry more = moving_[source].geometry(target);
  seams_->drop_behind(more.paths, from_receivers ? rf::Source::receiver : rf::Source::transmitter,
                      from_receivers ? receiver.body : transmitter.body);
  link.overflow += more.overflow;
  link.searched.add(more.searched);
  link.paths.insert(link.paths.end(), std::make_move_iterator(more.paths.begin()),
                    std::make_move_iterator(more.paths.end()));
  rf::keep_distinct(link.paths);
  rf::keep_most(link, fixed_[source].limits().max_paths);
  return link;
}

void ChannelSearch::count(std::map<std::string, uint64_t>& counters) const {
  counters["candidates"] = candidates_;
  counters["candidate_overflow"] = overflow_;
  counters["candidates_from_cache"] = cache_hits_;
}

std::vector<std::pair<std::string, std::string>> ChannelSearch::notes(const rf::LeftOut& left_out) const {
  constexpr const char* ways[] = {"none", "once, from the transmitter", "once, from each receiver",
                                  "every tick, from both ends", "every tick, from the transmitter"};
  std::vector<std::pair<std::string, std::string>> notes;
  const bool reuse = once() && !moving_searches_.empty();
  notes.emplace_back("search", std::string(ways[static_cast<uint32_t>(way_)]) +
                                   (reuse ? "; every tick for what moves" : ""));
  if (beams_ && way_ != Way::between_ends)
    notes.emplace_back("guarantee", beams_->guarantee(left_out.sequences, left_out.complete_depth));
  if (!moving_searches_.empty())
    notes.emplace_back(
        reuse ? "guarantee_moving" : "guarantee",
        moving_searches_[0].guarantee(way_ == Way::between_ends) +
            (left_out.sequences > 0
                 ? fmt::format("; {} at least are left out of the beams', beyond the {} that a search keeps",
                               left_out.sequences, rf::BeamSearchOptions{}.capacity)
                 : std::string()));
  if (beams_ && move_facets_ && way_ == Way::every_tick &&
      config_.search != ChannelConfig::Search::every_tick)
    notes.emplace_back("reuse",
                       "none: diffraction, scattering or a list of points with moving reflectors; the whole "
                       "search runs at every tick");
  if (way_ != Way::none && !beams_)
    notes.emplace_back(
        "guarantee",
        fmt::format(
            "{} rays: a sequence whose beam is narrower than their spacing, {:.2g} mrad, may be missed{}",
            config_.rays, 1e3 * std::sqrt(4.0 * pi / config_.rays),
            left_out.sequences > 0
                ? fmt::format("; {} that were met are left out, beyond the bounds", left_out.sequences)
                : std::string()));
  return notes;
}

}  // namespace greatx::sim
