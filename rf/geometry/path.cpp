// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/geometry/path.h"

#include <algorithm>

#include "core/error.h"
#include "core/hash.h"

namespace greatx::rf {

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
    case InteractionType::target:
      return "target";
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
  uint64_t id = mix64(0x67726561747858ull + interactions.size());
  for (const Interaction& interaction : interactions) {
    id = mix64(id + 0x9e3779b97f4a7c15ull +
               (uint64_t{interaction.element} << 8 | static_cast<uint64_t>(interaction.type)));
    id = mix64(id + 0x9e3779b97f4a7c15ull + interaction.patch);
  }
  return id;
}

}  // namespace greatx::rf
