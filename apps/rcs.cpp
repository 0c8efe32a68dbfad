// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The rcs command: the scattering of a node's model, computed once and kept as a table for channels.
#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "apps/commands.h"
#include "apps/console/command_line.h"
#include "apps/console/session.h"
#include "core/error.h"
#include "core/expected.h"
#include "core/units.h"
#include "core/watch.h"
#include "gpu/device.h"
#include "io/files/file.h"
#include "rf/targets/target_model.h"
#include "rf/targets/tubes/far_field.h"
#include "scene/description/scene.h"
#include "scene/device/gpu_scene.h"
#include "sim/scenario/parse/rcs_csv.h"
#include "sim/world/world.h"

namespace greatx::apps {

namespace {

struct RcsCommand {
  ScenarioOptions scenario;
  RunOptions run;
  std::string node, output = "rcs.csv";
  double carrier_hz = 28e9, step_deg = 5.0, width_m = 0.03;
  uint32_t budget = 16384, bounces = 3;
  bool bistatic = false;
};

/// Returns the world of one node at the origin, its model a body of its own as that of a channel's target.
sim::World world_of(const RcsCommand& command, const sim::Scenario& all) {
  for (const sim::NodeConfig& node : all.nodes) {
    if (node.name != command.node) continue;
    if (!node.model) throw_user_error("--node: expected a node with a model, found '{}'", command.node);
    sim::Scenario alone;
    alone.name = all.name;
    alone.scene.radio_materials = all.scene.radio_materials;
    alone.nodes = {node};
    alone.nodes[0].trajectory = sim::StaticTrajectory{};
    alone.nodes[0].sensors.clear();
    sim::ChannelConfig& channel = alone.channels.emplace_back();
    channel.name = "rcs";
    channel.carrier_hz = command.carrier_hz;
    channel.targets.push_back({0, sim::TargetTubes{}, {}});
    channel.where = node.where;
    return sim::load_world(alone);
  }
  std::vector<std::string> names;
  for (const sim::NodeConfig& node : all.nodes) names.push_back(node.name);
  throw_user_error("--node: {}", expected_one_of(names, command.node));
}

rf::PosedTarget posed(const scene::Scene& scene, uint32_t body) {
  rf::PosedTarget target;
  for (uint32_t i = 0; i < scene.bodies.size(); ++i) {
    const auto& joint = scene.bodies[i].joint;
    // A part may hang on a part, as a shank on a thigh; its carrier comes before it.
    const Pose carrier = joint ? target.bodies[joint->owner] : i == 0 ? Pose{} : scene.to_local(Pose{});
    target.bodies.push_back(joint ? carrier * joint->pose(0.0) : carrier);
  }
  target.centre = scene.to_local(scene.reach_of(body).center());
  target.size_m = glm::length(scene.reach_of(body).size());
  return target;
}

/// A direction of the table, away from the target.
struct TableDirection {
  double theta_deg, phi_deg;
  dvec3 unit;
};

std::vector<TableDirection> directions_of(const RcsCommand& command) {
  const auto zeniths = static_cast<int>(std::lround(180.0 / command.step_deg));
  std::vector<TableDirection> directions;
  for (int i = 0; i <= zeniths; ++i)
    for (int j = 0; j < 2 * zeniths; ++j) {
      // A pole has the basis of its azimuth, so that entries are smooth towards it.
      const double theta = std::clamp(radians(i * command.step_deg), 1e-6, pi - 1e-6),
                   phi = radians(j * command.step_deg);
      directions.push_back(
          {i * command.step_deg,
           j * command.step_deg,
           {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)}});
    }
  return directions;
}

std::string text_of(std::initializer_list<rf::Complex> entries) {
  std::string text;
  for (const rf::Complex& entry : entries) text += fmt::format(",{:.7g},{:.7g}", entry.real(), entry.imag());
  return text + "\n";
}

template <typename Matrix>
void add_monostatic(const std::vector<TableDirection>& directions, const Matrix& matrix, std::string& text) {
  text += "theta_deg,phi_deg,s_tt_re,s_tt_im,s_tp_re,s_tp_im,s_pp_re,s_pp_im\n";
  for (const TableDirection& d : directions) {
    const rf::ScatterMatrix s = matrix(d, d);
    const rf::Complex cross = 0.5 * (s[1] + s[2]);  // equal by reciprocity, but for the tubes
    text += fmt::format("{:g},{:g}", d.theta_deg, d.phi_deg) + text_of({s[0], cross, s[3]});
  }
}

template <typename Matrix>
void add_bistatic(const std::vector<TableDirection>& directions, const Matrix& matrix, std::string& text) {
  text +=
      "theta_in_deg,phi_in_deg,theta_out_deg,phi_out_deg,"
      "s_tt_re,s_tt_im,s_tp_re,s_tp_im,s_pt_re,s_pt_im,s_pp_re,s_pp_im\n";
  for (const TableDirection& in : directions)
    for (const TableDirection& out : directions) {
      const rf::ScatterMatrix s = matrix(in, out);
      text += fmt::format("{:g},{:g},{:g},{:g}", in.theta_deg, in.phi_deg, out.theta_deg, out.phi_deg) +
              text_of({s[0], s[1], s[2], s[3]});
    }
}

std::string table_of(const RcsCommand& command, gpu::Device& device, const sim::World& world, uint64_t seed) {
  const scene::Scene& scene = world.scene;
  const uint32_t body = world.body_of_node[0];
  if (body == 0 || scene.reach_of(body).empty())
    throw_user_error("--node: expected a node with surfaces, found '{}'", command.node);
  const rf::PosedTarget target = posed(scene, body);
  scene::GpuScene gpu_scene(device, scene, {});
  const rf::RadioSurfaces surfaces(scene, command.carrier_hz);
  rf::TubeOptions options;
  for (uint32_t i = 0; i < scene.instances.size() && options.instances.empty(); ++i)
    if (scene.owner_of(scene.instances[i].body) == body) options.instances = {i};
  options.tube_m = command.width_m;
  options.budget = command.budget;
  options.max_bounces = command.bounces;
  options.bandwidth_hz = 1.0;  // all echoes of a direction are summed at the carrier
  options.seed = seed;
  rf::TubeTargets tubes(gpu_scene, surfaces, "rcs", 0, 0, options);
  gpu::TickRing ring(device, 2, 1u << 20, 1u << 20);
  const auto matrix = [&](const TableDirection& in, const TableDirection& out) {
    checkpoint();
    return rf::far_field(tubes, gpu_scene, ring, target, {in.unit, out.unit}, command.carrier_hz);
  };
  std::string text = fmt::format(
      "# {} at {:g} Hz, tubes of {:g} m, {} bounces: S in m by physical optics and scatterers, phases about "
      "the centre of its box\n",
      command.node, command.carrier_hz, command.width_m, command.bounces);
  if (command.bistatic)
    add_bistatic(directions_of(command), matrix, text);
  else
    add_monostatic(directions_of(command), matrix, text);
  return text;
}

void run(const RcsCommand& command) {
  const double zeniths = 180.0 / command.step_deg;
  if (std::abs(zeniths - std::round(zeniths)) > 1e-9)
    throw_user_error("--step: expected a step that divides 180 degrees, found {}", command.step_deg);
  const auto steps = static_cast<uint64_t>(std::lround(zeniths));
  const uint64_t directions = (steps + 1) * 2 * steps,
                 lines = command.bistatic ? directions * directions : directions;
  if (lines > sim::most_rcs_lines)
    throw_user_error("--step: expected a step that gives at most {} lines of the table, found {} with {}",
                     sim::most_rcs_lines, lines, command.step_deg);
  const sim::Scenario scenario = load_scenario(command.scenario);
  const sim::World world = world_of(command, scenario);
  gpu::Device device(command.run.device_options());
  io::write_file_atomically(command.output, table_of(command, device, world, scenario.seed));
  check_validation(device);
  std::cout << fmt::format("wrote {}: {} {} at {:g} GHz\n", command.output, lines,
                           command.bistatic ? "pairs of directions" : "directions",
                           command.carrier_hz * 1e-9);
}

}  // namespace

void add_rcs(CLI::App& app) {
  CLI::App* command = app.add_subcommand("rcs", "compute the scattering of a node's model as a table");
  auto options = std::make_shared<RcsCommand>();
  options->scenario.add_to(*command);
  options->run.add_to(*command);
  command->add_option("--node", options->node, "the node whose model scatters")->required();
  command->add_option("--carrier", options->carrier_hz, "frequency, Hz")
      ->default_str("28e9")
      ->check(number_of(1e6, 1e13));
  command->add_option("--step", options->step_deg, "step of both angles, degrees; it divides 180")
      ->capture_default_str()
      ->check(number_of(0.1, 90.0));
  command->add_option("--width", options->width_m, "width of the ray tubes, m")
      ->capture_default_str()
      ->check(number_of(1e-4, 1e4));
  command->add_option("--budget", options->budget, "most ray tubes")
      ->capture_default_str()
      ->check(integer_of(100, 4'000'000));
  command->add_option("--bounces", options->bounces, "most surfaces that a tube meets")
      ->capture_default_str()
      ->check(integer_of(1, 6));
  command->add_flag("--bistatic", options->bistatic,
                    "every pair of directions, of the source and of the receiver, instead of equal ones");
  command->add_option("-o,--output", options->output, "the table, CSV")->capture_default_str();
  command->callback([options] { run(*options); });
}

}  // namespace greatx::apps
