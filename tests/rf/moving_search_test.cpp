// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks the paths by moving bodies that are found from the tree of the world at rest: on the host against
// all possible sequences, and on the device against the whole search at every tick, with equal bytes of the
// paths.
#include "rf/search/moving_search.h"

#include <cstring>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/random.h"
#include "core/units.h"
#include "rf/geometry/geometry.h"
#include "rf/paths/path_solver.h"
#include "tests/rf/exhaustive.h"
#include "tests/rf/random_scene.h"
#include "tests/support/gpu_fixture.h"

namespace greatx::rf {
namespace {

using test::TinyScene;
using ::testing::Contains;
using ::testing::ElementsAre;
using testing::exhaustive_candidates;
using ::testing::IsEmpty;
using ::testing::IsSubsetOf;
using ::testing::Not;
using testing::solve_paths;

constexpr double carrier_hz = 3.5e9;
enum Material : uint32_t { ground = 1, wall, pane, metal };  // as in add_radio_materials

Motion at(const dvec3& position, double yaw = 0.0, const dvec3& velocity = dvec3(0.0)) {
  Motion motion;
  motion.pose = {position, orientation_from_yaw_pitch_roll(yaw, 0.0, 0.0)};
  motion.velocity = velocity;
  return motion;
}

std::vector<FacetSequence> sequences(const CandidateList& list) {
  std::vector<FacetSequence> all;
  for (size_t i = 0; i < list.size(); ++i) all.emplace_back(list.sequence(i).begin(), list.sequence(i).end());
  return all;
}

std::vector<FacetSequence> sequences(const std::vector<GeometricPath>& paths) {
  std::vector<FacetSequence> all;
  for (const GeometricPath& path : paths) all.push_back(path.facets());
  return all;
}

/// Returns all data of the paths bit for bit, one line per path.
std::vector<std::string> bytes_of(const std::vector<Path>& paths) {
  std::vector<std::string> all;
  for (const Path& path : paths) {
    std::string line;
    const auto add = [&](double value) {
      uint64_t bits = 0;
      std::memcpy(&bits, &value, sizeof bits);
      line += fmt::format(" {:x}", bits);
    };
    for (const Interaction& i : path.interactions)
      line += fmt::format("{}{}.{} ", "0RTDS"[static_cast<size_t>(i.type)], i.element, i.patch);
    line += fmt::format("id {:x}", path.id());
    for (const dvec3& v : path.vertices) add(v.x), add(v.y), add(v.z);
    for (const double value : {path.length_m, path.foliage_m, path.delay_s, path.doppler_hz}) add(value);
    for (const Complex& t : path.transfer) add(t.real()), add(t.imag());
    all.push_back(line);
  }
  return all;
}

/// A street between two rows of houses with thin walls. A car drives along the street, and a drone flies
/// above it.
struct Street {
  Street() {
    add_radio_materials_to(tiny);
    car = tiny.body("car"), drone = tiny.body("drone");
    tiny.object("ground", 0, ground).quad({-60, -60, 0}, {60, -60, 0}, {60, 60, 0}, {-60, 60, 0});
    tiny.object("north", 0, wall).box({-40, 9, 0}, {-2, 20, 12}).box({3, 8, 0}, {35, 19, 9});
    tiny.object("south", 0, pane).box({-30, -18, 0}, {30, -8, 7});
    tiny.object("car", car, metal).box({-2.1, -0.9, 0.2}, {2.1, 0.9, 1.6});
    tiny.object("drone", drone, wall).box({-0.6, -0.5, -0.2}, {0.6, 0.5, 0.15});
  }
  static void add_radio_materials_to(TinyScene& tiny) { testing::add_radio_materials(tiny); }

  /// Returns the motions of the bodies at a tick. At tick 5 the car has left the scene.
  std::vector<Motion> motions(int tick) const {
    const double t = 0.7 * tick;
    Motion drive = at({-25.0 + 11.0 * t, -2.3 + 0.1 * t, 0.0}, 0.03 * t, {11.0, 0.1, 0.0});
    if (tick == 5) drive = at({4000.0, 0.0, -300.0});
    return {Motion{}, drive, at({-12.0 + 5.0 * t, 1.0, 7.5 - 0.8 * t}, 0.4 * t, {5.0, 0.0, -0.8})};
  }

  TinyScene tiny;
  uint32_t car = 0, drone = 0;
  dvec3 mast{-20.0, 3.5, 10.5};
};

/// Finds paths tick by tick in one of three ways. The device decides which paths are unobstructed.
class Channel {
 public:
  enum class Way { whole, reuse, between };
  Channel(const scene::Scene& scene, const RadioEffects& effects, const PathLimits& options, Way way,
          uint32_t threads = 0)
      : scene_(scene),
        model_(scene, carrier_hz, effects),
        gpu_scene_(test::device(), scene, {}),
        crossings_(gpu_scene_, model_.kinds),
        options_(options),
        way_(way),
        threads_(threads),
        fixed_(model_, options),
        moving_(model_, options) {}

  std::vector<Path> paths(const EndState& tx, const EndState& rx, const std::vector<Motion>& motions) {
    for (uint32_t body = 1; body < motions.size(); ++body) model_.facets.move(body, motions[body]);
    LinkGeometry link = geometry(tx, rx);
    std::vector<Segment> segments;
    fixed_.add_segments(link.paths, tx, rx, segments);
    gpu::TickRing ring(test::device(), 1, 1u << 16, 1u << 16);
    gpu::TickSlot& slot = ring.begin();
    std::vector<Pose> poses;
    for (const Motion& motion : motions) poses.push_back(motion.pose);
    gpu_scene_.record_update(slot, poses);
    const CrossingPass::Pending pending = crossings_.record(slot, segments);
    ring.submit(slot);
    ring.wait(slot);
    return fixed_.finish(link.paths, crossings_.collect(pending, segments, model_.facets), tx, rx,
                         model_.facets);
  }

  CandidateList last;  ///< candidates by moving bodies, or all candidates

 private:
  BeamSearchOptions beams(bool moving_bodies, uint32_t source_body) const {
    BeamSearchOptions options;
    options.max_depth = options_.max_depth;
    options.max_transmissions = model_.effects.transmission ? options_.max_transmissions : 0;
    options.moving_bodies = moving_bodies;
    options.source_body = source_body;
    options.threads = threads_;
    return options;
  }
  MovingSearch search() const {
    MovingSearchOptions options;
    options.max_depth = options_.max_depth;
    options.max_transmissions = beams(false, 0).max_transmissions;
    options.threads = threads_;
    return MovingSearch(model_.facets, model_.kinds, options);
  }

  LinkGeometry geometry(const EndState& tx, const EndState& rx) {
    if (way_ == Way::whole) {
      last = BeamSearch(model_.facets, model_.kinds, {}, beams(true, tx.body)).search(tx.position).list;
      fixed_.set_candidates(last, tx.position, Source::transmitter);
      return fixed_.geometry(rx);
    }
    if (way_ == Way::between) {
      BeamSearchOptions options = beams(false, 0);
      options.stop_depth = std::max(options_.max_depth, 2u) - 2;
      MovingSearch both = search();
      both.set_tree(BeamSearch(model_.facets, model_.kinds, {}, options).search(tx.position), tx.position);
      last = both.all(std::span(&rx.position, 1));
      fixed_.set_candidates(last, tx.position, Source::transmitter);
      LinkGeometry link = fixed_.geometry(rx);
      both.seams().drop_behind(link.paths, Source::transmitter, tx.body);
      return link;
    }
    if (!reuse_) {  // only at the first call
      const BeamSearchResult tree =
          BeamSearch(model_.facets, model_.kinds, {}, beams(false, 0)).search(tx.position);
      fixed_.set_candidates(tree.list, tx.position, Source::transmitter);
      reuse_ = search();
      reuse_->set_tree(tree, tx.position);
    }
    last = reuse_->moving(std::span(&rx.position, 1));
    moving_.set_candidates(last, tx.position, Source::transmitter);
    LinkGeometry link = fixed_.geometry(rx);
    LinkGeometry more = moving_.geometry(rx);
    reuse_->seams().drop_behind(more.paths, Source::transmitter, tx.body);
    for (GeometricPath& path : more.paths) link.paths.push_back(std::move(path));
    keep_distinct(link.paths);
    return link;
  }

  const scene::Scene& scene_;
  RadioModel model_;
  scene::GpuScene gpu_scene_;
  CrossingPass crossings_;
  PathLimits options_;
  Way way_;
  uint32_t threads_;
  PathSolver fixed_, moving_;
  std::optional<MovingSearch> reuse_;
};

RadioEffects with_walls(bool walls) {
  RadioEffects effects;
  effects.transmission = walls;
  return effects;
}

EndState end_at(const dvec3& position, uint32_t body = 0) {
  EndState end;
  end.position = position;
  end.body = body;
  return end;
}

bool touches_body(const scene::Scene& scene, const Path& path, uint32_t body) {
  for (const uint32_t facet : path.facets())
    if (scene.facets[facet].body == body) return true;
  return false;
}

/// Expects the same bytes at every tick from the whole search, from reuse and from a search between both
/// ends, with or without walls.
void expect_the_same(bool walls, uint32_t max_depth, uint32_t threads) {
  const Street street;
  const scene::Scene scene = street.tiny.build();
  PathLimits options;
  options.max_depth = max_depth;
  options.max_transmissions = max_depth;
  Channel whole(scene, with_walls(walls), options, Channel::Way::whole, threads);
  Channel reuse(scene, with_walls(walls), options, Channel::Way::reuse, threads);
  Channel between(scene, with_walls(walls), options, Channel::Way::between, threads);
  const EndState tx = end_at(street.mast);
  size_t by_car = 0, by_drone = 0;
  for (int tick = 0; tick < 7; ++tick) {
    SCOPED_TRACE(tick);
    const std::vector<Motion> motions = street.motions(tick);
    const EndState rx = end_at({6.0 + 0.3 * tick, -1.5, 1.7});
    const std::vector<Path> expected = whole.paths(tx, rx, motions);
    EXPECT_EQ(bytes_of(reuse.paths(tx, rx, motions)), bytes_of(expected));
    EXPECT_EQ(bytes_of(between.paths(tx, rx, motions)), bytes_of(expected));
    EXPECT_LT(reuse.last.size(), whole.last.size() / 2) << "little is looked at again";
    for (const Path& path : expected) {
      by_car += touches_body(scene, path, street.car);
      by_drone += touches_body(scene, path, street.drone);
      EXPECT_TRUE(tick != 5 || !touches_body(scene, path, street.car)) << "it has left";
    }
  }
  EXPECT_GT(by_car, 2u);
  EXPECT_TRUE(by_drone > 0 || max_depth < 3);
}

TEST(MovingSearch, ReuseGivesTheBytesOfTheWholeSearch) { expect_the_same(false, 3, 0); }
TEST(MovingSearch, ReuseGivesTheBytesOfTheWholeSearchThroughWalls) { expect_the_same(true, 3, 0); }
TEST(MovingSearch, ReuseGivesTheBytesOfTheWholeSearchAtDepthTwo) { expect_the_same(true, 2, 1); }

TEST(MovingSearch, ThreadsChangeNothing) {
  const Street street;
  const scene::Scene scene = street.tiny.build();
  for (const Channel::Way way : {Channel::Way::reuse, Channel::Way::between}) {
    Channel one(scene, with_walls(true), {}, way, 1), two(scene, with_walls(true), {}, way, 2);
    for (int tick = 0; tick < 3; ++tick) {
      const EndState tx = end_at(street.mast), rx = end_at({4.0, -2.0, 1.5});
      EXPECT_EQ(bytes_of(one.paths(tx, rx, street.motions(tick))),
                bytes_of(two.paths(tx, rx, street.motions(tick))));
      EXPECT_EQ(one.last, two.last);
    }
  }
}

TEST(MovingSearch, AReceiverOnABodyThatMoves) {
  const Street street;
  const scene::Scene scene = street.tiny.build();
  Channel whole(scene, with_walls(true), {}, Channel::Way::whole),
      reuse(scene, with_walls(true), {}, Channel::Way::reuse),
      between(scene, with_walls(true), {}, Channel::Way::between);
  size_t own = 0, found = 0;
  for (int tick = 0; tick < 5; ++tick) {
    SCOPED_TRACE(tick);
    const std::vector<Motion> motions = street.motions(tick);
    for (const double below : {0.5, -0.05}) {  // below the drone and inside it
      const EndState tx = end_at(street.mast),
                     rx = end_at(motions[street.drone].pose.apply(dvec3(0.1, 0.05, -below)), street.drone);
      const std::vector<Path> expected = whole.paths(tx, rx, motions);
      EXPECT_EQ(bytes_of(reuse.paths(tx, rx, motions)), bytes_of(expected));
      EXPECT_EQ(bytes_of(between.paths(tx, rx, motions)), bytes_of(expected));
      found += expected.size();
      for (const Path& path : expected) own += touches_body(scene, path, street.drone);
    }
  }
  EXPECT_GT(found, 20u);
  EXPECT_GT(own, 0u);
}

TEST(MovingSearch, BothEndsOnBodiesThatMove) {
  const Street street;
  const scene::Scene scene = street.tiny.build();
  Channel whole(scene, with_walls(false), {}, Channel::Way::whole),
      between(scene, with_walls(false), {}, Channel::Way::between);
  size_t found = 0;
  for (int tick = 0; tick < 5; ++tick) {
    SCOPED_TRACE(tick);
    const std::vector<Motion> motions = street.motions(tick);
    const EndState tx = end_at(motions[street.car].pose.apply(dvec3(0.3, 0.1, 1.8)), street.car),
                   rx = end_at(motions[street.drone].pose.apply(dvec3(0.1, 0.05, -0.4)), street.drone);
    const std::vector<Path> expected = whole.paths(tx, rx, motions);
    EXPECT_EQ(bytes_of(between.paths(tx, rx, motions)), bytes_of(expected));
    found += expected.size();
  }
  EXPECT_GT(found, 5u);
}

/// Each of two bodies carries a mirror of 2 m by 2 m. The path goes up from the transmitter, along x and down
/// to the receiver.
TEST(MovingSearch, TwoBodiesOneAfterTheOther) {
  TinyScene tiny;
  testing::add_radio_materials(tiny);
  const uint32_t left = tiny.body("left"), right = tiny.body("right");
  tiny.object("left", left, metal).quad({-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0});
  tiny.object("right", right, metal).quad({-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0});
  const scene::Scene scene = tiny.build();
  // The mirrors are tilted by 45 degrees and face each other along x: (0, 0, 0) -> (0, 0, 10) -> (20, 0, 10)
  // -> (20, 0, 0).
  const auto tilted = [](const dvec3& position, double pitch) {
    Motion motion;
    motion.pose = {position, orientation_from_yaw_pitch_roll(0.0, pitch, 0.0)};
    return motion;
  };
  std::vector<Motion> motions{Motion{}, tilted({0, 0, 10}, 0.75 * pi), tilted({20, 0, 10}, -0.75 * pi)};
  const EndState tx = end_at(dvec3(0.0)), rx = end_at({20, 0, 0});
  Channel reuse(scene, {}, {}, Channel::Way::reuse), between(scene, {}, {}, Channel::Way::between);
  for (Channel* channel : {&reuse, &between}) {
    const std::vector<Path> paths = channel->paths(tx, rx, motions);
    ASSERT_EQ(paths.size(), 2u);  // the path by both mirrors and the line of sight
    EXPECT_THAT(paths[1].facets(), ElementsAre(0u, 1u));
    EXPECT_NEAR(paths[1].length_m, 40.0, 1e-9);
    // One mirror turns away and the path disappears; the mirror turns back and the path returns.
    motions[right] = tilted({20, 0, 10}, -0.5 * pi);
    EXPECT_EQ(channel->paths(tx, rx, motions).size(), 1u);
    motions[right] = tilted({20, 0, 10}, -0.75 * pi);
    EXPECT_EQ(bytes_of(channel->paths(tx, rx, motions)), bytes_of(paths));
  }
}

/// Holds boxes drawn from a seed: a hall, a house in it and two bodies.
struct Boxes {
  explicit Boxes(uint64_t seed) {
    RandomStream random(seed, 0x6d6f7665u);
    testing::add_radio_materials(tiny);
    tiny.object("hall", 0, ground).box({-30, -30, 0}, {30, 30, 12});
    const auto draw = [&](double low, double high) { return random.uniform(low, high); };
    const auto box = [&](uint32_t body) {
      tiny.object("box", body, metal);
      tiny.box({-draw(0.5, 4), -draw(0.5, 4), 0.0}, {draw(0.5, 4), draw(0.5, 4), draw(1, 6)});
    };
    motions.push_back(Motion{});
    tiny.object("house", 0, metal).box({5, 5, 0}, {9 + draw(0, 4), 12, 5});
    for (int i = 0; i < 2; ++i) {
      box(tiny.body("body"));
      motions.push_back(at({draw(-15, 15), draw(-15, 15), draw(0, 4)}, draw(-3, 3)));
    }
    for (dvec3* end : {&source, &target}) *end = {draw(-20, 20), draw(-20, 20), draw(0.5, 9)};
  }
  TinyScene tiny;
  std::vector<Motion> motions;
  dvec3 source{0.0}, target{0.0};
};

/// Beyond the end of the tree, the search uses no occlusion but that of facets at rest before the target: so
/// it lists every sequence that has a path in empty space, unless its last facet is at rest and hidden from
/// the target.
TEST(MovingSearch, NothingThatExistsGeometricallyIsLost) {
  size_t with_body = 0, all = 0, hidden = 0;
  for (uint64_t seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE(seed);
    const Boxes boxes(seed);
    const scene::Scene scene = boxes.tiny.build();
    RadioModel model(scene, carrier_hz, {});
    for (uint32_t body = 1; body < boxes.motions.size(); ++body) model.facets.move(body, boxes.motions[body]);
    const auto paths =
        sequences(solve_paths(model.facets, boxes.source, boxes.target,
                              exhaustive_candidates(static_cast<uint32_t>(scene.facets.size()), 3)));
    BeamSearchOptions beams;
    beams.stop_depth = 0;
    MovingSearch search(model.facets, model.kinds, {});
    search.set_tree(BeamSearch(model.facets, model.kinds, {}, beams).search(boxes.source), boxes.source);
    auto found = sequences(search.all(std::span(&boxes.target, 1)));
    std::sort(found.begin(), found.end());
    BeamSearchOptions one;
    one.max_depth = one.stop_depth = 1;
    const auto seen = sequences(BeamSearch(model.facets, model.kinds, {}, one).search(boxes.target).list);
    for (const FacetSequence& path : paths) {
      const bool may_end = path.empty() || scene.facets[path.back()].body != 0 ||
                           std::ranges::find(seen, FacetSequence{path.back()}) != seen.end();
      EXPECT_EQ(std::binary_search(found.begin(), found.end(), path), may_end)
          << ::testing::PrintToString(path);
      hidden += !may_end;
    }
    EXPECT_LT(found.size(), 2 * paths.size());
    const auto moving = sequences(search.moving(std::span(&boxes.target, 1)));
    for (const FacetSequence& path : paths) {
      const bool moves =
          std::any_of(path.begin(), path.end(), [&](uint32_t f) { return scene.facets[f].body != 0; });
      // The tree has stopped: moving() finds a path whose first reflection moves, or whose last of two does.
      if (!moves) {
        EXPECT_THAT(moving, Not(Contains(path)));
      } else if (path.size() < 2 || scene.facets[path[0]].body != 0) {
        EXPECT_THAT(moving, Contains(path));
      }
      with_body += moves;
    }
    all += paths.size();
  }
  EXPECT_GT(with_body, 100u);
  EXPECT_GT(all, with_body);
  EXPECT_GT(hidden, 20u);
}

/// A box carries the receiver, and the last segment of a path does not see this box. So along the edge of the
/// front, the visibility test alone would let a path reach the inside of the top, within a tolerance below
/// the edge.
TEST(MovingSearch, TheFarSideOfAnEdgeIsDark) {
  TinyScene tiny;
  testing::add_radio_materials(tiny);
  const uint32_t body = tiny.body("box");
  tiny.object("box", body, metal).box({-1, -1, -1}, {1, 1, 1});
  const scene::Scene scene = tiny.build();
  RadioModel model(scene, carrier_hz, {});
  MovingSearch search(model.facets, model.kinds, {});
  // The facets are: bottom, top, y = -1, y = 1, x = -1, x = 1. The path comes from the left with a slope of 1
  // and meets the inside of the top.
  const dvec3 target(-0.5, 0.0, 0.5);
  for (const double behind : {4e-5, 1e-3, -4e-5}) {
    const dvec3 at(-1.0 + behind, 0.0, 1.0), source = at - dvec3(3.0, 0.0, 3.0);
    const double down = target.x - at.x;  // down to the target at the same slope
    const dvec3 end(target.x, 0.0, 1.0 - down);
    CandidateList list;
    const uint32_t top[] = {1};
    list.add(top);
    std::vector<GeometricPath> paths = solve_paths(model.facets, source, end, list);
    EXPECT_EQ(paths.size(), behind > 0.0 ? 1u : 0u);
    search.seams().drop_behind(paths, Source::transmitter, 0);
    EXPECT_THAT(paths, IsEmpty());
  }
  // Seen from outside and above, no facet is behind another one.
  CandidateList list;
  const uint32_t top[] = {1};
  list.add(top);
  std::vector<GeometricPath> paths = solve_paths(model.facets, {-2, 0, 2.0}, {0.0002, 0, 2.0}, list);
  ASSERT_EQ(paths.size(), 1u);
  search.seams().drop_behind(paths, Source::transmitter, 0);
  EXPECT_EQ(paths.size(), 1u);
}

TEST(MovingSearch, SeveralTargetsAreServedAtOnceAndEmptyListsAreFine) {
  const Street street;
  const scene::Scene scene = street.tiny.build();
  RadioModel model(scene, carrier_hz, {});
  const std::vector<Motion> motions = street.motions(2);
  for (uint32_t body = 1; body < motions.size(); ++body) model.facets.move(body, motions[body]);
  MovingSearch search(model.facets, model.kinds, {});
  search.set_tree(BeamSearch(model.facets, model.kinds, {}, {}).search(street.mast), street.mast);
  const dvec3 targets[] = {{6, -1.5, 1.7}, {-8, 2, 1.5}};
  const auto both = sequences(search.moving(targets));
  for (const dvec3& target : targets)
    EXPECT_THAT(sequences(search.moving(std::span(&target, 1))), IsSubsetOf(both));
  EXPECT_TRUE(search.moving(targets).is_canonical());
  EXPECT_THAT(sequences(search.moving({})), IsEmpty());
  EXPECT_THAT(sequences(search.all({})), ElementsAre(IsEmpty()));
}

}  // namespace
}  // namespace greatx::rf
