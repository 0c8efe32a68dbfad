// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Derivatives of the frequency response by what it takes from paths and ends: against differences, closed
// forms, and each direction of differentiation against the other.
#include <cstring>

#include <gtest/gtest.h>

#include "rf/channel/statistics.h"
#include "rf/gradient/cotangent_sums.h"
#include "rf/gradient/element_slopes.h"
#include "rf/gradient/response_gradient.h"
#include "tests/rf/channel_paths.h"
#include "tests/rf/gradient_support.h"

namespace greatx::rf {
namespace {

using testing::antenna;
using testing::numeric_slope;
using testing::plain_path;
using testing::random_paths;
using testing::relative_error;
using testing::Values;

constexpr double agreement = 1e-7;

std::shared_ptr<const PatternTable> measured_table() {
  RandomStream random(7, 3);
  std::vector<Jones> samples(size_t{9} * 12);
  for (Jones& sample : samples)
    sample = {{random.uniform(-1, 1), random.uniform(-1, 1)}, {random.uniform(-1, 1), random.uniform(-1, 1)}};
  return std::make_shared<const PatternTable>(PatternTable::Grid{9, 12, 0.1}, std::move(samples));
}

dquat turned(const dquat& orientation, const dvec3& turn) {
  const double angle = glm::length(turn);
  return angle == 0.0 ? orientation : glm::angleAxis(angle, turn / angle) * orientation;
}

/// A link of random paths with reflections between two arrays that stand askew.
struct TestLink {
  std::vector<Path> paths;
  ArrayPose transmitter, receiver;
  std::vector<Complex> transmitter_gains, receiver_gains;
  ChannelGrid grid{3.5e9, 1e6, 21, 3, 2e-4};

  TestLink(size_t count, Wavefront wavefront, bool squint, Pattern pattern = Pattern::half_wave_dipole) {
    paths = random_paths(count, 1e-7, 91);
    for (Path& path : paths) path.length_m += 3.0, path.delay_s = path.length_m / speed_of_light;
    transmitter = antenna(pattern, Polarization::vh);
    transmitter.array.pattern.model = PolarizationModel::model_1;
    transmitter.array.columns = 2;
    transmitter.array.column_spacing_m = 0.05;
    transmitter.orientation = glm::angleAxis(0.7, glm::normalize(dvec3(1, 2, 3)));
    receiver = antenna(Pattern::tr38901, Polarization::single);
    receiver.array.single_slant = 0.3;
    receiver.array.positions_m = {{0.1, -0.03, 0.02}, {0.0, 0.0, 0.0}, {-0.04, 0.25, 0.05}};
    receiver.orientation = glm::angleAxis(-1.1, glm::normalize(dvec3(3, -2, 1)));
    transmitter.wavefront = receiver.wavefront = wavefront;
    transmitter.beam_squint = receiver.beam_squint = squint;
    transmitter_gains = {{1.0, 0.1}, {0.9, -0.2}, {1.1, 0.0}, {0.8, 0.3}};
    receiver_gains = {{1.0, 0.0}, {0.7, 0.5}, {1.2, -0.1}};
  }
  ResponseLink link() const { return {paths, transmitter, receiver, transmitter_gains, receiver_gains}; }
  ResponseGradient gradient(PathSelection selection = PathSelection::all) const {
    return {link(), grid, selection};
  }
  Values response() const { return gradient().response(); }
  LinkTangent no_change() const {
    LinkTangent tangent;
    tangent.paths.resize(paths.size());
    return tangent;
  }
  /// Returns this link after a change of the size `by` along a tangent.
  TestLink moved(const LinkTangent& along, double by) const {
    TestLink other = *this;
    for (size_t i = 0; i < paths.size(); ++i) {
      const PathSlope& slope = along.paths[i].slope;
      Path& path = other.paths[i];
      for (int entry = 0; entry < 4; ++entry) path.transfer[entry] += by * slope.transfer[entry];
      path.length_m += by * slope.length_m;
      path.delay_s = path.length_m / speed_of_light;
      path.doppler_hz += by * slope.doppler_hz;
      path.departure = glm::normalize(path.departure + by * slope.departure);
      path.arrival = glm::normalize(path.arrival + by * slope.arrival);
      if (path.vertices.size() > 2) {
        path.vertices.front() -= by * along.paths[i].transmitter_radius_m * path.departure;
        path.vertices.back() -= by * along.paths[i].receiver_radius_m * path.arrival;
      }
    }
    other.transmitter.orientation = turned(transmitter.orientation, by * along.transmitter.attitude);
    other.receiver.orientation = turned(receiver.orientation, by * along.receiver.attitude);
    other.receiver.array.single_slant += by * along.receiver.slants[0];
    for (size_t i = 0; i < along.transmitter.gains.size(); ++i)
      other.transmitter_gains[i] += by * along.transmitter.gains[i];
    for (size_t i = 0; i < along.receiver.gains.size(); ++i)
      other.receiver_gains[i] += by * along.receiver.gains[i];
    other.grid.carrier_hz += by * along.carrier_hz;
    return other;
  }
};

/// Returns changes of one kind each, and one of all kinds together.
std::vector<std::pair<const char*, LinkTangent>> tangents_of(const TestLink& test) {
  RandomStream random(8, 5);
  const auto any = [&] { return random.uniform(-1, 1); };
  const auto across = [&](const dvec3& direction) {
    const dvec3 vector{any(), any(), any()};
    return vector - glm::dot(vector, direction) * direction;
  };
  std::vector<std::pair<const char*, LinkTangent>> list;
  LinkTangent all = test.no_change();
  const auto add = [&](const char* name, const auto& set) {
    list.emplace_back(name, test.no_change());
    set(list.back().second);
    set(all);
  };
  add("transfer", [&](LinkTangent& tangent) {
    for (PathTangent& path : tangent.paths)
      for (Complex& value : path.slope.transfer) value = {any(), any()};
  });
  add("length", [&](LinkTangent& tangent) {
    for (PathTangent& path : tangent.paths) path.slope.length_m = any();
  });
  add("doppler", [&](LinkTangent& tangent) {
    for (PathTangent& path : tangent.paths) path.slope.doppler_hz = 50.0 * any();
  });
  add("departure", [&](LinkTangent& tangent) {
    for (size_t i = 0; i < test.paths.size(); ++i)
      tangent.paths[i].slope.departure = across(test.paths[i].departure);
  });
  add("arrival", [&](LinkTangent& tangent) {
    for (size_t i = 0; i < test.paths.size(); ++i)
      tangent.paths[i].slope.arrival = across(test.paths[i].arrival);
  });
  add("transmitter's attitude", [&](LinkTangent& tangent) {
    tangent.transmitter.attitude = {0.3, -1.0, 0.5};
  });
  add("receiver's attitude", [&](LinkTangent& tangent) { tangent.receiver.attitude = {-0.6, 0.2, 0.9}; });
  add("receiver's slant", [&](LinkTangent& tangent) { tangent.receiver.slants[0] = 1.0; });
  add("transmitter's gains", [&](LinkTangent& tangent) {
    for (size_t i = 0; i < 4; ++i) tangent.transmitter.gains.emplace_back(any(), any());
  });
  add("receiver's gains", [&](LinkTangent& tangent) {
    for (size_t i = 0; i < 3; ++i) tangent.receiver.gains.emplace_back(any(), any());
  });
  add("carrier", [&](LinkTangent& tangent) { tangent.carrier_hz = 1e8; });
  all.transmitter.gains.resize(4), all.receiver.gains.resize(3);
  list.emplace_back("all", all);
  return list;
}

struct Way {
  Wavefront wavefront;
  bool squint;
};
const Way ways[] = {{Wavefront::plane, false},
                    {Wavefront::plane, true},
                    {Wavefront::curved, false},
                    {Wavefront::curved, true}};

TEST(ResponseGradient, TangentsAgreeWithDifferences) {
  for (const auto& [wavefront, squint] : ways) {
    const TestLink test(7, wavefront, squint);
    for (const auto& [name, tangent] : tangents_of(test)) {
      Values found(test.gradient().size());
      test.gradient().push_forward({&tangent, 1}, found);
      const Values expected =
          numeric_slope([&](double by) { return test.moved(tangent, by).response(); }, 2e-3);
      EXPECT_LT(relative_error(found, expected), agreement)
          << name << ", curved " << (wavefront == Wavefront::curved) << ", squint " << squint;
    }
  }
}

TEST(ResponseGradient, CotangentsAgreeWithTangents) {
  RandomStream random(9, 6);
  for (const auto& [wavefront, squint] : ways) {
    const TestLink test(7, wavefront, squint);
    const ResponseGradient gradient = test.gradient();
    Values loss(gradient.size());
    for (Complex& value : loss) value = {random.uniform(-1, 1), random.uniform(-1, 1)};
    const LinkCotangent cotangent = gradient.pull_back(loss);
    for (const auto& [name, tangent] : tangents_of(test)) {
      Values change(gradient.size());
      gradient.push_forward({&tangent, 1}, change);
      double expected = 0.0, size = 0.0;
      for (size_t i = 0; i < change.size(); ++i) {
        expected += (std::conj(loss[i]) * change[i]).real();
        size += std::abs(loss[i]) * std::abs(change[i]);
      }
      EXPECT_LT(std::abs(cotangent.along(tangent) - expected), 1e-12 * size) << name;
    }
  }
}

TEST(ResponseGradient, ManyPathsAndTangentsAreSummedInChunks) {
  TestLink test(100, Wavefront::plane, false);
  const std::vector<std::pair<const char*, LinkTangent>> named = tangents_of(test);
  std::vector<LinkTangent> tangents;
  for (const auto& [name, tangent] : named) tangents.push_back(tangent);
  const size_t size = test.gradient().size();
  Values together(size * tangents.size());
  test.gradient().push_forward(tangents, together);
  for (size_t n = 0; n < tangents.size(); ++n) {
    Values alone(size);
    test.gradient().push_forward({&tangents[n], 1}, alone);
    EXPECT_EQ(std::memcmp(alone.data(), together.data() + n * size, size * sizeof(Complex)), 0);
    // The sum of the changes of each path alone.
    Values sum(size);
    for (size_t i = 0; i < test.paths.size(); i += 50) {
      LinkTangent part = tangents[n];
      for (size_t j = 0; j < part.paths.size(); ++j)
        if (j < i || j >= i + 50) part.paths[j] = {};
      if (i > 0) part.transmitter = part.receiver = {}, part.carrier_hz = 0.0;
      test.gradient().push_forward({&part, 1}, sum);
    }
    EXPECT_LT(relative_error(sum, alone), 1e-13) << named[n].first;
  }
}

/// A path that two mirrors and a wall bend, as the curved wave front needs it.
Path bent_path(const std::vector<InteractionType>& types) {
  Path path = random_paths(1, 1e-7, 92)[0];
  path.vertices = {{0.0, 0.0, 1.0}};
  RandomStream random(5, 4);
  for (const InteractionType type : types) {
    path.interactions.push_back({type});
    path.vertices.push_back(path.vertices.back() +
                            dvec3(random.uniform(1, 4), random.uniform(-3, 3), random.uniform(-1, 1)));
  }
  path.vertices.push_back(path.vertices.back() + dvec3(2.0, 1.5, -0.5));
  path.length_m = 0.0;
  for (size_t i = 0; i + 1 < path.vertices.size(); ++i)
    path.length_m += glm::distance(path.vertices[i], path.vertices[i + 1]);
  path.delay_s = path.length_m / speed_of_light;
  path.departure = glm::normalize(path.vertices[1] - path.vertices[0]);
  path.arrival = glm::normalize(path.vertices[path.vertices.size() - 2] - path.vertices.back());
  return path;
}

TEST(ResponseGradient, SpheresAboutPatchesAgreeWithDifferences) {
  TestLink test(0, Wavefront::curved, true);
  test.paths = {bent_path({InteractionType::scattering}),
                bent_path({InteractionType::scattering, InteractionType::scattering})};
  LinkTangent tangent = test.no_change();
  for (size_t i = 0; i < 2; ++i) {
    // Both ends move along their rays, so that directions stay.
    PathTangent& path = tangent.paths[i];
    path.transmitter_radius_m = 0.7;
    path.receiver_radius_m = -0.4;
    path.slope.length_m = 0.3;
  }
  Values found(test.gradient().size());
  test.gradient().push_forward({&tangent, 1}, found);
  const Values expected = numeric_slope([&](double by) { return test.moved(tangent, by).response(); }, 2e-3);
  EXPECT_LT(relative_error(found, expected), agreement);
  Values loss(found.size(), Complex(0.3, -0.8));
  double sum = 0.0;
  for (size_t i = 0; i < found.size(); ++i) sum += (std::conj(loss[i]) * found[i]).real();
  EXPECT_NEAR(test.gradient().pull_back(loss).along(tangent), sum, 1e-10 * std::abs(sum));
}

TEST(ResponseGradient, AnImageTurnsWithItsAntenna) {
  TestLink test(0, Wavefront::curved, false);
  test.paths = {
      bent_path({InteractionType::reflection, InteractionType::transmission, InteractionType::reflection}),
      bent_path({InteractionType::diffraction})};
  LinkTangent tangent = test.no_change();
  tangent.transmitter.attitude = {0.4, 0.9, -0.3};
  tangent.receiver.attitude = {-0.5, 0.1, 0.8};
  Values found(test.gradient().size());
  test.gradient().push_forward({&tangent, 1}, found);
  const Values expected = numeric_slope([&](double by) { return test.moved(tangent, by).response(); }, 2e-3);
  EXPECT_LT(relative_error(found, expected), agreement);
}

TEST(ResponseGradient, OnePathTurnsWithItsLength) {
  // dH/dL = -j 2 pi (f_c + f)/c H
  const Path path = plain_path(1e-7, {0.3, 0.4});
  const ChannelGrid grid{28e9, 1e6, 9, 1, 1e-3};
  const ResponseGradient gradient({{&path, 1}, antenna(), antenna()}, grid);
  LinkTangent tangent;
  tangent.paths.resize(1);
  tangent.paths[0].slope.length_m = 1.0;
  Values change(gradient.size());
  gradient.push_forward({&tangent, 1}, change);
  const Values h = gradient.response();
  for (uint32_t k = 0; k < 9; ++k) {
    const double f = grid.carrier_hz + grid.subcarrier_number(k) * grid.subcarrier_spacing_hz;
    const Complex expected = Complex(0.0, -2.0 * pi * f / speed_of_light) * h[k];
    EXPECT_LT(std::abs(change[k] - expected), 1e-14 * std::abs(expected)) << k;
  }
}

TEST(ResponseGradient, NoPathHasNoGradient) {
  const ChannelGrid grid{3.5e9, 1e6, 9, 1, 1e-3};
  const ResponseGradient gradient({{}, antenna(), antenna()}, grid);
  const Values h = gradient.response();
  EXPECT_EQ(h, Values(9));
  const LinkCotangent cotangent = gradient.pull_back(Values(9, 1.0));
  EXPECT_TRUE(cotangent.paths.empty());
  EXPECT_EQ(cotangent.carrier_hz, 0.0);
  const LinkTangent tangent;
  Values change(9);
  gradient.push_forward({&tangent, 1}, change);
  EXPECT_EQ(change, Values(9));
}

TEST(ResponseGradient, SelectedPathsAloneCount) {
  TestLink test(6, Wavefront::plane, false);
  for (size_t i = 1; i < 6; ++i) test.paths[i].interactions.push_back({});
  LinkTangent tangent = tangents_of(test).back().second;
  const auto change = [&](PathSelection selection) {
    Values out(test.gradient().size());
    test.gradient(selection).push_forward({&tangent, 1}, out);
    return out;
  };
  Values sum = change(PathSelection::line_of_sight);
  const Values others = change(PathSelection::others), all = change(PathSelection::all);
  for (size_t i = 0; i < sum.size(); ++i) sum[i] += others[i];
  EXPECT_LT(relative_error(sum, all), 1e-13);
  const LinkCotangent cotangent =
      test.gradient(PathSelection::others).pull_back(Values(all.size(), Complex(1.0, 2.0)));
  EXPECT_EQ(cotangent.paths[0].length_m, 0.0);
  EXPECT_NE(cotangent.paths[1].length_m, 0.0);
}

TEST(ResponseGradient, GainsAndSlantsScaleTheResponse) {
  TestLink test(5, Wavefront::plane, false);
  const Values h = frequency_response_fp64(test.paths, test.transmitter, test.receiver, test.grid);
  const Values gained = test.response();
  const size_t per_pair = test.grid.size_per_pair();
  for (size_t i = 0; i < h.size(); ++i) {
    const size_t pair = i / per_pair;
    EXPECT_EQ(gained[i], h[i] * (test.receiver_gains[pair / 4] * test.transmitter_gains[pair % 4]));
  }
  ResponseLink link = test.link();
  link.receiver_slants = {test.receiver.array.single_slant};
  link.transmitter_slants = {0.0, 0.5 * pi};
  EXPECT_LT(relative_error(ResponseGradient(link, test.grid).response(), gained), 1e-14);
}

TEST(ResponseGradient, PowersAndSpreadsAgreeWithDifferences) {
  TestLink test(7, Wavefront::plane, false);
  for (const auto& [name, tangent] : tangents_of(test)) {
    const PowerSlopes found = power_slopes(test.link(), test.grid.carrier_hz, {&tangent, 1});
    const auto powers = [&](double by) {
      const TestLink moved = test.moved(tangent, by);
      const PowerSlopes slopes = power_slopes(moved.link(), moved.grid.carrier_hz, {});
      return Values(slopes.powers.begin(), slopes.powers.end());
    };
    const Values expected = numeric_slope(powers, 2e-3);
    EXPECT_LT(relative_error(Values(found.slopes.begin(), found.slopes.end()), expected), agreement) << name;

    std::vector<double> delays, delay_changes;
    for (size_t i = 0; i < test.paths.size(); ++i) {
      delays.push_back(test.paths[i].delay_s);
      delay_changes.push_back(tangent.paths[i].slope.length_m / speed_of_light);
    }
    const DelaySlopes slopes = delay_slopes(found.powers, found.slopes, delays, delay_changes);
    const auto statistics = [&](double by) {
      const TestLink moved = test.moved(tangent, by);
      const LinkStatistics of =
          link_statistics(moved.paths, power_slopes(moved.link(), moved.grid.carrier_hz, {}).powers);
      return Values{of.path_gain, of.mean_delay_s, of.delay_spread_s};
    };
    const Values numeric = numeric_slope(statistics, 2e-3), value = statistics(0.0);
    const double exact[] = {slopes.path_gain, slopes.mean_delay_s, slopes.delay_spread_s};
    for (size_t i = 0; i < 3; ++i)
      EXPECT_LT(std::abs(exact[i] - numeric[i]), 1e-7 * std::abs(numeric[i]) + 1e-12 * std::abs(value[i]))
          << name << " " << i;
  }
  // Without gains the powers are those of path_powers().
  test.transmitter_gains.clear(), test.receiver_gains.clear();
  const std::vector<double> expected =
      path_powers(test.paths, test.transmitter, test.receiver, test.grid.carrier_hz);
  const std::vector<double> powers = power_slopes(test.link(), test.grid.carrier_hz, {}).powers;
  for (size_t i = 0; i < powers.size(); ++i) EXPECT_NEAR(powers[i], expected[i], 1e-13 * expected[i]);
}

TEST(ResponseGradient, KernelsGiveTheSameBits) {
  if (cotangent_sums_avx2() == nullptr) GTEST_SKIP() << "no AVX2";
  RandomStream random(3, 3);
  std::vector<double> g(48), p(48), f(24);
  for (std::vector<double>* values : {&g, &p, &f})
    for (double& value : *values) value = random.uniform(-1, 1);
  const CotangentSums a = cotangent_sums_generic(g.data(), p.data(), f.data(), 3),
                      b = cotangent_sums_avx2()(g.data(), p.data(), f.data(), 3);
  EXPECT_EQ(a.plain, b.plain);
  EXPECT_EQ(a.by_frequency, b.by_frequency);
}

TEST(ElementSlopes, AgreeWithDifferencesForEveryPattern) {
  RandomStream random(4, 4);
  const double slants[] = {0.4, -1.2};
  const dquat orientation = glm::normalize(dquat(0.7, 0.3, -0.5, 0.2));
  for (const Pattern shape : {Pattern::isotropic, Pattern::short_dipole, Pattern::half_wave_dipole,
                              Pattern::tr38901, Pattern::imported})
    for (const PolarizationModel model : {PolarizationModel::model_1, PolarizationModel::model_2}) {
      const ElementPattern pattern(shape, model, shape == Pattern::imported ? measured_table() : nullptr);
      const auto fields = [&](const dvec3& k, const dquat& attitude, double slant) {
        const double both[] = {slants[0] + slant, slants[1] + slant};
        std::vector<Jones> jones(2);
        TurnedElement(pattern, both, attitude).respond(k, jones);
        return Values{jones[0].theta, jones[0].phi, jones[1].theta, jones[1].phi};
      };
      for (int n = 0; n < 12; ++n) {
        const dvec3 k =
            glm::normalize(dvec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)));
        std::array<FieldSlopes, 2> found;
        ElementSlopes(pattern, slants, orientation).at(k, found);
        EXPECT_LT(relative_error(
                      {found[0].field.theta, found[0].field.phi, found[1].field.theta, found[1].field.phi},
                      fields(k, orientation, 0.0)),
                  1e-15);
        const auto check = [&](const char* what, const auto& slope_of, const auto& moved) {
          Values slopes;
          for (const FieldSlopes& of : found) {
            const Jones slope = slope_of(of);
            slopes.insert(slopes.end(), {slope.theta, slope.phi});
          }
          EXPECT_LT(relative_error(slopes, numeric_slope(moved, 1e-4)), agreement)
              << what << " of pattern " << static_cast<int>(shape) << ", model " << static_cast<int>(model);
        };
        for (int x = 0; x < 3; ++x) {
          dvec3 axis(0.0);
          axis[x] = 1.0;
          const dvec3 along = axis - k[x] * k;
          check(
              "direction",
              [&](const FieldSlopes& of) {
                Jones sum;
                for (int y = 0; y < 3; ++y)
                  sum.theta += of.by_direction[static_cast<size_t>(y)].theta * along[y],
                      sum.phi += of.by_direction[static_cast<size_t>(y)].phi * along[y];
                return sum;
              },
              [&](double by) { return fields(glm::normalize(k + by * along), orientation, 0.0); });
          check(
              "attitude", [&](const FieldSlopes& of) { return of.by_attitude[static_cast<size_t>(x)]; },
              [&](double by) { return fields(k, turned(orientation, by * axis), 0.0); });
        }
        check(
            "slant", [](const FieldSlopes& of) { return of.by_slant; },
            [&](double by) { return fields(k, orientation, by); });
      }
    }
}

TEST(ElementSlopes, AtThePoleTheFieldVectorHasItsDerivative) {
  // Towards the zenith the basis has no derivative, but the field vector of a tilted dipole has one.
  const dquat orientation = glm::angleAxis(0.6, glm::normalize(dvec3(1.0, 0.4, 0.0)));
  const double slants[] = {0.0};
  const ElementPattern pattern(Pattern::short_dipole);
  const TurnedElement element(pattern, slants, orientation);
  const auto vector_at = [&](const dvec3& k) {
    Jones jones[1];
    element.respond(k, jones);
    const dvec3 field = jones[0].theta.real() * theta_hat(k) + jones[0].phi.real() * phi_hat(k);
    return Values{field.x, field.y, field.z};
  };
  std::array<FieldSlopes, 1> found;
  ElementSlopes(pattern, slants, orientation).at({0.0, 0.0, 1.0}, found);
  for (const dvec3& along : {dvec3(1.0, 0.0, 0.0), dvec3(0.0, 1.0, 0.0), dvec3(0.6, -0.8, 0.0)}) {
    Jones slope;
    for (int x = 0; x < 3; ++x)
      slope.theta += found[0].by_direction[static_cast<size_t>(x)].theta * along[x],
          slope.phi += found[0].by_direction[static_cast<size_t>(x)].phi * along[x];
    // Carried along, theta-hat = x and phi-hat = y lean over by -(theta-hat . dk) k.
    const double f_theta = found[0].field.theta.real(), f_phi = found[0].field.phi.real();
    const Values expected = {slope.theta.real(), slope.phi.real(), -(f_theta * along.x + f_phi * along.y)};
    const Values numeric = numeric_slope(
        [&](double by) { return vector_at(glm::normalize(dvec3(0.0, 0.0, 1.0) + by * along)); }, 1e-3);
    EXPECT_LT(relative_error(expected, numeric), agreement);
  }
}

}  // namespace
}  // namespace greatx::rf
