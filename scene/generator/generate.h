// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Generates procedural scenes and objects from a seed. They are written as ordinary glTF 2.0, which the
// ordinary loader reads (docs/generator.md).
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace greatx::scene {

struct GenerateOptions {
  std::string kind;  ///< one of generator_kinds()
  /// For "city", "country" and "canyon"; for "vehicle" and "person" it picks paint and clothes. The other
  /// kinds ignore it.
  uint64_t seed = 1;
  /// Edge of the square of "city" (100...1000) and "country" (160...2000), length of "canyon" (60...1000);
  /// the other kinds ignore it.
  double size_m = 300;
  /// One of generator_variants(kind); empty: the first of them. The variants of "city" and "country" are the
  /// seasons of their plants: "summer", "spring", "autumn", "winter".
  std::string variant;
  /// Packs the pictures in a hurry, for bytes that are read back at once. The model is the same.
  bool quick = false;
};

/// Returns the bytes of a .glb in metres. The ground is at z = 0. The origin is the centre of a scene, the
/// foot of an object, or the centre of the quadrotor. Vehicles face +x. The same options give the same bytes.
/// Throws UserError, which names the allowed values, for an unknown kind, an unknown variant, or a size out
/// of range.
std::vector<std::byte> generate_glb(const GenerateOptions& options);

/// Returns "city", "country", "canyon", "room", "mast", "car", "vehicle", "person",
/// "quadrotor".
std::vector<std::string> generator_kinds();

/// Says what a kind is, for help, and which sizes it has.
struct GeneratorKind {
  std::string name, words;                   ///< "car", "a car at rest"
  double least_size_m = 0, most_size_m = 0;  ///< bounds of GenerateOptions::size_m; both 0: it has no size
  bool seeded = false;                       ///< whether GenerateOptions::seed changes it
  std::string variant_word;                  ///< name of the choice of a variant: "variant" or "season"
};
std::vector<GeneratorKind> generators();

/// Returns the variants of `kind`, the default first, or nothing if it has none. Throws UserError for an
/// unknown kind.
std::vector<std::string> generator_variants(const std::string& kind);

}  // namespace greatx::scene
