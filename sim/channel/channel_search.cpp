// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/channel/channel_search.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <spdlog/spdlog.h>

#include "core/built_effects.h"
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
                             const ChannelConfig& config, const ChannelEnds& ends, SharedSearches* shared)
    : model_(model),
      config_(config),
      shared_(shared),
      move_facets_(plan.moving_reflectors.on),
      walls_(plan.transmission.on ? config.walls() : 0),
      transmitter_{.body = ends.transmitter.body, .kept = ends.transmitter.rests} {
  choose(plan, ends);
  list_sources(ends);
  if (way_ == Way::none) return;
  if (config_.candidates != ChannelConfig::Candidates::rays)
    make_beams();
  else if (gpu_scene != nullptr)
    rays_.emplace(*gpu_scene, ray_options(config_, walls_, move_facets_), model_.kinds);
}

void ChannelSearch::choose(const EffectPlan& plan, const ChannelEnds& ends) {
  const bool bounces = plan.reflection.on || plan.diffraction.on || plan.scattering.on;
  if (!all_effects_built || !bounces || config_.limits.max_depth == 0) return;
  // Scattering and rays need everything that the transmitter reaches, not only sequences that lead to the
  // receivers.
  const bool whole = config_.candidates == ChannelConfig::Candidates::rays || plan.scattering.on;
  const bool receivers_rest = std::ranges::all_of(ends.receivers, &ChannelEnd::rests);
  if (config_.search == ChannelConfig::Search::every_tick || (move_facets_ && whole)) {
    way_ = Way::every_tick;
    transmitter_.kept = false;
  } else if (plan.diffraction.on && move_facets_)
    way_ = Way::between_ends;  // bodies that move change the ways to edges from either end
  else if (ends.transmitter.rests)
    way_ = Way::once_from_transmitter;
  else if (receivers_rest)
    way_ = Way::once_from_receivers;
  else if (config_.search == ChannelConfig::Search::once)
    throw_user_error_at(config_.where,
                        "channel '{}': search: expected auto or every_tick, since both ends move; found once",
                        config_.name);
  else
    way_ = whole ? Way::every_tick : Way::between_ends;
  if (way_ == Way::between_ends && plan.diffraction.on) {
    // The paths are the same from both ends, but their fields are not.
    for (const ChannelEnd& receiver : ends.receivers)
      fields_from_receiver_.push_back(searched_from(ends.transmitter, receiver) == rf::Source::receiver);
    return;
  }
  // Other paths would be found from the other end, and their fields would be others.
  if (plan.diffraction.on || plan.scattering.on) choose_by_link(ends);
}

/// Replaces the way if a link is to be searched from another end than the way does.
void ChannelSearch::choose_by_link(const ChannelEnds& ends) {
  const rf::Source end = way_ == Way::once_from_receivers ? rf::Source::receiver : rf::Source::transmitter;
  for (const ChannelEnd& receiver : ends.receivers)
    if (searched_from(ends.transmitter, receiver) != end) way_ = Way::by_link;
}

void ChannelSearch::list_sources(const ChannelEnds& ends) {
  const bool every_tick = config_.search == ChannelConfig::Search::every_tick || move_facets_;
  const auto add_receiver = [&](size_t r, bool kept) {
    source_of_.push_back(sources_.size());
    sources_.push_back({rf::Source::receiver, r, ends.receivers[r].body, kept});
  };
  sources_.clear();
  source_of_.clear();
  if (way_ == Way::once_from_receivers) {
    for (size_t r = 0; r < ends.receivers.size(); ++r) add_receiver(r, true);
  } else if (way_ == Way::by_link) {
    std::optional<size_t> transmitter;
    for (size_t r = 0; r < ends.receivers.size(); ++r) {
      if (searched_from(ends.transmitter, ends.receivers[r]) == rf::Source::receiver) {
        add_receiver(r, ends.receivers[r].rests && !every_tick);
        continue;
      }
      if (!transmitter) {
        transmitter = sources_.size();
        sources_.push_back(transmitter_);
      }
      source_of_.push_back(*transmitter);
    }
  } else {
    sources_.push_back(transmitter_);
    sources_[0].kept = way_ == Way::once_from_transmitter;
  }
}

void ChannelSearch::make_beams() {
  rf::BeamSearchOptions options;
  options.max_depth = config_.limits.max_depth;
  options.max_transmissions = walls_;
  if (way_ == Way::every_tick || way_ == Way::by_link) options.moving_bodies = move_facets_;
  if (way_ == Way::every_tick) options.source_body = transmitter_.body;
  // The last two reflections are cheaper to find backwards from known receivers than forwards for any
  // receiver.
  if (way_ == Way::between_ends) options.stop_depth = std::max(config_.limits.max_depth, 2u) - 2;
  beams_.emplace(model_.facets, model_.kinds, model_.wedges, options);
  moving_searches_.clear();
  if (way_ == Way::between_ends || (once() && move_facets_))
    moving_searches_.emplace_back(model_.facets, model_.kinds, moving_options(config_, walls_, move_facets_),
                                  shared_ ? shared_->fixed_facets() : nullptr);
}

/// One search from the transmitter serves all points, of which there may be thousands.
void ChannelSearch::set_points() {
  points_ = true;
  fields_from_receiver_.clear();
  const bool kept = transmitter_.kept && !(beams_ && move_facets_);
  const bool others = way_ == Way::once_from_receivers || way_ == Way::by_link;
  if (!others && (!beams_ || way_ == Way::every_tick || kept)) return;
  way_ = kept ? Way::once_from_transmitter : Way::every_tick;
  sources_ = {transmitter_};
  sources_[0].kept = kept;
  source_of_.clear();
  fixed_.clear();
  moving_.clear();
  if (beams_) make_beams();
}

bool ChannelSearch::looks_ahead() const {
  return rays_ && !std::ranges::all_of(sources_, &SearchSource::kept);
}

void ChannelSearch::record_ahead(gpu::TickSlot& slot, const dvec3& transmitter,
                                 std::span<const dvec3> receivers) {
  searching_.assign(sources_.size(), std::nullopt);
  for (size_t s = 0; s < sources_.size(); ++s) {
    const SearchSource& from = sources_[s];
    if (from.kept) continue;
    searching_[s] = rays_->record(slot, position_of(from, transmitter, receivers));
  }
}

void ChannelSearch::grow_solvers(size_t count) {
  rf::PathLimits limits = config_.limits;
  limits.max_transmissions = config_.walls();
  const bool reflect = move_facets_ && !once();
  const auto edges = shared_ && model_.effects.diffraction ? shared_->edges(limits, reflect) : nullptr;
  while (fixed_.size() < count) fixed_.emplace_back(model_, limits, reflect, edges);
  left_out_.resize(fixed_.size());
  while (!moving_searches_.empty() && moving_searches_.size() < count)
    moving_searches_.push_back(moving_searches_[0]);
  if (once() && move_facets_ && beams_)
    while (moving_.size() < count) moving_.emplace_back(model_, limits, true);
}

void ChannelSearch::start(const dvec3& transmitter, std::span<const dvec3> receivers,
                          std::span<const Pose> bodies) {
  searching_.clear();
  renewed_tick_ = -1;
  seams_.reset();
  const bool again = !fixed_.empty();
  grow_solvers(sources_.size());
  for (size_t s = 0; s < sources_.size(); ++s) {
    const bool kept = sources_[s].kept;
    if (kept ? !again : !beams_)  // otherwise it is known, or renew() searches
      search_from(s, position_of(sources_[s], transmitter, receivers), bodies);
  }
}

void ChannelSearch::search_from(size_t index, const dvec3& source, std::span<const Pose> bodies) {
  if (rays_) {
    rf::CandidateSearchResult result = rays_->search(bodies, source);
    const rf::LeftOut left_out{result.overflow()};
    return take(index, std::move(result.list), left_out, source);
  }
  if (!beams_) return take(index, {}, {}, source);
  rf::BeamSearchResult result = beams(sources_[index], source);
  if (once() && move_facets_) moving_searches_[index].set_tree(result, source);
  const rf::LeftOut left_out{result.overflow(), result.complete_depth()};
  take(index, std::move(result.list), left_out, source);
}

rf::BeamSearchResult ChannelSearch::beams(const SearchSource& from, const dvec3& source) {
  // Results for moving bodies are not worth caching: the next run has other poses.
  if (!from.kept) {
    rf::BeamSearchOptions options = beams_->options();
    if (!options.moving_bodies || options.source_body == from.body) return beams_->search(source);
    options.source_body = from.body;
    return rf::BeamSearch(model_.facets, model_.kinds, model_.wedges, options).search(source);
  }
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
                         const dvec3& source) {
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
  fixed_[index].set_candidates(list, source, sources_[index].end);
}

void ChannelSearch::renew(int64_t tick, const dvec3& transmitter, std::span<const dvec3> receivers,
                          std::span<const Pose> bodies) {
  if (fixed_.empty()) start(transmitter, receivers, bodies);  // set_points() has changed the sources
  if constexpr (!all_effects_built) return fixed_[0].move_source(transmitter);
  if (!moving_searches_.empty()) seams_.emplace(moving_searches_[0].seams());
  if (way_ == Way::between_ends) return renew_between(transmitter, receivers);
  if (once()) return renew_moving(transmitter, receivers);
  if (beams_ && tick == renewed_tick_) return;  // further points at the same tick
  renewed_tick_ = tick;
  for (size_t s = 0; s < sources_.size(); ++s)
    if (!sources_[s].kept) renew_source(s, position_of(sources_[s], transmitter, receivers));
  searching_.clear();
}

void ChannelSearch::renew_source(size_t index, const dvec3& source) {
  if (beams_) return search_from(index, source, {});
  if (searching_.empty()) return fixed_[index].move_source(source);
  rf::CandidateSearchResult result = rays_->collect(*searching_[index]);
  const rf::LeftOut left_out{result.overflow()};
  take(index, std::move(result.list), left_out, source);
}

void ChannelSearch::renew_between(const dvec3& transmitter, std::span<const dvec3> receivers) {
  const rf::BeamSearchResult tree = beams(sources_[0], transmitter);
  moving_searches_[0].set_tree(tree, transmitter);
  take(0, moving_searches_[0].all(receivers), {tree.overflow(), tree.complete_depth()}, transmitter);
  if (model_.effects.diffraction) fixed_[0].find_edge_ways(transmitter_.body, 0);
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
                                         const rf::EndState& receiver, uint32_t threads) const {
  if constexpr (!all_effects_built) return fixed_[0].geometry(receiver, threads);
  const size_t source = source_of(index);
  const rf::Source end = sources_[source].end;
  const bool from_receiver = end == rf::Source::receiver;
  const rf::EndState& target = from_receiver ? transmitter : receiver;
  rf::LinkGeometry link = fixed_[source].geometry(target, threads, !points_);
  link.searched.add(left_out_[source]);
  if (way_ == Way::between_ends) {
    seams_->drop_behind(link.paths, rf::Source::transmitter, transmitter.body);
    // Both ends are searched from, and one of them computes the fields of paths over edges.
    if (!fields_from_receiver_.empty())
      for (rf::GeometricPath& path : link.paths)
        if (std::ranges::find(path.interactions, rf::InteractionType::diffraction, &rf::Interaction::type) !=
            path.interactions.end())
          path.from_receiver = fields_from_receiver_[index];
  }
  if (moving_.empty()) return link;
  rf::LinkGeometry more = moving_[source].geometry(target, threads);
  seams_->drop_behind(more.paths, end, from_receiver ? receiver.body : transmitter.body);
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

const char* ChannelSearch::by_link_times() const {
  if (way_ != Way::by_link) return "";
  if (std::ranges::all_of(sources_, &SearchSource::kept)) return "; once";
  return std::ranges::any_of(sources_, &SearchSource::kept) ? "; once if it rests, else every tick"
                                                            : "; every tick";
}

/// Says which paths with a scattering and another bend are drawn.
void ChannelSearch::note_two_bends(std::vector<std::pair<std::string, std::string>>& notes) const {
  const bool pairs = config_.limits.max_scatterings > 1,
             edges = config_.limits.scattering_beside_diffraction && model_.effects.diffraction;
  if (!pairs && !edges) return;
  const char* which = !edges   ? "two patches"
                      : !pairs ? "an edge and a patch, in either order"
                               : "two patches, or an edge and a patch in either order";
  notes.emplace_back("scattering_twice",
                     fmt::format("paths over {} are drawn: the expected power is that of all, and the "
                                 "deviation of the gain tells how far one draw is from it",
                                 which));
}

std::vector<std::pair<std::string, std::string>> ChannelSearch::notes(const rf::LeftOut& left_out) const {
  constexpr const char* ways[] = {"none",
                                  "once, from the transmitter",
                                  "once, from each receiver",
                                  "every tick, from both ends",
                                  "every tick, from the transmitter",
                                  "from one end of each link, the same in both directions"};
  std::vector<std::pair<std::string, std::string>> notes;
  const bool reuse = once() && !moving_searches_.empty();
  notes.emplace_back("search", std::string(ways[static_cast<uint32_t>(way_)]) +
                                   (reuse ? "; every tick for what moves" : by_link_times()));
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
  if (beams_ && model_.effects.diffraction)
    notes.emplace_back(
        "guarantee_edges",
        fmt::format("no path over one edge{} is left out that has up to {} reflections on each "
                    "side and up to {} interactions, and is {:g} mm clear of other edges{}",
                    config_.limits.max_diffractions > 1
                        ? fmt::format(", or over two if it may be stronger than {:g} dB below free space,",
                                      config_.limits.two_edge_floor_db)
                        : "",
                    config_.limits.max_reflections_beside_diffraction,
                    std::min(config_.limits.max_depth, left_out.complete_depth),
                    1e3 * rf::BeamSearchOptions{}.clearance_m,
                    model_.effects.corner_diffraction
                        ? fmt::format("; a field that ends with its edge steps by less than {:g} dB",
                                      config_.limits.corner_step_db)
                        : ""));
  if (const uint32_t budget = config_.limits.scattering_budget; model_.effects.scattering && budget > 0)
    notes.emplace_back(
        "scattering",
        fmt::format("of more than {} scatterings of a link, {} at most are traced: one is drawn "
                    "for each stratum of delay and place, with the stratum's power "
                    "(scattering_budget; 0 traces all)",
                    budget, budget));
  if (model_.effects.scattering) note_two_bends(notes);
  if (beams_ && move_facets_ && (way_ == Way::every_tick || way_ == Way::by_link) &&
      config_.search != ChannelConfig::Search::every_tick)
    notes.emplace_back("reuse",
                       "none: scattering or a list of points with moving reflectors; the whole "
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
