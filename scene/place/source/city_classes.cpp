// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/place/source/city_classes.h"

#include "scene/place/input/osm_values.h"

namespace greatx::scene::place {

namespace {

struct Word {
  std::string_view word, key, value;
};

/// IMGeo 2.2, catalogue of objects: functieWegdeel.
constexpr Word road_words[] = {{"rijbaan autosnelweg", "highway", "motorway"},
                               {"rijbaan autoweg", "highway", "trunk"},
                               {"rijbaan regionale weg", "highway", "secondary"},
                               {"rijbaan lokale weg", "highway", "residential"},
                               {"OV-baan", "highway", "busway"},
                               {"fietspad", "highway", "cycleway"},
                               {"voetpad", "highway", "footway"},
                               {"voetpad op trap", "highway", "steps"},
                               {"voetgangersgebied", "highway", "pedestrian"},
                               {"ruiterpad", "highway", "bridleway"},
                               {"woonerf", "highway", "living_street"},
                               {"inrit", "highway", "service"},
                               {"parkeervlak", "amenity", "parking"},
                               {"spoorbaan", "railway", "rail"}};

/// IMGeo 2.2: fysiekVoorkomen of roads and of ground, bare and with plants.
constexpr Word surface_words[] = {{"gesloten verharding", "surface", "asphalt"},
                                  {"open verharding", "surface", "paving_stones"},
                                  {"half verhard", "surface", "gravel"},
                                  {"onverhard", "surface", "ground"},
                                  {"zand", "surface", "sand"}};
constexpr Word land_words[] = {{"erf", "landuse", "residential"}, {"zand", "natural", "sand"}};
constexpr Word plant_words[] = {{"loofbos", "natural", "wood"},
                                {"gemengd bos", "natural", "wood"},
                                {"naaldbos", "natural", "wood"},
                                {"bos", "natural", "wood"},
                                {"heide", "natural", "heath"},
                                {"struiken", "natural", "scrub"},
                                {"heesters", "natural", "scrub"},
                                {"planten", "natural", "scrub"},
                                {"gras- en kruidachtigen", "landuse", "grass"},
                                {"grasland overig", "landuse", "grass"},
                                {"grasland agrarisch", "landuse", "meadow"},
                                {"bouwland", "landuse", "farmland"},
                                {"fruitteelt", "landuse", "orchard"},
                                {"rietland", "natural", "wetland"},
                                {"moeras", "natural", "wetland"}};

constexpr const char* word_attributes[] = {"plus_fysiekvoorkomen",
                                           "plus_fysiekvoorkomenwegdeel",
                                           "bgt_fysiekvoorkomen",
                                           "surfacematerial",
                                           "function",
                                           "class"};

using CityTags = std::map<std::string, std::string, std::less<>>;

template <size_t count>
bool add_word(const Attributes& attributes, const Word (&words)[count], CityTags& tags) {
  for (const char* name : word_attributes)
    if (const auto found = attributes.find(std::string_view(name)); found != attributes.end())
      for (const Word& word : words)
        if (word.word == found->second) {
          tags[std::string(word.key)] = word.value;
          return true;
        }
  return false;
}

void add_plants(const Attributes& attributes, CityTags& tags) {
  if (add_word(attributes, plant_words, tags)) return;
  const auto height = attributes.find("averageHeight");
  const auto metres = height != attributes.end() ? parse_length_m(height->second) : std::nullopt;
  if (metres && *metres >= 3.0)
    tags["natural"] = "wood";
  else if (metres && *metres >= 0.5)
    tags["natural"] = "scrub";
  else
    tags["landuse"] = "grass";
}

}  // namespace

CityClass city_class(std::string_view type, const Attributes& attributes) {
  using Shape = CityClass::Shape;
  const auto area = [](CityTags tags) { return CityClass{Shape::area, std::move(tags)}; };
  if (type == "Building") return {Shape::solid, {{"building", "yes"}}};
  if (type == "BuildingPart" || type == "BuildingStorey" || type == "BuildingUnit")
    return {Shape::solid, {{"building:part", "yes"}}};
  if (type == "BuildingInstallation") return {Shape::solid, {{"building:part", "installation"}}};
  if (type == "Bridge" || type == "BridgePart") return area({{"man_made", "bridge"}, {"layer", "1"}});
  if (type == "WaterBody") return area({{"natural", "water"}});
  if (type == "Railway") return area({{"railway", "rail"}, {"area", "yes"}});
  if (type == "Waterway") return area({{"natural", "water"}});
  if (type == "SolitaryVegetationObject") return {Shape::point, {{"natural", "tree"}}};
  CityTags tags;
  if (type == "Road" || type == "TransportSquare" || type == "Square" || type == "Track") {
    if (!add_word(attributes, road_words, tags))
      tags["highway"] = type == "Road" ? "road" : type == "Track" ? "track" : "pedestrian";
    add_word(attributes, surface_words, tags);
    tags["area"] = "yes";
    return area(std::move(tags));
  }
  if (type == "LandUse") {
    const bool land = add_word(attributes, land_words, tags);
    if (!add_word(attributes, surface_words, tags) && !land) tags["landuse"] = "yes";
    tags["area"] = "yes";
    return area(std::move(tags));
  }
  if (type == "PlantCover") {
    add_plants(attributes, tags);
    return area(std::move(tags));
  }
  return {};
}

}  // namespace greatx::scene::place
