// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "io/formats/hdf5_records.h"

#include <algorithm>

#include <fmt/ranges.h>

#include "io/formats/hdf5_library.h"
#include "io/formats/npy.h"

namespace greatx::io {

namespace {

/// The level that the file states for deflate. It plays no part in unpacking.
constexpr unsigned stated_level = 6;

hid_t hdf5_type(PackedType type, DType declared) {
  switch (type) {
    case PackedType::u32:
      return H5T_STD_U32LE;
    case PackedType::i64:
      return H5T_STD_I64LE;
    case PackedType::i16:
      return H5T_STD_I16LE;
    case PackedType::i32:
      return H5T_STD_I32LE;
    case PackedType::declared:
      break;
  }
  switch (declared) {
    case DType::u8:
      return H5T_STD_U8LE;
    case DType::u16:
      return H5T_STD_U16LE;
    case DType::u32:
      return H5T_STD_U32LE;
    case DType::u64:
      return H5T_STD_U64LE;
    case DType::i8:
      return H5T_STD_I8LE;
    case DType::i32:
      return H5T_STD_I32LE;
    case DType::i64:
      return H5T_STD_I64LE;
    case DType::f32:
      return H5T_IEEE_F32LE;
    case DType::f64:
      return H5T_IEEE_F64LE;
    case DType::complex64:
      break;
  }
  GREATX_CHECK(false, "{} is not packed", numpy_name(declared));
  return -1;
}

/// Writes one file. The library's objects hold no times, so that the bytes follow from the records alone.
class RecordsWriter {
 public:
  RecordsWriter(const std::filesystem::path& path, const std::vector<PackedColumn>& columns, size_t records)
      : path_(path),
        records_(records),
        columns_(columns),
        group_properties_(H5Pcreate(H5P_GROUP_CREATE), H5Pclose, path),
        file_(create(path)) {
    check(H5Pset_obj_track_times(group_properties_.id(), 0));
    for (size_t c = 0; c < columns.size(); ++c) begin(columns[c]);
  }

  /// Writes the packed column of a record, and returns its offset in the file.
  int64_t write(size_t record, size_t number, const PackedPlace& place, const Bytes& packed) {
    const PackedColumn& column = columns_[number];
    if (!column.varies()) return write_chunk(roots_[number].id(), record, column.shape.size() + 1, packed);
    std::vector<hsize_t> shape(column.shape.begin(), column.shape.end());
    shape[0] = static_cast<hsize_t>(place.rows);
    const Hdf5Handle dataset =
        create_dataset(roots_[number].id(), fmt::format("{:06}", record), column,
                       static_cast<PackedType>(place.type), shape, packed.empty() ? nullptr : shape.data());
    return packed.empty() ? 0 : write_chunk(dataset.id(), 0, shape.size(), packed);
  }

  /// Writes the first values of a column of steps.
  void write_first(const PackedColumn& column, const std::vector<int64_t>& values) {
    const std::string name = column.name.substr(0, column.name.rfind('_')) + "_first";
    const hsize_t extent = values.size();
    const Hdf5Handle dataset = create_dataset(file_.id(), name, column, PackedType::i64, {extent}, nullptr);
    if (!values.empty())
      check(H5Dwrite(dataset.id(), H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()));
  }

  void close() {
    roots_.clear();
    parents_.clear();
    file_.close(path_);
  }

 private:
  static Hdf5Handle create(const std::filesystem::path& path) {
    const Hdf5Handle creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose, path),
        access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, path);
    H5Pset_obj_track_times(creation.id(), 0);
    // HDF5 1.10 and newer keep a dataset of one chunk without an index of chunks.
    H5Pset_libver_bounds(access.id(), H5F_LIBVER_V110, H5F_LIBVER_V110);
    errno = 0;
    return {H5Fcreate(path.c_str(), H5F_ACC_TRUNC, creation.id(), access.id()), H5Fclose, path};
  }
  void check(herr_t result) const {
    if (result < 0) throw WriteError(path_, errno != 0 ? errno : EIO);
  }
  Hdf5Handle create_group(hid_t parent, const std::string& name) const {
    return {H5Gcreate2(parent, name.c_str(), H5P_DEFAULT, group_properties_.id(), H5P_DEFAULT), H5Gclose,
            path_};
  }

  /// Creates the group or the dataset of a column.
  void begin(const PackedColumn& column) {
    hid_t parent = file_.id();
    std::string name = column.name;
    if (const size_t slash = name.find('/'); slash != name.npos) {
      if (column.component == 0) parents_.push_back(create_group(file_.id(), name.substr(0, slash)));
      parent = parents_.back().id();
      name = name.substr(slash + 1);
    }
    if (column.varies()) {
      roots_.push_back(create_group(parent, name));
      if (column.step > 0.0) write_step(roots_.back().id(), column.step);
      return;
    }
    std::vector<hsize_t> shape(column.shape.begin(), column.shape.end());
    shape.insert(shape.begin(), records_);
    std::vector<hsize_t> chunk = shape;
    chunk[0] = 1;
    roots_.push_back(create_dataset(parent, name, column, PackedType::declared, shape,
                                    records_ > 0 ? chunk.data() : nullptr));
  }
  void write_step(hid_t group, double step) const {
    const Hdf5Handle scalar(H5Screate(H5S_SCALAR), H5Sclose, path_);
    const Hdf5Handle attribute(
        H5Acreate2(group, "step", H5T_IEEE_F64LE, scalar.id(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose, path_);
    check(H5Awrite(attribute.id(), H5T_NATIVE_DOUBLE, &step));
  }
  /// Creates a dataset, in chunks that the filters pack if `chunk` is given.
  Hdf5Handle create_dataset(hid_t parent, const std::string& name, const PackedColumn& column,
                            PackedType type, const std::vector<hsize_t>& shape, const hsize_t* chunk) const {
    const Hdf5Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, path_);
    check(H5Pset_obj_track_times(properties.id(), 0));
    check(H5Pset_dset_no_attrs_hint(properties.id(), true));
    const auto rank = static_cast<int>(shape.size());
    if (chunk != nullptr) {
      check(H5Pset_chunk(properties.id(), rank, chunk));
      if (size_of(type, column.dtype) > 1) check(H5Pset_shuffle(properties.id()));
      check(H5Pset_deflate(properties.id(), stated_level));
    }
    const Hdf5Handle space(H5Screate_simple(rank, shape.data(), nullptr), H5Sclose, path_);
    return {H5Dcreate2(parent, name.c_str(), hdf5_type(type, column.dtype), space.id(), H5P_DEFAULT,
                       properties.id(), H5P_DEFAULT),
            H5Dclose, path_};
  }
  int64_t write_chunk(hid_t dataset, size_t record, size_t axes, const Bytes& packed) const {
    std::vector<hsize_t> at(axes);
    at[0] = record;
    errno = 0;
    check(H5Dwrite_chunk(dataset, H5P_DEFAULT, 0, at.data(), packed.size(), packed.data()));
    unsigned mask = 0;
    haddr_t offset = 0;
    hsize_t size = 0;
    check(H5Dget_chunk_info_by_coord(dataset, at.data(), &mask, &offset, &size));
    GREATX_CHECK(size == packed.size() && mask == 0, "chunk of {} bytes for {}", size, packed.size());
    return static_cast<int64_t>(offset);
  }

  std::filesystem::path path_;
  hsize_t records_;
  const std::vector<PackedColumn>& columns_;
  Hdf5Handle group_properties_;
  Hdf5Handle file_;
  std::vector<Hdf5Handle> parents_, roots_;  ///< roots_ has the group or the dataset of each column
};

}  // namespace

void write_hdf5_records(const std::filesystem::path& path, const std::vector<PackedColumn>& columns,
                        std::vector<PackedPlace>& places, const ReadPacked& read) {
  const Hdf5Lock lock;
  const size_t records = places.size() / columns.size();
  RecordsWriter writer(path, columns, records);
  std::vector<std::vector<int64_t>> first(columns.size());
  for (size_t r = 0; r < records; ++r) {
    for (size_t c = 0; c < columns.size(); ++c) {
      PackedPlace& place = places[r * columns.size() + c];
      place.offset = writer.write(r, c, place, read(place));
      first[c].push_back(place.first);
    }
  }
  for (size_t c = 0; c < columns.size(); ++c)
    if (columns[c].coding == PackedColumn::Coding::steps) writer.write_first(columns[c], first[c]);
  writer.close();
}

Bytes places_npy(size_t columns, std::span<const PackedPlace> places) {
  Bytes file = npy_header(DType::i64, {static_cast<int64_t>(places.size() / columns),
                                       static_cast<int64_t>(columns), packed_place_numbers});
  append(file, std::as_bytes(places));
  return file;
}

PackedRecords::PackedRecords(const std::filesystem::path& data, const std::filesystem::path& table,
                             std::vector<PackedColumn> columns, bool finished)
    : columns_(std::move(columns)),
      data_(File::open_for_reading(data)),
      table_(File::open_for_reading(table)),
      data_bytes_(data_.size()) {
  const uint64_t row = columns_.size() * sizeof(PackedPlace), size = table_.size();
  const uint64_t stored = size < npy_header_bytes ? 0 : size - npy_header_bytes;
  records_ = static_cast<int64_t>(stored / row);
  if (!finished) return;
  Bytes header(npy_header_bytes);
  if (size >= npy_header_bytes) table_.read_at(0, header);
  const std::vector<int64_t> shape{records_, static_cast<int64_t>(columns_.size()), packed_place_numbers};
  if (stored % row != 0 || header != npy_header(DType::i64, shape))
    throw_user_error("{}: expected {} [records, {}, {}] as greatx writes it, found {} bytes", table.string(),
                     numpy_name(DType::i64), columns_.size(), packed_place_numbers, size);
}

PackedPlace PackedRecords::place(int64_t record, size_t column) const {
  if (record < 0 || record >= records_)
    throw_user_error("{}: expected a record {}, found {} records", table_.path().string(), record, records_);
  PackedPlace place;
  const uint64_t index = static_cast<uint64_t>(record) * columns_.size() + column;
  table_.read_at(npy_header_bytes + index * sizeof place, std::as_writable_bytes(std::span(&place, 1)));
  check_place(columns_[column], place, data_bytes_,
              fmt::format("{}: record {}", table_.path().string(), record));
  return place;
}

Array PackedRecords::load_column(int64_t record, size_t column) const {
  const PackedPlace found = place(record, column);
  Bytes packed(static_cast<size_t>(found.bytes));
  data_.read_at(static_cast<uint64_t>(found.offset), packed);
  return unpack_column(columns_[column], found, packed,
                       fmt::format("{}: record {}", data_.path().string(), record));
}

Array PackedRecords::load(int64_t record, size_t array) const {
  const auto first = std::ranges::find(columns_, array, &PackedColumn::array);
  GREATX_CHECK(first != columns_.end(), "no array {}", array);
  const auto column = static_cast<size_t>(first - columns_.begin());
  if (first->component < 0) return load_column(record, column);
  const int64_t rows = place(record, column).rows;
  Array joined(DType::f32, {rows, 4});
  for (size_t c = 0; c < 4; ++c) {
    const Array one = load_column(record, column + c);
    if (one.shape[0] != rows)
      throw_user_error("{}: record {}: expected {} rows of {}, found {}", table_.path().string(), record,
                       rows, columns_[column + c].name, one.shape[0]);
    const std::span<const float> values = one.as<float>();
    for (size_t i = 0; i < values.size(); ++i) joined.as<float>()[4 * i + c] = values[i];
  }
  return joined;
}

int64_t PackedRecords::whole_records() const {
  for (int64_t record = 0; record < records_; ++record) {
    for (size_t column = 0; column < columns_.size(); ++column) {
      try {
        place(record, column);
      } catch (const UserError&) {
        return record;
      }
    }
  }
  return records_;
}

}  // namespace greatx::io
