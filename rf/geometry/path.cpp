// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/geometry/path.h"

#include <algorithm>

#include "core/error.h"

namespace greatx::rf {

namespace {

/// Applies the finaliser of SplitMix64 (G. Steele, D. Lea, C. Flood, OOPSLA 2014), by which every bit of the
/// input affects every bit of the output.
uint64_t mixed(uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
  return x ^ (x >> 31);
}

}  // namespace

const char* name_of(InteractionType type) {
  switch (type) {
    case InteractionType::none:
      return "none";
    case InteractionType::reflection:
      return "reflection";
    case InteractionType::transmission:
      return "transmission";
    case InteractionType::diffraction:
      return "diffraction";
    case InteractionType::scattering:
      return "scattering";
  }
  throw ContractError("interaction type without a name");
}

FacetSequence reflecting_facets(std::span<const Interaction> interactions) {
  FacetSequence facets;
  for (const Interaction& interaction : interactions)
    if (interaction.type == InteractionType::reflection) facets.push_back(interaction.element);
  return facets;
}

bool interactions_less(std::span<const Interaction> a, std::span<const Interaction> b) {
  if (a.size() != b.size()) return a.size() < b.size();
  return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
}

uint64_t path_id(std::span<const Interaction> interactions) {
  uint64_t id = mixed(0x67726561747858ull + interactions.size());
  for (const Interaction& interaction : interactions) {
    id = mixed(id + 0x9e3779b97f4a7c15ull +
               (uint64_t{interaction.element} << 8 | static_cast<uint64_t>(interaction.type)));
    id = mixed(id + 0x9e3779b97f4a7c15ull + interaction.patch);
  }
  return id;
}

}  // namespace greatx::rf
