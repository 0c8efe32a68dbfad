// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/selftest/catalogue.h"

#include <algorithm>

#include "core/error.h"
#include "core/watch.h"

namespace greatx::apps::selftest {

std::vector<Case> catalogue() {
  std::vector<Case> all;
  for (const auto part : {ray_cases(), mesh_cases(), path_cases(), surface_cases(), channel_cases(),
                          edge_cases(), antenna_cases(), sensor_cases(), radar_cases(), time_cases()})
    all.insert(all.end(), part.begin(), part.end());
  std::ranges::stable_sort(all, {}, &Case::number);
  return all;
}

void run(const Case& item, const Lab& lab, std::vector<Row>& rows) {
  Rows taker(item.number, item.title, rows);
  checkpoint();
  try {
    item.run(lab, taker);
  } catch (const Interrupted&) {
    throw;
  } catch (const std::exception& error) {
    taker.add_error(error.what());
  }
}

}  // namespace greatx::apps::selftest
