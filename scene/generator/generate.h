// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Seeded procedural scenes and objects, written as ordinary glTF 2.0 that the ordinary loader reads
// (docs/generator.md).
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace greatx::scene {

struct GenerateOptions {
  std::string kind;   ///< one of generator_kinds()
  uint64_t seed = 1;  ///< of "city", "country" and "canyon"; the other kinds look the same for every seed
  double size_m =
      300;  ///< edge of the square of "city" (100...1000) and "country" (160...2000), length of "canyon"
            ///< (60...1000); unused otherwise
  std::string variant;  ///< one of generator_variants(kind); empty: the first of them
};

/// The bytes of a .glb in metres: z = 0 ground, centre of the scene or foot of the object at the origin (the
/// quadrotor: its centre), x forward for vehicles. The same options give the same bytes.
/// Throws UserError naming what is allowed for an unknown kind, an unknown variant, or a size out of range.
std::vector<std::byte> generate_glb(const GenerateOptions& options);

/// "city", "country", "canyon", "room", "mast", "car", "quadrotor".
std::vector<std::string> generator_kinds();

/// Variants of `kind`, the default first; empty if it has none. Throws UserError for an unknown kind.
std::vector<std::string> generator_variants(const std::string& kind);

}  // namespace greatx::scene
