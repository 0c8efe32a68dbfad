// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/material/material_words.h"

#include <algorithm>
#include <sstream>
#include <string_view>
#include <vector>

namespace greatx::scene {
namespace {

struct Row {
  const char* radio;
  /// Words with spaces between them. A word fits a word of the name that equals it, or is its plural. A
  /// word with a trailing '-' also fits one that begins or ends with it, as in German "Betonwand"; a short
  /// one does not, because "iron" is in "environment" and "tree" in "street".
  const char* words;
};

// Rows are tried from the first to the last. Media whose names contain those of others come first, then
// media, then the things that are usually made of one. The thicknesses are usual ones of buildings; a medium
// without thickness fills the half-space behind the surface, as the ground does.
constexpr Row rows[] = {
    {"itu: plasterboard, thickness_m: 0.0125", "plasterboard- drywall- gypsum- gips- rigips-"},
    {"itu: plywood, thickness_m: 0.018", "plywood- sperrholz-"},
    {"itu: chipboard, thickness_m: 0.018", "chipboard- spanplatte- mdf osb laminate- laminat-"},
    {"itu: floorboard, thickness_m: 0.02", "floorboard- floorboards- parquet- parkett-"},
    {"itu: clear_acrylic, thickness_m: 0.005", "acrylic- plexiglass- plexiglas- perspex-"},
    {"itu: marble, thickness_m: 0.3",
     "sandstone- limestone- cobblestone- marble- marmor- granite- granit- slate sandstein- kalkstein-"},
    {"itu: brick, thickness_m: 0.24",
     "brick- bricks- brickwork- ziegel- klinker- clinker- ladrillo- brique- baksteen- terracotta- "
     "terrakotta-"},
    {"itu: asphalt_concrete", "asphalt- tarmac- bitumen- macadam- blacktop asfalt- asfalto- tar"},
    {"itu: concrete, thickness_m: 0.3",
     "concrete- cement- beton- hormigon- cemento- calcestruzzo- stahlbeton- precast-"},
    {"itu: glass, thickness_m: 0.006",
     "glass- glas- glazing- glazed- vidrio- verre- vetro- windshield- windscreen-"},
    {"conductor: aluminium", "aluminium- aluminum- alu"},
    {"conductor: copper", "copper- kupfer- cobre-"},
    {"itu: metal",
     "metal- metall- metallic- steel- stahl- chrome- chrom iron castiron tin zinc- brass- bronze- "
     "silver gold acero- acier- metallo- galvanized- corrugated- rust rusty carpaint-"},
    {"itu: wood, thickness_m: 0.04",
     "wood- wooden- timber- holz- lumber- plank- planks- oak pine walnut birch spruce cedar bamboo- bark "
     "trunk- "
     "baumstamm- madera- bois legno- hout"},
    {"itu: plasterboard, thickness_m: 0.0125", "plaster- stucco- putz- render yeso-"},
    {"itu: ceiling_board, thickness_m: 0.015", "ceiling- zimmerdecke-"},
    {"itu: carpet_tile, thickness_m: 0.006", "carpet- teppich- rug"},
    {"itu: vinyl_tile, thickness_m: 0.003", "vinyl- linoleum- pvc"},
    {"foliage: weissberger",
     "leaf leafs leave leaves- foliage- hedge- hecke bush bushes- shrub- canopy treetop- laub- blatt "
     "blaetter "
     "blatter busch ivy efeu crown"},
    {"itu: wet_ground", "water- wasser- mud muddy swamp- marsh- river lake pond fluss"},
    {"itu: very_dry_ground", "sand- gravel- kies pebble- pebbles- desert-"},
    {"itu: medium_dry_ground",
     "grass- gras grasses lawn- rasen- turf- meadow- wiese- soil- dirt- earth erde ground- terrain- field "
     "mulch- "
     "clay mud pasture- herbe- pelouse- cesped- hierba- erba gazon-"},
    {"itu: marble, thickness_m: 0.3", "stone- stein- rock- fels- piedra- pierre- pietra- masonry-"},
    // Things that are usually made of one medium.
    {"itu: metal",
     "lamp lamppost- lamppole lantern- pole poles mast rail rails railing- guardrail- fence- handrail- "
     "gutter- "
     "pipe pipes antenna- tank girder- crane container- vehicle- car"},
    {"itu: glass, thickness_m: 0.006", "window- windows- fenster- ventana- fenetre- skylight- curtainwall-"},
    {"itu: asphalt_concrete",
     "road roads roadway- street streets- strasse- highway- carriageway- parking- driveway- lane runway- "
     "route "
     "calle straat- fahrbahn-"},
    {"itu: concrete",
     "pavement- sidewalk- footpath- walkway- kerb- curb- gehweg- trottoir- plaza- paving- paver-"},
    {"itu: brick, thickness_m: 0.02",
     "rooftile- rooftiles- dachziegel- roof- roofs roofing- dach tile tiles tiled"},
    {"foliage: weissberger", "tree trees vegetation- plant plants baum baeume baume arbre arbol bomen"},
    {"itu: wood, thickness_m: 0.04", "door doors tuer tur porte puerta furniture- table desk shelf"},
    {"itu: concrete, thickness_m: 0.3",
     "facade- fassade- wall walls wand waende mauer- front building- gebaeude- pillar- column- stair- "
     "stairs- "
     "bridge- mur muro pared house haus floor floors boden slab- foundation- ceiling-"},
};

/// Returns the letter without its accent that a character of UTF-8 from U+00C0 to U+00FF means, by its second
/// byte; an empty text for other characters.
std::string_view plain_letter(unsigned char second) {
  const unsigned char lower = second < 0xa0 ? second + 0x20 : second;  // é from É
  if (second == 0x9f) return "ss";
  if (lower >= 0xa0 && lower <= 0xa5) return "a";
  if (lower == 0xa7) return "c";
  if (lower >= 0xa8 && lower <= 0xab) return "e";
  if (lower >= 0xac && lower <= 0xaf) return "i";
  if (lower == 0xb1) return "n";
  if ((lower >= 0xb2 && lower <= 0xb6) || lower == 0xb8) return "o";
  if (lower >= 0xb9 && lower <= 0xbc) return "u";
  return "";
}

/// Returns the words of a name in lower case: "GlassFront.001" has "glass" and "front".
std::vector<std::string> words_of(const std::string& name) {
  std::vector<std::string> words(1);
  const auto next_word = [&] {
    if (!words.back().empty()) words.emplace_back();
  };
  bool after_small = false;
  for (size_t i = 0; i < name.size(); ++i) {
    const char c = name[i];
    const bool small = c >= 'a' && c <= 'z', large = c >= 'A' && c <= 'Z';
    if (large && after_small) next_word();
    if (small || large) {
      words.back() += small ? c : static_cast<char>(c - 'A' + 'a');
    } else if (c == '\xc3' && i + 1 < name.size() &&
               !plain_letter(static_cast<unsigned char>(name[i + 1])).empty()) {
      words.back() += plain_letter(static_cast<unsigned char>(name[++i]));
    } else {
      next_word();
    }
    after_small = small || static_cast<unsigned char>(name[i]) >= 0xa0;  // é, but not É
  }
  return words;
}

bool fits(std::string_view known, std::string_view word) {
  const bool part = known.ends_with('-');
  if (part) known.remove_suffix(1);
  if (word == known) return true;
  if (word.size() == known.size() + 1 && word.starts_with(known) && word.back() == 's') return true;
  return part && word.size() > known.size() && (word.starts_with(known) || word.ends_with(known));
}

}  // namespace

std::string suggested_radio(const std::string& material_name) {
  const std::vector<std::string> words = words_of(material_name);
  for (const Row& row : rows) {
    std::istringstream known_words(row.words);
    for (std::string known; known_words >> known;)
      if (std::ranges::any_of(words, [&](const std::string& word) { return fits(known, word); }))
        return row.radio;
  }
  return "";
}

}  // namespace greatx::scene
