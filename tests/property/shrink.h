// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Makes a case on which a property fails as small as it can, one change at a time (after J. Regehr et al.,
// "Test-case reduction for C compiler bugs", PLDI 2012: greedy passes until none succeeds).
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "tests/property/drawn_case.h"

namespace greatx::property {

/// Returns what is wrong with a case, or nothing.
using Verdict = std::function<std::optional<std::string>(const DrawnCase&)>;

struct Shrunk {
  DrawnCase smallest;
  std::string fault;  ///< the verdict on it
  uint32_t tried = 0, accepted = 0;
};

/// Returns a case that fails as well, from which no single change of these leads to a smaller one that fails:
/// one object fewer, one receiver fewer, less depth, an effect less, simpler shapes, rounder coordinates (to
/// 1, 1/4, 1/16 m). `drawn` must fail. A candidate on which the verdict throws does not count as failing,
/// unless `drawn` itself throws. Stops after `most` candidates.
Shrunk shrink(const DrawnCase& drawn, const Verdict& verdict, uint32_t most = 300);

/// Runs the verdict. If it fails, shrinks the case, writes it into a folder of its own under `parent` in each
/// of these forms (0/, 1/, ...: scenario.yaml and scene.glb), and returns a message that names the folder.
std::optional<std::string> check_case(const DrawnCase& drawn, const std::string& name, const Verdict& verdict,
                                      const std::vector<Form>& forms, const std::filesystem::path& parent);

}  // namespace greatx::property
