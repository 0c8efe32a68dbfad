// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "apps/calibration/resolve.h"

namespace greatx::apps {

namespace {

using Json = nlohmann::json;

std::string milliseconds(const Json& spread) {
  return fmt::format("{:.3g} ms", spread["median"].get<double>());
}

std::string error_words(const Json& error) {
  const auto value = [&](const char* name) {
    return error[name].is_null() ? std::string("equal") : fmt::format("{:.3g}", error[name].get<double>());
  };
  return fmt::format(
      "  {:<34}{} {} {}: {}{} on other ticks; {} with the scenario's own settings\n",
      error["name"].get<std::string>(), error["asked"].get<bool>() ? "at most" : "weighed by",
      value("allowed"), error["unit"].get<std::string>(),
      error.contains("calibrated") ? value("calibrated") + " on the ticks of the choice, " : "",
      value("checked"), value("own"));
}

std::string part_words(const Json& part) {
  std::string words = fmt::format("{}\n", part["modality"].get<std::string>());
  for (const Json& chosen : part["chosen"])
    words += fmt::format("  {:<34}{} -> {}\n", chosen["knob"].get<std::string>(),
                         chosen["own"].get<std::string>(), chosen["chosen"].get<std::string>());
  if (part["chosen"].empty()) words += "  every setting stays as it is\n";
  std::vector<std::string> written;
  for (const Json& kept : part["kept"])
    if (kept["why"] == "the scenario writes it") written.push_back(kept["knob"]);
  if (!written.empty())
    words += fmt::format("  {:<34}{}; what they cost in accuracy is not counted\n",
                         "as the scenario writes it", fmt::join(written, ", "));
  for (const Json& error : part["errors"]) words += error_words(error);
  const int64_t checked = part["checked_ticks"], met = part["met_ticks"];
  words += checked == 0 ? std::string("  no tick was left to check that\n")
                        : fmt::format(
                              "  {} of {} other ticks met that: at least {:.0f} % of ticks do, with 95 % "
                              "confidence\n",
                              met, checked, 100.0 * part["least_share"].get<double>());
  std::vector<std::string> figures;
  for (const Json& figure : part["figures"])
    if (!figure["value"].is_null() && figure["value"].get<double>() != 0.0)
      figures.push_back(fmt::format("{} {:.3g} {}", figure["name"].get<std::string>(),
                                    figure["value"].get<double>(), figure["unit"].get<std::string>()));
  if (!figures.empty()) words += fmt::format("  {:<34}{}\n", "all errors there", fmt::join(figures, ", "));
  if (part["finest"].get<bool>()) words += "  no joint setting but the finest met that with a margin\n";
  const Json& times = part["tick_ms"];
  return words +
         fmt::format("  {:<34}{}; {} with the scenario's own settings, {} at the finest, which are {}\n",
                     "time of a tick alone", milliseconds(times["chosen"]), milliseconds(times["own"]),
                     milliseconds(times["reference"]), part["reference"].get<std::string>());
}

}  // namespace

std::string calibration_words(const Json& calibration) {
  std::vector<std::string> wish;
  for (const auto& [name, value] : calibration["wish"].items())
    wish.push_back(fmt::format("{} {:g}", name, value.get<double>()));
  std::string words = fmt::format("settings chosen for {}\n", fmt::join(wish, ", "));
  for (const Json& part : calibration["parts"]) words += part_words(part);
  if (calibration.contains("tick_ms"))
    words += fmt::format("whole tick: {} of {:.3g} ms\n", milliseconds(calibration["tick_ms"]),
                         calibration["wish"]["time_budget_ms_per_tick"].get<double>());
  return words;
}

}  // namespace greatx::apps
