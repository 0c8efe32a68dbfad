// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "io/dataset_format.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <map>
#include <numeric>
#include <set>

#include <nlohmann/json.hpp>

#include "core/hash.h"
#include "io/npy.h"

namespace greatx::io {

using Json = nlohmann::ordered_json;

namespace {

struct FormatName {
  FileFormat format;
  std::string_view name, extension;
};
constexpr FormatName format_names[] = {
    {FileFormat::npy_stack, "npy_stack", ".npy"},
    {FileFormat::npy_ragged, "npy_ragged", ".npy"},
    {FileFormat::npy_frame, "npy_frame", ".npy"},
    {FileFormat::png, "png", ".png"},
    {FileFormat::png_depth24, "png_depth24", ".png"},
    {FileFormat::exr, "exr", ".exr"},
    {FileFormat::ply, "ply", ".ply"},
    {FileFormat::hdf5_events, "hdf5_events", ".h5"},
    {FileFormat::text_events, "text_events", ".txt"},
    {FileFormat::pcd, "pcd", ".pcd"},
    {FileFormat::kitti, "kitti", ".bin"},
};
const FormatName& row_of(FileFormat format) { return format_names[static_cast<size_t>(format)]; }

constexpr DType all_dtypes[] = {DType::u8,  DType::u16, DType::u32, DType::i8,  DType::i32,
                                DType::i64, DType::u64, DType::f32, DType::f64, DType::complex64};

void check_path(const std::string& name, const std::string& what) {
  for (size_t start = 0; start <= name.size();) {
    const size_t end = std::min(name.find('/', start), name.size());
    const std::string part = name.substr(start, end - start);
    const bool printable =
        std::all_of(part.begin(), part.end(), [](unsigned char c) { return c >= 32 && c != 127; });
    if (part.empty() || part == "." || part == ".." || !printable || part.find('\\') != part.npos) {
      throw_user_error("{} \"{}\": expected a name that can be a folder below the data set", what, name);
    }
    start = end + 1;
  }
}

constexpr size_t event_array_count = 4;  // t, x, y, p

void check_output(const SensorSpec& sensor, const OutputSpec& output) {
  GREATX_CHECK(!output.arrays.empty(), "{}/{} holds no array", sensor.name, output.name);
  const size_t most = is_cloud(output.format) ? output.arrays.size() : 1;
  GREATX_CHECK(output.arrays.size() == (is_export(output.format) ? event_array_count : most),
               "{}/{} holds {} arrays", sensor.name, output.name, output.arrays.size());
  for (const size_t i : arrays_of(sensor, output)) {
    const ArraySpec& array = sensor.arrays[i];
    const bool varies = !array.shape.empty() && array.shape[0] < 0;
    GREATX_CHECK(
        std::all_of(array.shape.begin() + varies, array.shape.end(), [](int64_t n) { return n >= 0; }),
        "{}: only the first axis of {} may vary", sensor.name, array.name);
    GREATX_CHECK(!is_stack(output.format) || varies == (output.format == FileFormat::npy_ragged),
                 "{}: {} as {}: a first axis that varies is ragged, a fixed one is stacked", sensor.name,
                 array.name, name_of(output.format));
    GREATX_CHECK(!is_export(output.format) || ragged_output(sensor, array.name) != nullptr,
                 "{}/{}: {} is not kept as npy_ragged", sensor.name, output.name, array.name);
  }
}

Json to_json(const SensorSpec& sensor) {
  Json arrays = Json::array(), outputs = Json::array();
  for (const ArraySpec& a : sensor.arrays) {
    arrays.push_back({{"name", a.name},
                      {"dtype", numpy_name(a.dtype)},
                      {"shape", a.shape},
                      {"unit", a.unit},
                      {"description", a.description}});
  }
  for (const OutputSpec& o : sensor.outputs)
    outputs.push_back({{"name", o.name}, {"format", name_of(o.format)}, {"arrays", o.arrays}});
  return {{"name", sensor.name},
          {"kind", sensor.kind},
          {"rate_hz", sensor.rate},
          {"arrays", std::move(arrays)},
          {"outputs", std::move(outputs)},
          {"metadata", Json::parse(sensor.metadata_json.empty() ? "{}" : sensor.metadata_json)}};
}

SensorSpec sensor_from(const Json& json) {
  SensorSpec sensor{json.at("name"), json.at("kind"), json.at("rate_hz"), {}, {}, json.at("metadata").dump()};
  for (const Json& a : json.at("arrays")) {
    const std::string dtype = a.at("dtype");
    const auto* found = std::find_if(std::begin(all_dtypes), std::end(all_dtypes),
                                     [&](DType candidate) { return numpy_name(candidate) == dtype; });
    if (found == std::end(all_dtypes)) throw_user_error("unknown dtype \"{}\"", dtype);
    sensor.arrays.push_back({a.at("name"), *found, a.at("shape"), a.at("unit"), a.at("description")});
  }
  for (const Json& o : json.at("outputs")) {
    const std::string format = o.at("format");
    const auto* found = std::find_if(std::begin(format_names), std::end(format_names),
                                     [&](const FormatName& candidate) { return candidate.name == format; });
    if (found == std::end(format_names)) throw_user_error("unknown format \"{}\"", format);
    sensor.outputs.push_back({o.at("name"), found->format, o.at("arrays")});
  }
  return sensor;
}

__extension__ using Wide = __int128;

int64_t floor_ratio(Wide numerator, Wide denominator) {
  Wide quotient = numerator / denominator;
  if (numerator % denominator < 0) --quotient;
  return static_cast<int64_t>(quotient);
}

template <typename Bits>
size_t first_non_finite(std::span<const Bits> values, Bits infinity, bool allow_positive) {
  const Bits magnitude = static_cast<Bits>(~Bits{0}) >> 1;
  bool bad = false;  // one pass without branches, as nearly every array is good
  for (const Bits v : values) bad |= (v & magnitude) >= infinity && !(allow_positive && v == infinity);
  if (!bad) return values.size();
  return static_cast<size_t>(std::find_if(values.begin(), values.end(),
                                          [&](Bits v) {
                                            return (v & magnitude) >= infinity &&
                                                   !(allow_positive && v == infinity);
                                          }) -
                             values.begin());
}

}  // namespace

std::string_view name_of(FileFormat format) { return row_of(format).name; }
bool is_stack(FileFormat format) {
  return format == FileFormat::npy_stack || format == FileFormat::npy_ragged;
}
bool is_export(FileFormat format) {
  return format == FileFormat::hdf5_events || format == FileFormat::text_events;
}
bool is_cloud(FileFormat format) { return format == FileFormat::ply || format == FileFormat::pcd; }
bool is_frame(FileFormat format) { return !is_stack(format) && !is_export(format); }

const OutputSpec* ragged_output(const SensorSpec& sensor, const std::string& array) {
  for (const OutputSpec& output : sensor.outputs)
    if (output.format == FileFormat::npy_ragged && output.arrays[0] == array) return &output;
  return nullptr;
}

std::vector<size_t> arrays_of(const SensorSpec& sensor, const OutputSpec& output) {
  std::vector<size_t> indices;
  for (const std::string& name : output.arrays) {
    const auto found = std::find_if(sensor.arrays.begin(), sensor.arrays.end(),
                                    [&](const ArraySpec& array) { return array.name == name; });
    GREATX_CHECK(found != sensor.arrays.end(), "{}/{} names the array {}, which is not declared", sensor.name,
                 output.name, name);
    indices.push_back(static_cast<size_t>(found - sensor.arrays.begin()));
  }
  return indices;
}

void check_sensors(const std::vector<SensorSpec>& sensors) {
  std::set<std::string> paths;
  const auto claim = [&](const std::string& path) {
    if (!paths.insert(path).second) throw_user_error("two outputs of the data set would share {}", path);
  };
  for (const SensorSpec& sensor : sensors) {
    check_path(sensor.name, "sensor");
    std::set<std::string> kept;
    for (const OutputSpec& output : sensor.outputs) {
      check_path(output.name, "output");
      check_output(sensor, output);
      kept.insert(output.arrays.begin(), output.arrays.end());
      claim(is_stack(output.format)    ? stack_path(0, sensor, output)
            : is_export(output.format) ? export_path(0, sensor, output)
                                       : frame_folder(0, sensor, output));
      if (output.format == FileFormat::npy_ragged) claim(offsets_path(0, sensor, output));
    }
    for (const ArraySpec& array : sensor.arrays)
      GREATX_CHECK(kept.contains(array.name), "{}: no output keeps the array {}", sensor.name, array.name);
  }
}

std::string sequence_folder(uint32_t sequence) { return fmt::format("sequence_{:04}", sequence); }
std::string frame_folder(uint32_t sequence, const SensorSpec& sensor, const OutputSpec& output) {
  return fmt::format("{}/{}/{}", sequence_folder(sequence), sensor.name, output.name);
}
std::string stack_path(uint32_t sequence, const SensorSpec& sensor, const OutputSpec& output) {
  return frame_folder(sequence, sensor, output) + ".npy";
}
std::string export_path(uint32_t sequence, const SensorSpec& sensor, const OutputSpec& output) {
  return frame_folder(sequence, sensor, output) + std::string(row_of(output.format).extension);
}
std::string offsets_path(uint32_t sequence, const SensorSpec& sensor, const OutputSpec& output) {
  return frame_folder(sequence, sensor, output) + "_offsets.npy";
}
std::string frame_path(uint32_t sequence, const SensorSpec& sensor, const OutputSpec& output,
                       int64_t sample) {
  return fmt::format("{}/{:06}{}", frame_folder(sequence, sensor, output), sample,
                     row_of(output.format).extension);
}
std::string index_path(uint32_t sequence, const char* extension) {
  return fmt::format("{}/index.{}", sequence_folder(sequence), extension);
}
uint64_t stack_row_bytes(const ArraySpec& array) {
  const bool varies = !array.shape.empty() && array.shape[0] < 0;
  return std::accumulate(
      array.shape.begin() + varies, array.shape.end(), uint64_t{size_of(array.dtype)},
      [](uint64_t product, int64_t extent) { return product * static_cast<uint64_t>(extent); });
}

std::string dataset_json(const DatasetInfo& info) {
  Json sensors = Json::array();
  for (const SensorSpec& sensor : info.sensors) sensors.push_back(to_json(sensor));
  const Json json = {{"format", "greatx-dataset"},
                     {"format_version", format_version},
                     {"run_key", info.run_key},
                     {"run", Json::parse(info.run_json)},
                     {"scenario_sha256", sha256_hex(bytes_of(info.scenario_text))},
                     {"sequences", info.sequences},
                     {"ticks_per_sequence", info.ticks_per_sequence},
                     {"tick_rate_hz", info.tick_rate},
                     {"index_columns", index_columns},
                     {"sensors", std::move(sensors)}};
  return json.dump(2) + "\n";
}

DatasetInfo parse_dataset_json(const std::string& text, const std::string& name) try {
  const Json json = Json::parse(text);
  if (json.at("format") != "greatx-dataset" || json.at("format_version") != format_version) {
    throw_user_error("expected format greatx-dataset version {}, found {} version {}", format_version,
                     json.at("format").dump(), json.at("format_version").dump());
  }
  DatasetInfo info;
  info.run_json = json.at("run").dump();
  info.run_key = json.at("run_key");
  info.tick_rate = json.at("tick_rate_hz");
  info.sequences = json.at("sequences");
  info.ticks_per_sequence = json.at("ticks_per_sequence");
  for (const Json& sensor : json.at("sensors")) info.sensors.push_back(sensor_from(sensor));
  check_sensors(info.sensors);
  return info;
} catch (const std::exception& error) {
  throw_user_error("{}: not the description of a data set: {}", name, error.what());
}

std::string describe_differences(const std::string& stored, const std::string& wanted) {
  const Json a = Json::parse(stored, nullptr, false).flatten(), b = Json::parse(wanted).flatten();
  std::map<std::string, std::pair<std::string, std::string>> differences;
  for (const auto& [key, value] : a.items())
    if (!b.contains(key) || b[key] != value) differences[key] = {value.dump(), "nothing"};
  for (const auto& [key, value] : b.items()) {
    if (!a.contains(key))
      differences[key] = {"nothing", value.dump()};
    else if (a[key] != value)
      differences[key].second = value.dump();
  }
  std::string text;
  size_t count = 0;
  for (const auto& [key, values] : differences) {
    if (++count > 8) return text + fmt::format("  and {} more\n", differences.size() - 8);
    text += fmt::format("  {}: the data set has {}, this run has {}\n",
                        key.substr(std::min<size_t>(1, key.size())), values.first, values.second);
  }
  return text;
}

std::string index_csv(const DatasetInfo& info, const std::vector<IndexRow>& rows) {
  std::string text = std::string(index_columns) + ",name\n";
  for (const IndexRow& row : rows) {
    text += fmt::format("{},{},{},{},{},{}\n", row.tick, row.time_ns, row.sensor, row.sample, row.row,
                        info.sensors[static_cast<size_t>(row.sensor)].name);
  }
  return text;
}

Bytes index_npy(const std::vector<IndexRow>& rows) {
  static_assert(sizeof(IndexRow) == 5 * sizeof(int64_t));
  Bytes bytes = npy_header(DType::i64, {static_cast<int64_t>(rows.size()), 5});
  append(bytes, std::as_bytes(std::span(rows)));
  return bytes;
}

std::vector<IndexRow> read_index_npy(const std::filesystem::path& path) {
  const NpyFile file(path);
  if (file.dtype() != DType::i64 || file.shape().size() != 2 || file.shape()[1] != 5)
    throw_user_error("{}: expected int64 [records, 5]", path.string());
  const Array array = file.read();
  const std::span<const int64_t> v = array.as<int64_t>();
  std::vector<IndexRow> rows;
  for (size_t i = 0; i < v.size(); i += 5) rows.push_back({v[i], v[i + 1], v[i + 2], v[i + 3], v[i + 4]});
  return rows;
}

SampleClock::Ratio SampleClock::parse(const std::string& text) {
  Ratio ratio{0, 1};
  const char* at = text.data();
  const char* const end = at + text.size();
  auto result = std::from_chars(at, end, ratio.numerator);
  if (result.ptr != end && *result.ptr == '/')
    result = std::from_chars(result.ptr + 1, end, ratio.denominator);
  if (result.ptr != end && *result.ptr == '.') {
    for (at = result.ptr + 1; at != end && *at >= '0' && *at <= '9' && ratio.denominator < 1'000'000'000;
         ++at) {
      ratio.numerator = 10 * ratio.numerator + (*at - '0');
      ratio.denominator *= 10;
    }
    result.ptr = at;
  }
  if (result.ec != std::errc{} || result.ptr != end || ratio.numerator <= 0 || ratio.denominator <= 0 ||
      ratio.numerator > (int64_t{1} << 53)) {
    throw_user_error("rate \"{}\": expected a positive rational number of Hz", text);
  }
  return ratio;
}

SampleClock::SampleClock(const std::string& tick_rate, const std::string& rate)
    : tick_rate_(parse(tick_rate)), rate_(parse(rate)) {}

int64_t SampleClock::tick_of(int64_t sample) const {
  // floor(sample * tick_rate / rate + 1/2)
  const Wide numerator = Wide{tick_rate_.numerator} * rate_.denominator;
  const Wide denominator = Wide{tick_rate_.denominator} * rate_.numerator;
  return floor_ratio(2 * sample * numerator + denominator, 2 * denominator);
}

int64_t SampleClock::samples_before(int64_t tick) const {
  const double guess = static_cast<double>(tick) / static_cast<double>(tick_rate_.numerator) *
                       static_cast<double>(tick_rate_.denominator) * static_cast<double>(rate_.numerator) /
                       static_cast<double>(rate_.denominator);
  auto count = static_cast<int64_t>(guess);
  while (count > 0 && tick_of(count - 1) >= tick) --count;
  while (tick_of(count) < tick) ++count;
  return count;
}

int64_t SampleClock::time_ns(int64_t tick) const {
  const Wide numerator = Wide{tick} * tick_rate_.denominator * 1'000'000'000;
  return floor_ratio(2 * numerator + tick_rate_.numerator, 2 * Wide{tick_rate_.numerator});
}

std::string find_bad_value(const SensorSpec& sensor, const ArraySpec& spec, const Array& array) {
  if (array.dtype != DType::f32 && array.dtype != DType::f64 && array.dtype != DType::complex64) return {};
  if (sensor.metadata_json.find("\"non_finite\"") != std::string::npos) {
    const Json metadata = Json::parse(sensor.metadata_json);
    const Json listed = metadata.value("non_finite", Json::array());
    if (std::find(listed.begin(), listed.end(), spec.name) != listed.end()) return {};
  }
  const bool sky = sensor.kind == "camera" && spec.name.starts_with("depth");
  const size_t count = array.bytes.size() / (array.dtype == DType::f64 ? 8 : 4);
  size_t at = 0;
  double value = 0.0;
  if (array.dtype == DType::f64) {
    const auto* const values = reinterpret_cast<const uint64_t*>(array.bytes.data());
    at = first_non_finite<uint64_t>({values, count}, 0x7ff0'0000'0000'0000u, sky);
    if (at < count) value = std::bit_cast<double>(values[at]);
  } else {
    const auto* const values = reinterpret_cast<const uint32_t*>(array.bytes.data());
    at = first_non_finite<uint32_t>({values, count}, 0x7f80'0000u, sky);
    if (at < count) value = std::bit_cast<float>(values[at]);
  }
  if (at == count) return {};
  return fmt::format("{} at element {} of {}", value, array.dtype == DType::complex64 ? at / 2 : at,
                     spec.name);
}

}  // namespace greatx::io
