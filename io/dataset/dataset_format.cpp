// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "io/dataset/dataset_format.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <map>
#include <numeric>
#include <set>

#include <nlohmann/json.hpp>

#include "core/hash.h"
#include "io/files/inside.h"
#include "io/files/untrusted_json.h"
#include "io/formats/npy.h"
#include "io/formats/packed_columns.h"

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
    {FileFormat::hdf5_records, "hdf5_records", ".h5"},
};
const FormatName& row_of(FileFormat format) { return format_names[static_cast<size_t>(format)]; }

constexpr int64_t most_index_rows = int64_t{1} << 26;
/// Bounds the numerator and denominator of a rate, so that times of most_ticks ticks are computed within 128
/// bits.
constexpr int64_t most_of_ratio = 1'000'000'000'000;

constexpr DType all_dtypes[] = {DType::u8,  DType::u16, DType::u32, DType::i8,  DType::i32,
                                DType::i64, DType::u64, DType::f32, DType::f64, DType::complex64};

constexpr Compression all_compressions[] = {Compression::none, Compression::fast, Compression::small};
constexpr double least_step = 1e-9, most_step = 1e9;
constexpr size_t event_array_count = 4;  // t, x, y, p
constexpr size_t most_sensors = 10'000, most_arrays = 256, most_axes = 16, most_arrays_in_all = 65'536;

/// Describes the fault of an array; returns an empty string if there is none.
std::string fault_of_array(const SensorSpec& sensor, const ArraySpec& array) {
  const bool varies = !array.shape.empty() && array.shape[0] < 0;
  if (!std::all_of(array.shape.begin() + varies, array.shape.end(), [](int64_t n) { return n >= 0; }))
    return fmt::format("{}: only the first axis of {} may vary", sensor.name, array.name);
  uint64_t bytes = size_of(array.dtype);
  bool fits = array.shape.size() <= most_axes;
  for (size_t axis = varies; fits && axis < array.shape.size(); ++axis)
    fits = !__builtin_mul_overflow(bytes, std::max<uint64_t>(1, static_cast<uint64_t>(array.shape[axis])),
                                   &bytes) &&
           bytes <= largest_array;
  if (fits) return {};
  return fmt::format("{}: {} has {} axes and more than {} bytes, or more than {} axes", sensor.name,
                     array.name, array.shape.size(), largest_array, most_axes);
}

/// Describes the fault of an output; returns an empty string if there is none. The sensor must declare its
/// arrays.
std::string fault_of_output(const SensorSpec& sensor, const OutputSpec& output) {
  const size_t most = is_cloud(output.format) || is_packed(output.format) ? output.arrays.size() : 1;
  if (output.arrays.size() != (is_export(output.format) ? event_array_count : most))
    return fmt::format("{}/{} holds {} arrays", sensor.name, output.name, output.arrays.size());
  for (const size_t i : arrays_of(sensor, output)) {
    const ArraySpec& array = sensor.arrays[i];
    const bool varies = !array.shape.empty() && array.shape[0] < 0;
    if (is_stack(output.format) && varies != (output.format == FileFormat::npy_ragged))
      return fmt::format("{}: {} as {}: a first axis that varies is ragged, a fixed one is stacked",
                         sensor.name, array.name, name_of(output.format));
    if (is_export(output.format) && sequence_output(sensor, array.name) == nullptr)
      return fmt::format("{}/{}: {} is kept neither as npy_ragged nor as hdf5_records", sensor.name,
                         output.name, array.name);
  }
  if (is_packed(output.format))
    if (const std::string fault = fault_of_packed(specs_of(sensor, output)); !fault.empty())
      return fmt::format("{}/{}: {}", sensor.name, output.name, fault);
  return {};
}

/// Describes the first fault of a sensor's arrays and outputs; returns an empty string if there is none.
std::string fault_of_sensor(const SensorSpec& sensor) {
  std::set<std::string> names, kept;
  for (const ArraySpec& array : sensor.arrays) {
    names.insert(array.name);
    if (std::string fault = fault_of_array(sensor, array); !fault.empty()) return fault;
  }
  for (const OutputSpec& output : sensor.outputs) {
    if (output.arrays.empty()) return fmt::format("{}/{} holds no array", sensor.name, output.name);
    for (const std::string& name : output.arrays)
      if (!names.contains(name))
        return fmt::format("{}/{} names the array {}, which is not declared", sensor.name, output.name, name);
    kept.insert(output.arrays.begin(), output.arrays.end());
  }
  for (const OutputSpec& output : sensor.outputs)
    if (std::string fault = fault_of_output(sensor, output); !fault.empty()) return fault;
  for (const ArraySpec& array : sensor.arrays)
    if (!kept.contains(array.name))
      return fmt::format("{}: no output keeps the array {}", sensor.name, array.name);
  return {};
}

/// Collects the paths of a sequence. Paths must differ, and no path may be a folder of another one.
class Claims {
 public:
  /// Adds a path; returns an empty string if the path is free, and a description of the conflict otherwise.
  std::string add(const std::string& path) {
    const std::string taken = fmt::format("two outputs of the data set would share {}", path);
    if (folders_.contains(path) || !paths_.insert(path).second) return taken;
    for (size_t end = path.find('/'); end != path.npos; end = path.find('/', end + 1)) {
      if (paths_.contains(path.substr(0, end)))
        return fmt::format("two outputs of the data set would share {}, as a file and as a folder",
                           path.substr(0, end));
      folders_.insert(path.substr(0, end));
    }
    return {};
  }

 private:
  std::set<std::string> paths_, folders_;
};

/// Describes the first conflict between the paths of a sequence; returns an empty string if there is none.
std::string fault_of_paths(const std::vector<SensorSpec>& sensors) {
  Claims claims;
  std::vector<std::string> paths;
  for (const char* extension : {"npy", "csv"}) {
    paths.push_back(index_path(0, extension));
    paths.push_back(part_name(paths.back()).string());
  }
  for (const SensorSpec& sensor : sensors) {
    if (!fault_of_path(sensor.name).empty())
      return fmt::format("sensor \"{}\": expected a name that can be a folder below the data set",
                         sensor.name);
    for (const OutputSpec& output : sensor.outputs) {
      if (!fault_of_path(output.name).empty())
        return fmt::format("output \"{}\": expected a name that can be a folder below the data set",
                           output.name);
      paths.push_back(is_stack(output.format)    ? stack_path(0, sensor, output)
                      : is_export(output.format) ? export_path(0, sensor, output)
                      : is_packed(output.format) ? packed_path(0, sensor, output)
                                                 : frame_folder(0, sensor, output));
      if (is_packed(output.format)) paths.push_back(places_path(0, sensor, output));
      if (output.format == FileFormat::npy_ragged) paths.push_back(offsets_path(0, sensor, output));
    }
  }
  for (const std::string& path : paths)
    if (std::string fault = claims.add(path); !fault.empty()) return fault;
  return {};
}

Json to_json(const SensorSpec& sensor) {
  Json arrays = Json::array(), outputs = Json::array();
  for (const ArraySpec& a : sensor.arrays) {
    arrays.push_back({{"name", a.name},
                      {"dtype", numpy_name(a.dtype)},
                      {"shape", a.shape},
                      {"unit", a.unit},
                      {"description", a.description}});
    if (a.step != 0.0) arrays.back()["step"] = a.step;
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

template <typename Row, size_t N, typename Name>
const Row& row_named(const JsonValue& value, const Row (&rows)[N], const char* what, Name name) {
  const std::string text = value.text();
  const Row* const found =
      std::find_if(std::begin(rows), std::end(rows), [&](const Row& row) { return name(row) == text; });
  if (found == std::end(rows)) value.fail(what);
  return *found;
}

SensorSpec sensor_from(const JsonValue& json) {
  SensorSpec sensor{json.at("name").text(), json.at("kind").text(), json.at("rate_hz").text(), {}, {}, {}};
  if (!json.at("metadata").is_object()) json.at("metadata").fail("an object");
  sensor.metadata_json = json.at("metadata").dump();
  for (const JsonValue& a : json.at("arrays").list(most_arrays)) {
    const DType dtype = row_named(a.at("dtype"), all_dtypes, "NumPy's name of a type that greatx writes",
                                  [](DType row) { return numpy_name(row); });
    sensor.arrays.push_back(
        {a.at("name").text(), dtype, {}, a.at("unit").text(), a.at("description").text()});
    for (const JsonValue& extent : a.at("shape").list(most_axes))
      sensor.arrays.back().shape.push_back(extent.integer(-1, int64_t{1} << 40));
    if (a.has("step")) sensor.arrays.back().step = a.at("step").number(least_step, most_step);
  }
  for (const JsonValue& o : json.at("outputs").list(most_arrays)) {
    const FormatName& format = row_named(o.at("format"), format_names, "a file format of greatx",
                                         [](const FormatName& row) { return row.name; });
    sensor.outputs.push_back({o.at("name").text(), format.format, {}});
    for (const JsonValue& name : o.at("arrays").list(most_arrays))
      sensor.outputs.back().arrays.push_back(name.text());
  }
  if (const std::string fault = fault_of_sensor(sensor); !fault.empty())
    json.fail("arrays and outputs that fit each other (" + fault + ")");
  return sensor;
}

__extension__ using Wide = __int128;

/// Returns floor(numerator / denominator). Throws UserError if the result does not fit into 64 bits. Within
/// the bounds of SampleClock, no intermediate product reaches 2^127.
int64_t floor_ratio(Wide numerator, Wide denominator) {
  Wide quotient = numerator / denominator;
  if (numerator % denominator < 0) --quotient;
  if (quotient > INT64_MAX || quotient < INT64_MIN)
    throw_user_error("expected times and counts of samples below 2^63 (of nanoseconds: 292 years)");
  return static_cast<int64_t>(quotient);
}

template <typename Bits>
size_t first_non_finite(std::span<const Bits> values, Bits infinity, bool allow_positive) {
  const Bits magnitude = static_cast<Bits>(~Bits{0}) >> 1;
  bool bad = false;  // a first pass without branches, because nearly all arrays are good
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
bool is_packed(FileFormat format) { return format == FileFormat::hdf5_records; }
bool is_frame(FileFormat format) { return !is_stack(format) && !is_export(format) && !is_packed(format); }

const OutputSpec* sequence_output(const SensorSpec& sensor, const std::string& array) {
  for (const OutputSpec& output : sensor.outputs)
    if ((output.format == FileFormat::npy_ragged || is_packed(output.format)) &&
        std::find(output.arrays.begin(), output.arrays.end(), array) != output.arrays.end())
      return &output;
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

std::vector<ArraySpec> specs_of(const SensorSpec& sensor, const OutputSpec& output) {
  std::vector<ArraySpec> specs;
  for (const size_t i : arrays_of(sensor, output)) specs.push_back(sensor.arrays[i]);
  return specs;
}

void check_sensors(const std::vector<SensorSpec>& sensors) {
  for (const SensorSpec& sensor : sensors) {
    const std::string fault = fault_of_sensor(sensor);
    GREATX_CHECK(fault.empty(), "{}", fault);
  }
  if (const std::string fault = fault_of_paths(sensors); !fault.empty()) throw_user_error("{}", fault);
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
std::string packed_path(uint32_t sequence, const SensorSpec& sensor, const OutputSpec& output) {
  return frame_folder(sequence, sensor, output) + ".h5";
}
std::string places_path(uint32_t sequence, const SensorSpec& sensor, const OutputSpec& output) {
  return frame_folder(sequence, sensor, output) + ".npy";
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
  Json json = {{"format", "greatx-dataset"},
               {"format_version", format_version},
               {"run_key", info.run_key},
               {"run", Json::parse(info.run_json)},
               {"scenario_sha256", sha256_hex(bytes_of(info.scenario_text))},
               {"sequences", info.sequences},
               {"ticks_per_sequence", info.ticks_per_sequence},
               {"tick_rate_hz", info.tick_rate},
               {"index_columns", index_columns},
               {"sensors", std::move(sensors)}};
  if (info.compression != Compression::none) json["compression"] = name_of(info.compression);
  return json.dump(2) + "\n";
}

DatasetInfo parse_dataset_json(const std::string& text, const std::string& name) {
  const JsonDocument document(text, {name, 1});
  const JsonValue json = document.root();
  if (json.at("format").text() != "greatx-dataset") json.at("format").fail("\"greatx-dataset\"");
  if (json.at("format_version").integer(INT64_MIN, INT64_MAX) != format_version)
    json.at("format_version").fail(fmt::format("version {}", format_version));
  DatasetInfo info;
  if (!json.at("run").is_object()) json.at("run").fail("an object");
  info.run_json = json.at("run").dump();
  info.run_key = json.at("run_key").text();
  info.tick_rate = json.at("tick_rate_hz").text();
  info.sequences = static_cast<uint32_t>(json.at("sequences").integer(1, most_sequences));
  info.ticks_per_sequence = json.at("ticks_per_sequence").integer(0, most_ticks);
  if (json.has("compression"))
    info.compression = row_named(json.at("compression"), all_compressions, "none, fast or small",
                                 [](Compression row) { return std::string_view(name_of(row)); });
  size_t arrays = 0;
  const std::vector<JsonValue> sensors = json.at("sensors").list(most_sensors);
  for (const JsonValue& sensor : sensors) {
    info.sensors.push_back(sensor_from(sensor));
    for (const OutputSpec& output : info.sensors.back().outputs) arrays += output.arrays.size();
    if (arrays > most_arrays_in_all)
      sensor.fail(fmt::format("at most {} arrays of all sensors together", most_arrays_in_all));
  }
  if (const std::string fault = fault_of_paths(info.sensors); !fault.empty())
    json.at("sensors").fail("files that can lie beside each other (" + fault + ")");
  const auto check_clock = [&](const JsonValue& field, const std::string& rate) {
    try {
      const SampleClock clock(info.tick_rate, rate);
      clock.time_ns(info.ticks_per_sequence);
      clock.samples_before(info.ticks_per_sequence);
    } catch (const UserError& error) {
      field.fail(error.what());
    }
  };
  check_clock(json.at("tick_rate_hz"), info.tick_rate);
  for (size_t i = 0; i < sensors.size(); ++i)
    if (!info.sensors[i].rate.empty()) check_clock(sensors[i].at("rate_hz"), info.sensors[i].rate);
  return info;
}

std::string describe_differences(const std::string& stored, const std::string& wanted,
                                 const std::string& name) {
  const JsonDocument document(stored, {name, 1});
  const Json a = document.root().json().flatten(), b = Json::parse(wanted).flatten();
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
  if (file.dtype() != DType::i64 || file.shape().size() != 2 || file.shape()[1] != 5 ||
      file.rows() > most_index_rows)
    throw_user_error("{}: expected int64 [records, 5], at most {} records, found {} [{}]", path.string(),
                     most_index_rows, numpy_name(file.dtype()), fmt::join(file.shape(), ", "));
  const Array array = file.read();
  const std::span<const int64_t> v = array.as<int64_t>();
  std::vector<IndexRow> rows;
  rows.reserve(v.size() / 5);
  for (size_t i = 0; i < v.size(); i += 5) rows.push_back({v[i], v[i + 1], v[i + 2], v[i + 3], v[i + 4]});
  return rows;
}

void check_index_rows(const std::string& name, const DatasetInfo& info, const std::vector<IndexRow>& rows) {
  const auto expect = [&](size_t row, const char* what, int64_t value, int64_t most) {
    if (value < 0 || value > most)
      throw_user_error("{}: row {}: expected a {} from 0 to {}, found {}", name, row, what, most, value);
  };
  for (size_t i = 0; i < rows.size(); ++i) {
    expect(i, "tick", rows[i].tick, info.ticks_per_sequence - 1);
    expect(i, "time in ns", rows[i].time_ns, INT64_MAX / 2);
    expect(i, "sensor", rows[i].sensor, std::ssize(info.sensors) - 1);
    expect(i, "sample", rows[i].sample, most_ticks);
    expect(i, "row", rows[i].row, most_ticks);
  }
}

SampleClock::Ratio SampleClock::parse(const std::string& text) {
  Ratio ratio{0, 1};
  const char* at = text.data();
  const char* const end = at + text.size();
  auto result = std::from_chars(at, end, ratio.numerator);
  bool good = result.ec == std::errc{};
  if (good && result.ptr != end && *result.ptr == '/') {
    result = std::from_chars(result.ptr + 1, end, ratio.denominator);
    good = result.ec == std::errc{};
  }
  if (good && result.ptr != end && *result.ptr == '.') {
    for (at = result.ptr + 1; good && at != end && *at >= '0' && *at <= '9'; ++at)
      good = !__builtin_mul_overflow(ratio.numerator, 10, &ratio.numerator) &&
             !__builtin_add_overflow(ratio.numerator, *at - '0', &ratio.numerator) &&
             !__builtin_mul_overflow(ratio.denominator, 10, &ratio.denominator);
    result.ptr = at;
  }
  good = good && result.ptr == end && ratio.numerator > 0 && ratio.denominator > 0;
  if (good) {
    const int64_t divisor = std::gcd(ratio.numerator, ratio.denominator);
    ratio = {ratio.numerator / divisor, ratio.denominator / divisor};
  }
  if (!good || ratio.numerator > most_of_ratio || ratio.denominator > most_of_ratio)
    throw_user_error("rate {}: expected a positive rational number of Hz, of numbers up to {}",
                     Json(text).dump(-1, ' ', true, Json::error_handler_t::replace), most_of_ratio);
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
  if (tick <= 0) return 0;
  // tick_of(k) < tick means 2 k n + d < 2 d tick, so k < d (2 tick - 1) / (2 n). The count of such k >= 0 is
  // this bound, rounded up.
  const Wide numerator = Wide{tick_rate_.numerator} * rate_.denominator;
  const Wide denominator = Wide{tick_rate_.denominator} * rate_.numerator;
  return floor_ratio(denominator * (2 * tick - 1) + 2 * numerator - 1, 2 * numerator);
}

int64_t SampleClock::time_ns(int64_t tick) const {
  const Wide numerator = Wide{tick} * tick_rate_.denominator * 1'000'000'000;
  return floor_ratio(2 * numerator + tick_rate_.numerator, 2 * Wide{tick_rate_.numerator});
}

std::string find_bad_value(const SensorSpec& sensor, const ArraySpec& spec, const Array& array) {
  if (array.dtype != DType::f32 && array.dtype != DType::f64 && array.dtype != DType::complex64) return {};
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
  // Few arrays have such values, and metadata may be long, so they are read last.
  if (sensor.metadata_json.find("\"non_finite\"") != std::string::npos) {
    const Json metadata = Json::parse(sensor.metadata_json);
    const auto listed = metadata.find("non_finite");
    if (listed != metadata.end() && listed->is_array() &&
        std::find(listed->begin(), listed->end(), spec.name) != listed->end())
      return {};
  }
  return fmt::format("{} at element {} of {}", value, array.dtype == DType::complex64 ? at / 2 : at,
                     spec.name);
}

}  // namespace greatx::io
