// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/property/shrink.h"

#include <cmath>
#include <fstream>
#include <vector>

#include <fmt/format.h>

namespace greatx::property {

namespace {

std::optional<std::string> verdict_of(const DrawnCase& drawn, const Verdict& verdict) {
  try {
    return verdict(drawn);
  } catch (const std::exception& error) {
    return fmt::format("threw: {}", error.what());
  }
}
bool threw(const std::string& fault) { return fault.starts_with("threw: "); }

double rounded(double value, double step) { return std::round(value / step) * step; }

/// Appends the changes that make every number of the case a multiple of `step`, one at a time.
void add_rounder(const DrawnCase& drawn, double step, std::vector<DrawnCase>& candidates) {
  const auto add = [&](auto&& change) {
    candidates.push_back(drawn);
    change(candidates.back());
  };
  const auto round_point = [step](dvec3& p) {
    p = {rounded(p.x, step), rounded(p.y, step), rounded(p.z, step)};
  };
  add([&](DrawnCase& c) { round_point(c.transmitter); });
  for (size_t i = 0; i < drawn.receivers.size(); ++i) add([&](DrawnCase& c) { round_point(c.receivers[i]); });
  for (size_t i = 0; i < drawn.boxes.size(); ++i) {
    add([&](DrawnCase& c) { round_point(c.boxes[i].corner); });
    add([&](DrawnCase& c) {
      DrawnBox& box = c.boxes[i];
      box.u = {rounded(box.u.x, step), rounded(box.u.y, step)};
      box.v = {rounded(box.v.x, step), rounded(box.v.y, step)};
      box.height = rounded(box.height, step);
    });
  }
}

bool is_solid(const DrawnBox& box) {
  return box.height > 0.0 && std::abs(box.u.x * box.v.y - box.u.y * box.v.x) > 1e-3;
}

bool same(const DrawnBox& a, const DrawnBox& b) {
  return a.corner == b.corner && a.u == b.u && a.v == b.v && a.height == b.height && a.material == b.material;
}
bool same(const DrawnCase& a, const DrawnCase& b) {
  return a.ground == b.ground && a.transmitter == b.transmitter && a.receivers == b.receivers &&
         a.depth == b.depth && a.transmission == b.transmission && a.diffraction == b.diffraction &&
         a.scattering == b.scattering && a.dispersion == b.dispersion && a.two_edges == b.two_edges &&
         a.reflections_after == b.reflections_after && a.every_tick == b.every_tick && a.rays == b.rays &&
         a.transmitter_moves == b.transmitter_moves && a.receivers_move == b.receivers_move &&
         a.carrier_hz == b.carrier_hz && a.boxes.size() == b.boxes.size() &&
         std::equal(a.boxes.begin(), a.boxes.end(), b.boxes.begin(),
                    [](const DrawnBox& p, const DrawnBox& q) { return same(p, q); });
}

/// Returns the changes to try, those that take away most first.
std::vector<DrawnCase> smaller(const DrawnCase& drawn) {
  std::vector<DrawnCase> candidates;
  const auto add = [&](auto&& change) {
    candidates.push_back(drawn);
    change(candidates.back());
  };
  for (size_t i = 0; i < drawn.boxes.size(); ++i)
    add([&](DrawnCase& c) { c.boxes.erase(c.boxes.begin() + static_cast<long>(i)); });
  if (drawn.ground) add([](DrawnCase& c) { c.ground = false; });
  for (size_t i = 0; drawn.receivers.size() > 1 && i < drawn.receivers.size(); ++i)
    add([&](DrawnCase& c) { c.receivers.erase(c.receivers.begin() + static_cast<long>(i)); });
  if (drawn.depth > 0) add([](DrawnCase& c) { --c.depth; });
  if (drawn.transmission) add([](DrawnCase& c) { c.transmission = false; });
  if (drawn.diffraction) add([](DrawnCase& c) { c.diffraction = false; });
  if (drawn.scattering) add([](DrawnCase& c) { c.scattering = false; });
  if (drawn.dispersion) add([](DrawnCase& c) { c.dispersion = false; });
  if (drawn.two_edges) add([](DrawnCase& c) { c.two_edges = false; });
  if (drawn.reflections_after > 0) add([](DrawnCase& c) { --c.reflections_after; });
  if (drawn.rays > 0) add([](DrawnCase& c) { c.rays = 0; });
  if (drawn.every_tick) add([](DrawnCase& c) { c.every_tick = false; });
  if (drawn.transmitter_moves) add([](DrawnCase& c) { c.transmitter_moves = false; });
  if (drawn.receivers_move) add([](DrawnCase& c) { c.receivers_move = false; });
  for (size_t i = 0; i < drawn.boxes.size(); ++i) {
    add([&](DrawnCase& c) { c.boxes[i].material = 3; });
    add([&](DrawnCase& c) {
      DrawnBox& box = c.boxes[i];
      box.u.y = box.v.x = 0.0;
      box.u.x = std::max(std::abs(box.u.x), 1.0), box.v.y = std::max(std::abs(box.v.y), 1.0);
    });
  }
  add([](DrawnCase& c) { c.carrier_hz = 3.5e9; });
  for (const double step : {1.0, 0.25, 0.0625}) add_rounder(drawn, step, candidates);
  std::erase_if(candidates, [&](const DrawnCase& c) {
    return same(c, drawn) || !std::all_of(c.boxes.begin(), c.boxes.end(), is_solid);
  });
  return candidates;
}

}  // namespace

Shrunk shrink(const DrawnCase& drawn, const Verdict& verdict, uint32_t most) {
  Shrunk result{drawn, verdict_of(drawn, verdict).value_or(""), 1, 0};
  if (result.fault.empty()) return result;
  const bool by_throwing = threw(result.fault);
  for (bool again = true; again;) {
    again = false;
    for (const DrawnCase& candidate : smaller(result.smallest)) {
      if (result.tried == most) return result;
      ++result.tried;
      const std::optional<std::string> fault = verdict_of(candidate, verdict);
      if (!fault || threw(*fault) != by_throwing) continue;
      result.smallest = candidate;
      result.fault = *fault;
      ++result.accepted;
      again = true;
      break;
    }
  }
  return result;
}

std::optional<std::string> check_case(const DrawnCase& drawn, const std::string& name, const Verdict& verdict,
                                      const std::vector<Form>& forms, const std::filesystem::path& parent) {
  if (!verdict_of(drawn, verdict)) return std::nullopt;
  const Shrunk shrunk = shrink(drawn, verdict);
  const std::filesystem::path folder = parent / fmt::format("{}_seed_{}", name, drawn.seed);
  std::filesystem::remove_all(folder);
  for (size_t i = 0; i < forms.size(); ++i) write_case(shrunk.smallest, forms[i], folder / std::to_string(i));
  const std::string message = fmt::format(
      "{} fails: {}\n  smallest case ({} of {} changes): {}\n  replay it with {}/*/scenario.yaml", name,
      shrunk.fault, shrunk.accepted, shrunk.tried, describe(shrunk.smallest), folder.string());
  std::ofstream(folder / "message.txt") << message << '\n';
  return message;
}

}  // namespace greatx::property
