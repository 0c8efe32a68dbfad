// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Reads measured values with their positions, from CSV or from NumPy's arrays (docs/fit.md).
#pragma once

#include <vector>

#include "apps/fit/fit_file.h"

namespace greatx::apps {

/// Fills points, orientations, and values or responses of a set from the files that `map` names: `file` with
/// `columns`, or `positions` and `values`. A value that is not a number is a gap. Throws UserError
/// "file:line:column: ..." or, for arrays, "file: ...".
void read_measurements(const FieldMap& map, sim::FitSet& set, std::vector<FitData>& data);

}  // namespace greatx::apps
