// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "draw/sheet/companion.h"

#include <algorithm>
#include <string>

namespace greatx::io {

std::optional<Companion> companion(const PanelSource& source, std::string_view kind,
                                   std::initializer_list<const char*> arrays) {
  const std::vector<SensorSpec>& sensors = source.records.sensors();
  for (size_t i = 0; i < sensors.size(); ++i) {
    if (sensors[i].kind != kind || node_of(sensors[i]) != node_of(source.spec()) ||
        !has_arrays(sensors[i], std::span(arrays.begin(), arrays.size())))
      continue;
    Companion found{{source.records, source.sequence, i, {}}, {}, {}};
    found.from_first = mount_of(found.source).inverse() * mount_of(source);
    const std::vector<IndexRow> records = source.records.records_of(source.sequence, i);
    for (const IndexRow& row : source.chosen) {
      const auto at = std::find_if(records.begin(), records.end(),
                                   [&](const IndexRow& other) { return other.tick == row.tick; });
      found.rows.push_back(at == records.end() ? std::nullopt : std::optional(*at));
    }
    if (std::any_of(found.rows.begin(), found.rows.end(), [](const auto& row) { return row.has_value(); }))
      return found;
  }
  return std::nullopt;
}

}  // namespace greatx::io
