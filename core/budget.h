// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// What input may make the program hold. A few hundred bytes can ask for gigabytes (aliases, counts, sizes of pictures):
// what is planned is stated before it is allocated, and refused by name beyond the figures below. docs/limits.md has them
// for the user; tests/core/budget_test.cpp compares the two.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>

namespace greatx {

/// A bound and what it is for.
struct Budget {
  const char* what;  ///< "textures of a model"
  uint64_t most;
  const char* unit = "bytes";
};

namespace budget {

inline constexpr uint64_t mib = uint64_t{1} << 20, gib = uint64_t{1} << 30;

inline constexpr Budget yaml_file{"a YAML file", 16 * mib};
/// Each alias counts as all that it stands for.
inline constexpr Budget yaml_values{"a YAML document, its aliases written out", 1'000'000, "values"};
inline constexpr Budget csv_file{"a CSV file", 256 * mib};
inline constexpr Budget model_file{"a glTF file", 2 * gib};
/// In memory each of its values takes eight times as much and more.
inline constexpr Budget model_json{"the JSON of a glTF file", 256 * mib};
inline constexpr Budget model_externals{"the files that a model names", 2 * gib};
inline constexpr Budget import_xml{"a Mitsuba scene file", 64 * mib};
/// Positions, normals, tangents, texture coordinates and indices, as they are in memory.
inline constexpr Budget model_geometry{"the geometry of a model", 2 * gib};
/// No byte of the file stands behind them.
inline constexpr Budget model_zeros{"elements of a model without a buffer view", 256 * mib};
/// Decoded, RGBA of 8 bits.
inline constexpr Budget model_textures{"the textures of a model", 1 * gib};
inline constexpr Budget scene_textures{"the textures of a scene", 2 * gib};
/// Each place of a mesh has its own.
inline constexpr Budget scene_triangles{"a scene", 24'000'000, "triangles"};
inline constexpr Budget scene_vertices{"a scene", 72'000'000, "vertices"};
inline constexpr Budget import_geometry{"the geometry of an imported scene", 2 * gib};
/// Ends of paths between single elements, of all links of a channel that may be in their near field.
inline constexpr Budget element_pairs{"links solved element by element", 1 << 20, "pairs of elements"};
inline constexpr Budget channel_record{"a record of a channel", 4 * gib};

}  // namespace budget

/// The product, or 2^64 - 1 where that does not hold it.
constexpr uint64_t saturating_product(std::initializer_list<uint64_t> factors) {
  uint64_t product = 1;
  bool overflow = false;
  for (const uint64_t factor : factors) {
    if (factor == 0) return 0;
    overflow |= __builtin_mul_overflow(product, factor, &product);
  }
  return overflow ? UINT64_MAX : product;
}

constexpr uint64_t saturating_sum(uint64_t a, uint64_t b) { return a > UINT64_MAX - b ? UINT64_MAX : a + b; }

/// "1.5 GiB" of bytes, "1000001 values" of others.
std::string amount(uint64_t value, const Budget& budget);

/// Throws UserError "where: planned ..., more than the ... that ... may take (docs/limits.md)" beyond the budget.
/// `where` names file and field.
void require_within(const std::string& where, uint64_t planned, const Budget& budget);

/// A budget that several things share: stated one after the other, each before it is allocated.
class Spending {
 public:
  explicit Spending(const Budget& budget) : budget_(budget) {}
  /// Throws as require_within() if the sum so far and `planned` are too much.
  void plan(const std::string& where, uint64_t planned);
  uint64_t planned() const { return planned_; }

 private:
  Budget budget_;
  uint64_t planned_ = 0;
};

}  // namespace greatx
