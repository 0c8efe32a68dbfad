// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <limits>
#include <optional>
#include <vector>

#include "core/error.h"
#include "io/files/file.h"
#include "io/formats/event_files.h"
#include "io/formats/hdf5_library.h"

namespace greatx::io {

namespace {

/// Writes an HDF5 dataset of one axis and known length from front to back.
class Column {
 public:
  Column(const Hdf5Handle& file, const std::filesystem::path& path, const char* name, hid_t stored,
         hid_t given, uint64_t rows)
      : path_(path), given_(given), properties_(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, path) {
    H5Pset_obj_track_times(properties_.id(), 0);  // the bytes must not depend on the time of day
    const hsize_t extent = rows;
    const Hdf5Handle space(H5Screate_simple(1, &extent, nullptr), H5Sclose, path);
    dataset_.emplace(
        H5Dcreate2(file.id(), name, stored, space.id(), H5P_DEFAULT, properties_.id(), H5P_DEFAULT), H5Dclose,
        path);
  }
  template <typename T>
  void append(std::span<const T> values) {
    if (values.empty()) return;
    const hsize_t start = written_, count = values.size();
    const Hdf5Handle file_space(H5Dget_space(dataset_->id()), H5Sclose, path_);
    H5Sselect_hyperslab(file_space.id(), H5S_SELECT_SET, &start, nullptr, &count, nullptr);
    const Hdf5Handle memory_space(H5Screate_simple(1, &count, nullptr), H5Sclose, path_);
    errno = 0;
    if (H5Dwrite(dataset_->id(), given_, memory_space.id(), file_space.id(), H5P_DEFAULT, values.data()) < 0)
      throw WriteError(path_, errno != 0 ? errno : EIO);
    written_ += count;
  }

 private:
  std::filesystem::path path_;
  hid_t given_;
  Hdf5Handle properties_;
  std::optional<Hdf5Handle> dataset_;
  hsize_t written_ = 0;
};

}  // namespace

void write_hdf5_events(const std::filesystem::path& path, const EventArrays& events) {
  const Hdf5Lock lock;
  errno = 0;
  Hdf5Handle file(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose, path);
  std::vector<uint64_t> ms_to_idx;
  {
    const Hdf5Handle group(H5Gcreate2(file.id(), "/events", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose,
                           path);
    const auto rows = static_cast<uint64_t>(events.size());
    Column t(file, path, "/events/t", H5T_STD_U32LE, H5T_NATIVE_UINT32, rows),
        x(file, path, "/events/x", H5T_STD_U16LE, H5T_NATIVE_UINT16, rows),
        y(file, path, "/events/y", H5T_STD_U16LE, H5T_NATIVE_UINT16, rows),
        p(file, path, "/events/p", H5T_STD_U8LE, H5T_NATIVE_UINT8, rows);
    events.for_each_piece([&](const EventArrays::Piece& piece) {
      std::vector<uint32_t> microseconds;
      microseconds.reserve(static_cast<size_t>(piece.size()));
      for (const int64_t t_ns : piece.t.as<int64_t>()) {
        const int64_t us = t_ns / 1000;
        if (t_ns < 0 || us > std::numeric_limits<uint32_t>::max())
          throw_user_error("{}: expected times of at most 4294.967295 s for DSEC's format, found {} ns",
                           events.file().string(), t_ns);
        const uint64_t index = static_cast<uint64_t>(piece.first) + microseconds.size();
        while (ms_to_idx.size() <= static_cast<uint64_t>(us / 1000)) ms_to_idx.push_back(index);
        microseconds.push_back(static_cast<uint32_t>(us));
      }
      t.append(std::span<const uint32_t>(microseconds));
      x.append(piece.x.as<uint16_t>());
      y.append(piece.y.as<uint16_t>());
      p.append(piece.p.as<uint8_t>());
    });
    ms_to_idx.push_back(rows);
    Column(file, path, "/ms_to_idx", H5T_STD_U64LE, H5T_NATIVE_UINT64, ms_to_idx.size())
        .append(std::span<const uint64_t>(ms_to_idx));
    const Hdf5Handle scalar(H5Screate(H5S_SCALAR), H5Sclose, path),
        properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, path);
    H5Pset_obj_track_times(properties.id(), 0);
    const Hdf5Handle offset(H5Dcreate2(file.id(), "/t_offset", H5T_STD_I64LE, scalar.id(), H5P_DEFAULT,
                                       properties.id(), H5P_DEFAULT),
                            H5Dclose, path);
    constexpr int64_t zero = 0;
    if (H5Dwrite(offset.id(), H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, &zero) < 0)
      throw WriteError(path, EIO);
  }
  file.close(path);
}

}  // namespace greatx::io
