// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Writes the index of a campaign: index.sqlite with the tables `records`, a row for each record, and `links`,
// a row for each link of a record of a channel; and index.csv, which holds `records` with the first link.
// docs/campaigns.md lists the columns.
#pragma once

#include <cstdint>

#include "apps/campaign/store.h"

namespace greatx::apps {

/// Writes the index of the cells that are merged. Returns the number of records.
uint64_t write_index(const OpenCampaign& open, bool quiet);

}  // namespace greatx::apps
