// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "draw/sheet/animation.h"

#include <cstdlib>
#include <memory>
#include <webp/demux.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/formats/webp.h"
#include "tests/io/sample_set.h"
#include "tests/support/temporary_folder.h"

namespace greatx::io {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

struct Decoded {
  WebPAnimInfo info{};
  std::vector<int> end_ms;  ///< end of each frame, ms
  std::vector<Array> rgb;
};

/// Decodes an animation by libwebp's own decoder.
Decoded decode(const Bytes& file) {
  const WebPData data{reinterpret_cast<const uint8_t*>(file.data()), file.size()};
  const std::unique_ptr<WebPAnimDecoder, void (*)(WebPAnimDecoder*)> decoder(
      WebPAnimDecoderNew(&data, nullptr), WebPAnimDecoderDelete);
  Decoded decoded;
  if (decoder == nullptr) return decoded;
  WebPAnimDecoderGetInfo(decoder.get(), &decoded.info);
  uint8_t* rgba = nullptr;
  int end_ms = 0;
  while (WebPAnimDecoderGetNext(decoder.get(), &rgba, &end_ms)) {
    decoded.end_ms.push_back(end_ms);
    Array& rgb = decoded.rgb.emplace_back(
        DType::u8, std::vector<int64_t>{decoded.info.canvas_height, decoded.info.canvas_width, 3});
    const std::span<uint8_t> to = rgb.as<uint8_t>();
    for (size_t i = 0; i < to.size(); ++i) to[i] = rgba[i / 3 * 4 + i % 3];
  }
  return decoded;
}

double mean_difference(const Array& a, const Array& b) {
  if (a.shape != b.shape) return 255.0;
  double sum = 0.0;
  for (size_t i = 0; i < a.bytes.size(); ++i) sum += std::abs(a.as<uint8_t>()[i] - b.as<uint8_t>()[i]);
  return sum / static_cast<double>(a.bytes.size());
}

std::string error_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const UserError& error) {
    return error.what();
  }
  return "";
}

/// Flat colours survive lossy coding at their places and times, in an animation that repeats for ever.
TEST(Webp, KeepsColoursAndTimes) {
  const uint8_t colors[3][3] = {{200, 40, 30}, {20, 160, 60}, {90, 90, 220}};
  WebpAnimator animator(32, 16);
  const int starts[] = {0, 40, 130};
  for (int f = 0; f < 3; ++f) {
    Array rgb(DType::u8, {16, 32, 3});
    for (size_t i = 0; i < rgb.bytes.size(); ++i) rgb.as<uint8_t>()[i] = colors[f][i % 3];
    animator.add(rgb, starts[f]);
  }
  const Decoded decoded = decode(animator.finish(200));
  EXPECT_EQ(decoded.info.canvas_width, 32u);
  EXPECT_EQ(decoded.info.canvas_height, 16u);
  EXPECT_EQ(decoded.info.loop_count, 0u) << "0: for ever";
  ASSERT_THAT(decoded.end_ms, ElementsAre(40, 130, 200));
  for (size_t f = 0; f < 3; ++f)
    for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(decoded.rgb[f].as<uint8_t>()[3 * 200 + c], colors[f][c], 6);
}

TEST(Animation, PlaysAtItsOwnSpeedOrTenASecond) {
  const auto every = [](int64_t ns, int64_t count) {
    std::vector<SheetMoment> moments;
    for (int64_t i = 0; i < count; ++i) moments.push_back({5 + i, 1'000'000'000 + i * ns});
    return playback_of(moments);
  };
  EXPECT_THAT(every(33'333'333, 4).start_ms, ElementsAre(0, 33, 67, 100));
  EXPECT_EQ(every(33'333'333, 4).end_ms, 133);
  EXPECT_EQ(every(33'333'333, 4).speed, 1.0);
  EXPECT_THAT(every(1'000'000, 3).start_ms, ElementsAre(0, 100, 200)) << "too fast to see";
  EXPECT_DOUBLE_EQ(every(1'000'000, 3).speed, 0.01);
  EXPECT_THAT(every(500'000'000, 3).start_ms, ElementsAre(0, 100, 200)) << "too slow to watch";
  EXPECT_DOUBLE_EQ(every(500'000'000, 3).speed, 5.0);
  EXPECT_EQ(every(1, 1).end_ms, 100);
}

TEST(Animation, PlaysAtTheWishedRate) {
  std::vector<SheetMoment> moments;
  for (int64_t i = 0; i < 4; ++i) moments.push_back({i, i * 100'000'000});
  const Playback playback = playback_of(moments, 30.0);
  EXPECT_THAT(playback.start_ms, ElementsAre(0, 33, 67, 100));
  EXPECT_EQ(playback.end_ms, 133);
  EXPECT_DOUBLE_EQ(playback.speed, 3.0);
  EXPECT_THAT(playback_of(moments, 0.5).start_ms, ElementsAre(0, 2000, 4000, 6000));
}

class AnimationOfSample : public SampleSet {};

/// The camera at 30 Hz has three frames in 70 ms, and the animation shows all of them: four pictures, the
/// trajectories and the channel, three by two.
TEST_F(AnimationOfSample, ShowsWhatThePanelsShow) {
  const DatasetReader reader(set_);
  const AnimationFile written = write_animation(reader, folder_.path() / "first.webp", {}, 1);
  EXPECT_EQ(written.frames, 3u);
  EXPECT_EQ(written.width, 2 * 28 + 3 * 400 + 2 * 14);
  EXPECT_EQ(written.bytes, std::filesystem::file_size(folder_.path() / "first.webp"));

  const Decoded decoded = decode(read_file(folder_.path() / "first.webp"));
  ASSERT_EQ(decoded.rgb.size(), 3u);
  EXPECT_THAT(decoded.end_ms, ElementsAre(33, 67, written.duration_ms)) << "ticks of 1 kHz: 0, 33, 67";
  EXPECT_EQ(decoded.info.canvas_width, static_cast<uint32_t>(written.width));
  EXPECT_EQ(decoded.info.canvas_height, static_cast<uint32_t>(written.height));
  const Animation animation(reader, {}, 1);
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_LT(mean_difference(decoded.rgb[i], animation.frame(i)), 6.0) << i;
    EXPECT_GT(mean_difference(decoded.rgb[i], animation.frame((i + 1) % 3)), 12.0) << i;
  }
  write_animation(reader, folder_.path() / "again" / "x.webp", {}, 1);
  EXPECT_EQ(read_file(folder_.path() / "again" / "x.webp"), read_file(folder_.path() / "first.webp"));
}

TEST_F(AnimationOfSample, ShowsChosenSensorsAlone) {
  const DatasetReader reader(set_);
  AnimationOptions options;
  options.sheet.sensors = {"uav/lidar"};
  EXPECT_EQ(Animation(reader, options).width(), 2 * 28 + 400);
  options.sheet.sensors = {"uav/lidar", "poses"};
  options.sheet.factor = 2;
  EXPECT_EQ(Animation(reader, options).width(), 2 * (2 * 28 + 2 * 400 + 14)) << "a picture and a plot";
  options.sheet.sensors = {"uav"};
  options.sheet.factor = 1;
  EXPECT_EQ(Animation(reader, options).width(), 2 * 28 + 2 * 400 + 14);
  options.sheet.sensors = {"uav/lidra"};
  EXPECT_THAT(error_of([&] { Animation(reader, options); }),
              HasSubstr("expected the name of a sensor, a channel or a node, found 'uav/lidra'"));
}

TEST_F(AnimationOfSample, TakesSoManyFramesFromFirstToLast) {
  const DatasetReader reader(set_);
  const std::vector<size_t> all = shown_sensors(reader, {});
  EXPECT_EQ(Animation(reader, {.frames = 2}).frames(), 2u);
  EXPECT_EQ(Animation(reader, {.frames = 2}).frame(1).bytes.size(),
            Animation(reader, {.frames = 3}).frame(2).bytes.size());
  EXPECT_EQ(choose_moments(reader, 0, all, 2).back().tick, choose_moments(reader, 0, all, 3).back().tick);
  EXPECT_EQ(choose_moments(reader, 0, all, 1).size(), 1u);
  write_animation(reader, folder_.path() / "one.webp", {.frames = 1});
  EXPECT_EQ(decode(read_file(folder_.path() / "one.webp")).rgb.size(), 1u);
}

TEST_F(AnimationOfSample, BadInputIsNamed) {
  const DatasetReader reader(set_);
  EXPECT_THAT(error_of([&] { write_animation(reader, folder_.path() / "x.gif", {}); }),
              HasSubstr("x.gif: expected a name that ends in .webp"));
  EXPECT_THAT(error_of([&] { write_animation(reader, folder_.path() / "x.webp", {.frames = 0}); }),
              HasSubstr("1 frame or more, found 0"));
  EXPECT_THAT(error_of([&] { write_animation(reader, folder_.path() / "x.webp", {}, 2); }),
              HasSubstr("sequence 2 has no records"));
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "x.webp"));
}

TEST(Animation, NeedsASensorThatIsDrawnMomentByMoment) {
  const test::TemporaryFolder folder;
  DatasetInfo info = sample_info();
  info.sensors = {info.sensors[3]};
  {
    DatasetWriter writer(folder.path(), info);
    writer.begin_sequence(0);
    for (int64_t tick = 0; tick < 3; ++tick) {
      Packet packet = sample_packet(sample_info(), 0, tick);
      std::erase_if(packet.records, [](const Record& record) { return record.sensor != 3; });
      for (Record& record : packet.records) record.sensor = 0;
      writer.write(std::move(packet));
    }
    writer.flush();
  }
  EXPECT_THAT(error_of([&] { Animation(DatasetReader(folder.path()), {}); }),
              HasSubstr("nothing to animate"));
}

}  // namespace
}  // namespace greatx::io
