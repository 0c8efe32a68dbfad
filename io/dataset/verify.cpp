// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "io/dataset/verify.h"

#include <algorithm>
#include <map>
#include <set>

#include "core/text.h"
#include "io/dataset/dataset_reader.h"
#include "io/dataset/expect_dataset.h"
#include "io/dataset/manifest.h"
#include "io/dataset/packed_stream.h"
#include "io/dataset/worker_pool.h"
#include "io/files/inside.h"
#include "io/formats/npy.h"

namespace greatx::io {

namespace fs = std::filesystem;

namespace {

class Verifier {
 public:
  Verifier(const fs::path& folder, uint32_t threads) : folder_(folder), workers_(threads) {}
  std::vector<Problem> run();

 private:
  void check_files();
  void check_foreign_files();
  void check_index(const DatasetReader& reader, uint32_t sequence);
  void check_row(const DatasetReader& reader, uint32_t sequence, const IndexRow& row,
                 int64_t expected_sample);
  void check_stacks(const DatasetReader& reader, uint32_t sequence, const std::vector<int64_t>& counts);
  void check_packed(const DatasetReader& reader, uint32_t sequence, size_t sensor, const OutputSpec& output,
                    int64_t records);
  int64_t check_offsets(const std::string& path, int64_t records);
  void check_stack_values(const SensorSpec& sensor, const ArraySpec& spec, const std::string& path,
                          const std::vector<int64_t>& expected_shape);
  void check_frame_values(const DatasetReader& reader, uint32_t sequence);
  void report(const std::string& file, const std::string& what, const std::string& expected = {},
              const std::string& found = {}) {
    problems_.push_back({file, what, expected, found});
  }
  bool sound(const std::string& path) const { return listed_.contains(path) && !broken_.contains(path); }

  fs::path folder_;
  WorkerPool workers_;
  std::vector<FileEntry> files_;
  std::set<std::string> listed_;  ///< paths in the manifest
  std::set<std::string> broken_;  ///< listed paths of missing or changed files, which are already reported
  std::set<std::string> used_;    ///< paths that the index accounts for
  std::vector<Problem> problems_;
};

std::vector<Problem> Verifier::run() {
  expect_dataset(folder_);
  if (!exists_inside(folder_, manifest_file)) {
    size_t records = 0;
    const DatasetReader reader(folder_);
    for (uint32_t sequence = 0; sequence < reader.sequences(); ++sequence)
      records += reader.records(sequence).size();
    report(manifest_file, "the data set is unfinished; generate --resume finishes it", "a manifest",
           fmt::format("{} whole records", records));
    return problems_;
  }
  try {
    files_ = read_manifest(folder_);
  } catch (const UserError& error) {
    report(manifest_file, error.what());
    return problems_;
  }
  for (const FileEntry& file : files_) listed_.insert(file.path);
  check_files();
  check_foreign_files();
  used_ = {dataset_file, scenario_file};
  for (const std::string& path : used_)
    if (!listed_.contains(path)) report(path, "is not in the manifest");
  try {
    const DatasetReader reader(folder_);
    for (uint32_t sequence = 0; sequence < reader.sequences(); ++sequence) {
      check_index(reader, sequence);
      check_frame_values(reader, sequence);
    }
    for (const std::string& path : listed_)
      if (!used_.contains(path)) report(path, "is in the manifest, but no record of the index has it");
  } catch (const UserError& error) {
    // If there are problems already, this error is a consequence of them.
    if (problems_.empty()) report(folder_.string(), error.what());
  }
  return problems_;
}

void Verifier::check_files() {
  std::vector<std::vector<Problem>> found(files_.size());
  workers_.for_each(files_.size(), [&](size_t i) {
    const FileEntry& file = files_[i];
    try {
      const std::optional<uint64_t> size = size_inside(folder_, file.path);
      if (!size) {
        found[i].push_back({file.path, "is missing", fmt::format("{} bytes", file.size), "no file"});
      } else if (*size != file.size) {
        found[i].push_back({file.path, "has another size", fmt::format("{} bytes", file.size),
                            fmt::format("{} bytes", *size)});
      } else if (const std::string hash = sha256_of(File::open_for_reading(folder_ / file.path));
                 hash != file.sha256) {
        found[i].push_back({file.path, "has another SHA-256", file.sha256, hash});
      }
    } catch (const UserError& error) {
      found[i].push_back({file.path, error.what(), {}, {}});
    }
  });
  for (std::vector<Problem>& list : found) {
    for (Problem& problem : list) {
      broken_.insert(problem.file);
      problems_.push_back(std::move(problem));
    }
  }
}

void Verifier::check_foreign_files() {
  std::set<std::string> foreign;
  for (const auto& entry : fs::recursive_directory_iterator(folder_)) {
    if (entry.is_directory() && !entry.is_symlink()) continue;
    const std::string path = entry.path().lexically_relative(folder_).generic_string();
    const bool companion =
        std::find(std::begin(companion_files), std::end(companion_files), path) != std::end(companion_files);
    if (path != manifest_file && !companion && !listed_.contains(path)) foreign.insert(path);
  }
  for (const std::string& path : foreign)
    report(printable(path), "does not belong to the data set", "no such file", "a file");
}

void Verifier::check_index(const DatasetReader& reader, uint32_t sequence) {
  const std::string npy = index_path(sequence, "npy"), csv = index_path(sequence, "csv");
  used_.insert({npy, csv});
  const std::vector<IndexRow>& rows = reader.records(sequence);
  if (sound(csv) && read_text_file(inside(folder_, csv)) != index_csv(reader.info(), rows))
    report(csv, "says something else than index.npy");
  std::vector<int64_t> counts(reader.sensors().size());
  for (size_t i = 0; i < rows.size(); ++i) {
    if (i > 0 && std::pair(rows[i].tick, rows[i].sensor) <= std::pair(rows[i - 1].tick, rows[i - 1].sensor))
      report(npy, fmt::format("row {} is not in order of tick and sensor", i));
    check_row(reader, sequence, rows[i], counts[static_cast<size_t>(rows[i].sensor)]++);
  }
  for (size_t s = 0; s < counts.size(); ++s) {
    const SensorSpec& sensor = reader.sensors()[s];
    if (sensor.rate.empty()) continue;
    const int64_t due =
        SampleClock(reader.info().tick_rate, sensor.rate).samples_before(reader.info().ticks_per_sequence);
    if (counts[s] != due)
      report(npy, sensor.name + ": number of records", std::to_string(due), std::to_string(counts[s]));
  }
  check_stacks(reader, sequence, counts);
}

void Verifier::check_row(const DatasetReader& reader, uint32_t sequence, const IndexRow& row,
                         int64_t expected_sample) {
  const SensorSpec& sensor = reader.sensors()[static_cast<size_t>(row.sensor)];
  const std::string npy = index_path(sequence, "npy");
  const auto expect = [&](const char* what, int64_t expected, int64_t found) {
    if (expected == found) return;
    report(npy, fmt::format("{}, tick {}: {}", sensor.name, row.tick, what), std::to_string(expected),
           std::to_string(found));
  };
  const SampleClock clock(reader.info().tick_rate, sensor.rate.empty() ? "1" : sensor.rate);
  expect("row", expected_sample, row.row);
  expect("sample", expected_sample, row.sample);
  expect("time in ns", clock.time_ns(row.tick), row.time_ns);
  if (!sensor.rate.empty()) expect("tick of the sample", clock.tick_of(row.sample), row.tick);
  for (const OutputSpec& output : sensor.outputs) {
    if (!is_frame(output.format)) continue;
    const std::string path = frame_path(sequence, sensor, output, row.sample);
    used_.insert(path);
    if (!listed_.contains(path)) report(path, "is in the index, but not in the manifest");
  }
}

void Verifier::check_stacks(const DatasetReader& reader, uint32_t sequence,
                            const std::vector<int64_t>& counts) {
  for (size_t s = 0; s < counts.size(); ++s) {
    const SensorSpec& sensor = reader.sensors()[s];
    for (const OutputSpec& output : sensor.outputs) {
      if (is_export(output.format)) {
        const std::string path = export_path(sequence, sensor, output);
        used_.insert(path);
        if (!listed_.contains(path)) report(path, "is not in the manifest");
      }
      if (is_packed(output.format)) check_packed(reader, sequence, s, output, counts[s]);
      if (!is_stack(output.format)) continue;
      const ArraySpec& spec = sensor.arrays[arrays_of(sensor, output)[0]];
      std::vector<int64_t> shape = spec.shape;
      int64_t rows = counts[s];
      if (output.format == FileFormat::npy_ragged) {
        rows = check_offsets(offsets_path(sequence, sensor, output), counts[s]);
        shape.erase(shape.begin());
      }
      shape.insert(shape.begin(), rows);
      const std::string path = stack_path(sequence, sensor, output);
      used_.insert(path);
      if (!listed_.contains(path)) report(path, "is not in the manifest");
      if (sound(path) && rows >= 0) check_stack_values(sensor, spec, path, shape);
    }
  }
}

/// Checks the table of a packed output, and the values of its floating-point arrays. Integers have no invalid
/// values, and the hashes cover their bytes.
void Verifier::check_packed(const DatasetReader& reader, uint32_t sequence, size_t number,
                            const OutputSpec& output, int64_t records) {
  const SensorSpec& sensor = reader.sensors()[number];
  const std::string data = packed_path(sequence, sensor, output),
                    table = places_path(sequence, sensor, output);
  bool good = true;
  for (const std::string& path : {data, table}) {
    used_.insert(path);
    if (!listed_.contains(path)) report(path, "is not in the manifest");
    good = good && sound(path);
  }
  if (!good) return;
  try {
    const PackedRecords packed = open_packed(folder_, sequence, sensor, output, true);
    if (packed.records() != records) {
      report(table, "number of records", std::to_string(records), std::to_string(packed.records()));
      return;
    }
    const std::vector<ArraySpec> arrays = specs_of(sensor, output);
    workers_.for_each(static_cast<size_t>(records), [&](size_t record) {
      for (size_t column = 0; column < packed.columns().size(); ++column)
        (void)packed.place(static_cast<int64_t>(record), column);
      for (size_t a = 0; a < arrays.size(); ++a) {
        if (arrays[a].dtype != DType::f32 && arrays[a].dtype != DType::f64) continue;
        const std::string bad =
            find_bad_value(sensor, arrays[a], packed.load(static_cast<int64_t>(record), a));
        if (!bad.empty())
          throw_user_error("{}: record {}: expected finite values, found {}", packed.data_path().string(),
                           record, bad);
      }
    });
  } catch (const UserError& error) {
    report(data, error.what());
  }
}

/// Checks the offsets of a ragged stack. Returns the last offset, or -1 if the offsets are not valid.
int64_t Verifier::check_offsets(const std::string& path, int64_t records) {
  used_.insert(path);
  if (!listed_.contains(path)) report(path, "is not in the manifest");
  if (!sound(path)) return -1;
  const NpyFile file(inside(folder_, path));
  if (file.dtype() != DType::i64 || file.shape() != std::vector<int64_t>{records + 1}) {
    report(path, "shape", fmt::format("<i8 [{}]", records + 1),
           fmt::format("{} [{}]", numpy_name(file.dtype()), fmt::join(file.shape(), ", ")));
    return -1;
  }
  const Array array = file.read();
  const std::span<const int64_t> offsets = array.as<int64_t>();
  if (offsets[0] != 0 || !std::is_sorted(offsets.begin(), offsets.end())) {
    report(path, "offsets do not ascend from 0");
    return -1;
  }
  return offsets.back();
}

void Verifier::check_stack_values(const SensorSpec& sensor, const ArraySpec& spec, const std::string& path,
                                  const std::vector<int64_t>& expected_shape) {
  const NpyFile file(inside(folder_, path));
  if (file.dtype() != spec.dtype || file.shape() != expected_shape) {
    report(path, "shape", fmt::format("{} [{}]", numpy_name(spec.dtype), fmt::join(expected_shape, ", ")),
           fmt::format("{} [{}]", numpy_name(file.dtype()), fmt::join(file.shape(), ", ")));
    return;
  }
  const auto row_bytes = static_cast<int64_t>(std::max<uint64_t>(1, stack_row_bytes(spec)));
  const int64_t step = std::max<int64_t>(1, (int64_t{16} << 20) / row_bytes);
  for (int64_t first = 0; first < file.rows(); first += step) {
    const std::string bad =
        find_bad_value(sensor, spec, file.read_rows(first, std::min(first + step, file.rows())));
    if (!bad.empty()) {
      report(path, fmt::format("from row {} on", first), "finite values", bad);
      return;
    }
  }
}

/// Decodes the frames with floating-point values and checks the values. Frames of integers need no check:
/// integers have no invalid values, and the hashes cover their bytes.
void Verifier::check_frame_values(const DatasetReader& reader, uint32_t sequence) {
  const std::vector<IndexRow>& rows = reader.records(sequence);
  std::vector<std::vector<Problem>> found(rows.size());
  workers_.for_each(rows.size(), [&](size_t r) {
    const SensorSpec& sensor = reader.sensors()[static_cast<size_t>(rows[r].sensor)];
    for (const OutputSpec& output : sensor.outputs) {
      const bool exact = output.format == FileFormat::exr || is_cloud(output.format) ||
                         output.format == FileFormat::kitti || output.format == FileFormat::npy_frame;
      const std::string path = exact ? frame_path(sequence, sensor, output, rows[r].sample) : "";
      if (!exact || !sound(path)) continue;
      const std::vector<size_t> arrays = arrays_of(sensor, output);
      for (size_t a = 0; a < arrays.size(); ++a) {
        const ArraySpec& spec = sensor.arrays[arrays[a]];
        if (spec.dtype != DType::f32 && spec.dtype != DType::f64 && spec.dtype != DType::complex64) continue;
        try {
          const std::string bad =
              find_bad_value(sensor, spec, reader.load_output(sequence, rows[r], output, a));
          if (!bad.empty()) found[r].push_back({path, "values", "finite values", bad});
        } catch (const UserError& error) {
          found[r].push_back({path, error.what(), "", ""});
        }
      }
    }
  });
  for (const std::vector<Problem>& list : found) problems_.insert(problems_.end(), list.begin(), list.end());
}

}  // namespace

std::string Problem::str() const {
  std::string text = file + ": " + what;
  if (!expected.empty()) text += ": expected " + expected;
  if (!found.empty()) text += ", found " + found;
  return text;
}

std::vector<Problem> verify(const fs::path& folder, uint32_t threads) try {
  return Verifier(folder, threads).run();
} catch (const fs::filesystem_error& error) {
  throw_user_error("{}: {}", error.path1().string(), error.code().message());
}

}  // namespace greatx::io
