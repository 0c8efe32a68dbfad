// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/radar/echoes/echo_finder.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/error.h"
#include "core/parallel.h"
#include "core/same_pose.h"
#include "core/units.h"
#include "rf/atmosphere/path_attenuation.h"
#include "rf/radar/echoes/echo_merge.h"
#include "rf/radar/echoes/echo_tracks.h"
#include "rf/radar/echoes/facet_echoes.h"
#include "rf/radar/echoes/rain_patches.h"
#include "rf/radar/echoes/tube_echoes.h"
#include "scene/material/lossless.h"

namespace greatx::rf {
namespace {

constexpr double track_error = 1e-3;  ///< fraction of a wavelength
constexpr double rate_step_s = 1e-6;  ///< time step for rates
constexpr size_t echo_chunk = 256;

void check(const EchoOptions& o) {
  if (o.max_bounces < 1 || o.max_bounces > most_bounces)
    throw_user_error("radar bounces: expected 1 to {}, found {}", most_bounces, o.max_bounces);
  if (o.tubes < 1) throw_user_error("radar tubes: expected 1 at least, found {}", o.tubes);
  if (!(o.air_db_per_km >= 0.0))
    throw_user_error("radar air: expected 0 dB/km or more, found {}", o.air_db_per_km);
  if (!(o.antenna_radius_m >= 0.0))
    throw_user_error("radar antenna: expected a radius of 0 m or more, found {}", o.antenna_radius_m);
  if (!(o.border_floor_m2 >= 0.0))
    throw_user_error("radar floor: expected a cross-section of 0 m^2 or more, found {}", o.border_floor_m2);
  if (!(o.hidden_floor_m2 >= 0.0))
    throw_user_error("radar floor: expected a hidden cross-section of 0 m^2 or more, found {}",
                     o.hidden_floor_m2);
  if (!(o.merge_share >= 0.0 && o.bandwidth_hz > 0.0 && o.beam_rad > 0.0))
    throw_user_error(
        "radar merging: expected a share >= 0, a bandwidth and a beam > 0, found {}, {} Hz, {} rad",
        o.merge_share, o.bandwidth_hz, o.beam_rad);
  if (!(o.diffuse_patch_m >= 0.0))
    throw_user_error("radar patches: expected 0 m or more, found {}", o.diffuse_patch_m);
}

TurnedElement turned(const EchoEnd& end, const Pose& pose) {
  return {end.pattern, std::span(&end.slant, 1), pose.orientation};
}

/// Provides the data of the raw echoes for merging and tracking: their instances, their vertices and the
/// rates of their path lengths.
class Movers {
 public:
  Movers(const scene::Scene& scene, const FacetWorld& world, const RawEchoes& raw, const EchoMotion& motion,
         const dvec3& transmitter, uint32_t threads)
      : scene_(scene),
        world_(world),
        raw_(raw),
        motion_(motion),
        transmitter_(transmitter),
        threads_(threads),
        asked_(std::make_unique<bool[]>(scene.bodies.size())) {
    for (const uint32_t facet : raw.chains)
      if (world.facet(facet).body != 0) asked_[world.facet(facet).body] = true;
  }

  std::vector<uint32_t> instances() const {
    std::vector<uint32_t> all;
    for (const RawEcho& echo : raw_.echoes)
      all.push_back(echo.bounces == 0 ? 0 : scene_.facets[raw_.chain(echo).back()].instance + 1);
    return all;
  }
  CarriedPath vertices(const RawEcho& echo) const {
    return carried_vertices(world_, transmitter_, echo.departure, raw_.chain(echo), echo.point);
  }
  /// Returns the poses of all bodies that echoes have met.
  PoseTable poses(std::vector<double> times) const {
    return PoseTable(motion_, std::span(asked_.get(), scene_.bodies.size()), std::move(times), threads_);
  }
  /// Returns the poses of the bodies that some echoes have met, given by their indices.
  PoseTable poses_of(std::span<const uint32_t> echoes, std::vector<double> times) const {
    const auto met = std::make_unique<bool[]>(scene_.bodies.size());
    for (const uint32_t echo : echoes)
      for (const uint32_t facet : raw_.chain(raw_.echoes[echo])) met[world_.facet(facet).body] = true;
    return PoseTable(motion_, std::span(met.get(), scene_.bodies.size()), std::move(times), threads_);
  }
  /// Returns the rates of path length in the middle of the frame, m/s.
  std::vector<double> rates() const {
    std::vector<double> rates(raw_.echoes.size(), 0.0);
    if (motion_.frame_s() == 0.0) return rates;
    const double middle = motion_.slot_start_s.front() + 0.5 * motion_.frame_s();
    const PoseTable table = poses({middle - 0.5 * rate_step_s, middle + 0.5 * rate_step_s});
    if (!moves(table)) return rates;
    parallel_for((rates.size() + echo_chunk - 1) / echo_chunk, threads_, [&](size_t part) {
      for (size_t i = part * echo_chunk; i < std::min(rates.size(), (part + 1) * echo_chunk); ++i) {
        const CarriedPath path = vertices(raw_.echoes[i]);
        rates[i] = (table.length(path, 1) - table.length(path, 0)) / rate_step_s;
      }
    });
    return rates;
  }

 private:
  bool moves(const PoseTable& table) const {
    if (table.transmitter(0) != table.transmitter(1) || table.receiver(0) != table.receiver(1)) return true;
    for (uint32_t body = 1; body < scene_.bodies.size(); ++body) {
      if (!asked_[body]) continue;
      const Pose &a = table.body(body, 0), &b = table.body(body, 1);
      if (a.position != b.position || a.orientation != b.orientation) return true;
    }
    return false;
  }

  const scene::Scene& scene_;
  const FacetWorld& world_;
  const RawEchoes& raw_;
  const EchoMotion& motion_;
  dvec3 transmitter_;
  uint32_t threads_;
  std::unique_ptr<bool[]> asked_;  ///< [bodies]
};

void keep_strongest(std::vector<MergedEcho>& merged, uint32_t most, EchoStatistics& statistics) {
  if (merged.size() <= most) return;
  std::vector<uint32_t> order(merged.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
    const double x = std::norm(merged[a].amplitude), y = std::norm(merged[b].amplitude);
    return x != y ? x > y : a < b;
  });
  statistics.left_out = order.size() - most;
  for (size_t i = most; i < order.size(); ++i)
    statistics.left_out_power += std::norm(merged[order[i]].amplitude);
  order.resize(most);
  std::sort(order.begin(), order.end());
  std::vector<MergedEcho> kept;
  for (const uint32_t i : order) kept.push_back(merged[i]);
  merged.swap(kept);
}

/// Adds scatterers that turn too fast for a patch as echoes of the surfaces on their ways.
void add_fast(std::span<const Scatterer> fast, const FacetWorld& world, const dvec3& source,
              const dvec3& receiver, RawEchoes& raw) {
  using Way = Scatterer::Over;
  for (const Scatterer& one : fast) {
    const dvec3 out = one.point - source, home = one.point - receiver;
    RawEcho echo{one.amplitude,
                 glm::normalize(out),
                 glm::normalize(home),
                 one.point,
                 glm::length(out) + glm::length(home),
                 static_cast<uint32_t>(raw.chains.size()),
                 1};
    if (one.over == Way::both || one.over == Way::out) {
      echo.departure = mirrored_direction(world.facet(one.mirror), source, one.point);
      echo.length_m += glm::distance(one.point, mirrored(world.facet(one.mirror), source)) - glm::length(out);
      raw.chains.push_back(one.mirror);
    }
    raw.chains.push_back(one.facet);
    if (one.over == Way::both || one.over == Way::home) {
      const PosedFacet& mirror = world.facet(one.mirror);
      echo.arrival = mirrored_direction(mirror, receiver, one.point);
      echo.length_m += glm::distance(one.point, mirrored(mirror, receiver)) - glm::length(home);
      echo.point =
          receiver - mirror.distance(receiver) / glm::dot(mirror.normal, echo.arrival) * echo.arrival;
      raw.chains.push_back(one.mirror);
    }
    echo.bounces = static_cast<uint32_t>(raw.chains.size()) - echo.first_facet;
    raw.echoes.push_back(echo);
  }
}

Echo echo_of(const MergedEcho& merged, const RawEcho& raw, const RawEchoes& all, const scene::Scene& scene,
             const EchoOptions& options) {
  Echo echo;
  echo.amplitude = merged.amplitude * amplitude(options.air_db_per_km, raw.length_m);
  echo.departure = raw.departure;
  echo.arrival = raw.arrival;
  echo.point = raw.point;
  echo.bounces = raw.bounces;
  if (raw.bounces > 0) {
    const scene::Facet& facet = scene.facets[all.chain(raw).back()];
    echo.instance = facet.instance + 1;
    echo.material = facet.material + 1;
  }
  return echo;
}

/// Adds the delays of all echoes. Each echo that no cubic follows gets a table; the tables are in the order
/// of the echoes.
void add_tracks(const Movers& movers, const RawEchoes& raw, std::span<const MergedEcho> merged,
                const EchoMotion& motion, double wavelength_m, uint32_t threads, EchoList& list) {
  const PoseTable poses = movers.poses(track_times(motion));
  std::vector<uint8_t> fits(list.echoes.size());
  const size_t chunks = (list.echoes.size() + echo_chunk - 1) / echo_chunk;
  parallel_for(chunks, threads, [&](size_t part) {
    for (size_t i = part * echo_chunk; i < std::min(list.echoes.size(), (part + 1) * echo_chunk); ++i)
      fits[i] = fit_track(poses, movers.vertices(raw.echoes[merged[i].strongest]), track_error * wavelength_m,
                          list.echoes[i].delay);
  });
  std::vector<uint32_t> wild;
  for (uint32_t i = 0; i < fits.size(); ++i)
    if (!fits[i]) wild.push_back(i);
  if (wild.empty()) return;
  std::vector<double> times = motion.slot_start_s;
  for (const double start : motion.slot_start_s) times.push_back(start + rate_step_s);
  std::vector<uint32_t> strongest;
  for (const uint32_t i : wild) strongest.push_back(merged[i].strongest);
  const PoseTable at_slots = movers.poses_of(strongest, std::move(times));
  list.tables.resize(wild.size() * motion.slot_start_s.size());
  parallel_for(wild.size(), threads, [&](size_t row) {
    const auto table = track_table(at_slots, movers.vertices(raw.echoes[strongest[row]]), rate_step_s);
    std::copy(table.begin(), table.end(), list.tables.begin() + row * table.size());
    DelayTrack& track = list.echoes[wild[row]].delay;
    track.coefficients = {table[table.size() / 2][0], table[table.size() / 2][1], 0.0, 0.0};
    track.mid_s = motion.slot_start_s[table.size() / 2];
    track.table = static_cast<int32_t>(row);
  });
}

}  // namespace

EchoFinder::EchoFinder(scene::GpuScene& scene, const RadioSurfaces& surfaces, const EchoEnd& transmitter,
                       const std::optional<EchoEnd>& receiver, const EchoOptions& options,
                       const scene::EdgeSurvey* survey)
    : scene_(&scene),
      surfaces_(surfaces),
      transmitter_(transmitter),
      receiver_(receiver.value_or(transmitter)),
      monostatic_(!receiver.has_value()),
      options_((check(options), options)),
      world_(scene.scene()),
      trees_(scene.scene()),
      tracer_(scene.scene(), trees_,
              [&world = scene.scene()](uint32_t facet) {
                return !scene::is_lossless(world.materials[world.facets[facet].material]);
              }),
      memory_(std::make_unique<BeamMemory>(scene.scene().facets.size())),
      traced_(options.max_bounces + (monostatic_ && options.max_bounces >= mirror_bounces ? 1 : 0)) {
  const bool on_host = traces_on_host(scene.device(), options);
  const bool over_mirrors = traced_ > options.max_bounces;
  if (!on_host) pass_.emplace(scene, traced_, monostatic_, transmitter.own_body != 0);
  if (over_mirrors) mirrors_.emplace(scene.scene(), world_, surfaces_);
  if (options_.edges) edges_.emplace(scene.scene(), survey);
  if (options_.transmission) {
    veils_.emplace(scene.scene(), trees_, world_, surfaces_);
    if (veils_->none()) veils_.reset();
  }
  if (options_.diffuse)
    clutter_.emplace(scene.scene(), surfaces_, options_, transmitter_, monostatic_ ? nullptr : &receiver_);
}

bool EchoFinder::traces_on_host(const gpu::Device& device, const EchoOptions& options) {
  return options.tracing == EchoTracing::host ||
         (options.tracing == EchoTracing::automatic && device.info().type == "cpu");
}

std::vector<TargetBox> EchoFinder::targets(std::span<const Pose> body_poses) const {
  const scene::Scene& scene = scene_->scene();
  std::vector<TargetBox> boxes;
  for (const uint32_t i : options_.targets)
    if (scene.instances[i].body == 0) boxes.push_back({scene.instances[i].bounds, Pose{}, i, 0});
  std::vector<uint8_t> named(scene.bodies.size(), 0);
  for (const uint32_t i : options_.targets) named[scene.owner_of(scene.instances[i].body)] = 1;
  // The box of a body includes the parts that it carries.
  for (uint32_t body = 1; body < scene.bodies.size(); ++body)
    if (scene.owner_of(body) == body && body != transmitter_.own_body &&
        (options_.moving_targets || named[body] != 0))
      boxes.push_back({scene.reach_of(body), body_poses[body], 0, body});
  return boxes;
}

EchoFinder::Pending EchoFinder::record(gpu::TickSlot& slot, const Pose& transmitter, const Pose& receiver,
                                       std::span<const Pose> body_poses) {
  GREATX_CHECK(body_poses.size() == scene_->scene().bodies.size(), "{} poses of {} bodies", body_poses.size(),
               scene_->scene().bodies.size());
  GREATX_CHECK(!monostatic_ || transmitter.position == receiver.position, "a monostatic radar in two places");
  Pending pending;
  pending.transmitter = transmitter, pending.receiver = receiver;
  pending.body_poses.assign(body_poses.begin(), body_poses.end());
  if (!pass_) return pending;
  pose_world(body_poses);
  pending.grid = std::make_shared<const RayGrid>(grid_at(transmitter));
  std::vector<vec3> directions(pending.grid->size());
  for (uint32_t tube = 0; tube < directions.size(); ++tube) directions[tube] = vec3(pending.grid->axis(tube));
  pending.rays = pass_->record(slot, rays_of(pending), directions);
  return pending;
}

void EchoFinder::pose_world(std::span<const Pose> body_poses) {
  for (uint32_t body = 1; body < body_poses.size(); ++body) {
    const Pose &now = body_poses[body], &before = world_.motion(body).pose;
    if (same_pose(now, before)) continue;
    Motion motion;
    motion.pose = now;
    world_.move(body, motion);
  }
}

void EchoFinder::check_antenna(const dvec3& at, const RayGrid& grid, std::span<const uint32_t> hits) const {
  const scene::Scene& scene = scene_->scene();
  for (uint32_t tube = 0; tube < grid.size(); ++tube) {
    const uint32_t index = RayHits::facet(hits[tube]);
    if (index == VisibleCell::nothing) continue;
    const PosedFacet& facet = world_.facet(index);
    const double distance = std::abs(facet.distance(at));
    if (distance >= options_.antenna_radius_m) continue;  // no point of the plane is nearer
    const double reach = distance / std::abs(glm::dot(facet.normal, grid.axis(tube)));
    if (reach < options_.antenna_radius_m)
      throw_user_error("radar '{}': expected nothing within {} m of its antenna, found '{}' at {:.4f} m",
                       transmitter_.name, options_.antenna_radius_m,
                       scene.instances[scene.facets[index].instance].name, reach);
  }
}

/// Finds the echoes of the facets with beams that are seen through veils.
class EchoFinder::VeiledSearch {
 public:
  VeiledSearch(const EchoFinder& finder, const BeamedFacets& beamed, const RayGrid& grid,
               const EchoField& field, const dvec3& source)
      : scene_{finder.world_, finder.trees_, finder.veils_->sight(), &*finder.veils_},
        search_(scene_, grid, field, finder.options_, source, finder.monostatic_,
                finder.transmitter_.own_body, finder.receiver_.own_body) {
    const Veils::Ends ends{source, field.receiver_at(), finder.transmitter_.own_body,
                           finder.receiver_.own_body};
    behind_.facets = finder.veils_->behind(beamed.facets, ends, finder.options_.threads);
  }
  size_t parts() const { return FacetEchoes::parts(behind_); }
  void find(size_t part, RawEchoes& out) const { search_.find(behind_, part, out, nullptr); }

 private:
  FacetScene scene_;
  FacetEchoes search_;
  BeamedFacets behind_;
};

RawEchoes EchoFinder::raw_echoes(const Pending& pending, const RayGrid& grid, const RayHits& hits,
                                 const EchoField& field, EchoStatistics& statistics) const {
  const dvec3& source = pending.transmitter.position;
  const FacetScene scene{world_, trees_, tracer_, nullptr, clutter_ ? &*clutter_ : nullptr};
  const FacetEchoes small(scene, grid, field, options_, source, monostatic_, transmitter_.own_body,
                          receiver_.own_body);
  std::vector<MirroredFacet> images;
  if (mirrors_)
    images = mirrors_->find(targets(pending.body_poses), world_, trees_, tracer_, source,
                            transmitter_.own_body, options_.threads);
  const BeamedFacets beamed = small.choose(images);
  const TubeEchoes tubes(grid, hits, world_, trees_, field, scene_->scene(), source, monostatic_, options_,
                         clutter_ ? &*clutter_ : nullptr, beamed);
  std::optional<VeiledSearch> veiled;
  if (veils_) veiled.emplace(*this, beamed, grid, field, source);
  std::optional<EdgeEchoes::Search> edges;
  const EchoSender edge_sender(world_, trees_, field, options_, monostatic_);
  if (edges_)
    edges.emplace(*edges_, world_, tracer_, field, edge_sender,
                  EdgeEchoes::Ends{source, transmitter_.own_body, receiver_.own_body, monostatic_});

  // The four searches run side by side, the longest works first. The order of the echoes is another one.
  std::array<std::vector<RawEchoes>, 4> found;
  LoopsBeside loops;
  const auto add = [&](size_t search, size_t parts, const auto& find) {
    found[search].resize(parts);
    loops.add(parts, [&found, search, find](size_t part) { find(part, found[search][part]); });
  };
  add(1, FacetEchoes::parts(beamed),
      [&](size_t part, RawEchoes& out) { small.find(beamed, part, out, memory_.get()); });
  if (veiled) add(3, veiled->parts(), [&](size_t part, RawEchoes& out) { veiled->find(part, out); });
  add(0, tubes.parts(), [&](size_t part, RawEchoes& out) { tubes.find(part, out); });
  if (edges) add(2, edges->parts(), [&](size_t part, RawEchoes& out) { edges->find(part, out); });
  loops.run(options_.threads);

  statistics.tubes = grid.size();
  statistics.facets = static_cast<uint32_t>(beamed.facets.size());
  statistics.images = static_cast<uint32_t>(beamed.images.size());
  RawEchoes all;
  for (std::vector<RawEchoes>& parts : found) all.join(parts);
  statistics.remembered = all.remembered;
  return all;
}

std::complex<double> EchoFinder::direct(const Pending& pending, const EchoEnd& other, const Pose& pose) {
  pose_world(pending.body_poses);
  const dvec3 &from = pose.position, &to = pending.receiver.position;
  const EchoTracer::View view = tracer_.view(world_, receiver_.own_body, other.own_body);
  if (!tracer_.clear(view, from, to, ~0u)) return 0.0;
  const TurnedElement sender = turned(other, pose), receiver = turned(receiver_, pending.receiver);
  const EchoField field(world_, surfaces_, options_, sender, receiver, to);
  return field.direct(from) * amplitude(options_.air_db_per_km, glm::distance(from, to));
}

EchoList EchoFinder::collect(const Pending& pending, const EchoMotion& motion, EchoStatistics* statistics) {
  const scene::Scene& scene = scene_->scene();
  pose_world(pending.body_poses);
  const TurnedElement transmitter = turned(transmitter_, pending.transmitter);
  const TurnedElement receiver = turned(receiver_, pending.receiver);
  const EchoField field(world_, surfaces_, options_, transmitter, receiver, pending.receiver.position);
  const auto reflects = [&](uint32_t facet) { return field.reflects(facet); };
  const std::shared_ptr<const RayGrid> grid =
      pending.grid ? pending.grid : std::make_shared<const RayGrid>(grid_at(pending.transmitter));
  const dvec3& source = pending.transmitter.position;
  EchoTracer::Answer traced;
  const auto last = [&](uint32_t first, uint32_t second) {
    return traced_ > options_.max_bounces && mirrors(world_, first, second) ? traced_ : options_.max_bounces;
  };
  if (!pass_)
    traced = tracer_.trace(world_, rays_of(pending), *grid, traced_, monostatic_, reflects, last,
                           options_.threads);
  const std::span<const uint32_t> words = pass_ ? pass_->collect(pending.rays) : traced.words;
  const bool direct = pass_ ? pass_->direct(pending.rays) : traced.direct;
  check_antenna(source, *grid, words);
  RayHits hits(words, grid->size());
  if (monostatic_) hits.find_seen(*grid, world_, source, options_.max_bounces, options_.threads);
  EchoStatistics counted;
  memory_->begin(pending.transmitter, pending.receiver);
  RawEchoes raw = raw_echoes(pending, *grid, hits, field, counted);
  FoundPatches patches;
  if (clutter_) {
    const EchoTracer::View view = tracer_.view(world_, transmitter_.own_body);
    patches = clutter_->find(raw.rough, world_, {*grid, tracer_, view}, pending.transmitter, pending.receiver,
                             motion);
    add_fast(patches.fast, world_, source, pending.receiver.position, raw);
  }
  const dvec3 arm = pending.receiver.position - source;
  // Two elements at one place (with different polarizations) have no path between them.
  if (const double length = glm::length(arm); !monostatic_ && direct && length > 0.0) {
    raw.echoes.push_back({field.direct(source), arm / length, -arm / length, source, length, 0, 0});
  }

  counted.contributions = raw.echoes.size();
  counted.below_floor = raw.below_floor;
  counted.patch_blocks = patches.list.empty() ? 0 : patches.list.blocks;
  const Movers movers(scene, world_, raw, motion, source, options_.threads);
  MergeCells cells;
  cells.wavelength_m = surfaces_.wavelength_m();
  cells.length_m = options_.merge_share * speed_of_light / options_.bandwidth_hz;
  cells.rate_mps =
      motion.frame_s() > 0.0 ? options_.merge_share * cells.wavelength_m / motion.frame_s() : 0.0;
  cells.direction = options_.merge_share * options_.beam_rad;
  cells.compare_arrival = !monostatic_;
  std::vector<MergedEcho> merged = merge(raw, movers.rates(), movers.instances(), cells);
  counted.below_floor += std::erase_if(
      merged, [&](const MergedEcho& echo) { return std::norm(echo.amplitude) < options_.hidden_ratio; });
  keep_strongest(merged, options_.max_echoes, counted);

  EchoList list;
  list.first_slot = motion.first_slot;
  list.slots = static_cast<uint32_t>(motion.slot_start_s.size());
  for (const MergedEcho& echo : merged)
    list.echoes.push_back(echo_of(echo, raw.echoes[echo.strongest], raw, scene, options_));
  add_tracks(movers, raw, merged, motion, cells.wavelength_m, options_.threads, list);
  list.patches = std::move(patches.list);
  add_rain(
      {options_, transmitter, receiver, pending.transmitter, transmitter_.own_body, surfaces_.wavelength_m()},
      world_, tracer_, motion, list.patches);
  counted.patches = list.patches.size();
  if (statistics != nullptr) *statistics = counted;
  return list;
}

}  // namespace greatx::rf
