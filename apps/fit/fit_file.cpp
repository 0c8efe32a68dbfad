// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/fit/fit_file.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "apps/fit/measurement_file.h"
#include "core/budget.h"
#include "core/expected.h"
#include "core/fields/yaml.h"
#include "core/input_file.h"
#include "core/text.h"
#include "sim/fit/model.h"
#include "sim/plan/antennas.h"

namespace greatx::apps {
namespace {

using sim::FitParameter;
using sim::FitProperty;
using sim::FitQuantity;
using sim::FitRange;
using sim::FitSet;
using sim::FitUnknown;
using sim::FitUnknownKind;

constexpr uint32_t most_subcarriers = 1u << 16;
constexpr double most_scale_db = 400.0, most_clock_s = 1e-2, most_offset_m = 100.0;

std::string fit_text(const std::filesystem::path& file) {
  return InputFile(file, "expected a readable description of a fit", budget::yaml_file).text();
}

/// Reads [low, high].
std::pair<double, double> read_bounds(const Field& field, double least, double most) {
  const std::vector<Field> ends = field.list("two numbers, the least and the greatest value", 2);
  if (ends.size() != 2) field.fail("two numbers, the least and the greatest value");
  const double low = ends[0].between(least, most), high = ends[1].between(least, most);
  if (!(low < high)) field.fail("a least value below the greatest", fmt::format("[{}, {}]", low, high));
  return {low, high};
}

/// Reads bounds, start, prior and log of a variable whose values lie from `least` to `most`.
FitRange read_range(const FieldMap& map, double least, double most, bool may_be_logarithmic) {
  FitRange range;
  const Field bounds = map.require("bounds", "two numbers, the least and the greatest value");
  std::tie(range.low, range.high) = read_bounds(bounds, least, most);
  if (const auto f = map.find("start")) range.start = f->between(range.low, range.high);
  if (const auto f = may_be_logarithmic ? map.find("log") : std::nullopt) range.logarithmic = f->boolean();
  if (range.logarithmic && !(range.low > 0.0))
    bounds.fail("a least value above 0 for a logarithm", number_words(range.low));
  if (const auto f = map.find("prior")) {
    const FieldMap prior(*f, {"mean", "sigma"});
    const Field mean = prior.require("mean", "a number");
    range.prior = {mean.between(least, most), prior.require("sigma", "a number above 0").positive()};
    if (range.logarithmic && !(range.prior->mean > 0.0)) mean.fail("a number greater than 0");
  }
  return range;
}

FitUnknown read_unknown(const std::string& key, const Field& field, FitUnknownKind kind) {
  using Each = FitUnknown::Each;
  constexpr double most[] = {most_scale_db, most_clock_s, 180.0, most_offset_m};
  FitUnknown unknown;
  unknown.kind = kind;
  unknown.where = field.where();
  const bool has_end = kind == FitUnknownKind::orientation_deg || kind == FitUnknownKind::antenna_offset_m;
  Keys keys{"bounds", "start", "prior", "each"};
  if (has_end) keys.push_back("end");
  if (!field.is_map()) field.fail(fmt::format("a map with the bounds of {}", key));
  const FieldMap map(field, keys);
  const double limit = most[static_cast<size_t>(kind)];
  unknown.range = read_range(map, -limit, limit, false);
  if (const auto f = map.find("each"))
    unknown.each = static_cast<Each>(kind == FitUnknownKind::clock_s ? f->choice({"all", "file", "position"})
                                                                     : f->choice({"all", "file"}));
  if (const auto f = map.find("end"))
    unknown.end = static_cast<FitUnknown::End>(f->choice({"receiver", "transmitter"}));
  return unknown;
}

std::vector<FitUnknown> read_unknowns(const Field& field) {
  constexpr std::string_view names[] = {"scale_db", "clock_s", "orientation_deg", "antenna_offset_m"};
  const FieldMap map(field, Keys(std::begin(names), std::end(names)));
  std::vector<FitUnknown> unknowns;
  for (size_t kind = 0; kind < std::size(names); ++kind)
    if (const auto f = map.find(names[kind]))
      unknowns.push_back(read_unknown(std::string(names[kind]), *f, static_cast<FitUnknownKind>(kind)));
  return unknowns;
}

/// The range in which a property has a meaning (docs/materials.md).
std::pair<double, double> range_of_property(FitProperty property) {
  switch (property) {
    case FitProperty::permittivity:
      return {1.0, 1e6};
    case FitProperty::conductivity:
      return {0.0, 1e9};
    case FitProperty::thickness:
      return {1e-6, 1e3};
    case FitProperty::roughness:
      return {0.0, 1e3};
    case FitProperty::scattering:
      return {0.0, 0.9999};
    case FitProperty::cross_polarization:
      return {1e-6, 0.999999};  // the field has the slope of a root at 0 and 1
    default:
      return {0.0, 1.0};
  }
}

FitParameter read_parameter(const Field& field) {
  constexpr std::string_view properties[] = {"permittivity",     "conductivity", "thickness",
                                             "roughness",        "scattering",   "cross_polarization",
                                             "backscatter_share"};
  const FieldMap map(field, {"material", "property", "layer", "windows", "bounds", "start", "prior", "log"});
  FitParameter parameter;
  parameter.where = field.where();
  const Field material = map.require("material", "the name of a material, or a list of names");
  if (material.is_list())
    for (const Field& one : material.list("names of materials", 1)) parameter.materials.push_back(one.text());
  else
    parameter.materials.push_back(material.text());
  parameter.property = static_cast<FitProperty>(map.require("property", "a property").choice(properties));
  const bool of_layer = parameter.property == FitProperty::permittivity ||
                        parameter.property == FitProperty::conductivity ||
                        parameter.property == FitProperty::thickness;
  for (const char* key : {"layer", "windows"})
    if (const auto f = map.find(key); f && !of_layer)
      f->refuse("expected no layer for a property of the whole surface");
  if (const auto f = map.find("layer")) parameter.layer = f->integer32(0, 100);
  if (const auto f = map.find("windows")) parameter.windows = f->boolean();
  const auto [least, most] = range_of_property(parameter.property);
  parameter.range = read_range(map, least, most, true);
  return parameter;
}

sim::FitLoss read_loss(const Field& field) {
  const FieldMap map(field, {"kind", "scale"});
  sim::FitLoss loss;
  constexpr double scales[] = {1.0, 1.345, 2.385};  // 95 % efficiency (Holland and Welsch, 1977)
  loss.kind = static_cast<sim::FitLossKind>(
      map.require("kind", "squares, huber or cauchy").choice({"squares", "huber", "cauchy"}));
  loss.scale = scales[static_cast<size_t>(loss.kind)];
  if (const auto f = map.find("scale")) {
    if (loss.kind == sim::FitLossKind::squares) f->refuse("expected none for squares");
    loss.scale = f->positive(1e-3, 1e6);
  }
  return loss;
}

sim::FitSplit read_split(const Field& field, uint64_t seed) {
  const FieldMap map(field, {"block_m", "held_out", "seed"});
  sim::FitSplit split;
  split.seed = seed;
  if (const auto f = map.find("block_m")) split.block_m = f->positive(1e-2, 1e6);
  if (const auto f = map.find("held_out")) split.held_out = f->between(0.0, 0.9);
  if (const auto f = map.find("seed")) split.seed = f->integer(0);
  return split;
}

/// Reads the band of a response and what becomes of it.
sim::FitBand read_band(const FieldMap& map, const sim::ChannelConfig& channel, bool taps) {
  sim::FitBand band;
  band.subcarriers = channel.subcarriers;
  band.spacing_hz = channel.subcarrier_spacing_hz;
  if (const auto f = map.find("subcarriers")) band.subcarriers = f->integer32(1, most_subcarriers);
  if (const auto f = map.find("subcarrier_spacing_hz")) band.spacing_hz = f->positive(1.0, 1e12);
  if (0.5 * band.subcarriers * band.spacing_hz >= channel.carrier_hz)
    map.field().refuse(
        fmt::format("subcarriers: expected every one above 0 Hz, found {} x {:g} Hz at {:g} Hz",
                    band.subcarriers, band.spacing_hz, channel.carrier_hz));
  band.taps = band.subcarriers;
  if (!taps) return band;
  if (const auto f = map.find("window")) band.hann = f->choice({"none", "hann"}) == 1;
  if (const auto f = map.find("taps")) {
    const std::vector<Field> ends = f->list("the first tap and the number of taps", 2);
    if (ends.size() != 2) f->fail("two integers, the first tap and the number of taps");
    const double first = ends[0].between(-double(band.subcarriers), double(band.subcarriers));
    if (first != std::floor(first)) ends[0].fail("a whole number");
    band.first_tap = static_cast<int32_t>(first);
    band.taps = ends[1].integer32(1, band.subcarriers);
  }
  return band;
}

void read_ports(const FieldMap& map, const sim::Scenario& scenario, const sim::ChannelConfig& channel,
                FitSet& set) {
  const auto f = map.find("ports");
  if (!f) return;
  const std::vector<Field> ends = f->list("the receiving and the sending port", 2);
  if (ends.size() != 2) f->fail("two integers, the receiving and the sending port");
  const uint32_t receiving =
      set.receiver.empty() ? 1 : sim::antenna_array(scenario, set.receiver, channel.carrier_hz).port_count();
  const uint32_t sending =
      sim::antenna_array(scenario, channel.transmitters[set.transmitter], channel.carrier_hz).port_count();
  set.receive_port = ends[0].integer32(0, receiving - 1);
  set.transmit_port = ends[1].integer32(0, sending - 1);
}

void read_ends(const FieldMap& map, const sim::Scenario& scenario, const sim::ChannelConfig& channel,
               FitSet& set) {
  const auto transmitter = map.find("transmitter");
  if (!transmitter && channel.transmitters.size() > 1)
    map.require("transmitter", fmt::format("one of the channel's {}", channel.transmitters.size()));
  if (transmitter) {
    const std::string name = transmitter->text();
    const auto at = std::ranges::find(channel.transmitters, name);
    if (at == channel.transmitters.end()) transmitter->refuse(expected_one_of(channel.transmitters, name));
    set.transmitter = static_cast<uint32_t>(at - channel.transmitters.begin());
  }
  if (const auto f = map.find("receiver")) {
    set.receiver = f->text();
    std::vector<std::string> names;
    for (const sim::NodeConfig& node : scenario.nodes)
      for (const sim::SensorConfig& sensor : node.sensors)
        if (std::holds_alternative<sim::AntennaConfig>(sensor.config))
          names.push_back(node.name + "/" + sensor.name);
    if (std::ranges::find(names, set.receiver) == names.end())
      f->refuse(expected_one_of(names, set.receiver));
  }
}

/// Reads what a set compares, and how.
FitSet read_set(const Field& field, const sim::Scenario& scenario, const sim::ChannelConfig& channel,
                std::vector<FitData>& data) {
  if (!field.is_map()) field.fail("a map with name, quantity and file");
  Keys keys{"name", "file", "columns", "positions", "values", "transmitter", "receiver", "quantity", "sigma"};
  FitSet set;
  // The quantity decides which other keys there are.
  for (const auto& [key, value] : field.entries())
    if (key == "quantity")
      set.quantity = static_cast<FitQuantity>(value.choice({"power_db", "delay_spread_ns", "cir", "cfr"}));
  const Keys band{"subcarriers", "subcarrier_spacing_hz"}, taps{"window", "taps"};
  switch (set.quantity) {
    case FitQuantity::power_db:
      keys = keys + Keys{"average"} + band;
      break;
    case FitQuantity::delay_spread_ns:
      keys = keys + Keys{"spread_of"} + band + taps;
      break;
    case FitQuantity::cir:
      keys = keys + Keys{"compare", "phase", "ports", "floor_db"} + band + taps;
      break;
    case FitQuantity::cfr:
      keys = keys + Keys{"compare", "phase", "ports", "floor_db"} + band;
      break;
  }
  const FieldMap map(field, keys);
  map.require("quantity", "power_db, delay_spread_ns, cir or cfr");
  set.name = map.require("name", "a name").name();
  read_ends(map, scenario, channel, set);
  if (const auto f = map.find("average")) set.coherent = f->choice({"incoherent", "coherent"}) == 1;
  if (const auto f = map.find("spread_of")) set.from_response = f->choice({"paths", "response"}) == 1;
  if (const auto f = map.find("compare")) set.complex_values = f->choice({"magnitude", "complex"}) == 1;
  if (const auto f = map.find("phase")) {
    if (!set.complex_values) f->refuse("expected compare: complex beside it");
    set.phase_known = f->choice({"unknown", "known"}) == 1;
  }
  if (const auto f = map.find("floor_db")) {
    if (set.complex_values) f->refuse("expected compare: magnitude beside it");
    set.floor_db = f->positive(1.0, 200.0);
  }
  const bool response = set.quantity == FitQuantity::cir || set.quantity == FitQuantity::cfr;
  if (!set.coherent && !set.from_response && !response)
    for (const char* key : {"subcarriers", "subcarrier_spacing_hz", "window", "taps"})
      if (const auto f = map.find(key))
        f->refuse(set.quantity == FitQuantity::power_db ? "expected average: coherent beside it"
                                                        : "expected spread_of: response beside it");
  set.band = read_band(map, channel, set.from_response || set.quantity == FitQuantity::cir);
  if (response) {
    read_ports(map, scenario, channel, set);
    set.width = set.quantity == FitQuantity::cir ? set.band.taps : set.band.subcarriers;
    if (set.quantity == FitQuantity::cir && set.complex_values &&
        (set.band.hann || set.band.first_tap != 0 || set.band.taps != set.band.subcarriers))
      field.refuse("compare: expected all taps without a window for complex, found a part or a window");
  }
  if (const auto f = map.find("sigma")) set.sigma = f->positive(1e-9, 1e9);
  read_measurements(map, set, data);
  return set;
}

}  // namespace

bool is_fit_file(const std::filesystem::path& file) {
  std::error_code unreadable;
  if (!std::filesystem::is_regular_file(file, unreadable)) return false;
  try {
    const std::shared_ptr<const FieldValue> root = read_yaml(fit_text(file), file.string());
    return std::ranges::any_of(root->members, [](const FieldValue::Member& member) {
      return member.key == "greatx_fit" || member.key == "measurements";
    });
  } catch (const UserError&) {
    return false;
  }
}

FitFile read_fit_file(const std::filesystem::path& file) {
  const std::filesystem::path folder = std::filesystem::absolute(file).parent_path();
  std::string text = fit_text(file);
  Field root = Field::parse_yaml(text, {file.string(), folder, {}});
  const FieldMap map(root, {"greatx_fit", "scenario", "channel", "measurements", "unknown", "parameters",
                            "loss", "split", "seed", "starts", "iterations"});
  map.require("greatx_fit", "1 (the format's version)").choice({"1"});
  FitFile fit{file.string(), std::move(text), root, map.require("scenario", "a scenario").text(), ""};
  std::error_code unreadable;
  const std::filesystem::path beside = folder / fit.scenario;
  if (std::filesystem::is_regular_file(beside, unreadable)) fit.scenario = beside.string();
  if (const auto f = map.find("channel")) fit.channel = f->text();
  map.require("measurements", "a list of measurements");
  map.require("parameters", "a list of parameters");
  return fit;
}

FitInput read_fit_input(const FitFile& fit, const sim::Scenario& scenario, uint32_t channel) {
  const FieldMap map(fit.root, {"greatx_fit", "scenario", "channel", "measurements", "unknown", "parameters",
                                "loss", "split", "seed", "starts", "iterations"});
  FitInput input;
  sim::FitProblem& problem = input.problem;
  const sim::ChannelConfig& config = scenario.channels[channel];
  const Field measurements = map.require("measurements", "a list of measurements");
  for (const Field& item : measurements.list("measurements", 1)) {
    FitSet set = read_set(item, scenario, config, input.data);
    for (const FitSet& other : problem.sets)
      if (other.name == set.name)
        item.refuse(fmt::format("name: expected a new one, found '{}' again", set.name));
    problem.sets.push_back(std::move(set));
  }
  for (const Field& item : map.require("parameters", "a list of parameters").list("parameters", 1))
    problem.parameters.push_back(read_parameter(item));
  if (const auto f = map.find("unknown")) problem.unknowns = read_unknowns(*f);
  sim::check_unknowns(problem);
  if (const auto f = map.find("loss")) problem.loss = read_loss(*f);
  const auto seed = map.find("seed");
  problem.seed = problem.split.seed = seed ? seed->integer(0) : 1;
  if (const auto f = map.find("split")) problem.split = read_split(*f, problem.split.seed);
  if (const auto f = map.find("starts")) problem.starts = f->integer32(1, 10'000);
  if (const auto f = map.find("iterations")) problem.iterations = f->integer32(1, 100'000);
  return input;
}

}  // namespace greatx::apps
