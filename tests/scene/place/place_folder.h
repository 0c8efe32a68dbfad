// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Writes places into a temporary folder and reads them.
#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>

#include "core/error.h"
#include "scene/place/config/place_config.h"
#include "scene/place/source/source.h"
#include "tests/support/temporary_folder.h"

namespace greatx::scene::place::test {

class PlaceFolder {
 public:
  std::filesystem::path write(const std::string& name, const std::string& content) const {
    const std::filesystem::path file = folder_.path() / name;
    std::ofstream(file, std::ios::binary) << content;
    return file;
  }
  std::filesystem::path path(const std::string& name) const { return folder_.path() / name; }
  /// Writes place.yaml, with its first line, and loads it.
  PlaceConfig load(const std::string& yaml) const {
    return load_place_config(write("place.yaml", "greatx_place: 1\n" + yaml));
  }
  PlaceInput read(const std::string& yaml) const { return read_place(load(yaml)); }

 private:
  greatx::test::TemporaryFolder folder_;
};

inline std::string message_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const UserError& error) {
    return error.what();
  }
  return "no error";
}

inline const Feature* find_feature(const PlaceInput& input, const std::string& id) {
  const auto found = std::ranges::find(input.features, id, &Feature::id);
  return found != input.features.end() ? &*found : nullptr;
}

inline std::vector<Finding> findings_of(const PlaceInput& input, const std::string& topic) {
  std::vector<Finding> found;
  for (const Finding& finding : input.findings)
    if (finding.topic == topic) found.push_back(finding);
  return found;
}

/// Returns the area of a ring, m2.
inline double area_of(const Ring& ring) {
  double twice = 0.0;
  for (size_t i = 0, before = ring.size() - 1; i < ring.size(); before = i++)
    twice += ring[before].x * ring[i].y - ring[before].y * ring[i].x;
  return std::abs(twice) / 2.0;
}

/// Returns an ESRI ASCII grid whose heights are `height(column, row)`, row 0 in the north.
inline std::string ascii_grid(int columns, int rows, double left, double bottom, double cell,
                              const std::function<std::string(int, int)>& height) {
  std::string text =
      fmt::format("ncols {}\nnrows {}\nxllcorner {}\nyllcorner {}\ncellsize {}\nNODATA_value -9999\n",
                  columns, rows, left, bottom, cell);
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) text += height(column, row) + " ";
    text += "\n";
  }
  return text;
}

}  // namespace greatx::scene::place::test
