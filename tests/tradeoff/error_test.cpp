// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The figures of error against closed forms, on made-up records.
#include <cmath>
#include <complex>
#include <functional>
#include <limits>
#include <map>

#include <gtest/gtest.h>

#include "sim/tradeoff/error/error_sum.h"
#include "sim/tradeoff/error/ssim.h"

namespace greatx::sim {
namespace {

/// A sensor with one record of the given arrays.
struct Made {
  SensorSpec spec;
  Record record;
  explicit Made(const std::string& kind) { spec.kind = kind; }
  template <typename T>
  Made& add(const std::string& name, std::vector<int64_t> shape, const std::vector<T>& values) {
    spec.arrays.push_back({name, DTypeOf<T>::value, shape, "", ""});
    record.arrays.push_back(Array::of<T>(std::move(shape), std::span<const T>(values)));
    return *this;
  }
};

std::map<std::string, double> errors(const Made& reference, const Made& got) {
  const std::unique_ptr<ErrorSum> sum = make_error_sum(reference.spec.kind);
  sum->add(reference.spec, reference.record, got.spec, got.record);
  std::map<std::string, double> values;
  for (const ErrorFigure& figure : sum->figures()) values[figure.name] = figure.value;
  return values;
}
constexpr double infinity = std::numeric_limits<double>::infinity();

Made csi(double scale, const std::vector<uint64_t>& ids, double gain = 1e-8, double spread_s = 10e-9) {
  std::vector<std::complex<float>> h;
  for (int i = 0; i < 64; ++i)
    h.push_back(std::polar(static_cast<float>(scale), 0.1f * static_cast<float>(i)));
  return Made("csi")
      .add("cfr", {64}, h)
      .add("path_gain", {1, 1}, std::vector<double>{gain})
      .add("delay_spread", {1, 1}, std::vector<double>{spread_s})
      .add("id", {static_cast<int64_t>(ids.size())}, ids);
}

TEST(CsiError, ScaledTransferFunction) {
  const auto found = errors(csi(1.0, {1, 2, 3}), csi(1.01, {2, 3, 4}, 2e-8, 12.5e-9));
  EXPECT_NEAR(found.at("nmse"), -40.0, 1e-4);
  EXPECT_NEAR(found.at("path_gain"), 10.0 * std::log10(2.0), 1e-6);
  EXPECT_NEAR(found.at("delay_spread"), 2.5, 1e-6);
  EXPECT_EQ(found.at("links"), 0.0);
  EXPECT_NEAR(found.at("paths"), 50.0, 1e-9);  // 2 of 4 in both
}

TEST(CsiError, EqualAndLostLinks) {
  EXPECT_EQ(errors(csi(1.0, {1}), csi(1.0, {1})).at("nmse"), -infinity);
  const auto lost = errors(csi(1.0, {1}), csi(0.0, {}, 0.0, std::nan("")));
  EXPECT_NEAR(lost.at("nmse"), 0.0, 1e-9);
  EXPECT_EQ(lost.at("links"), 100.0);
  EXPECT_EQ(lost.at("paths"), 100.0);
  EXPECT_FALSE(lost.contains("path_gain"));
  EXPECT_FALSE(lost.contains("delay_spread"));
}

Made camera(int64_t height, int64_t width, const std::function<int(int64_t, int64_t)>& grey, float depth,
            uint16_t id) {
  std::vector<uint8_t> rgb;
  for (int64_t y = 0; y < height; ++y)
    for (int64_t x = 0; x < width; ++x) rgb.insert(rgb.end(), 3, static_cast<uint8_t>(grey(x, y)));
  const auto pixels = static_cast<size_t>(height * width);
  std::vector<float> depths(pixels, depth);
  depths[0] = std::numeric_limits<float>::infinity();
  return Made("camera")
      .add("rgb", {height, width, 3}, rgb)
      .add("depth", {height, width}, depths)
      .add("instance", {height, width}, std::vector<uint16_t>(pixels, id));
}

TEST(CameraError, BlackAgainstWhiteAndDepthPlusAConstant) {
  const auto flat = [](int value) { return [=](int64_t, int64_t) { return value; }; };
  const auto found = errors(camera(24, 32, flat(0), 10.0f, 1), camera(24, 32, flat(255), 10.5f, 2));
  EXPECT_NEAR(found.at("flip"), 0.9674, 2e-4);  // the authors' own program
  // Flat pictures: the means alone, (2 a b + C1) / (a^2 + b^2 + C1) with C1 = (0.01 * 255)^2.
  EXPECT_NEAR(found.at("ssim"), 1.0 - 6.5025 / (255.0 * 255.0 + 6.5025), 1e-9);
  EXPECT_NEAR(found.at("depth"), 0.5, 1e-6);
  EXPECT_NEAR(found.at("depth_p95"), 0.5, 1e-6);
  EXPECT_EQ(found.at("depth_other"), 0.0);
  EXPECT_EQ(found.at("ids"), 100.0);
  const auto same = errors(camera(24, 32, flat(7), 10.0f, 1), camera(24, 32, flat(7), 10.0f, 1));
  for (const auto& [name, value] : same) EXPECT_EQ(value, 0.0) << name;
}

TEST(CameraError, AnotherResolution) {
  const auto ramp = [](int64_t step) {
    return [=](int64_t x, int64_t) { return static_cast<int>(step * x + step / 2); };
  };
  // Half of the pixels of the same ramp: bilinear enlargement gives it back, but for the ends.
  const auto found = errors(camera(32, 48, ramp(4), 10.0f, 1), camera(16, 24, ramp(8), 10.0f, 1));
  EXPECT_LT(found.at("flip"), 0.01);
  EXPECT_GT(found.at("flip"), 0.0);
  EXPECT_EQ(found.at("depth"), 0.0);
  EXPECT_GT(found.at("depth_other"), 0.0);  // one pixel without depth covers four
}

TEST(Ssim, NoiseAgainstFlatIsNearZero) {
  Array a(DType::u8, {64, 64, 3}), b = a;
  uint32_t state = 1;
  for (uint8_t& value : a.as<uint8_t>())
    value = static_cast<uint8_t>((state = state * 1664525u + 1013904223u) >> 24);
  for (uint8_t& value : b.as<uint8_t>()) value = 128;
  EXPECT_LT(ssim(a, b), 0.05);
  EXPECT_NEAR(ssim(a, a), 1.0, 1e-12);
  EXPECT_EQ(ssim(a, b), ssim(b, a));
}

Made events(const std::vector<int64_t>& t, const std::vector<uint16_t>& x, const std::vector<uint8_t>& p) {
  const auto count = static_cast<int64_t>(t.size());
  return Made("event_camera")
      .add("t", {count}, t)
      .add("x", {count}, x)
      .add("y", {count}, std::vector<uint16_t>(x.size(), 3))
      .add("p", {count}, p);
}

TEST(EventError, ShiftedMissingAndTurned) {
  const Made reference = events({0, 1000, 14000, 14000}, {1, 1, 2, 5}, {1, 1, 0, 1});
  // One bin is 1 us. The second event is late by a quarter of it; the last one is missing.
  const auto found = errors(reference, events({0, 1250, 14000}, {1, 1, 2}, {1, 1, 0}));
  EXPECT_NEAR(found.at("voxels"), (0.25 + 0.25 + 1.0) / 4.0, 1e-6);
  EXPECT_NEAR(found.at("count"), 25.0, 1e-9);
  EXPECT_NEAR(found.at("unmatched"), 100.0 / 7.0, 1e-9);
  EXPECT_NEAR(found.at("time"), 0.0, 1e-9);  // of 0, 0.25, 0 us
  EXPECT_NEAR(errors(reference, events({}, {}, {})).at("voxels"), 1.0, 1e-9);
  EXPECT_EQ(errors(reference, reference).at("voxels"), 0.0);
  EXPECT_EQ(errors(events({}, {}, {}), events({}, {}, {})).at("voxels"), 0.0);
  EXPECT_EQ(errors(events({}, {}, {}), reference).at("count"), infinity);
}

// d * (14 / d) in doubles is above 14 for d = 25, 41, 43, ...: the last event must stay in the last bin.
// AddressSanitizer checks that.
TEST(EventError, RoundingKeepsTheLastEventInTheGrid) {
  for (int64_t d = 1; d <= 300; ++d) {
    const Made both = events({7, 7 + d}, {0, 1}, {1, 1});
    EXPECT_NEAR(errors(both, events({7}, {0}, {1})).at("voxels"), 0.5, 1e-6) << d;
  }
}

Made lidar(const std::vector<double>& azimuths, double range) {
  std::vector<float> points, ranges;
  for (const double azimuth : azimuths) {
    const double values[] = {range * std::cos(azimuth), range * std::sin(azimuth), 0.1 * range, 0.5};
    for (const double value : values) points.push_back(static_cast<float>(value));
    ranges.push_back(static_cast<float>(range));
  }
  const auto count = static_cast<int64_t>(azimuths.size());
  return Made("lidar")
      .add("points", {count, 4}, points)
      .add("range", {count}, ranges)
      .add("ring", {count}, std::vector<uint16_t>(azimuths.size(), 4))
      .add("return_number", {count}, std::vector<uint16_t>(azimuths.size(), 1));
}

TEST(LidarError, RangesAndMissingReturns) {
  std::vector<double> all;
  for (int i = 0; i < 1000; ++i) all.push_back(-3.14 + 6.28 * i / 1000.0);
  const std::vector<double> some(all.begin(), all.begin() + 900);
  const auto found = errors(lidar(all, 20.0), lidar(some, 20.25));
  EXPECT_NEAR(found.at("range"), 0.25, 1e-5);
  EXPECT_NEAR(found.at("range_p95"), 0.25, 1e-5);
  EXPECT_NEAR(found.at("missed"), 10.0, 1e-9);
  EXPECT_EQ(errors(lidar(all, 20.0), lidar(all, 20.0)).at("range"), 0.0);
  EXPECT_EQ(errors(lidar(all, 20.0), lidar({}, 20.0)).at("missed"), 100.0);
}

Made radar(float scale, const std::vector<float>& range, const std::vector<float>& power) {
  const auto count = static_cast<int64_t>(range.size());
  Made made("radar");
  made.spec.metadata_json = R"({"range_bin_m": 0.5, "velocity_bin_m_s": 0.3})";
  return made.add("range_doppler", {2, 2}, std::vector<float>{scale, 2 * scale, scale, scale})
      .add("range", {count}, range)
      .add("velocity", {count}, std::vector<float>(range.size(), 1.0f))
      .add("power", {count}, power);
}

TEST(RadarError, MapAndDetections) {
  const auto found = errors(radar(1.0f, {10.0f, 20.0f, 40.0f}, {-90.0f, -80.0f, -85.0f}),
                            radar(1.1f, {10.2f, 20.0f, 60.0f, 61.0f}, {-88.5f, -80.5f, -99.0f, -99.0f}));
  EXPECT_NEAR(found.at("map"), -10.0, 1e-5);
  EXPECT_NEAR(found.at("missed"), 100.0 / 3.0, 1e-9);
  EXPECT_NEAR(found.at("false"), 200.0 / 3.0, 1e-9);
  EXPECT_NEAR(found.at("power"), 1.5, 1e-5);  // the upper one of 0.5 and 1.5
  EXPECT_EQ(errors(radar(1.0f, {}, {}), radar(1.0f, {}, {})).at("map"), -infinity);
}

TEST(ErrorSum, ArraysThatOneSideLacksAreLeftOut) {
  for (const char* const kind : {"csi", "camera", "event_camera", "lidar", "radar"})
    EXPECT_TRUE(errors(Made(kind), csi(1.0, {1})).empty()) << kind;
  EXPECT_EQ(make_error_sum("pose"), nullptr);
}

TEST(ErrorSum, ManySamplesStayBounded) {
  const std::unique_ptr<ErrorSum> sum = make_error_sum("camera");
  const auto flat = [](int64_t, int64_t) { return 5; };
  const Made reference = camera(512, 512, flat, 10.0f, 1), other = camera(512, 512, flat, 11.0f, 1);
  for (int i = 0; i < 10; ++i) sum->add(reference.spec, reference.record, other.spec, other.record);
  for (const ErrorFigure& figure : sum->figures())
    if (figure.name == "depth_p95") {
      EXPECT_NEAR(figure.value, 1.0, 1e-6);
    }
}

}  // namespace
}  // namespace greatx::sim
