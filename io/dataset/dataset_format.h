// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines the format of a data set, which writer, reader and verify share: the paths of its files, the
// contents of dataset.json and of the index, and the ticks at which a sensor fires. docs/dataset.md describes
// the format for users.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/record.h"
#include "io/files/file.h"

namespace greatx::io {

inline constexpr int format_version = 1;
inline constexpr const char* dataset_file = "dataset.json";
inline constexpr const char* scenario_file = "scenario.yaml";
inline constexpr const char* manifest_file = "manifest.json";
inline constexpr const char* journal_file = "journal.txt";  ///< exists only while the data set is unfinished
/// Holds the results of the run's consistency checks, by record. It lies beside the data and not in the
/// manifest, because it is complete only when the data are.
inline constexpr const char* consistency_file = "consistency.csv";
/// Holds what a calibration has chosen for the run, if its scenario gave errors instead of settings. It has
/// times, which do not decide the bytes of the data, so it is not part of the manifest.
inline constexpr const char* calibration_file = "calibration.json";
/// Holds a record of each run of the program that wrote to the data set: command line, machine, times,
/// losses.
inline constexpr const char* run_file = "run.json";
/// Lists the files that `greatx generate` and `greatx inspect` may leave beside the data. They are not part
/// of the manifest.
inline constexpr const char* companion_files[] = {
    "contact_sheet.png", "animation.webp", "animation.mp4", "report.html",
    consistency_file,    calibration_file, run_file};

// A data set may state no numbers beyond these bounds, so that false numbers cost neither time nor memory.
inline constexpr int64_t most_sequences = 1'000'000, most_ticks = 1'000'000'000'000;
inline constexpr uint64_t largest_array = uint64_t{4} << 30;  ///< bytes of one array of one record

/// Describes the run, as far as it stays the same from begin to end. Two runs with the same DatasetInfo give
/// the same bytes on the same device, so it must not hold wall-clock times, host names or paths.
struct DatasetInfo {
  /// One JSON object: scenario name, scene hash, seed, device, driver, versions, ...
  std::string run_json = "{}";
  std::string scenario_text;  ///< written as scenario.yaml; its SHA-256 goes into dataset.json
  std::string run_key;  ///< hash over everything that decides the bytes; this library does not interpret it
  std::string tick_rate = "1000";  ///< Hz, rational: "1000", "30000/1001"
  std::vector<SensorSpec> sensors;
  uint32_t sequences = 1;
  int64_t ticks_per_sequence = 0;
  /// Decides the effort of packing; the sensors' outputs say what is packed.
  Compression compression = Compression::none;
};

/// Describes one record in the index, which is sorted by tick, then by sensor.
struct IndexRow {
  int64_t tick = 0;
  int64_t time_ns = 0;
  int64_t sensor = 0;  ///< index into DatasetInfo::sensors
  int64_t sample = 0;  ///< number k of the sample; also the number in the names of per-frame files
  int64_t row = 0;     ///< row in the sensor's stacked arrays of this sequence
  friend bool operator==(const IndexRow&, const IndexRow&) = default;
};
inline constexpr const char* index_columns = "tick,time_ns,sensor,sample,row";

/// Throws UserError if a name is no plain relative path, or if two outputs would share a file or a folder.
/// Throws ContractError if an output does not fit its arrays, if no output keeps an array, or if an array is
/// larger than largest_array.
void check_sensors(const std::vector<SensorSpec>& sensors);
/// Returns the arrays of an output as indices into SensorSpec::arrays.
std::vector<size_t> arrays_of(const SensorSpec& sensor, const OutputSpec& output);
std::vector<ArraySpec> specs_of(const SensorSpec& sensor, const OutputSpec& output);

/// Returns the output npy_ragged or hdf5_records that keeps the array, or null if there is none.
const OutputSpec* sequence_output(const SensorSpec& sensor, const std::string& array);

std::string_view name_of(FileFormat format);
bool is_stack(FileFormat format);   ///< npy_stack or npy_ragged: one file per sequence
bool is_export(FileFormat format);  ///< one file per sequence, made from its stacks when it ends
bool is_packed(FileFormat format);  ///< hdf5_records: two files per sequence, made when it ends
bool is_frame(FileFormat format);   ///< one file per record
bool is_cloud(FileFormat format);   ///< PLY or PCD: points with properties, several arrays per file
// The next functions return paths relative to the data set's folder, with '/' between their parts.
std::string sequence_folder(uint32_t sequence);
std::string stack_path(uint32_t sequence, const SensorSpec& sensor, const OutputSpec& output);
std::string offsets_path(uint32_t sequence, const SensorSpec& sensor, const OutputSpec& output);
std::string export_path(uint32_t sequence, const SensorSpec& sensor, const OutputSpec& output);
/// The HDF5 file of an output hdf5_records, and the table of places in it.
std::string packed_path(uint32_t sequence, const SensorSpec& sensor, const OutputSpec& output);
std::string places_path(uint32_t sequence, const SensorSpec& sensor, const OutputSpec& output);
std::string frame_folder(uint32_t sequence, const SensorSpec& sensor, const OutputSpec& output);
std::string frame_path(uint32_t sequence, const SensorSpec& sensor, const OutputSpec& output, int64_t sample);
std::string index_path(uint32_t sequence, const char* extension);
/// Returns the bytes of one row of a stack. A row is one record (npy_stack) or one element along the first
/// axis of a record (npy_ragged).
uint64_t stack_row_bytes(const ArraySpec& array);

std::string dataset_json(const DatasetInfo& info);
/// Parses dataset.json; scenario_text stays empty. `name` is the file's name in messages. Throws UserError if
/// the text is not a valid dataset.json.
DatasetInfo parse_dataset_json(const std::string& text, const std::string& name);
/// Lists the fields in which two dataset.json differ, one per line: "path: the data set has X, this run has
/// Y". After eight fields, one line gives the number of the others. `name` is the file of `stored`. Throws
/// UserError if `stored` is not JSON.
std::string describe_differences(const std::string& stored, const std::string& wanted,
                                 const std::string& name);

std::string index_csv(const DatasetInfo& info, const std::vector<IndexRow>& rows);
Bytes index_npy(const std::vector<IndexRow>& rows);
/// Throws UserError if the file is not an index.
std::vector<IndexRow> read_index_npy(const std::filesystem::path& path);
/// Throws UserError, which names the file and the row, if a row holds a number outside its valid range.
void check_index_rows(const std::string& name, const DatasetInfo& info, const std::vector<IndexRow>& rows);

/// Computes the tick of each sample and the time of each tick in exact integer arithmetic. Sample k fires at
/// tick round(k * tick_rate / rate), where halves are rounded up.
class SampleClock {
 public:
  /// Takes rates in Hz as text: "30", "29.97", "30000/1001". Throws UserError if a rate is not a positive
  /// rational number whose numerator and denominator are at most 10^12. Ticks and samples given to the
  /// functions must not exceed most_ticks. The functions throw UserError if a result does not fit into 64
  /// bits.
  SampleClock(const std::string& tick_rate, const std::string& rate);
  int64_t tick_of(int64_t sample) const;
  int64_t samples_before(int64_t tick) const;  ///< number of samples that fire at ticks 0 .. tick-1
  int64_t time_ns(int64_t tick) const;         ///< rounded to the nearest nanosecond

 private:
  struct Ratio {
    int64_t numerator, denominator;
  };
  static Ratio parse(const std::string& text);
  Ratio tick_rate_, rate_;
};

/// Describes the first invalid value of the array; returns an empty string if all values are valid. Values of
/// floating-point arrays must be finite, with two exceptions: a camera's arrays whose names begin with
/// "depth" may hold +infinity (sky), and arrays that the sensor's metadata list under "non_finite" may hold
/// any value.
std::string find_bad_value(const SensorSpec& sensor, const ArraySpec& spec, const Array& array);

}  // namespace greatx::io
