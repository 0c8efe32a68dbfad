// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <iostream>
#include <memory>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "apps/commands.h"
#include "apps/console/command_line.h"
#include "apps/files/scene_import.h"
#include "apps/place/command/build_command.h"
#include "apps/scene_check.h"
#include "core/error.h"
#include "core/srgb.h"
#include "scene/build/build.h"
#include "scene/generator/generate.h"
#include "scene/georeference/georeference.h"
#include "scene/import/mitsuba.h"

namespace greatx::apps {

namespace {

struct GenerateCommand {
  scene::GenerateOptions options;
  std::string output;
};

void generate(const GenerateCommand& command) {
  const std::vector<std::byte> glb = scene::generate_glb(command.options);
  io::create_folder_of(command.output);
  io::write_file_atomically(command.output, glb);
  std::cout << fmt::format("wrote {} ({:.1f} KiB)\n", command.output,
                           static_cast<double>(glb.size()) / 1024.0);
}

struct ImportCommand {
  std::string file, output, radio_materials;
  scene::MitsubaOptions options;
};

void import(const ImportCommand& command) {
  const scene::ImportedScene imported = scene::import_mitsuba(command.file, command.options);
  const std::filesystem::path file(command.file);
  io::create_folder_of(command.output);
  io::create_folder_of(command.radio_materials);
  io::write_file_atomically(command.output, imported_glb(imported, file.stem().string()));
  std::cout << fmt::format("wrote {}: {} objects, {} triangles, {} materials\n", command.output,
                           imported.objects.size(), imported.triangle_count(), imported.materials.size());
  for (const scene::ImportedMaterial& material : imported.materials)
    std::cout << fmt::format("  material {:<28} {}\n", material.name, material.radio_json);
  for (const std::string& note : imported.notes) std::cout << "  note: " << note << '\n';
  if (command.radio_materials.empty()) return;
  io::write_file_atomically(command.radio_materials, imported_sidecar(imported, file.filename().string()));
  std::cout << fmt::format("wrote {}\n", command.radio_materials);
}

void add_import(CLI::App& scene_command) {
  CLI::App* command = scene_command.add_subcommand(
      "import", "convert a scene of Mitsuba 3 or Sionna RT (XML and PLY) to glTF (docs/import.md)");
  auto options = std::make_shared<ImportCommand>();
  command->add_option("FILE", options->file, ".xml, its meshes beside it")->required();
  command->add_option("-o,--output", options->output, ".glb to write")->required();
  command->add_option("--radio-materials", options->radio_materials,
                      "also write the radio properties as YAML, to be edited (docs/materials.md)");
  command
      ->add_option("--thickness", options->options.default_thickness_m,
                   "of materials whose file gives none, m (Sionna RT's default)")
      ->capture_default_str();
  command->callback([options] { import(*options); });
}

struct InfoCommand {
  std::string file;
  scene::LoadOptions options;
};

std::string describe(const std::vector<scene::RadioLayer>& layers) {
  std::vector<std::string> texts;
  for (const scene::RadioLayer& layer : layers)
    texts.push_back(layer.thickness_m > 0.0
                        ? fmt::format("{}, {:g} m", layer.medium.source, layer.thickness_m)
                        : layer.medium.source + ", half-space");
  return fmt::format("{}", fmt::join(texts, " | "));
}

std::string describe(const std::optional<scene::RadioMaterial>& radio) {
  if (!radio) return "no radio properties";
  if (radio->foliage && radio->foliage->attenuation_db_per_m)
    return fmt::format("foliage, {} dB/m", *radio->foliage->attenuation_db_per_m);
  if (radio->foliage) return "foliage, Weissberger's model";
  const std::string wall = describe(radio->layers);
  if (!radio->windows) return wall;
  return fmt::format("{}; windows on {:g} % of its area: {}", wall, 100.0 * radio->windows->share,
                     describe(radio->windows->layers));
}

double luminance(const vec3& color) { return 0.2126 * color.r + 0.7152 * color.g + 0.0722 * color.b; }

/// Returns the luminance of the base colour, averaged over its texture. Texels that the alpha mask cuts out
/// do not count.
double mean_luminance(const scene::Material& material, const scene::Scene& scene) {
  const vec4& factor = material.pbr.base_color;
  if (material.pbr.base_color_texture < 0) return luminance(vec3(factor));
  const scene::Texture& texture = scene.textures[static_cast<size_t>(material.pbr.base_color_texture)];
  const bool cut = material.pbr.alpha_mode == scene::AlphaMode::mask;
  double linear[256], sum = 0.0;
  for (int i = 0; i < 256; ++i) linear[i] = texture.srgb ? linear_from_srgb(i / 255.0) : i / 255.0;
  size_t count = 0;
  for (size_t at = 0; at + 3 < texture.rgba.size(); at += 4) {
    const uint8_t* texel = texture.rgba.data() + at;
    if (cut && factor.a * static_cast<float>(texel[3]) / 255.0f < material.pbr.alpha_cutoff) continue;
    sum += 0.2126 * factor.r * linear[texel[0]] + 0.7152 * factor.g * linear[texel[1]] +
           0.0722 * factor.b * linear[texel[2]];
    ++count;
  }
  return count > 0 ? sum / static_cast<double>(count) : 0.0;
}

/// Returns a text such as "reflectance 0.20 (905 nm, from the base colour), 0.25 (1550 nm)": the stated
/// reflectance, or the value that LiDAR uses if none is stated.
std::string reflectance_of(const scene::Material& material, const scene::Scene& scene) {
  const bool textured = material.pbr.base_color_texture >= 0;
  const double color = mean_luminance(material, scene);
  const auto at = [&](const std::optional<float>& stated, const char* wavelength) {
    if (stated) return fmt::format("{:.2f} ({})", *stated, wavelength);
    return fmt::format("{:.2f} ({}, {})", color, wavelength,
                       textured ? "mean of the base colour's texture" : "from the base colour");
  };
  return fmt::format("reflectance {}, {}", at(material.reflectance_905nm, "905 nm"),
                     at(material.reflectance_1550nm, "1550 nm"));
}

void info(const InfoCommand& command) {
  const scene::Model model = scene::load_model(command.file, command.options);
  const scene::Scene scene =
      scene::build_scene({{"", &model, {}, dvec3(1.0), false, {}}}, {command.file, {}});
  const dvec3 size = scene.bounds.size(), center = scene.bounds.center() + scene.origin;
  std::cout << fmt::format("{}\n  {} triangles, {} facets, {} instances, {} lights, {} textures\n",
                           command.file, scene.triangle_count(), scene.facets.size(), scene.instances.size(),
                           scene.lights.size(), scene.textures.size());
  std::cout << fmt::format("  {:.2f} x {:.2f} x {:.2f} m around ({:.2f}, {:.2f}, {:.2f})\n", size.x, size.y,
                           size.z, center.x, center.y, center.z);
  if (model.georeference)
    std::cout << fmt::format("  origin at {}\n", scene::georeference_words(*model.georeference));
  std::cout << fmt::format("  nodes {}\n", scene::node_names(model));
  for (const scene::Material& material : scene.materials) {
    std::cout << fmt::format("  material {:<28} {}; {}\n", material.name, describe(material.radio),
                             reflectance_of(material, scene));
  }
  for (const std::string& note : scene.notes) std::cout << "  note: " << note << '\n';
}

}  // namespace

void add_scene(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("scene", "make a scene or an object, import or build one, describe or check a file");
  command->require_subcommand(1);
  for (const scene::GeneratorKind& kind : scene::generators()) {
    CLI::App* maker = command->add_subcommand(kind.name, fmt::format("make {}", kind.words));
    auto options = std::make_shared<GenerateCommand>();
    options->options.kind = kind.name;
    options->output = kind.name + ".glb";
    if (kind.seeded)
      maker->add_option("--seed", options->options.seed, "every choice follows from it")
          ->capture_default_str();
    if (kind.most_size_m > 0.0)
      maker->add_option("--size", options->options.size_m, "edge of the square, or length of the street, m")
          ->capture_default_str()
          ->check(number_of(kind.least_size_m, kind.most_size_m));
    if (const std::vector<std::string> variants = scene::generator_variants(kind.name); !variants.empty())
      maker->add_option("--" + kind.variant_word, options->options.variant, "which one")
          ->default_str(variants.front())
          ->check(one_of(variants));
    maker->add_option("-o,--output", options->output, "file to write")->capture_default_str();
    maker->callback([options] { generate(*options); });
  }
  add_import(*command);
  add_scene_build(*command);
  add_scene_check(*command);
  CLI::App* describe = command->add_subcommand("info", "describe a glTF file as greatx sees it");
  auto options = std::make_shared<InfoCommand>();
  describe->add_option("FILE", options->file, ".gltf or .glb")->required();
  describe->add_option("--radio-materials", options->options.radio_materials,
                       "YAML with radio properties (docs/materials.md)");
  describe->add_flag("--optical-only", options->options.optical_only,
                     "accept materials without radio properties");
  describe->callback([options] { info(*options); });
}

}  // namespace greatx::apps
