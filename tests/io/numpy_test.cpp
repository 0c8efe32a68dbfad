// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks that NumPy reads the files of a data set: a sequence's CSI, memory-mapped by the lines of the
// README, and every other .npy file.
#include <gtest/gtest.h>

#include "io/files/file.h"
#include "io/formats/npy.h"
#include "tests/io/sample_run.h"
#include "tests/support/temporary_folder.h"

namespace greatx::io {
namespace {

int python(const std::filesystem::path& folder, const std::string& script) {
  write_file_atomically(folder / "script.py", script);
  return std::system(fmt::format("cd '{}' && '{}' script.py", folder.string(), GREATX_PYTHON).c_str());
}

TEST(NumPy, MemoryMapsTheStackedCsi) {
  const test::TemporaryFolder folder;
  {
    DatasetWriter writer(folder.path() / "set", sample_info());
    ASSERT_TRUE(write_sample_run(writer, sample_info()));
  }
  // By sample_cfr() element i of record k in sequence s is s + k - 1j i.
  EXPECT_EQ(python(folder.path(), R"(
import numpy
csi = numpy.load("set/sequence_0001/bs/csi/cfr.npy", mmap_mode="c")  # )"
                                  R"([batch, rx, rx_ant, tx, tx_ant, time, subcarrier]
assert isinstance(csi, numpy.memmap)
assert csi.shape == (7, 1, 2, 1, 4, 1, 8), csi.shape
assert csi.dtype == numpy.complex64 and csi.flags.c_contiguous and csi.offset == 256
k = numpy.arange(7).reshape(7, 1)
expected = (1 + k) - 1j * numpy.arange(64)
assert numpy.array_equal(csi.reshape(7, 64), expected.astype(numpy.complex64))
)"),
            0);
}

TEST(NumPy, ReadsIndexAndRaggedArrays) {
  const test::TemporaryFolder folder;
  {
    DatasetWriter writer(folder.path() / "set", sample_info());
    ASSERT_TRUE(write_sample_run(writer, sample_info()));
  }
  EXPECT_EQ(python(folder.path(), R"(
import glob, numpy
for f in glob.glob("set/**/*.npy", recursive=True):
    numpy.load(f, mmap_mode="r" if numpy.load(f).size else None)
index = numpy.load("set/sequence_0000/index.npy")
table = numpy.genfromtxt("set/sequence_0000/index.csv", delimiter=",", skip_header=1, )"
                                  R"(usecols=range(5), dtype=numpy.int64)
assert numpy.array_equal(index, table)
camera = index[index[:, 2] == 0]
assert camera[:, 0].tolist() == [0, 33, 67] and camera[:, 3].tolist() == [0, 1, 2]
delay = numpy.load("set/sequence_0000/bs/csi/delay.npy")
offsets = numpy.load("set/sequence_0000/bs/csi/delay_offsets.npy")
vertices = numpy.load("set/sequence_0000/bs/csi/vertices.npy")
assert offsets.shape == (8,) and offsets[-1] == len(delay) == len(vertices) and vertices.shape[1:] == (3, 3)
)"),
            0);
}

TEST(NumPy, ReadsPointCloudsOfOtherTools) {
  const test::TemporaryFolder folder;
  {
    DatasetWriter writer(folder.path() / "set", sample_info());
    ASSERT_TRUE(write_sample_run(writer, sample_info()));
  }
  EXPECT_EQ(python(folder.path(), R"(
import glob, numpy
def pcd(path):
    head, _, data = open(path, "rb").read().partition(b"DATA binary\n")
    lines = dict(line.split(" ", 1) for line in head.decode("ascii").splitlines() if not line.startswith("#"))
    kind = numpy.dtype([(name, "<" + code.lower() + size) for name, code, size in
                        zip(lines["FIELDS"].split(), lines["TYPE"].split(), lines["SIZE"].split())])
    points = numpy.frombuffer(data, kind)
    assert lines["VERSION"] == "0.7" and lines["HEIGHT"] == "1" and set(lines["COUNT"].split()) == {"1"}
    assert len(points) == int(lines["POINTS"]) == int(lines["WIDTH"]) and len(data) == points.nbytes
    return points
def ply(path):
    head, _, data = open(path, "rb").read().partition(b"end_header\n")
    kinds = {"float": "<f4", "uint16": "<u2"}
    return numpy.frombuffer(data, [(w[2], kinds[w[1]]) for w in )"
                                  R"((line.split() for line in head.decode().splitlines())
                                   if w[0] == "property"])
files = sorted(glob.glob("set/sequence_*/uav/lidar/pcd/*.pcd"))
total = 0
for path in files:
    points, cloud = pcd(path), ply(path.replace("/pcd/", "/cloud/").replace(".pcd", ".ply"))
    kitti = numpy.fromfile(path.replace("/pcd/", "/velodyne/").replace(".pcd", ".bin"), )"
                                  R"(numpy.float32).reshape(-1, 4)
    assert points.dtype.names == ("x", "y", "z", "intensity", "ring", "time") == cloud.dtype.names
    for name in points.dtype.names:
        assert numpy.array_equal(points[name], cloud[name]), name
    assert numpy.array_equal(kitti, numpy.stack([points[name] for name in ("x", "y", "z", "intensity")], -1))
    total += len(points)
assert len(files) > 3 and total > 20
)"),
            0);
}

TEST(NumPy, ReadsEveryTypeAndShape) {
  const test::TemporaryFolder folder;
  std::string script = "import numpy\n";
  int count = 0;
  for (const DType dtype : {DType::u8, DType::u16, DType::u32, DType::i32, DType::i64, DType::u64, DType::f32,
                            DType::f64, DType::complex64}) {
    for (const std::vector<int64_t>& shape : {std::vector<int64_t>{}, std::vector<int64_t>{5},
                                              std::vector<int64_t>{0, 3}, std::vector<int64_t>{4, 3, 2}}) {
      const std::string name = fmt::format("a{}.npy", count++);
      write_file_atomically(folder.path() / name, encode_npy(Array(dtype, shape)));
      script += fmt::format("a = numpy.load('{}'); assert a.dtype.str == '{}' and list(a.shape) == [{}], a\n",
                            name, numpy_name(dtype), fmt::join(shape, ", "));
    }
  }
  EXPECT_EQ(python(folder.path(), script), 0);
}

}  // namespace
}  // namespace greatx::io
