// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The part of event cameras: the events of a record summed by pixel, ON and OFF apart.
#include <algorithm>

#include "draw/report/parts.h"

namespace greatx::io::report {

namespace {
constexpr int64_t longest_side = 16384;
}

Json describe_events(const PanelSource& source) {
  const JsonDocument metadata = metadata_of(source);
  Json json = Json::object();
  for (const char* const key : {"width", "height"})
    if (metadata.root().has(key)) json[key] = metadata.root().at(key).integer(1, longest_side);
  return json;
}

Json encode_events(const Context& context, const PanelSource& source, const IndexRow& row) {
  Json json = Json::object();
  const JsonDocument metadata = metadata_of(source);
  if (source.has("x") && source.has("y") && source.has("p") && metadata.root().has("width") &&
      metadata.root().has("height")) {
    const int64_t width = metadata.root().at("width").integer(1, longest_side),
                  height = metadata.root().at("height").integer(1, longest_side);
    const Array x = source.load(row, "x", {DType::u16}, {-1}), y = source.load(row, "y", {DType::u16}, {-1}),
                p = source.load(row, "p", {DType::u8}, {-1});
    expect_same_rows(source, {&x, &y, &p});
    const int64_t by = (width + context.detail.value_width - 1) / context.detail.value_width;
    const int64_t columns = (width + by - 1) / by, rows = (height + by - 1) / by;
    std::vector<uint32_t> counts(static_cast<size_t>(2 * rows * columns));
    size_t on = 0;
    for (size_t i = 0; i < p.as<uint8_t>().size(); ++i) {
      const int64_t column = x.as<uint16_t>()[i], line = y.as<uint16_t>()[i];
      if (column >= width || line >= height)
        throw_user_error("{}, tick {}: expected events within {} x {} pixels, found one at ({}, {})",
                         source.place(), row.tick, width, height, column, line);
      const bool up = p.as<uint8_t>()[i] != 0;
      on += up;
      uint32_t& count =
          counts[static_cast<size_t>((up ? 0 : rows * columns) + line / by * columns + column / by)];
      count = std::min(count + 1, 255u);
    }
    if (by > 1)
      context.collected.notes.insert(fmt::format("Events of {} are summed over blocks of {} x {} pixels.",
                                                 printable(source.spec().name), by, by));
    json["counts"] = {{"blob", context.blobs.add(packed(counts, 1, 0))},
                      {"h", rows},
                      {"w", columns},
                      {"by", by},
                      {"on", on},
                      {"off", p.as<uint8_t>().size() - on}};
  }
  if (source.has("difference_picture")) {
    std::set<uint32_t> unused;
    json["difference"] =
        encode_ids(context, source.load(row, "difference_picture", {DType::u8}, {0, 0}), unused);
  }
  return json;
}

}  // namespace greatx::io::report
