// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks a property on drawn scenes. GREATX_PROPERTY_SCENES sets the number of scenes of each property
// (default 4), GREATX_PROPERTY_FIRST the first seed (default 1), and GREATX_PROPERTY_FOLDER where a failing
// case is kept (default: the folder for temporary files).
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tests/property/shrink.h"

namespace greatx::property {

/// Draws the scenes of a property, prepares each, and expects the verdict to find nothing. `forms` are those
/// that the verdict compares.
void check_scenes(const std::string& name, const Verdict& verdict, const std::vector<Form>& forms,
                  const std::function<void(DrawnCase&)>& prepare = {});

}  // namespace greatx::property
