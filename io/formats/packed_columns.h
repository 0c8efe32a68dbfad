// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Packs arrays of records without loss, so that HDF5's own filters shuffle and deflate unpack them. An array
// becomes one column, or four if its rows are x, y, z and something else. The packed column of one record is
// one chunk. docs/dataset.md describes the result for users; hdf5_records.h writes and reads the files.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/record.h"
#include "io/files/file.h"

namespace greatx::io {

/// Describes how a column is stored.
struct PackedColumn {
  enum class Coding {
    plain,      ///< as the values are
    steps,      ///< differences from the value before; the first value is kept apart
    multiples,  ///< values over `step`, which are integers
  };
  std::string name;    ///< path in the HDF5 file: "range_doppler", "t_steps", "points/x"
  size_t array = 0;    ///< index of the array among those of the output
  int component = -1;  ///< 0 to 3: its place in the rows of an array [-1, 4]; -1: the whole array
  Coding coding = Coding::plain;
  DType dtype = DType::f32;
  std::vector<int64_t> shape;  ///< of one record; a first axis of -1 varies
  double step = 0.0;           ///< of `multiples`, in `unit`
  std::string unit;

  bool varies() const { return !shape.empty() && shape[0] < 0; }
  /// Returns the elements of a record along the axes that do not vary.
  uint64_t row_elements() const;
};

/// Tells the types in which a column may be stored. The smallest type that holds all values of a record is
/// chosen.
enum class PackedType : int64_t {
  declared,  ///< the array's own type
  u32,       ///< of `steps`
  i64,       ///< of `steps`, if u32 does not suffice
  i16,       ///< of `multiples`
  i32,       ///< of `multiples`, if i16 does not suffice; if this does not suffice either: `declared`
};
size_t size_of(PackedType type, DType declared);

/// Tells the place of the packed column of one record, and how to unpack it. A row of the table NAME.npy.
struct PackedPlace {
  int64_t offset = 0, bytes = 0;  ///< of the packed bytes in the file; no bytes if there are no values
  int64_t rows = 0;               ///< along the axis that varies; 1 if none does
  int64_t type = 0;               ///< PackedType
  int64_t first = 0;              ///< the first value, of `steps`
};
inline constexpr int64_t packed_place_numbers = 5;
static_assert(sizeof(PackedPlace) == packed_place_numbers * sizeof(int64_t));

/// Describes why arrays cannot be packed in one file; returns an empty string if they can.
std::string fault_of_packed(std::span<const ArraySpec> arrays);
/// Returns the columns of arrays that can be packed, in the order of the arrays.
std::vector<PackedColumn> packed_columns(std::span<const ArraySpec> arrays);

/// Appends the packed column of a record's array to `out`; the offset of the place is that in `out`. `level`
/// is libdeflate's, 1 to 12. Throws UserError if the column has 4 GiB or more, which HDF5 does not allow.
PackedPlace pack_column(const PackedColumn& column, const Array& array, int level, Bytes& out);
/// Throws UserError, which begins with `name`, if a column cannot have such a place in a file of
/// `file_bytes`. Must be called before memory is allocated for the column.
void check_place(const PackedColumn& column, const PackedPlace& place, uint64_t file_bytes,
                 const std::string& name);
/// Unpacks a column whose place is good, to the type and shape that it declares. Throws UserError if the
/// bytes are not what the place says.
Array unpack_column(const PackedColumn& column, const PackedPlace& place, std::span<const std::byte> packed,
                    const std::string& name);

}  // namespace greatx::io
