// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The catalogue of hard cases, which `greatx selftest` and a test run on any device. A case computes figures
// with the passes of the product and compares each with a closed form. Data flows one way:
//
//   Case ─► Lab (device, stages, fault to plant) ─► passes of the product ─► Row ─► table, JSON, exit code
//
// A case compares one or more figures. Each figure is a row of its own for every tracer and every precision
// that computes it: a row says what computed it. Where a figure counts what must not happen (a ray that slips
// through, a byte that differs), the expected value is 0 or the number of rays, and the tolerance is 0.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "apps/selftest/lab.h"

namespace greatx::apps::selftest {

/// Holds one comparison.
struct Row {
  uint32_t number = 0;  ///< of the case
  std::string title;    ///< of the case
  std::string figure;   ///< what is compared, with its unit
  std::string by;       ///< what computed it: "tree, fp32", "host, fp64", "host, fp64 + tree, fp32", ...
  double expected = 0.0, got = 0.0, tolerance = 0.0;
  std::string error;  ///< message of the exception that ended the case; empty: none

  /// Returns whether the figure agrees. A figure that is not finite never does.
  bool passed() const { return error.empty() && std::isfinite(got) && std::abs(got - expected) <= tolerance; }
};

/// Takes the figures of one case.
class Rows {
 public:
  Rows(uint32_t number, std::string title, std::vector<Row>& list)
      : number_(number), title_(std::move(title)), list_(list) {}
  void add(std::string figure, std::string by, double expected, double got, double tolerance) {
    list_.push_back({number_, title_, std::move(figure), std::move(by), expected, got, tolerance, {}});
  }
  void add_error(const std::string& message) {
    list_.push_back({number_, title_, "ran to its end", "program", 0.0, 0.0, 0.0, message});
  }

 private:
  uint32_t number_;
  std::string title_;
  std::vector<Row>& list_;
};

struct Case {
  uint32_t number = 0;  ///< number in the catalogue, the same as in the names of the unit tests
  const char* title = "";
  void (*run)(const Lab& lab, Rows& rows) = nullptr;
};

/// Returns every case, ascending by number. A number may have several cases.
std::vector<Case> catalogue();

/// Runs a case and appends its rows. An exception of the product becomes a row that fails, except
/// Interrupted, which passes.
void run(const Case& item, const Lab& lab, std::vector<Row>& rows);

// The parts of the catalogue.
std::span<const Case> ray_cases();
std::span<const Case> mesh_cases();
std::span<const Case> path_cases();
std::span<const Case> surface_cases();
std::span<const Case> channel_cases();
std::span<const Case> edge_cases();
std::span<const Case> antenna_cases();
std::span<const Case> sensor_cases();
std::span<const Case> radar_cases();
std::span<const Case> time_cases();

}  // namespace greatx::apps::selftest
