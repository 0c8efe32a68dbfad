// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines bounds on the memory that input may make the program hold. A few hundred bytes can ask for
// gigabytes (aliases, counts, sizes of pictures). Code therefore states how much it plans to hold before it
// allocates it, and a plan beyond one of the figures below is refused by name. docs/limits.md lists the
// figures for the user, and tests/core/budget_test.cpp compares the two.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>

namespace greatx {

/// Describes a bound, and the thing that it bounds.
struct Budget {
  const char* what;  ///< "textures of a model"
  uint64_t most;
  const char* unit = "bytes";
};

namespace budget {

inline constexpr uint64_t mib = uint64_t{1} << 20, gib = uint64_t{1} << 30;

inline constexpr Budget yaml_file{"a YAML file", 16 * mib};
/// Each alias counts as all the values that it stands for.
inline constexpr Budget yaml_values{"a YAML document, its aliases written out", 1'000'000, "values"};
inline constexpr Budget csv_file{"a CSV file", 256 * mib};
inline constexpr Budget model_file{"a glTF file", 2 * gib};
/// In memory, each value of the JSON takes at least eight times as much.
inline constexpr Budget model_json{"the JSON of a glTF file", 256 * mib};
inline constexpr Budget model_externals{"the files that a model names", 2 * gib};
inline constexpr Budget import_xml{"a Mitsuba scene file", 64 * mib};
/// Counts positions, normals, tangents, texture coordinates and indices as they are in memory.
inline constexpr Budget model_geometry{"the geometry of a model", 2 * gib};
/// Counts elements that the file does not store.
inline constexpr Budget model_zeros{"elements of a model without a buffer view", 256 * mib};
/// Counts the decoded textures: RGBA of 8 bits.
inline constexpr Budget model_textures{"the textures of a model", 1 * gib};
inline constexpr Budget scene_textures{"the textures of a scene", 2 * gib};
/// Each placement of a mesh has its own triangles.
inline constexpr Budget scene_triangles{"a scene", 24'000'000, "triangles"};
inline constexpr Budget scene_vertices{"a scene", 72'000'000, "vertices"};
inline constexpr Budget import_geometry{"the geometry of an imported scene", 2 * gib};
/// Counts the ends of paths between single elements, over all links of a channel that may be in their near
/// field.
inline constexpr Budget element_pairs{"links solved element by element", 1 << 20, "pairs of elements"};
inline constexpr Budget channel_record{"a record of a channel", 4 * gib};

}  // namespace budget

/// Returns the product, or 2^64 - 1 where the product does not fit.
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

/// Returns "1.5 GiB" for bytes and "1000001 values" for other units.
std::string amount(uint64_t value, const Budget& budget);

/// Throws UserError "where: planned ..., more than the ... that ... may take (docs/limits.md)" if `planned`
/// is beyond the budget. `where` names the file and the field.
void require_within(const std::string& where, uint64_t planned, const Budget& budget);

/// Represents a budget that several things share. Each thing is counted before it is allocated.
class Spending {
 public:
  explicit Spending(const Budget& budget) : budget_(budget) {}
  /// Throws like require_within() if the sum so far plus `planned` is beyond the budget.
  void plan(const std::string& where, uint64_t planned);
  uint64_t planned() const { return planned_; }

 private:
  Budget budget_;
  uint64_t planned_ = 0;
};

}  // namespace greatx
