// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Compares pictures of one small scene with the pictures beside this file (goldens.yaml). Other tests check
// that results are right; these tests check that no result changes unnoticed. Only
//     cmake --build BUILD --target update-goldens
// rewrites the pictures. Look at the changes before you commit them.
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <vector>

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include "draw/canvas/canvas.h"
#include "io/files/file.h"
#include "io/formats/png.h"
#include "sim/tradeoff/error/flip.h"
#include "tests/golden/pictures.h"
#include "tests/support/gpu_fixture.h"

namespace greatx::test {
namespace {

const std::filesystem::path folder = GREATX_GOLDEN_FOLDER;  ///< goldens and scenarios
const std::filesystem::path findings =
    GREATX_GOLDEN_FINDINGS;  ///< pictures of failed comparisons, in the build folder

bool updating() { return std::getenv("GREATX_UPDATE_GOLDENS") != nullptr; }

std::string scenario_text(const std::string& name) { return io::read_text_file(folder / (name + ".yaml")); }

Array golden(const std::string& name) {
  const std::filesystem::path file = folder / (name + ".png");
  return io::decode_png(io::read_file(file), file.string());
}

/// Holds the difference of two pictures by the measure of a row, and a picture of the places that differ.
struct Comparison {
  double value = 0.0;
  Array where;
  size_t foreign = 0;  ///< ids that do not occur around their pixel in the golden; every one is a failure
};

Comparison compare_by_flip(const Array& expected, const Array& actual) {
  const sim::Flip flipped = sim::flip(expected, actual);
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

/// Compares ids. A pixel at an outline has another id among its eight neighbours in the golden and may have
/// any of these ids. All other pixels must have exactly the id of the golden.
template <typename T>
Comparison compare_ids(const Array& expected, const Array& actual) {
  const int64_t height = expected.shape[0], width = expected.shape[1];
  Comparison result{0.0, Array(DType::u8, {height, width})};
  const auto near = [&](T id, int64_t row, int64_t column) {
    for (int64_t r = std::max<int64_t>(row - 1, 0); r <= std::min(row + 1, height - 1); ++r)
      for (int64_t c = std::max<int64_t>(column - 1, 0); c <= std::min(column + 1, width - 1); ++c)
        if (expected.as<T>()[static_cast<size_t>(r * width + c)] == id) return true;
    return false;
  };
  size_t different = 0;
  for (int64_t row = 0; row < height; ++row)
    for (int64_t column = 0; column < width; ++column) {
      const auto pixel = static_cast<size_t>(row * width + column);
      const T id = actual.as<T>()[pixel];
      if (id == expected.as<T>()[pixel]) continue;
      ++different;
      const bool at_outline = near(id, row, column);
      if (!at_outline) ++result.foreign;
      result.where.as<uint8_t>()[pixel] = at_outline ? 128 : 255;
    }
  result.value = static_cast<double>(different) / static_cast<double>(width * height);
  return result;
}

/// Returns the measure of a row; each row has exactly one.
std::string measure_of(const YAML::Node& row) {
  for (const char* measure : {"flip", "ids", "share"})
    if (row[measure]) return measure;
  throw std::runtime_error("a row of goldens.yaml has no measure");
}

Comparison compare(const YAML::Node& row, const Array& expected, const Array& actual) {
  const std::string measure = measure_of(row);
  if (measure == "flip") return compare_by_flip(expected, actual);
  if (measure == "ids")
    return expected.dtype == DType::u8 ? compare_ids<uint8_t>(expected, actual)
                                       : compare_ids<uint16_t>(expected, actual);
  const int step = row["step"].as<int>();
  return expected.dtype == DType::u8 ? compare_codes<uint8_t>(expected, actual, step)
                                     : compare_codes<uint16_t>(expected, actual, step);
}

bool within_tolerance(const YAML::Node& row, const Comparison& found) {
  const YAML::Node elsewhere = row["without_texture_table"];
  const bool here = !elsewhere || device().info().has_texture_table();
  return found.foreign == 0 && found.value <= (here ? row[measure_of(row)] : elsewhere).as<double>();
}

bool same_shape(const Array& a, const Array& b) { return a.dtype == b.dtype && a.shape == b.shape; }

/// Describes the change by an update in words. An unreadable golden is no error.
std::string change(const std::string& name, const YAML::Node& row, const Array& actual) try {
  if (!std::filesystem::exists(folder / (name + ".png"))) return "new";
  const Array before = golden(name);
  if (!same_shape(before, actual)) return "another size";
  if (before.bytes == actual.bytes) return "as it was";
  return fmt::format("changed, {} {:.4f}", measure_of(row), compare(row, before, actual).value);
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
    std::filesystem::remove(findings / (name + what));  // files of an earlier run
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
  if (within_tolerance(row, found)) return;
  keep("_expected.png", expected);
  keep("_actual.png", actual);
  keep("_difference.png", found.where);
  const std::string measure = measure_of(row);
  ADD_FAILURE() << name << ": " << measure << " " << found.value << " (at most " << row[measure] << "), "
                << found.foreign << " foreign ids; see " << findings << "/" << name
                << "_{expected,actual,difference}.png";
}

std::vector<YAML::Node> rows_of(const std::string& scenario) {
  std::vector<YAML::Node> rows;
  for (const YAML::Node& row : YAML::LoadFile((folder / "goldens.yaml").string()))
    if (row["scenario"].as<std::string>() == scenario) rows.push_back(row);
  return rows;
}

std::string name_of(const YAML::Node& row) { return row["picture"].as<std::string>(); }

Array picture_of(const KeptRun& run, const YAML::Node& row, int64_t later = 0) {
  return picture_of(run, row["tick"].as<int64_t>() + later, row["sensor"].as<std::string>(),
                    row["array"].as<std::string>());
}

void run_rows_of(const std::string& scenario) {
  const KeptRun run = keep_run(scenario_text(scenario));
  const std::vector<YAML::Node> rows = rows_of(scenario);
  for (const YAML::Node& row : rows) (updating() ? update : check)(name_of(row), row, picture_of(run, row));
  EXPECT_FALSE(rows.empty());
}

TEST(Golden, Day) { run_rows_of("day"); }
TEST(Golden, Night) { run_rows_of("night"); }
TEST(Golden, Fog) { run_rows_of("fog"); }

YAML::Node row_of(const std::string& picture) {
  for (const YAML::Node& row : rows_of("day"))
    if (name_of(row) == picture) return row;
  throw std::runtime_error("no row " + picture);
}

TEST(GoldenGuard, SeesThatShadowsAreMissing) {
  if (updating()) GTEST_SKIP() << "goldens are being rewritten";
  const YAML::Node row = row_of("rgb_day");
  const KeptRun run =
      keep_run(scenario_text("day") + "effects: {static_shadows: off, moving_shadows: off}\n");
  EXPECT_FALSE(within_tolerance(row, compare(row, golden("rgb_day"), picture_of(run, row))));
}

TEST(GoldenGuard, EveryKindSeesThatItIsLater) {
  if (updating()) GTEST_SKIP() << "goldens are being rewritten";
  const KeptRun run = keep_run(scenario_text("day"));
  for (const YAML::Node& row : rows_of("day")) {
    const Array expected = golden(name_of(row)), later = picture_of(run, row, 1);
    EXPECT_FALSE(within_tolerance(row, compare(row, expected, later))) << name_of(row);
  }
}

TEST(GoldenGuard, SeesThatThePictureIsDarker) {
  if (updating()) GTEST_SKIP() << "goldens are being rewritten";
  const Array day = golden("rgb_day");
  Array darker = day;
  for (uint8_t& byte : darker.as<uint8_t>()) byte = static_cast<uint8_t>(byte * 9 / 10);
  const YAML::Node row = row_of("rgb_day");
  EXPECT_FALSE(within_tolerance(row, compare(row, day, darker)));
}

TEST(GoldenGuard, IdsDifferAtOutlinesAlone) {
  Array ids(DType::u8, {20, 40});  // 1 on the left, 2 on the right
  for (size_t i = 0; i < 800; ++i) ids.as<uint8_t>()[i] = i % 40 < 20 ? 1 : 2;
  const YAML::Node row = YAML::Load("{ids: 0.005}");
  const auto passes = [&](std::initializer_list<size_t> pixels, uint8_t id) {
    Array other = ids;
    for (const size_t pixel : pixels) other.as<uint8_t>()[pixel] = id;
    return within_tolerance(row, compare(row, ids, other));
  };
  EXPECT_TRUE(passes({}, 0));
  EXPECT_TRUE(passes({5 * 40 + 19, 6 * 40 + 19, 8 * 40 + 19, 9 * 40 + 19}, 2));  // 4 of 800
  EXPECT_FALSE(passes({19, 59, 99, 139, 179}, 2));                               // more than 0.5 %
  EXPECT_FALSE(passes({5 * 40 + 19}, 3));                                        // an id that does not exist
  EXPECT_FALSE(passes({5 * 40 + 18}, 2));  // the neighbour of an outline pixel
}

}  // namespace
}  // namespace greatx::test
