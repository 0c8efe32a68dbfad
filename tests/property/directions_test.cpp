// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks that both directions of a link have the same paths and the transposed transfer function, whichever
// of its ends move, with diffraction, scattering, and reflections on one side or both sides of them.
#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "sim/channel/channel_snapshot.h"
#include "sim/scenario/parse/load_scenario.h"
#include "tests/property/check_scenes.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/kept_run.h"
#include "tests/support/temporary_folder.h"

namespace greatx::property {
namespace {

using Solved = sim::ChannelSnapshot::Link;
using Response = std::vector<std::complex<float>>;

constexpr uint32_t ticks = 2, subcarriers = 16, ports = 2;

/// One direction of a channel: the links in fp64 and H, at both ticks.
struct Direction {
  std::vector<std::vector<Solved>> links;  ///< [ticks][receivers of the case]
  std::vector<Response> responses;         ///< [ticks], [rx, rx_ant, tx, tx_ant, subcarrier]
  std::string search;                      ///< the note of the run
};

Form form_of(bool swapped) {
  Form form;
  form.swapped = swapped;
  form.slant = true;
  form.ticks = ticks;
  return form;
}

Direction solve(const DrawnCase& drawn, bool swapped) {
  const greatx::test::TemporaryFolder folder;
  write_case(drawn, form_of(swapped), folder.path());
  const sim::Experiment experiment =
      sim::make_experiment(sim::load_scenario(folder.path() / "scenario.yaml"));
  Direction direction;
  sim::ChannelSnapshot snapshot(test::device(), experiment, 0, {});
  for (uint32_t tick = 0; tick < ticks; ++tick) {
    if (tick > 0) snapshot.move(0, tick);
    snapshot.solve([&, &links = direction.links.emplace_back()](Solved link) {
      links.push_back(std::move(link));
      return true;
    });
  }
  const test::KeptRun run =
      test::keep_run(sim::make_experiment(sim::load_scenario(folder.path() / "scenario.yaml")));
  for (uint32_t tick = 0; tick < ticks; ++tick) {
    const auto h = run.array<std::complex<float>>(tick, "csi", "cfr");
    direction.responses.emplace_back(h.begin(), h.end());
  }
  direction.search = run.note("csi.search");
  return direction;
}

std::string words(std::span<const rf::Interaction> interactions) {
  std::string text;
  for (const rf::Interaction& one : interactions)
    text += fmt::format("{}{} ", "-RTDS"[static_cast<size_t>(one.type)], one.element);
  return text;
}

/// Returns what differs between a path and the same path from the other end. Fields agree to 1e-12 of the
/// largest component.
std::optional<std::string> backward_difference(const rf::Path& path, const rf::Path& back) {
  double largest = 0.0, off = 0.0;
  for (const int i : {0, 1, 2, 3}) {
    const int transposed = i == 1 ? 2 : i == 2 ? 1 : i;
    largest = std::max(largest, std::abs(path.transfer[i]));
    off = std::max(off, std::abs(path.transfer[i] - back.transfer[transposed]));
  }
  if (off > 1e-12 * largest) return fmt::format("the field differs by {:.3g} of itself", off / largest);
  if (std::abs(path.length_m - back.length_m) > 1e-12 * path.length_m)
    return fmt::format("{} m and {} m", path.length_m, back.length_m);
  if (glm::length(path.departure - back.arrival) > 1e-9 || glm::length(path.arrival - back.departure) > 1e-9)
    return "departure and arrival are not exchanged";
  if (std::abs(path.doppler_hz - back.doppler_hz) > 1e-9 * (1.0 + std::abs(path.doppler_hz)))
    return fmt::format("{} Hz and {} Hz", path.doppler_hz, back.doppler_hz);
  return std::nullopt;
}

std::optional<std::string> backward_difference(const Solved& link, const Solved& back) {
  std::map<std::vector<rf::Interaction>, const rf::Path*> known;
  for (const rf::Path& path : back.paths)
    known[{path.interactions.rbegin(), path.interactions.rend()}] = &path;
  for (const rf::Path& path : link.paths) {
    const auto found = known.find(path.interactions);
    if (found == known.end())
      return fmt::format("{} of {} m is not there backwards", words(path.interactions), path.length_m);
    if (const auto fault = backward_difference(path, *found->second))
      return fmt::format("{}: {}", words(path.interactions), *fault);
    known.erase(found);
  }
  if (known.empty()) return std::nullopt;
  return fmt::format("{} is there backwards alone", words(known.begin()->first));
}

/// Returns what is wrong unless H is transposed, to 1e-6 of its largest element. The transmitter of the case
/// is the only one of one direction, and the only receiver of the other.
std::optional<std::string> not_transposed(const Response& there, const Response& back, size_t receivers) {
  if (there.size() != back.size()) return fmt::format("{} and {} values of H", there.size(), back.size());
  double largest = 0.0, off = 0.0;
  for (size_t r = 0; r < receivers; ++r)
    for (size_t u = 0; u < ports; ++u)
      for (size_t s = 0; s < ports; ++s)
        for (size_t k = 0; k < subcarriers; ++k) {
          const std::complex<float> a = there[((r * ports + u) * ports + s) * subcarriers + k],
                                    b = back[((s * receivers + r) * ports + u) * subcarriers + k];
          largest = std::max(largest, static_cast<double>(std::abs(a)));
          off = std::max(off, static_cast<double>(std::abs(a - b)));
        }
  if (off <= 1e-6 * largest) return std::nullopt;
  return fmt::format("H differs from the transpose by {:.3g} of its largest element", off / largest);
}

std::optional<std::string> directions_differ(const DrawnCase& drawn) {
  const Direction there = solve(drawn, false), back = solve(drawn, true);
  for (size_t tick = 0; tick < ticks; ++tick) {
    for (size_t r = 0; r < drawn.receivers.size(); ++r)
      if (const auto fault = backward_difference(there.links[tick].at(r), back.links[tick].at(r)))
        return fmt::format("tick {}, link {}: {}", tick, r, *fault);
    if (const auto fault =
            not_transposed(there.responses[tick], back.responses[tick], drawn.receivers.size()))
      return fmt::format("tick {}: {}", tick, *fault);
  }
  return std::nullopt;
}

/// Adds diffraction and scattering to a case, every second one with `search: every_tick`, every third with
/// two edges, every fourth with dispersion. The ends move by `moving`: 0 none, 1 the transmitter, 2 the
/// receivers, 3 all.
void bend(DrawnCase& drawn, uint32_t after, uint32_t moving) {
  drawn.diffraction = drawn.scattering = true;
  drawn.every_tick = drawn.seed % 2 == 0;
  drawn.dispersion = drawn.seed % 4 == 1;
  drawn.two_edges = drawn.seed % 3 == 0;
  drawn.reflections_after = after;
  drawn.transmitter_moves = (moving & 1u) != 0;
  drawn.receivers_move = (moving & 2u) != 0;
  drawn.receivers.resize(2);
}

class BothDirections : public ::testing::TestWithParam<std::tuple<uint32_t, uint32_t>> {};

TEST_P(BothDirections, HaveTheSamePathsAndTheTransposedTransferFunction) {
  const auto [after, moving] = GetParam();
  check_scenes(fmt::format("directions_{}_{}", after, moving), directions_differ,
               {form_of(false), form_of(true)}, [&](DrawnCase& drawn) { bend(drawn, after, moving); });
}

std::string name_of_setting(const ::testing::TestParamInfo<std::tuple<uint32_t, uint32_t>>& info) {
  constexpr const char* names[] = {"AllRest", "TheTransmitterMoves", "TheReceiversMove", "AllMove"};
  return fmt::format("{}After{}", std::get<0>(info.param), names[std::get<1>(info.param)]);
}

INSTANTIATE_TEST_SUITE_P(Property, BothDirections,
                         ::testing::Combine(::testing::Values(0u, 1u), ::testing::Values(0u, 1u, 2u, 3u)),
                         name_of_setting);

TEST(Property, BothDirectionsHaveTheSamePaths) {
  check_scenes("reciprocity", directions_differ, {form_of(false), form_of(true)},
               [](DrawnCase& drawn) { drawn.diffraction = false; });
}

/// Without scattering, two ends that move are searched from both.
TEST(Property, BothDirectionsOverEdges) {
  for (const uint32_t moving : {0u, 1u, 2u, 3u})
    check_scenes(fmt::format("directions_edges_{}", moving), directions_differ,
                 {form_of(false), form_of(true)}, [&](DrawnCase& drawn) {
                   bend(drawn, 0, moving);
                   drawn.scattering = drawn.every_tick = false;
                 });
}

TEST(Property, BothDirectionsShootTheirRaysFromOneEnd) {
  for (const uint32_t moving : {0u, 3u})
    check_scenes(fmt::format("directions_rays_{}", moving), directions_differ,
                 {form_of(false), form_of(true)}, [&](DrawnCase& drawn) {
                   bend(drawn, 0, moving);
                   drawn.diffraction = false;
                   drawn.rays = 4096;
                 });
}

/// The properties above compare something: paths with reflections on one side of a bend, on the other side,
/// and on both, and links that are searched from either end.
TEST(Property, BothDirectionsHaveBendsToCompare) {
  std::map<std::string, size_t> shapes;
  size_t from_receiver = 0, from_transmitter = 0;
  for (const uint32_t after : {0u, 1u})
    for (uint64_t seed = 1; seed <= 4; ++seed) {
      DrawnCase drawn = draw_case(seed);
      bend(drawn, after, 0);
      drawn.transmission = false;
      const Direction direction = solve(drawn, false);
      for (const Solved& link : direction.links[0])
        for (const rf::Path& path : link.paths) {
          std::string shape = fmt::format("{}:", after);
          for (const rf::Interaction& one : path.interactions)
            shape += "-RTDS"[static_cast<size_t>(one.type)];
          ++shapes[shape];
          if (shape.find_first_of("DS") == std::string::npos) continue;
          ++(path.from_receiver ? from_receiver : from_transmitter);
        }
    }
  for (const char* shape : {"0:D", "0:S", "0:RD", "0:DR", "0:RS", "0:SR", "1:RD", "1:DR", "1:RS", "1:SR"})
    EXPECT_GT(shapes[shape], 5u) << shape;
  EXPECT_GT(from_receiver, 100u);
  EXPECT_GT(from_transmitter, 100u);
}

/// The end that is searched from depends on the ends of a link alone, so that a receiver's link is the same
/// with other receivers.
TEST(Property, AnotherReceiverDoesNotChangeTheEndThatIsSearchedFrom) {
  check_scenes(
      "directions_alone",
      [](const DrawnCase& drawn) -> std::optional<std::string> {
        if (drawn.receivers.size() < 2) return std::nullopt;
        DrawnCase alone = drawn;
        alone.receivers.resize(1);
        const Direction all = solve(drawn, false), one = solve(alone, false);
        for (size_t tick = 0; tick < ticks; ++tick)
          if (!std::equal(one.responses[tick].begin(), one.responses[tick].end(),
                          all.responses[tick].begin()))
            return fmt::format("tick {}: H of rx0 has other bits if it is alone", tick);
        return std::nullopt;
      },
      {form_of(false)}, [](DrawnCase& drawn) { bend(drawn, 0, 0); });
}

}  // namespace
}  // namespace greatx::property
