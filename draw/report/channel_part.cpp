// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The part of channels: H(f) of each link, and the strongest paths with their vertices. sensing_part.cpp has
// what a channel senses.
#include <algorithm>
#include <cmath>
#include <complex>

#include "core/units.h"
#include "draw/report/parts.h"

namespace greatx::io::report {

namespace {

using Complex = std::complex<float>;
constexpr size_t most_antennas = 100'000, most_targets = 10'000;
constexpr double power_ratio = 1.005;

/// An end of the channel: its antenna's name, mount and ports.
struct End {
  std::string name, node;
  Pose mount;
  int64_t ports = 1;
};

std::vector<End> ends_of(const JsonValue& metadata, const char* key) {
  std::vector<End> ends;
  if (!metadata.has(key)) return ends;
  for (const JsonValue& json : metadata.at(key).list(most_antennas)) {
    End& end = ends.emplace_back();
    if (json.has("name")) end.name = json.at("name").text();
    end.node = end.name.substr(0, end.name.find('/'));
    if (json.has("ports")) end.ports = json.at("ports").integer(1, 1'000'000);
    if (json.has("body_from_antenna")) end.mount = pose_of(json.at("body_from_antenna"));
  }
  return ends;
}

/// Returns evenly spaced indices below `count`, at most `most`.
std::vector<size_t> spread(size_t count, size_t most) {
  std::vector<size_t> chosen;
  const size_t kept = std::min(count, most);
  for (size_t i = 0; i < kept; ++i) chosen.push_back(kept == 1 ? 0 : i * (count - 1) / (kept - 1));
  return chosen;
}

/// H(f) of one link: of some pairs of ports, complex, and the mean power of all pairs.
Json encode_link(const Context& context, const PanelSource& source, const Array& cfr, size_t rx, size_t tx) {
  const auto extent = [&](size_t axis) { return static_cast<size_t>(cfr.shape[axis]); };
  const size_t rx_ports = extent(1), tx_ports = extent(3), times = extent(4), n = extent(5);
  const std::span<const Complex> h = cfr.as<Complex>();
  const auto row = [&](size_t r, size_t t) {  // the first time sample
    return h.subspan((((rx * rx_ports + r) * extent(2) + tx) * tx_ports + t) * times * n, n);
  };
  const size_t by = (n + most_subcarriers - 1) / most_subcarriers;
  if (by > 1)
    context.collected.notes.insert(
        fmt::format("{}: every {}th subcarrier is shown.", printable(source.spec().name), by));
  std::vector<float> power;
  for (size_t k = 0; k < n; k += by) {
    double sum = 0.0;
    for (size_t r = 0; r < rx_ports; ++r)
      for (size_t t = 0; t < tx_ports; ++t) sum += std::norm(std::complex<double>(row(r, t)[k]));
    power.push_back(static_cast<float>(sum / static_cast<double>(rx_ports * tx_ports)));
  }
  Json pairs = Json::array();
  double largest = 0.0;
  std::vector<Complex> values;
  const std::vector<size_t> chosen = spread(rx_ports * tx_ports, most_port_pairs);
  if (rx_ports * tx_ports > chosen.size())
    context.collected.notes.insert(fmt::format("{}: H(f) of {} of {} pairs of ports; the mean is of all.",
                                               printable(source.spec().name), chosen.size(),
                                               rx_ports * tx_ports));
  for (const size_t pair : chosen) {
    pairs.push_back({pair / tx_ports, pair % tx_ports});
    const std::span<const Complex> line = row(pair / tx_ports, pair % tx_ports);
    for (size_t k = 0; k < n; k += by) {
      values.push_back(line[k]);
      for (const float part : {line[k].real(), line[k].imag()})
        if (std::isfinite(part)) largest = std::max(largest, std::abs(double{part}));
    }
  }
  const double step = largest > 0.0 ? largest / 32767.0 : 1.0;
  std::vector<uint32_t> codes;
  for (const bool imaginary : {false, true})
    for (const Complex& value : values)
      codes.push_back(
          static_cast<uint32_t>(32768 + nearest(double{imaginary ? value.imag() : value.real()} / step)));
  const LogCode code = LogCode::of(power, power_ratio);
  std::vector<uint32_t> levels;
  for (const float value : power) levels.push_back(code.code(value));
  return {{"rx", rx},
          {"tx", tx},
          {"n", power.size()},
          {"by", by},
          {"pairs", std::move(pairs)},
          {"blob", context.blobs.add(packed(codes, 2, power.size()))},
          {"step", step},
          {"mean",
           {{"blob", context.blobs.add(packed(levels, 2, power.size()))},
            {"low", code.low},
            {"ratio", code.ratio}}}};
}

/// The strongest paths of a record as text, a row each: [rx, tx, delay ns, power dB, Doppler Hz, kinds,
/// vertices x y z, objects, materials, departure zenith and azimuth, arrival zenith and azimuth, deg].
Json encode_paths(const Context& context, const PanelSource& source, const IndexRow& record) {
  const Array rx = source.load(record, "rx", {DType::i32}, {-1}),
              tx = source.load(record, "tx", {DType::i32}, {-1}),
              delay = source.load(record, "delay", {DType::f64}, {-1}),
              kind = source.load(record, "interaction", {DType::u8}, {-1, 0}),
              vertex = source.load(record, "vertex", {DType::f64}, {-1, 0, 3});
  expect_same_rows(source, {&rx, &tx, &delay, &kind, &vertex});
  const auto optional = [&](const char* name, DType type, const std::vector<int64_t>& shape) {
    std::optional<Array> array;
    if (source.has(name)) {
      array = source.load(record, name, {type}, shape);
      expect_same_rows(source, {&rx, &*array});
    }
    return array;
  };
  const std::optional<Array> amplitude = optional("amplitude", DType::complex64, {-1, 0, 0}),
                             doppler = optional("doppler", DType::f64, {-1}),
                             object = optional("object", DType::u32, {-1, 0}),
                             material = optional("object_material", DType::u32, {-1, 0}),
                             departure = optional("departure", DType::f64, {-1, 2}),
                             arrival = optional("arrival", DType::f64, {-1, 2});
  const auto count = static_cast<size_t>(rx.shape[0]), depth = static_cast<size_t>(kind.shape[1]);
  if (static_cast<size_t>(vertex.shape[1]) != depth)
    throw_user_error("{}, tick {}: expected as many vertices as interactions, found {} and {}",
                     source.place(), record.tick, vertex.shape[1], depth);
  std::vector<double> power(count, 0.0);
  if (amplitude) {
    const auto ports = static_cast<size_t>(amplitude->shape[1] * amplitude->shape[2]);
    const std::span<const Complex> a = amplitude->as<Complex>();
    for (size_t i = 0; i < count; ++i) {
      for (size_t k = 0; k < ports; ++k) power[i] += std::norm(std::complex<double>(a[i * ports + k]));
      power[i] = std::isfinite(power[i]) ? power[i] / static_cast<double>(ports) : 0.0;
    }
  }
  std::vector<size_t> order(count);
  for (size_t i = 0; i < count; ++i) order[i] = i;
  std::ranges::stable_sort(order, [&](size_t a, size_t b) { return power[a] > power[b]; });
  if (count > context.detail.paths) {
    order.resize(context.detail.paths);
    context.collected.notes.insert(fmt::format("{}: the {} strongest paths of each record.",
                                               printable(source.spec().name), context.detail.paths));
  }
  Json list = Json::array();
  for (const size_t i : order) {
    Json kinds = Json::array(), places = Json::array(), objects = Json::array(), materials = Json::array();
    for (size_t d = 0; d < depth && kind.as<uint8_t>()[i * depth + d] != 0; ++d) {
      const double* const at = vertex.as<double>().data() + 3 * (i * depth + d);
      kinds.push_back(kind.as<uint8_t>()[i * depth + d]);
      for (const Json& value : place_json(context, {at[0], at[1], at[2]})) places.push_back(value);
      const uint32_t id = object && d < static_cast<size_t>(object->shape[1])
                              ? object->as<uint32_t>()[i * static_cast<size_t>(object->shape[1]) + d]
                              : 0;
      const uint32_t made_of = material && d < static_cast<size_t>(material->shape[1])
                                   ? material->as<uint32_t>()[i * static_cast<size_t>(material->shape[1]) + d]
                                   : 0;
      objects.push_back(id);
      materials.push_back(made_of);
      context.collected.instances.insert(id);
      context.collected.materials.insert(made_of);
    }
    const auto angle = [&](const std::optional<Array>& angles, size_t part) {
      return angles ? rounded(degrees(angles->as<double>()[2 * i + part]), 2) : Json(nullptr);
    };
    list.push_back({rx.as<int32_t>()[i], tx.as<int32_t>()[i], rounded(1e9 * delay.as<double>()[i], 3),
                    amplitude && power[i] > 0.0 ? rounded(10.0 * std::log10(power[i]), 2) : Json(nullptr),
                    doppler ? rounded(doppler->as<double>()[i], 1) : Json(nullptr), std::move(kinds),
                    std::move(places), std::move(objects), std::move(materials), angle(departure, 0),
                    angle(departure, 1), angle(arrival, 0), angle(arrival, 1)});
  }
  return {{"blob", context.blobs.add(packed_text(list.dump()))}, {"all", count}};
}

std::vector<std::string> targets_of(const JsonValue& metadata) {
  std::vector<std::string> names;
  if (metadata.has("targets"))
    for (const JsonValue& target : metadata.at("targets").list(most_targets))
      names.push_back(target.has("node") ? target.at("node").text() : "");
  return names;
}

Json places_of(const Context& context, const std::vector<End>& ends, int64_t tick) {
  Json list = Json::array();
  for (const End& end : ends)
    list.push_back(pose_json(context, context.poses.world_from(end.node, end.mount, tick)));
  return list;
}

}  // namespace

Json describe_channel(const PanelSource& source) {
  const JsonDocument metadata = metadata_of(source);
  const JsonValue root = metadata.root();
  Json json = Json::object();
  for (const char* const key : {"carrier_hz", "subcarrier_spacing_hz", "subcarriers", "first_subcarrier"})
    if (root.has(key)) json[key] = root.at(key).number(-1e15, 1e15);
  for (const auto& [key, list] : {std::pair{"tx", "transmitters"}, std::pair{"rx", "receivers"}}) {
    json[key] = Json::array();
    for (const End& end : ends_of(root, list))
      json[key].push_back({{"name", shown_name(end.name)}, {"ports", end.ports}});
  }
  if (root.has("sensing")) {
    const JsonValue sensing = root.at("sensing");
    for (const char* const key : {"range_bin_m", "velocity_min_m_s", "velocity_bin_m_s", "azimuth_min_rad",
                                  "azimuth_max_rad", "symbols"})
      if (sensing.has(key)) json["sensing"][key] = sensing.at(key).number(-1e12, 1e12);
  }
  json["targets"] = Json::array();
  for (const std::string& name : targets_of(root)) json["targets"].push_back(shown_name(name));
  return json;
}

Json encode_channel(const Context& context, const PanelSource& source, const IndexRow& row) {
  const JsonDocument metadata = metadata_of(source);
  const std::vector<End> tx = ends_of(metadata.root(), "transmitters"),
                         rx = ends_of(metadata.root(), "receivers");
  Json json = {{"tx", places_of(context, tx, row.tick)}, {"rx", places_of(context, rx, row.tick)}};
  size_t links = 0;
  const auto links_of = [&](size_t receivers, size_t transmitters) {
    links = std::max(links, receivers * transmitters);
    std::vector<ChannelLink> shown;
    for (size_t i = 0; i < std::min(receivers * transmitters, most_links); ++i)
      shown.push_back({i / transmitters, i % transmitters});
    return shown;
  };
  if (source.has("cfr")) {
    const Array cfr = source.load(row, "cfr", {DType::complex64}, {0, 0, 0, 0, 0, 0});
    json["links"] = Json::array();
    for (const ChannelLink& link :
         links_of(static_cast<size_t>(cfr.shape[0]), static_cast<size_t>(cfr.shape[2])))
      json["links"].push_back(encode_link(context, source, cfr, link.rx, link.tx));
  }
  if (source.has("rx") && source.has("tx") && source.has("delay") && source.has("interaction") &&
      source.has("vertex"))
    json["paths"] = encode_paths(context, source, row);
  if (source.has("range_doppler") || source.has("range_azimuth") || source.has("detection_range"))
    json["sensing"] =
        encode_sensing(context, source, row, targets_of(metadata.root()).size(),
                       links_of(std::max<size_t>(rx.size(), 1), std::max<size_t>(tx.size(), 1)));
  if (links > most_links)
    context.collected.notes.insert(
        fmt::format("{}: the first {} of {} links.", printable(source.spec().name), most_links, links));
  return json;
}

}  // namespace greatx::io::report
