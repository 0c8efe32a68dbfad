// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/property/drawn_case.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>

#include <fmt/format.h>

#include "core/random.h"
#include "core/units.h"
#include "io/formats/glb_writer.h"
#include "sim/experiment/experiment.h"
#include "sim/scenario/parse/load_scenario.h"
#include "tests/support/kept_run.h"
#include "tests/support/temporary_folder.h"

namespace greatx::property {

namespace {

struct NamedRadio {
  const char* name;
  const char* fields;  ///< JSON of GREATX_radio_material
};
constexpr NamedRadio materials[] = {
    {"ground", R"({"itu": "concrete", "scattering_coefficient": 0.2, "pattern": "directive"})"},
    {"brick", R"({"itu": "brick", "thickness_m": 0.2, "scattering_coefficient": 0.4,
                  "cross_polarization": 0.2})"},
    {"glass", R"({"itu": "glass", "thickness_m": 0.01})"},
    {"metal", R"({"itu": "metal"})"},
};

double on_grid(double value) { return std::round(value * 1024.0) / 1024.0; }

using Triangle = std::array<dvec3, 3>;

std::vector<Triangle> quad(const dvec3& corner, const dvec3& along, const dvec3& up) {
  const dvec3 b = corner + along, c = b + up, d = corner + up;
  return {{corner, b, c}, {corner, c, d}};
}

std::vector<Triangle> triangles_of(const DrawnBox& box) {
  const dvec3 o = box.corner, u(box.u, 0.0), v(box.v, 0.0), w(0.0, 0.0, box.height);
  std::vector<Triangle> all;
  for (const auto& face :
       {quad(o, v, u), quad(o + w, u, v), quad(o, u, w), quad(o + v, w, u), quad(o, w, v), quad(o + u, v, w)})
    all.insert(all.end(), face.begin(), face.end());
  return all;
}

struct Object {
  std::string name;
  uint32_t material = 0;
  std::vector<Triangle> triangles;
};

std::vector<Object> objects_of(const DrawnCase& drawn) {
  std::vector<Object> objects;
  if (drawn.ground) objects.push_back({"ground", 0, quad({-32, -32, 0}, {64, 0, 0}, {0, 64, 0})});
  for (size_t i = 0; i < drawn.boxes.size(); ++i)
    objects.push_back({fmt::format("box {}", i), drawn.boxes[i].material, triangles_of(drawn.boxes[i])});
  if (objects.empty())  // a file needs a mesh: a leaf of metal far below
    objects.push_back({"leaf", 3, {{dvec3(0, 0, -90), dvec3(0.125, 0, -90), dvec3(0, 0.125, -90)}}});
  return objects;
}

std::vector<Triangle> in_form(std::vector<Triangle> triangles, const Form& form) {
  if (form.split) {
    std::vector<Triangle> finer;
    for (const Triangle& t : triangles) {
      const dvec3 ab = 0.5 * (t[0] + t[1]), bc = 0.5 * (t[1] + t[2]), ca = 0.5 * (t[2] + t[0]);
      finer.insert(finer.end(), {{t[0], ab, ca}, {ab, t[1], bc}, {ca, bc, t[2]}, {ab, bc, ca}});
    }
    triangles = std::move(finer);
  }
  if (form.reversed) {
    std::ranges::reverse(triangles);
    for (Triangle& t : triangles) t = {t[1], t[2], t[0]};
  }
  return triangles;
}

std::string glb_of(const DrawnCase& drawn, const Form& form, const std::filesystem::path& file) {
  io::GlbWriter glb;
  constexpr int count = std::size(materials);
  for (int i = 0; i < count; ++i) {
    const NamedRadio& radio = materials[form.reversed ? count - 1 - i : i];
    io::GlbMaterial material;
    material.name = radio.name;
    material.extensions_json = fmt::format(R"({{"GREATX_radio_material": {}}})", radio.fields);
    glb.add_material(material);
  }
  std::vector<Object> objects = objects_of(drawn);
  if (form.reversed) std::ranges::reverse(objects);
  for (const Object& object : objects) {
    io::GlbPrimitive primitive;
    const int material = static_cast<int>(object.material);
    primitive.material = form.reversed ? count - 1 - material : material;
    for (const Triangle& triangle : in_form(object.triangles, form))
      for (const dvec3& corner : triangle) {
        primitive.indices.push_back(static_cast<uint32_t>(primitive.positions.size()));
        primitive.positions.push_back(vec3(corner / form.unit_m));
      }
    io::GlbNode node;
    node.name = object.name;
    node.mesh = glb.add_mesh(object.name, {primitive});
    node.pose = {form.shift, orientation_from_yaw_pitch_roll(radians(form.turn_deg), 0, 0)};
    if (form.unit_m != 1.0) node.scale = form.unit_m;
    glb.add_node(node);
  }
  const io::Bytes bytes = glb.finish("drawn");
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  return file.filename().string();
}

std::string node_yaml(const std::string& name, const Form& form, const dvec3& at, bool moves) {
  const auto place = [&](const dvec3& from) {
    const dvec3 p = orientation_from_yaw_pitch_roll(radians(form.turn_deg), 0, 0) * from + form.shift;
    return fmt::format("position_m: [{:.17g}, {:.17g}, {:.17g}]", p.x, p.y, p.z);
  };
  const std::string trajectory =
      moves ? fmt::format("type: waypoints, points: [{{t_s: 0, {}}}, {{t_s: 1, {}}}]", place(at),
                          place(at + dvec3(7.0, -4.0, 1.0)))
            : "type: static, " + place(at);
  return fmt::format(
      "  - name: {}\n    trajectory: {{{}}}\n    sensors: [{{name: antenna, type: antenna{}}}]\n", name,
      trajectory, form.slant ? ", polarization: slant" : "");
}

}  // namespace

DrawnCase draw_case(uint64_t seed) {
  RandomStream random(seed, 0x70726f70u);
  DrawnCase drawn;
  drawn.seed = seed;
  const auto grid = [&](double low, double high) { return on_grid(random.uniform(low, high)); };
  const uint32_t boxes = 2 + random.below(4);
  for (uint32_t i = 0; i < boxes; ++i) {
    DrawnBox box;
    // The foot is below the ground: of coincident facets a path names the one of the lowest number
    // (rf/geometry/geometry.h), and so one of two materials. The property of renumbering has found that.
    box.corner = {grid(-20, 14), grid(-20, 14), -0.5};
    if (random.below(4) == 0) box.corner.z = grid(0.5, 3);
    const double length = grid(3, 9), across = random.below(2) == 0 ? 0.0 : grid(-5, 5),
                 share = grid(0.4, 1.5);
    box.u = {length, across};
    box.v = {on_grid(-across * share), on_grid(length * share)};
    box.height = grid(3, 12);
    box.material = 1 + random.below(3);
    drawn.boxes.push_back(box);
  }
  const auto place = [&] {
    const double x = random.uniform(-22, 22), y = random.uniform(-22, 22);
    return dvec3(x, y, random.uniform(0.3, 14));
  };
  drawn.transmitter = place();
  for (int i = 0; i < 3; ++i) drawn.receivers.push_back(place());
  drawn.depth = 2 + random.below(2);
  drawn.transmission = random.below(2) == 0;
  drawn.diffraction = random.below(3) == 0;
  constexpr double carriers[] = {0.9e9 + 0.2e9, 3.5e9, 28e9};
  drawn.carrier_hz = carriers[random.below(3)];
  return drawn;
}

void write_case(const DrawnCase& drawn, const Form& form, const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  const std::string file = glb_of(drawn, form, folder / "scene.glb");
  std::vector<uint32_t> there = form.only;
  if (there.empty())
    for (uint32_t r = 0; r < drawn.receivers.size(); ++r) there.push_back(r);
  std::vector<std::string> nodes;
  nodes.push_back(node_yaml("tx", form, drawn.transmitter, drawn.transmitter_moves));
  std::string receivers;
  for (const uint32_t r : there) {
    nodes.push_back(node_yaml(fmt::format("rx{}", r), form, drawn.receivers[r], drawn.receivers_move));
    receivers += fmt::format("{}rx{}/antenna", receivers.empty() ? "" : ", ", r);
  }
  if (form.reversed) std::ranges::reverse(nodes);
  std::ofstream yaml(folder / "scenario.yaml");
  const auto on = [](bool value) { return value ? "on" : "off"; };
  yaml << fmt::format("greatx: 1\nname: drawn\nticks: {}\ntick_rate_hz: 10\nscene: {{file: {}}}\n",
                      form.ticks, file)
       << fmt::format("effects: {{transmission: {}, diffraction: {}, scattering: {}, dispersion: {}}}\n",
                      on(drawn.transmission), on(drawn.diffraction), on(drawn.scattering),
                      on(drawn.dispersion))
       << "nodes:\n";
  for (const std::string& node : nodes) yaml << node;
  const std::string transmitter = "tx/antenna";
  yaml << fmt::format(
      "channels:\n  - {{name: csi, tx: [{}], rx: [{}], rate_hz: 10, carrier_hz: {}, bandwidth_hz: 20e6,\n"
      "     subcarriers: 16, max_depth: {}, max_reflections_after: {}, scattering_patch_m: 16{}{}{},\n"
      "     outputs: [cfr, paths]}}\n",
      form.swapped ? receivers : transmitter, form.swapped ? transmitter : receivers, drawn.carrier_hz,
      drawn.depth, drawn.reflections_after, drawn.every_tick ? ", search: every_tick" : "",
      drawn.rays > 0 ? fmt::format(", rays: {}", drawn.rays) : "",
      drawn.two_edges ? ", max_diffractions: 2" : "");
}

Links run_case(const std::filesystem::path& folder) {
  const test::KeptRun run =
      test::keep_run(sim::make_experiment(sim::load_scenario(folder / "scenario.yaml")));
  const auto delay = run.array<double>(0, "csi", "delay");
  const auto amplitude = run.array<std::complex<float>>(0, "csi", "amplitude");
  const auto rx = run.array<int32_t>(0, "csi", "rx");
  const auto cfr = run.array<std::complex<float>>(0, "csi", "cfr");
  Links links(cfr.size() / 16);
  for (size_t i = 0; i < delay.size(); ++i)
    links.at(static_cast<size_t>(rx[i])).paths.push_back({delay[i] * speed_of_light, amplitude[i]});
  for (size_t r = 0; r < links.size(); ++r) {
    std::ranges::stable_sort(links[r].paths, {}, &LinkPath::length_m);
    links[r].cfr.assign(cfr.begin() + static_cast<long>(16 * r),
                        cfr.begin() + static_cast<long>(16 * (r + 1)));
  }
  return links;
}

Links run_case(const DrawnCase& drawn, const Form& form) {
  const test::TemporaryFolder folder;
  write_case(drawn, form, folder.path());
  return run_case(folder.path());
}

std::string describe(const DrawnCase& drawn) {
  return fmt::format(
      "seed {}: {} boxes{}, {} receivers, depth {}{}{}{}{}, {} reflections after{}{}{}{}, {} Hz", drawn.seed,
      drawn.boxes.size(), drawn.ground ? " on a ground" : "", drawn.receivers.size(), drawn.depth,
      drawn.transmission ? ", transmission" : "", drawn.diffraction ? ", diffraction" : "",
      drawn.scattering ? ", scattering" : "", drawn.dispersion ? ", dispersion" : "", drawn.reflections_after,
      drawn.every_tick ? ", searched every tick" : "", drawn.rays > 0 ? ", rays" : "",
      drawn.transmitter_moves ? ", the transmitter moves" : "",
      drawn.receivers_move ? ", the receivers move" : "", drawn.carrier_hz);
}

}  // namespace greatx::property
