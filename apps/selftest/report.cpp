// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/selftest/report.h"

#include <fmt/format.h>

namespace greatx::apps::selftest {

std::string heading() {
  return fmt::format("{:<7} {:>3}  {:<56} {:<26} {:>14} {:>14} {:>9}", "verdict", "no.", "figure",
                     "computed by", "expected", "got", "+-");
}

std::string line_of(const Row& row) {
  std::string line =
      fmt::format("{:<7} {:>3}  {:<56} {:<26} {:>14.9g} {:>14.9g} {:>9.2g}", row.passed() ? "ok" : "FAILED",
                  row.number, row.figure, row.by, row.expected, row.got, row.tolerance);
  if (!row.error.empty()) line += "\n             " + row.error;
  return line;
}

std::string summary_of(const Verdict& verdict, const gpu::DeviceInfo& device) {
  const std::string where = fmt::format("{} ({}, {})", device.name, device.type, device.driver);
  if (verdict.failed == 0)
    return fmt::format("{} cases, {} figures, all as expected, in {:.1f} s on {}", verdict.cases,
                       verdict.rows, verdict.seconds, where);
  return fmt::format("{} of {} figures FAILED ({} cases, {:.1f} s) on {}", verdict.failed, verdict.rows,
                     verdict.cases, verdict.seconds, where);
}

nlohmann::json json_of(std::span<const Row> rows, const Verdict& verdict, const gpu::DeviceInfo& device) {
  nlohmann::json json{{"greatx", GREATX_VERSION},     {"device", device.name},
                      {"device_type", device.type},   {"driver", device.driver},
                      {"vulkan", device.api_version}, {"cases", verdict.cases},
                      {"failed", verdict.failed},     {"passed", verdict.failed == 0},
                      {"seconds", verdict.seconds},   {"rows", nlohmann::json::array()}};
  for (const Row& row : rows) {
    json["rows"].push_back({{"number", row.number},
                            {"case", row.title},
                            {"figure", row.figure},
                            {"by", row.by},
                            {"expected", row.expected},
                            {"got", row.got},
                            {"tolerance", row.tolerance},
                            {"passed", row.passed()}});
    if (!row.error.empty()) json["rows"].back()["error"] = row.error;
  }
  return json;
}

}  // namespace greatx::apps::selftest
