// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Table of Recommendation ITU-R P.2040-4 (2025), "Effects of building materials and structures on radiowave
// propagation above about 100 MHz", Table 3: eta' = a f^b (eq. 28), sigma = c f^d S/m (eq. 29), f in GHz.
#include <algorithm>
#include <array>
#include <cctype>
#include <span>
#include <string_view>
#include <utility>

#include "scene/material/material.h"

namespace greatx::scene {
namespace {

struct TableRow {
  double a, b, c, d;
  double min_ghz, max_ghz;
};

struct TableMaterial {
  const char* name;
  std::array<TableRow, 5> rows;  ///< unused ones have max_ghz = 0
};

// clang-format off
constexpr TableMaterial table3[] = {
    {"vacuum",            {{{1.0, 0.0, 0.0, 0.0, 0.001, 100.0}}}},
    {"concrete",          {{{5.24, 0.0, 0.0462, 0.7822, 1.0, 100.0},
                            {5.17, 0.0, 0.0145, 1.09, 110.0, 330.0}}}},
    {"brick",             {{{3.91, 0.0, 0.0238, 0.16, 1.0, 40.0},
                            {4.15, 0.0, 0.0006, 1.5712, 110.0, 330.0}}}},
    {"plasterboard",      {{{2.73, 0.0, 0.0085, 0.9395, 1.0, 100.0},
                            {2.56, 0.0, 0.0001, 1.7799, 110.0, 330.0},
                            {2.65, 0.0, 0.0002, 1.598, 100.0, 400.0}}}},
    {"wood",              {{{1.99, 0.0, 0.0047, 1.0718, 0.001, 100.0},
                            {1.82, 0.0, 0.0040, 1.0761, 110.0, 330.0},
                            {2.1183, 0.0, 0.0055, 1.1113, 100.0, 400.0}}}},
    {"glass",             {{{6.31, 0.0, 0.0036, 1.3394, 0.1, 100.0},
                            {5.79, 0.0, 0.0004, 1.658, 220.0, 450.0},
                            {6.5767, 0.0, 0.0012, 1.4697, 100.0, 400.0}}}},
    {"clear_acrylic",     {{{2.58, 0.0, 0.0001, 1.6524, 110.0, 330.0}}}},
    {"ceiling_board",     {{{1.48, 0.0, 0.0011, 1.075, 1.0, 100.0},
                            {1.52, 0.0, 0.0029, 1.029, 220.0, 450.0},
                            {1.2567, 0.0, 0.00013, 1.454, 100.0, 400.0}}}},
    {"chipboard",         {{{2.58, 0.0, 0.0217, 0.78, 1.0, 100.0},
                            {2.16, 0.0, 0.0023, 1.359, 100.0, 200.0}}}},
    {"plywood",           {{{2.71, 0.0, 0.33, 0.0, 1.0, 40.0},
                            {1.94, 0.0, 0.0067, 0.9982, 110.0, 330.0},
                            {2.17, 0.0, 0.0063, 1.045, 100.0, 400.0}}}},
    {"marble",            {{{7.074, 0.0, 0.0055, 0.9262, 1.0, 60.0},
                            {7.94, 0.0, 0.0001, 1.733, 110.0, 330.0},
                            {8.62, 0.0, 0.0027, 1.15, 100.0, 400.0}}}},
    {"floorboard",        {{{3.66, 0.0, 0.0044, 1.3515, 50.0, 100.0},
                            {5.27, 0.0, 2.22e-17, 7.3413, 220.0, 300.0},
                            {5.27, 0.0, 0.0003, 2.0298, 300.0, 400.0},
                            {5.27, 0.0, 49.8726, 0.0, 400.0, 450.0},
                            {3.1575, 0.0, 0.001675, 1.32775, 100.0, 400.0}}}},
    {"vinyl_tile",        {{{3.62, 0.0, 0.0051, 0.8422, 1.0, 40.0}}}},
    {"carpet_tile",       {{{2.08, 0.0, 0.0009, 0.82, 1.0, 40.0}}}},
    {"asphalt_concrete",  {{{4.83, 0.0, 0.0108, 1.3969, 1.0, 40.0}}}},
    // The recommendation ends at 100 GHz; the second row is not in it (beyond_table3).
    {"metal",             {{{1.0, 0.0, 1e7, 0.0, 1.0, 100.0},
                            {1.0, 0.0, 1e7, 0.0, 100.0, 1000.0}}}},
    {"very_dry_ground",   {{{3.0, 0.0, 0.00015, 2.52, 1.0, 10.0}}}},
    {"medium_dry_ground", {{{15.0, -0.1, 0.035, 1.63, 1.0, 10.0}}}},
    {"wet_ground",        {{{30.0, -0.4, 0.15, 1.30, 1.0, 10.0}}}},
};
// clang-format on

/// Says where rows come from that the recommendation does not have. The conductivity of a metal is constant
/// far below the damping frequency of its electrons (conductors.h), so that of "metal" holds to 1 THz.
constexpr std::pair<const char*, const char*> beyond_table3[] = {
    {"metal", "; above 100 GHz the same conductivity (Hagen and Rubens 1903)"},
};

/// Returns the name in lower case without '_', '-', ' ' and without a leading "itu": "ITU_Ceiling-Board" ->
/// "ceilingboard".
std::string comparison_key(const std::string& name) {
  std::string key;
  for (const char character : name) {
    if (character == '_' || character == '-' || character == ' ') continue;
    key += static_cast<char>(std::tolower(static_cast<unsigned char>(character)));
  }
  if (key.starts_with("itu")) key.erase(0, 3);
  return key;
}

}  // namespace

std::optional<RadioMedium> itu_medium(const std::string& name) {
  const std::string key = comparison_key(name);
  for (const TableMaterial& material : table3) {
    if (comparison_key(material.name) != key) continue;
    RadioMedium medium;
    medium.source = std::string("ITU-R P.2040-4 Table 3, ") + material.name;
    for (const auto& [beyond, source] : beyond_table3)
      if (std::string_view(beyond) == material.name) medium.source += source;
    for (const TableRow& row : material.rows) {
      if (row.max_ghz == 0.0) break;
      medium.rows.push_back({row.a, row.b, row.c, row.d, row.min_ghz * 1e9, row.max_ghz * 1e9});
    }
    return medium;
  }
  return std::nullopt;
}

std::vector<std::string> itu_names() {
  std::vector<std::string> names;
  for (const TableMaterial& material : table3) names.emplace_back(material.name);
  return names;
}

}  // namespace greatx::scene
