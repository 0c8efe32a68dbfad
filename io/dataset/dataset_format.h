// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// What writer, reader and verify agree on: where files lie, what dataset.json and the index say, when a
// sensor fires. docs/dataset.md is the user's side of it.
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
inline constexpr const char* journal_file = "journal.txt";  ///< only while the data set is unfinished
/// What the run found to agree, by record; beside the data, since it is whole only when they are.
inline constexpr const char* consistency_file = "consistency.csv";
/// What `greatx generate` and `greatx inspect` may leave beside the data; not part of the manifest.
inline constexpr const char* companion_files[] = {"contact_sheet.png", "animation.webp", consistency_file};

/// Bounds of what a data set may say, so that numbers that lie ask for no time and no memory.
inline constexpr int64_t most_sequences = 1'000'000, most_ticks = 1'000'000'000'000;
inline constexpr uint64_t largest_array = uint64_t{4} << 30;  ///< bytes of one array of one record

/// What does not change during a run. Two runs whose DatasetInfo agree give the same bytes on the same
/// device, so it must not hold wall-clock times, host names or paths.
struct DatasetInfo {
  std::string run_json =
      "{}";                   ///< JSON object: scenario name, scene hash, seed, device, driver, versions, ...
  std::string scenario_text;  ///< kept as scenario.yaml; its SHA-256 goes into dataset.json
  std::string run_key;        ///< hash over everything that decides the bytes; free text for this library
  std::string tick_rate = "1000";  ///< Hz, rational: "1000", "30000/1001"
  std::vector<SensorSpec> sensors;
  uint32_t sequences = 1;
  int64_t ticks_per_sequence = 0;
};

/// One line of the index: a record, in order of tick, then sensor.
struct IndexRow {
  int64_t tick = 0;
  int64_t time_ns = 0;
  int64_t sensor = 0;  ///< index into the sensors
  int64_t sample = 0;  ///< k; also the frame number of files per frame
  int64_t row = 0;     ///< of the sensor's stacked arrays in this sequence
  friend bool operator==(const IndexRow&, const IndexRow&) = default;
};
inline constexpr const char* index_columns = "tick,time_ns,sensor,sample,row";

/// Throws UserError for names that are no plain relative paths or meet on disk, ContractError for outputs
/// that do not fit their arrays, an array that no output keeps or one that is larger than largest_array.
void check_sensors(const std::vector<SensorSpec>& sensors);
/// The arrays of an output, as indices into SensorSpec::arrays.
std::vector<size_t> arrays_of(const SensorSpec& sensor, const OutputSpec& output);

/// The npy_ragged output that keeps an array; null: none.
const OutputSpec* ragged_output(const SensorSpec& sensor, const std::string& array);

std::string_view name_of(FileFormat format);
bool is_stack(FileFormat format);   ///< npy_stack or npy_ragged: one file a sequence
bool is_export(FileFormat format);  ///< one file a sequence, made from its stacks when it ends
bool is_frame(FileFormat format);   ///< one file a record
bool is_cloud(FileFormat format);   ///< points with their properties, several arrays in a file
/// Paths relative to the data set's folder, with '/'.
std::string sequence_folder(uint32_t sequence);
std::string stack_path(uint32_t sequence, const SensorSpec& sensor, const OutputSpec& output);
std::string offsets_path(uint32_t sequence, const SensorSpec& sensor, const OutputSpec& output);
std::string export_path(uint32_t sequence, const SensorSpec& sensor, const OutputSpec& output);
std::string frame_folder(uint32_t sequence, const SensorSpec& sensor, const OutputSpec& output);
std::string frame_path(uint32_t sequence, const SensorSpec& sensor, const OutputSpec& output, int64_t sample);
std::string index_path(uint32_t sequence, const char* extension);
/// Bytes of one row of a stack: of one record (npy_stack) or of one element along the first axis
/// (npy_ragged).
uint64_t stack_row_bytes(const ArraySpec& array);

std::string dataset_json(const DatasetInfo& info);
/// The inverse, except for scenario_text. `name` stands for the file in messages. Throws UserError.
DatasetInfo parse_dataset_json(const std::string& text, const std::string& name);
/// The fields in which two dataset.json differ, "path: the data set has X, this run has Y", at most eight
/// lines. `name` is the stored one's file. Throws UserError if that is no JSON.
std::string describe_differences(const std::string& stored, const std::string& wanted,
                                 const std::string& name);

std::string index_csv(const DatasetInfo& info, const std::vector<IndexRow>& rows);
Bytes index_npy(const std::vector<IndexRow>& rows);
std::vector<IndexRow> read_index_npy(const std::filesystem::path& path);
/// Throws UserError, with the file's name and the row, for a row whose numbers can be those of no record.
void check_index_rows(const std::string& name, const DatasetInfo& info, const std::vector<IndexRow>& rows);

/// When samples fire: sample k at tick round(k * tick_rate / rate), half up, and when ticks are, exactly.
class SampleClock {
 public:
  /// Rationals as text: "30", "29.97", "30000/1001", numerator and denominator up to 10^12. Throws UserError.
  /// Ticks and samples must lie within most_ticks; a result beyond 64 bits is a UserError.
  SampleClock(const std::string& tick_rate, const std::string& rate);
  int64_t tick_of(int64_t sample) const;
  int64_t samples_before(int64_t tick) const;  ///< how many fire at ticks 0 .. tick-1
  int64_t time_ns(int64_t tick) const;

 private:
  struct Ratio {
    int64_t numerator, denominator;
  };
  static Ratio parse(const std::string& text);
  Ratio tick_rate_, rate_;
};

/// The first value of the array that must not be there, described; empty if all is well. Floating-point
/// arrays are finite, except: a camera's arrays named "depth..." may hold +infinity (sky), and the arrays
/// that the sensor's metadata list as "non_finite" may hold anything.
std::string find_bad_value(const SensorSpec& sensor, const ArraySpec& spec, const Array& array);

}  // namespace greatx::io
