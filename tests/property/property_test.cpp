// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks properties that hold in any scene, from files to records (check_scenes.h says how to run more).
#include <algorithm>
#include <cmath>
#include <cstring>
#include <sched.h>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/units.h"
#include "sim/experiment/experiment.h"
#include "sim/scenario/parse/load_scenario.h"
#include "tests/property/check_scenes.h"
#include "tests/support/temporary_folder.h"

namespace greatx::property {
namespace {

/// Lengths may differ by `length_m`. Amplitudes are complex64: 2^-23 each, and more where the phase follows a
/// length that has changed.
struct Tolerance {
  double length_m = 1e-8, amplitude = 1e-6;
};

std::optional<std::string> difference(const Links& a, const Links& b, const DrawnCase& drawn,
                                      const Tolerance& tolerance = {}) {
  if (a.size() != b.size()) return fmt::format("{} links, {} in the other form", a.size(), b.size());
  const double wavenumber = 2.0 * pi * drawn.carrier_hz / speed_of_light;
  for (size_t r = 0; r < a.size(); ++r) {
    if (a[r].paths.size() != b[r].paths.size())
      return fmt::format("link {}: {} paths, {} in the other form", r, a[r].paths.size(), b[r].paths.size());
    std::vector<bool> taken(b[r].paths.size(), false);
    for (const LinkPath& path : a[r].paths) {
      // Paths of one length may come in any order.
      const double most =
          std::abs(path.amplitude) * (tolerance.amplitude + 2.0 * wavenumber * tolerance.length_m);
      size_t match = 0;
      while (match < taken.size() &&
             (taken[match] || std::abs(b[r].paths[match].length_m - path.length_m) > tolerance.length_m ||
              std::abs(b[r].paths[match].amplitude - path.amplitude) > most))
        ++match;
      if (match == taken.size())
        return fmt::format("link {}: the path of {} m and amplitude {} has no partner", r, path.length_m,
                           std::abs(path.amplitude));
      taken[match] = true;
    }
  }
  return std::nullopt;
}

/// Checks that the links are the same in another form.
void check_form(const std::string& name, const Form& form, const Tolerance& tolerance = {}) {
  check_scenes(name,
               [&](const DrawnCase& drawn) {
                 return difference(run_case(drawn), run_case(drawn, form), drawn, tolerance);
               },
               {Form{}, form});
}

TEST(Property, ScenesHavePathsToCompare) {
  size_t paths = 0, links = 0;
  for (uint64_t seed = 1; seed <= 4; ++seed)
    for (const Link& link : run_case(draw_case(seed))) paths += link.paths.size(), ++links;
  EXPECT_EQ(links, 12u);
  EXPECT_GT(paths, 40u);
}

TEST(Property, NoPathGainsEnergy) {
  check_scenes(
      "energy",
      [](const DrawnCase& drawn) -> std::optional<std::string> {
        for (const Link& link : run_case(drawn))
          for (const LinkPath& path : link.paths) {
            const double free = speed_of_light / drawn.carrier_hz / (4.0 * pi * path.length_m);
            if (!(std::abs(path.amplitude) <= free * (1.0 + 1e-6)))
              return fmt::format("the path of {} m has {} of the amplitude of free space", path.length_m,
                                 std::abs(path.amplitude) / free);
          }
        return std::nullopt;
      },
      {Form{}}, [](DrawnCase& drawn) { drawn.diffraction = false; });
}

TEST(Property, UtmOffsetsChangeNothing) {
  // Positions of 5e6 m have roundings of 1e-9 m; a path of depth 3 adds up some.
  Form form;
  form.shift = {500'000.0, 5'000'000.0, 0.0};
  check_form("utm", form, {2e-8, 1e-6});
}

TEST(Property, ATurnedWorldHasTheSameLinks) {
  Form form;
  form.turn_deg = 37.3;
  check_form("turn", form);
}

TEST(Property, FinerTrianglesChangeNothing) {
  Form form;
  form.split = true;
  check_form("split", form);
}

TEST(Property, RenumberingChangesNothing) {
  Form form;
  form.reversed = true;
  check_form("renumber", form);
}

TEST(Property, UnitsChangeNothing) {
  Form form;
  form.unit_m = 0.0625;
  check_form("units", form);
}

TEST(Property, AReceiverDoesNotDependOnTheOthers) {
  Form alone;
  alone.only = {1};
  check_scenes("subset",
               [&](const DrawnCase& drawn) -> std::optional<std::string> {
                 if (drawn.receivers.size() < 2) return std::nullopt;
                 const Links all = run_case(drawn), one = run_case(drawn, alone);
                 if (all[1].cfr == one[0].cfr) return std::nullopt;
                 return "the frequency response of rx1 has other bits if it is alone";
               },
               {Form{}, alone});
}

TEST(Property, ThreadsChangeNoBit) {
  check_scenes("threads",
               [](const DrawnCase& drawn) -> std::optional<std::string> {
                 cpu_set_t all, one;
                 sched_getaffinity(0, sizeof(all), &all);
                 const Links many = run_case(drawn);
                 CPU_ZERO(&one);
                 for (int cpu = 0; cpu < CPU_SETSIZE && CPU_COUNT(&one) == 0; ++cpu)
                   if (CPU_ISSET(cpu, &all)) CPU_SET(cpu, &one);
                 sched_setaffinity(0, sizeof(one), &one);
                 const Links single = run_case(drawn);
                 sched_setaffinity(0, sizeof(all), &all);
                 for (size_t r = 0; r < many.size(); ++r)
                   if (many[r].cfr != single[r].cfr)
                     return fmt::format("link {} has other bits on one core", r);
                 return std::nullopt;
               },
               {Form{}});
}

/// The property "no scene has two boxes of brick and two reflections" is false. Its smallest counter-example
/// has nothing else.
TEST(Shrink, FindsTheSmallestCaseOfAnArtificialProperty) {
  const Verdict verdict = [](const DrawnCase& drawn) -> std::optional<std::string> {
    const auto brick = std::ranges::count(drawn.boxes, 1u, &DrawnBox::material);
    if (brick >= 2 && drawn.depth >= 2 && drawn.transmitter.x > 0.6) return "two boxes of brick";
    return std::nullopt;
  };
  DrawnCase drawn;
  for (uint64_t seed = 1; !verdict(drawn = draw_case(seed)); ++seed) ASSERT_LT(seed, 1000u);
  drawn.diffraction = true;
  const Shrunk shrunk = shrink(drawn, verdict);
  EXPECT_EQ(shrunk.smallest.boxes.size(), 2u);
  EXPECT_EQ(shrunk.smallest.receivers.size(), 1u);
  EXPECT_EQ(shrunk.smallest.depth, 2u);
  EXPECT_FALSE(shrunk.smallest.ground);
  EXPECT_FALSE(shrunk.smallest.diffraction);
  EXPECT_FALSE(shrunk.smallest.transmission);
  EXPECT_GT(shrunk.smallest.transmitter.x, 0.6);
  EXPECT_EQ(std::fmod(shrunk.smallest.transmitter.x, 1.0), 0.0);
  for (const DrawnBox& box : shrunk.smallest.boxes) {
    EXPECT_EQ(box.u.y, 0.0);
    EXPECT_EQ(std::fmod(box.corner.x, 1.0), 0.0);
    EXPECT_EQ(std::fmod(box.height, 1.0), 0.0);
  }
  EXPECT_EQ(shrunk.fault, "two boxes of brick");
}

TEST(Shrink, WritesFilesThatReplayTheFailure) {
  const greatx::test::TemporaryFolder folder;
  Form turned;
  turned.turn_deg = 30.0;
  // "No link has a path that is reflected" is false in every scene with a ground.
  const Verdict verdict = [](const DrawnCase& drawn) -> std::optional<std::string> {
    for (const Link& link : run_case(drawn))
      if (link.paths.size() > 1) return "more than one path";
    return std::nullopt;
  };
  DrawnCase drawn = draw_case(2);
  drawn.transmitter = {-20.0, -21.0, 13.0};
  drawn.receivers = {{21.0, -20.5, 13.5}};
  const std::optional<std::string> message =
      check_case(drawn, "artificial", verdict, {Form{}, turned}, folder.path());
  ASSERT_TRUE(message);
  const std::filesystem::path kept = folder.path() / "artificial_seed_2";
  EXPECT_NE(message->find(kept.string()), std::string::npos) << *message;
  EXPECT_TRUE(std::filesystem::exists(kept / "message.txt"));
  for (const char* form : {"0", "1"}) {
    const Links links = run_case(kept / form);
    ASSERT_EQ(links.size(), 1u);
    EXPECT_EQ(links[0].paths.size(), 2u) << *message;
  }
  EXPECT_LE(sim::make_experiment(sim::load_scenario(kept / "0" / "scenario.yaml")).scene().instances.size(),
            1u);
}

TEST(Shrink, ACaseThatHoldsIsLeftAlone) {
  const greatx::test::TemporaryFolder folder;
  const Verdict holds = [](const DrawnCase&) { return std::nullopt; };
  EXPECT_FALSE(check_case(draw_case(1), "holds", holds, {Form{}}, folder.path()));
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace greatx::property
