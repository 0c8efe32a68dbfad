// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/library/greatx.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <numeric>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "assets/assets.h"
#include "core/error.h"
#include "core/version.h"
#include "engine/session/path_set.h"
#include "engine/session/session.h"
#include "engine/session/stream.h"
#include "sim/scenario/parse/load_scenario.h"

namespace greatx::embed {

namespace {

using Json = nlohmann::ordered_json;

/// Calls a function of the engine, whose classes of errors are no part of the interface.
template <typename Work>
auto guarded(const Work& work) -> decltype(work()) {
  try {
    return work();
  } catch (const UserError& error) {
    throw Error(error.what());
  } catch (const std::runtime_error&) {
    throw;
  } catch (const std::exception& error) {
    throw std::runtime_error(error.what());
  }
}

/// Returns the type of the same name. Both lists have one order.
Type type_of_array(DType dtype) {
  static_assert(static_cast<int>(Type::u8) == static_cast<int>(DType::u8) &&
                static_cast<int>(Type::i8) == static_cast<int>(DType::i8) &&
                static_cast<int>(Type::f32) == static_cast<int>(DType::f32) &&
                static_cast<int>(Type::complex64) == static_cast<int>(DType::complex64));
  return static_cast<Type>(dtype);
}

Array array_of(std::string name, std::string unit, std::string description, greatx::Array from) {
  Array array;
  array.name = std::move(name);
  array.unit = std::move(unit);
  array.description = std::move(description);
  array.type = type_of_array(from.dtype);
  array.shape = std::move(from.shape);
  array.bytes = std::move(from.bytes);
  return array;
}

gpu::DeviceOptions device_options(const Options& options) {
  const std::optional<gpu::Tracer> tracer = gpu::tracer_of(options.tracer);
  if (!tracer) throw_user_error("tracer: expected auto, driver or tree, found '{}'", options.tracer);
  return {options.device, options.validation, *tracer};
}

/// Reads the fields that a caller gives beside those that follow from the arguments.
Json fields_of(const char* where, const std::string& text) {
  const Json fields = Json::parse(text, nullptr, false);
  if (!fields.is_object()) throw_user_error("{}: fields: expected a JSON object, found '{}'", where, text);
  return fields;
}

/// Returns the text of a scenario with these nodes and channels, which the parser of sim/ checks.
std::string scenario_text(const engine::Session& session, Json nodes, Json channels = Json::array()) {
  Json scenario{{"greatx", 1}, {"name", "added"}, {"ticks", 1}, {"nodes", std::move(nodes)}};
  scenario["tick_rate_hz"] = Json::parse(session.facts())["tick_rate_hz"];
  if (!channels.empty()) scenario["channels"] = std::move(channels);
  return scenario.dump();
}

Json antenna_node(const std::string& name, const Position& position, const std::string& sensor, Json fields) {
  fields["name"] = sensor;
  fields["type"] = "antenna";
  return Json{{"name", name},
              {"trajectory", {{"type", "static"}, {"position_m", {position.x, position.y, position.z}}}},
              {"sensors", Json::array({std::move(fields)})}};
}

/// The parser requires that the antennas of a channel exist, so the text of a channel has stand-ins with
/// their names. Throws UserError if the scenario has no antenna of such a name.
Json stand_ins(const engine::Session& session, const std::string& channel,
               const std::vector<std::string>& antennas) {
  const std::vector<std::string> known = Json::parse(session.facts())["antennas"];
  std::map<std::string, Json> nodes;
  for (const std::string& antenna : antennas) {
    if (std::find(known.begin(), known.end(), antenna) == known.end())
      throw_user_error("channel '{}': expected antennas of the scenario ({}), found '{}'", channel,
                       fmt::join(known, ", "), antenna);
    const size_t slash = antenna.rfind('/');
    const std::string node = antenna.substr(0, slash), sensor = antenna.substr(slash + 1);
    Json stand_in = antenna_node(node, {}, sensor, Json::object());
    const auto [at, is_new] = nodes.emplace(node, stand_in);
    if (is_new) continue;
    Json& sensors = at->second["sensors"];
    const auto same = [&](const Json& other) { return other["name"] == sensor; };
    if (std::none_of(sensors.begin(), sensors.end(), same)) sensors.push_back(stand_in["sensors"][0]);
  }
  Json list = Json::array();
  for (const auto& [name, node] : nodes) list.push_back(node);
  return list;
}

bool all(size_t) { return true; }

}  // namespace

Error::~Error() = default;

std::string version() { return GREATX_VERSION; }

std::vector<std::string> embedded_scenarios() {
  std::vector<std::string> names;
  for (const EmbeddedScenario& scenario : greatx::embedded_scenarios()) names.emplace_back(scenario.name);
  return names;
}

size_t Array::size() const {
  return static_cast<size_t>(
      std::accumulate(shape.begin(), shape.end(), int64_t{1}, std::multiplies<int64_t>()));
}

void Array::check_type(Type asked) const {
  if (asked == type) return;
  const auto words = [](Type of) { return numpy_name(static_cast<DType>(of)); };
  throw Error(fmt::format("{}: expected elements of type {}, found {}", name, words(asked), words(type)));
}

struct Paths::State {
  std::shared_ptr<engine::PathSet> set;
  std::vector<Array> arrays;
};

Paths::Paths(std::shared_ptr<State> state) : state_(std::move(state)) {}
size_t Paths::receivers() const { return state_->set->receivers(); }
size_t Paths::transmitters() const { return state_->set->transmitters(); }
size_t Paths::size() const { return static_cast<size_t>(array("delay").shape[0]); }
const std::vector<Array>& Paths::arrays() const { return state_->arrays; }
std::string Paths::facts() const { return state_->set->facts(); }

const Array& Paths::array(const std::string& name) const {
  for (const Array& array : state_->arrays)
    if (array.name == name) return array;
  std::vector<std::string> names;
  for (const Array& array : state_->arrays) names.push_back(array.name);
  throw Error(fmt::format("paths: expected one of {}, found '{}'", fmt::join(names, ", "), name));
}

Array Paths::frequency_response(const Grid& grid) const {
  return guarded([&] {
    const engine::ResponseRequest request{grid.subcarrier_spacing_hz, grid.subcarriers, grid.time_samples,
                                          grid.time_spacing_s, rf::PathSelection::all};
    return array_of("cfr", "1", "[rx, rx_ant, tx, tx_ant, time, subcarrier]: frequency response",
                    state_->set->response(request, all));
  });
}

struct Run::State {
  std::unique_ptr<engine::Stream> stream;
};

Run::Run(std::shared_ptr<State> state) : state_(std::move(state)) {}
std::string Run::sensors() const { return state_->stream->sensors(); }

std::optional<Packet> Run::next() {
  return guarded([&]() -> std::optional<Packet> {
    std::optional<greatx::Packet> from = state_->stream->next();
    if (!from) return std::nullopt;
    Packet packet{from->tick, from->time_ns, {}};
    for (greatx::Record& record : from->records) {
      const SensorSpec& spec = state_->stream->specs()[record.sensor];
      Record& to = packet.records.emplace_back(Record{spec.name, record.sample, {}});
      for (size_t i = 0; i < record.arrays.size(); ++i)
        to.arrays.push_back(array_of(spec.arrays[i].name, spec.arrays[i].unit, spec.arrays[i].description,
                                     std::move(record.arrays[i])));
    }
    return packet;
  });
}

struct Simulation::State {
  engine::Session session;

  Paths solve(const std::string& channel, uint32_t sequence, int64_t tick,
              const std::optional<engine::PointReceivers>& points) {
    auto paths = std::make_shared<Paths::State>();
    paths->set = session.solve(channel, sequence, tick, points, all);
    for (engine::NamedArray& named : paths->set->take_arrays())
      paths->arrays.push_back(array_of(named.name, named.unit, named.description, std::move(named.array)));
    return Paths(std::move(paths));
  }
};

Simulation::Simulation(std::shared_ptr<State> state) : state_(std::move(state)) {}

Simulation::Simulation(const std::string& scenario, const Options& options) {
  guarded([&] {
    sim::Scenario loaded;
    const auto embedded = greatx::embedded_scenarios();
    const auto found = std::find_if(embedded.begin(), embedded.end(),
                                    [&](const EmbeddedScenario& one) { return one.name == scenario; });
    if (found != embedded.end()) {
      loaded = sim::parse_scenario(std::string(found->text), scenario + ".yaml", ".", options.assets);
    } else if (std::filesystem::is_regular_file(scenario)) {
      loaded = sim::load_scenario(scenario, options.assets);
    } else {
      throw_user_error("{}: no such scenario: expected a YAML file or one of {}", scenario,
                       fmt::join(embed::embedded_scenarios(), ", "));
    }
    state_.reset(new State{{std::move(loaded), options.assets, device_options(options)}});
  });
}

Simulation Simulation::from_text(const std::string& text, const Options& options) {
  return guarded([&] {
    sim::Scenario scenario = sim::parse_scenario(text, "scenario", ".", options.assets);
    return Simulation(
        std::shared_ptr<State>(new State{{std::move(scenario), options.assets, device_options(options)}}));
  });
}

std::string Simulation::place_antenna(const std::string& name, const Position& position,
                                      const std::string& fields) {
  return guarded([&] {
    const Json node = antenna_node(name, position, "antenna", fields_of("place_antenna", fields));
    state_->session.add_nodes(scenario_text(state_->session, Json::array({node})), "place_antenna");
    return name + "/antenna";
  });
}

void Simulation::add_channel(const std::string& name, const std::vector<std::string>& transmitters,
                             const std::vector<std::string>& receivers, const std::string& fields) {
  guarded([&] {
    std::vector<std::string> antennas = transmitters;
    antennas.insert(antennas.end(), receivers.begin(), receivers.end());
    Json channel = fields_of("add_channel", fields);
    channel["name"] = name;
    channel["tx"] = transmitters;
    channel["rx"] = receivers;
    if (!channel.contains("rate_hz"))  // a channel that is only asked for its paths fires at every tick
      channel["rate_hz"] = Json::parse(state_->session.facts())["tick_rate_hz"];
    Json nodes = stand_ins(state_->session, name, antennas);
    state_->session.add_channels(
        scenario_text(state_->session, std::move(nodes), Json::array({std::move(channel)})), "add_channel",
        false);
  });
}

std::string Simulation::facts() const {
  return guarded([&] { return state_->session.facts(); });
}
std::string Simulation::explain() {
  return guarded([&] { return state_->session.explain(); });
}
std::string Simulation::device() {
  return guarded([&] { return state_->session.device_facts(); });
}

Paths Simulation::paths(const std::string& channel, int64_t tick, uint32_t sequence) {
  return guarded([&] { return state_->solve(channel, sequence, tick, std::nullopt); });
}

Paths Simulation::paths_to(const std::string& channel, const std::vector<Position>& points, int64_t tick,
                           uint32_t sequence, const std::string& fields) {
  return guarded([&] {
    engine::PointReceivers receivers;
    for (const Position& point : points) receivers.points.emplace_back(point.x, point.y, point.z);
    const Json node = antenna_node("point", {}, "antenna", fields_of("paths_to", fields));
    receivers.antenna = scenario_text(state_->session, Json::array({node}));
    return state_->solve(channel, sequence, tick, receivers);
  });
}

Run Simulation::run(uint32_t sequence, int64_t first_tick) {
  return guarded([&] {
    auto run = std::make_shared<Run::State>();
    run->stream = state_->session.stream(sequence, first_tick);
    return Run(std::move(run));
  });
}

}  // namespace greatx::embed
