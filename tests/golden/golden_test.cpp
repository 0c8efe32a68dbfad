// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Pictures of one small scene against those kept beside this file (goldens.yaml). Other tests say what is right; these say
// that nothing changed unseen. They are rewritten by
//     cmake --build BUILD --target update-goldens
// alone: look at what changed before it is committed.
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <iostream>

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include "io/canvas.h"
#include "io/file.h"
#include "io/png.h"
#include "tests/golden/pictures.h"
#include "tests/support/flip.h"

namespace greatx::test {
namespace {

const std::filesystem::path folder = GREATX_GOLDEN_FOLDER;      ///< goldens and scenarios
const std::filesystem::path findings = GREATX_GOLDEN_FINDINGS;  ///< what failed, in the build folder

bool updating() { return std::getenv("GREATX_UPDATE_GOLDENS") != nullptr; }

std::string scenario_text(const std::string& name) { return io::read_text_file(folder / (name + ".yaml")); }

Array golden(const std::string& name) {
  const std::filesystem::path file = folder / (name + ".png");
  return io::decode_png(io::read_file(file), file.string());
}

/// How far two pictures are apart by a row's measure, and a picture of where.
struct Comparison {
  double value = 0.0;
  Array where;
};

Comparison compare_by_flip(const Array& expected, const Array& actual) {
  const Flip flipped = flip(expected, actual);
  Comparison result{flipped.mean, Array(DType::u8, expected.shape)};
  for (size_t i = 0; i < flipped.error.size(); ++i) {
    const io::Color color = io::viridis(flipped.error[i]);
    uint8_t* const to = result.where.as<uint8_t>().data() + 3 * i;
    to[0] = color.r, to[1] = color.g, to[2] = color.b;
  }
  return result;
}

template <typename T>
Comparison compare_codes(const Array& expected, const Array& actual, int step) {
  const size_t channels = expected.shape.size() == 3 ? 3 : 1;
  const size_t pixels = expected.as<T>().size() / channels;
  Comparison result{0.0, Array(DType::u8, {expected.shape[0], expected.shape[1]})};
  for (size_t i = 0; i < pixels; ++i)
    for (size_t c = i * channels; c < (i + 1) * channels; ++c)
      if (std::abs(int{expected.as<T>()[c]} - int{actual.as<T>()[c]}) > step)
        result.where.as<uint8_t>()[i] = 255;
  const auto where = result.where.as<uint8_t>();
  result.value =
      static_cast<double>(std::count(where.begin(), where.end(), 255)) / static_cast<double>(pixels);
  return result;
}

Comparison compare(const YAML::Node& row, const Array& expected, const Array& actual) {
  if (row["flip"]) return compare_by_flip(expected, actual);
  const int step = row["step"].as<int>();
  return expected.dtype == DType::u8 ? compare_codes<uint8_t>(expected, actual, step)
                                     : compare_codes<uint16_t>(expected, actual, step);
}

bool same_shape(const Array& a, const Array& b) { return a.dtype == b.dtype && a.shape == b.shape; }

/// What an update changes, in words; a golden that cannot be read is no obstacle.
std::string change(const std::string& name, const YAML::Node& row, const Array& actual) try {
  if (!std::filesystem::exists(folder / (name + ".png"))) return "new";
  const Array before = golden(name);
  if (!same_shape(before, actual)) return "another size";
  if (before.bytes == actual.bytes) return "as it was";
  return fmt::format("changed, {} {:.4f}", row["flip"] ? "FLIP" : "share",
                     compare(row, before, actual).value);
} catch (const UserError& error) {
  return fmt::format("written anew: {}", error.what());
}

void update(const std::string& name, const YAML::Node& row, const Array& actual) {
  const std::string text = change(name, row, actual);
  io::write_file_atomically(folder / (name + ".png"), io::encode_png(actual));
  std::cout << name << ".png: " << text << '\n';
}

void check(const std::string& name, const YAML::Node& row, const Array& actual) {
  for (const char* what : {"_expected.png", "_actual.png", "_difference.png"})
    std::filesystem::remove(findings / (name + what));  // of an earlier run
  const Array expected = golden(name);
  const auto keep = [&](const char* what, const Array& picture) {
    std::filesystem::create_directories(findings);
    io::write_file_atomically(findings / (name + what), io::encode_png(picture));
  };
  if (!same_shape(expected, actual)) {
    keep("_actual.png", actual);
    ADD_FAILURE() << name << ": another size or type than the golden; see " << findings;
    return;
  }
  const Comparison found = compare(row, expected, actual);
  const char* const measure = row["flip"] ? "flip" : "share";
  const double tolerance = row[measure].as<double>();
  if (found.value <= tolerance) return;
  keep("_expected.png", expected);
  keep("_actual.png", actual);
  keep("_difference.png", found.where);
  ADD_FAILURE() << name << ": " << measure << " " << found.value << " > " << tolerance << "; see " << findings
                << "/" << name << "_{expected,actual,difference}.png";
}

void run_rows_of(const std::string& scenario) {
  const KeptRun run = keep_run(scenario_text(scenario));
  size_t rows = 0;
  for (const YAML::Node& row : YAML::LoadFile((folder / "goldens.yaml").string())) {
    if (row["scenario"].as<std::string>() != scenario) continue;
    ++rows;
    const std::string name = row["picture"].as<std::string>();
    const Array actual = picture_of(run, row["tick"].as<int64_t>(), row["sensor"].as<std::string>(),
                                    row["array"].as<std::string>());
    (updating() ? update : check)(name, row, actual);
  }
  EXPECT_GT(rows, 0u);
}

TEST(Golden, Day) { run_rows_of("day"); }
TEST(Golden, Night) { run_rows_of("night"); }
TEST(Golden, Fog) { run_rows_of("fog"); }

double tolerance_of(const std::string& picture) {
  for (const YAML::Node& row : YAML::LoadFile((folder / "goldens.yaml").string()))
    if (row["picture"].as<std::string>() == picture) return row["flip"].as<double>();
  throw std::runtime_error("no row " + picture);
}

TEST(GoldenGuard, SeesThatShadowsAreMissing) {
  if (updating()) GTEST_SKIP() << "goldens are being rewritten";
  const KeptRun run =
      keep_run(scenario_text("day") + "effects: {static_shadows: off, moving_shadows: off}\n");
  EXPECT_GT(flip(golden("rgb_day"), picture_of(run, 1, "uav/front", "rgb")).mean, tolerance_of("rgb_day"));
}

TEST(GoldenGuard, SeesThatThePictureIsLaterOrDarker) {
  if (updating()) GTEST_SKIP() << "goldens are being rewritten";
  const Array day = golden("rgb_day");
  const KeptRun run = keep_run(scenario_text("day"));
  EXPECT_GT(flip(day, picture_of(run, 2, "uav/front", "rgb")).mean, tolerance_of("rgb_day"));
  Array darker = day;
  for (uint8_t& byte : darker.as<uint8_t>()) byte = static_cast<uint8_t>(byte * 9 / 10);
  EXPECT_GT(flip(day, darker).mean, tolerance_of("rgb_day"));
}

}  // namespace
}  // namespace greatx::test
