// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/files/known_format.h"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <string_view>

#include <fmt/format.h>

namespace greatx::scene {
namespace {

constexpr size_t head_bytes = 4096;

enum class Kind {
  blender,
  fbx,
  obj,
  collada,
  stl,
  three_ds,
  ply,
  x3d,
  usd,
  ifc,
  step,
  citygml,
  map,
  raster,
  points,
  mitsuba,
  sketchup,
  cad,
  archive,
  scenario,
  campaign,
  place,
  gltf
};

struct Description {
  Kind kind;
  const char* name;
  const char* way;
};

constexpr const char* by_blender =
    "Blender imports it and exports glTF 2.0 (docs/models.md); or `assimp export FILE FILE.glb -fglb2` "
    "(Debian: assimp-utils)";

const Description descriptions[] = {
    {Kind::blender, "a Blender file",
     "Blender exports glTF 2.0 (File, Export; docs/models.md), also by `blender -b FILE --python-expr "
     "\"import "
     "bpy; bpy.ops.export_scene.gltf(filepath='FILE.glb')\"`"},
    {Kind::fbx, "an FBX file", by_blender},
    {Kind::obj, "a Wavefront OBJ file", by_blender},
    {Kind::collada, "a COLLADA file", by_blender},
    {Kind::three_ds, "a 3DS file", by_blender},
    {Kind::x3d, "an X3D or VRML file", by_blender},
    {Kind::stl, "an STL file",
     "it has neither materials nor a unit of length: import it into Blender, give it both, and export glTF "
     "2.0 "
     "(docs/models.md)"},
    {Kind::ply, "a PLY file",
     "of a Mitsuba or Sionna RT scene `greatx scene import` reads the .xml file that names it; else import "
     "it "
     "into Blender and export glTF 2.0 (docs/models.md)"},
    {Kind::usd, "a USD file", "Blender imports it and exports glTF 2.0 (docs/models.md)"},
    {Kind::ifc, "an IFC file", "IfcConvert (ifcopenshell.org) makes glTF of it: `IfcConvert FILE FILE.glb`"},
    {Kind::step, "a STEP file", "FreeCAD opens it and exports glTF"},
    {Kind::citygml, "a CityGML file",
     "`citygml-tools to-cityjson FILE` makes CityJSON of it, which `greatx scene build` reads "
     "(docs/places.md)"},
    {Kind::map, "a map",
     "`greatx scene build place.yaml` makes a scene of it, where place.yaml names it as a source "
     "(docs/places.md)"},
    {Kind::raster, "a raster",
     "`greatx scene build place.yaml` takes terrain and orthophotos as sources (docs/places.md)"},
    {Kind::points, "a point cloud",
     "it has no surfaces: rasterise its ground and give `greatx scene build` the heights as a GeoTIFF "
     "(docs/places.md), for example by `pdal translate FILE heights.tif`; or mesh it in CloudCompare and "
     "export "
     "it by Blender"},
    {Kind::mitsuba, "a scene of Mitsuba or Sionna RT",
     "`greatx scene import FILE -o FILE.glb` converts it (docs/import.md)"},
    {Kind::sketchup, "a SketchUp file", "SketchUp exports glTF, or COLLADA for Blender"},
    {Kind::cad, "a CAD drawing", "open it in a program that exports solids as glTF, such as FreeCAD"},
    {Kind::archive, "an archive", "unpack it first"},
    {Kind::scenario, "a scenario of greatx", "`greatx generate FILE -o DIR` runs it"},
    {Kind::campaign, "a campaign of greatx", "`greatx campaign run FILE -o DIR` runs it (docs/campaigns.md)"},
    {Kind::place, "a place of greatx", "`greatx scene build FILE` makes a scene of it"},
    {Kind::gltf, "a glTF scene",
     "a scenario names it: `scene: {file: FILE}` (docs/scenario.md); `greatx scene info FILE` describes it"},
};

struct Extension {
  const char* text;  ///< with spaces between them, lower case
  Kind kind;
};

constexpr Extension extensions[] = {
    {".blend .blend1", Kind::blender},
    {".fbx", Kind::fbx},
    {".obj .mtl", Kind::obj},
    {".dae", Kind::collada},
    {".stl", Kind::stl},
    {".3ds .max", Kind::three_ds},
    {".ply", Kind::ply},
    {".x3d .wrl", Kind::x3d},
    {".usd .usda .usdc .usdz", Kind::usd},
    {".ifc", Kind::ifc},
    {".step .stp", Kind::step},
    {".gml .citygml", Kind::citygml},
    {".osm .pbf .geojson .gpkg .shp .kml", Kind::map},
    {".tif .tiff .asc .hgt .vrt", Kind::raster},
    {".las .laz .e57 .pcd .xyz .pts", Kind::points},
    {".skp", Kind::sketchup},
    {".dwg .dxf", Kind::cad},
    {".zip .7z .gz .tgz .rar .xz .zst", Kind::archive},
};

/// The start of a file, and where it is looked for.
class Head {
 public:
  explicit Head(std::span<const unsigned char> bytes)
      : size_(bytes.size()),
        text_(reinterpret_cast<const char*>(bytes.data()), std::min(bytes.size(), head_bytes)) {}
  bool begins(std::string_view with) const { return text_.starts_with(with); }
  bool has(std::string_view part) const { return text_.find(part) != std::string_view::npos; }
  /// Whether a line begins so.
  bool has_line(const std::string& start) const { return begins(start) || has("\n" + start); }
  char first_character() const {
    const size_t at = text_.find_first_not_of(" \t\r\n\xef\xbb\xbf");
    return at == std::string_view::npos ? '\0' : text_[at];
  }
  /// A binary STL file has 80 bytes, a number of triangles, and 50 bytes for each.
  bool is_binary_stl() const {
    if (size_ < 84) return false;
    uint64_t triangles = 0;
    for (size_t i = 0; i < 4; ++i)
      triangles |= uint64_t{static_cast<unsigned char>(text_[80 + i])} << (8 * i);
    return triangles > 0 && size_ == 84 + 50 * triangles;
  }

 private:
  size_t size_;
  std::string_view text_;
};

std::optional<Kind> kind_of_xml(const Head& head) {
  if (head.has("<scene")) return Kind::mitsuba;
  if (head.has("CityModel")) return Kind::citygml;
  if (head.has("<COLLADA")) return Kind::collada;
  if (head.has("<osm") || head.has("<kml")) return Kind::map;
  if (head.has("<X3D")) return Kind::x3d;
  return std::nullopt;
}

std::optional<Kind> kind_of_content(const Head& head) {
  if (head.begins("glTF")) return Kind::gltf;
  if (head.begins("BLENDER")) return Kind::blender;
  if (head.begins("Kaydara FBX Binary") || head.begins("; FBX")) return Kind::fbx;
  if (head.begins("LASF") || head.begins("ASTM-E57") || head.begins("# .PCD")) return Kind::points;
  if (head.begins("PXR-USDC") || head.begins("#usda")) return Kind::usd;
  if (head.begins("ply\n") || head.begins("ply\r")) return Kind::ply;
  if (head.begins("#VRML") || head.begins("#X3D")) return Kind::x3d;
  if (head.begins("ISO-10303-21")) return head.has("IFC") ? Kind::ifc : Kind::step;
  if (head.begins("SQLite format 3") || head.begins(std::string_view("\0\0\x27\x0a", 4))) return Kind::map;
  if (head.begins(std::string_view("II*\0", 4)) || head.begins(std::string_view("MM\0*", 4)))
    return Kind::raster;
  if (head.begins("AC10")) return Kind::cad;
  if (head.first_character() == '<') return kind_of_xml(head);
  if (head.first_character() == '{') {
    if (head.has("\"CityJSON\"") || head.has("\"FeatureCollection\"")) return Kind::map;
    return head.has("\"asset\"") || head.has("\"meshes\"") ? std::optional(Kind::gltf) : std::nullopt;
  }
  if (head.has_line("greatx_place:")) return Kind::place;
  if (head.has_line("greatx_campaign:")) return Kind::campaign;
  if (head.has_line("greatx:")) return Kind::scenario;
  if (head.has_line("solid ") && head.has("facet")) return Kind::stl;
  if (head.is_binary_stl()) return Kind::stl;
  if (head.has_line("mtllib ") || (head.has_line("v ") && (head.has_line("vn ") || head.has_line("f "))))
    return Kind::obj;
  return std::nullopt;
}

std::optional<Kind> kind_of_name(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::ranges::transform(extension, extension.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension.empty()) return std::nullopt;
  for (const Extension& known : extensions)
    if (fmt::format(" {} ", known.text).find(' ' + extension + ' ') != std::string::npos) return known.kind;
  return std::nullopt;
}

}  // namespace

std::optional<KnownFormat> recognised_format(const std::filesystem::path& file,
                                             std::span<const unsigned char> bytes) {
  std::optional<Kind> kind = kind_of_content(Head(bytes));
  if (!kind) kind = kind_of_name(file);
  if (!kind) return std::nullopt;
  const auto* const found = std::ranges::find(descriptions, *kind, &Description::kind);
  std::string way = found->way;
  const std::string name = file.filename().string(), stem = file.stem().string();
  for (size_t at = 0; (at = way.find("FILE", at)) != std::string::npos;) {
    const std::string& shown = way.compare(at, 8, "FILE.glb") == 0 ? stem : name;
    way.replace(at, 4, shown);
    at += shown.size();
  }
  return KnownFormat{found->name, way, *kind == Kind::gltf, *kind == Kind::scenario, *kind == Kind::mitsuba};
}

KnownFormat unknown_format() {
  return {
      "a format that greatx does not know",
      "greatx reads glTF, imports scenes of Mitsuba 3 and Sionna RT (greatx scene import) and builds maps, "
      "CityJSON and terrain (greatx scene build); Blender makes glTF of OBJ, FBX, USD and others "
      "(docs/import.md, docs/models.md)"};
}

std::vector<unsigned char> first_bytes(const std::filesystem::path& file) {
  std::vector<unsigned char> bytes(head_bytes);
  std::ifstream stream(file, std::ios::binary);
  stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<size_t>(std::max<std::streamsize>(stream.gcount(), 0)));
  return bytes;
}

std::string wrong_format(const std::filesystem::path& file, const KnownFormat& found,
                         const std::string& expected) {
  return fmt::format("{}: expected {}, found {}; {}", file.string(), expected, found.name, found.way);
}

}  // namespace greatx::scene
