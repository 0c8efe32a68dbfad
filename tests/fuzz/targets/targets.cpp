// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/targets/targets.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "core/error.h"
#include "io/dataset/dataset_reader.h"
#include "io/dataset/journal.h"
#include "io/formats/hdf5_records.h"
#include "io/formats/npy.h"
#include "scene/files/picture.h"
#include "scene/georeference/georeference.h"
#include "scene/gltf/model.h"
#include "scene/import/mitsuba.h"
#include "scene/import/ply_mesh.h"
#include "scene/material/radio_sidecar.h"
#include "sim/scenario/parse/load_scenario.h"
#include "sim/scenario/parse/pattern_csv.h"
#include "sim/scenario/parse/pattern_file.h"
#include "sim/scenario/parse/receiver_list.h"
#include "sim/scenario/parse/shot_csv.h"
#include "sim/scenario/parse/trajectory_csv.h"
#include "sim/scenario/parse/trajectory_gpx.h"

namespace greatx::fuzz {

namespace {

namespace fs = std::filesystem;

/// Returns a folder of this process for inputs that readers open by name. In memory if there is /dev/shm.
const fs::path& scratch() {
  static const struct Folder {
    Folder() {
      const fs::path parent = fs::exists("/dev/shm") ? fs::path("/dev/shm") : fs::temp_directory_path();
      std::string name = (parent / "greatx_fuzz_XXXXXX").string();
      if (mkdtemp(name.data()) == nullptr) std::abort();
      path = name;
    }
    ~Folder() {
      std::error_code ignored;
      fs::remove_all(path, ignored);
    }
    fs::path path;
  } folder;
  return folder.path;
}

fs::path written(const char* name, const uint8_t* data, size_t size) {
  const fs::path file = scratch() / name;
  fs::create_directories(file.parent_path());
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  return file;
}

void read_gltf(const uint8_t* data, size_t size) {
  // A GLB comes from memory, as embedded assets do; text as a file, with no file beside it.
  if (size >= 4 && std::string(reinterpret_cast<const char*>(data), 4) == "glTF")
    (void)scene::load_model("input.glb", std::as_bytes(std::span(data, size)), {});
  else
    (void)scene::load_model(written("input.gltf", data, size), {});
}
void read_georeference(const uint8_t* data, size_t size) {
  const bool binary = size >= 4 && std::string(reinterpret_cast<const char*>(data), 4) == "glTF";
  (void)scene::georeference_of_file(written(binary ? "place.glb" : "place.gltf", data, size));
}
void read_scenario(const uint8_t* data, size_t size) {
  (void)sim::parse_scenario(std::string(reinterpret_cast<const char*>(data), size), "input.yaml", scratch());
}
void read_radio_material(const uint8_t* data, size_t size) {
  const scene::RadioSidecar sidecar = scene::RadioSidecar::read(written("radio.yaml", data, size));
  for (const char* name : {"wall", "itu_brick", "leaves_1"})
    if (const Field* fields = sidecar.find(name)) (void)scene::read_radio_fields(*fields, {});
}
void read_antenna(const uint8_t* data, size_t size) {
  (void)sim::load_pattern_csv(written("pattern.csv", data, size));
}
void read_antenna_msi(const uint8_t* data, size_t size) {
  (void)sim::load_pattern_file(written("pattern.msi", data, size), {});
}
void read_antenna_ffd(const uint8_t* data, size_t size) {
  (void)sim::load_pattern_file(written("pattern.ffd", data, size), {});
}
void read_shots(const uint8_t* data, size_t size) { (void)sim::load_shots(written("shots.csv", data, size)); }
/// A place for tables and tracks in latitude and longitude.
sim::EarthPositions somewhere() {
  sim::SceneConfig scene;
  scene.georeference = Georeference{{52.0116, 4.3571, 45.0}, 43.4, "NAP"};
  return sim::EarthPositions(scene);
}
void read_trajectory(const uint8_t* data, size_t size) {
  (void)sim::load_way_points(written("way.csv", data, size), {somewhere(), {}});
}
void read_gpx(const uint8_t* data, size_t size) {
  (void)sim::load_gpx(written("way.gpx", data, size), {somewhere(), {}});
}
void read_receivers(const uint8_t* data, size_t size) {
  (void)sim::load_receiver_list(written("receivers.csv", data, size), somewhere());
}
void read_ply(const uint8_t* data, size_t size) { (void)scene::read_ply_mesh({data, size}, "input.ply"); }
void read_mitsuba(const uint8_t* data, size_t size) {
  // The meshes that the corpus names: a sound one, so that the XML decides.
  constexpr const char* triangle =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  for (const char* name : {"meshes/wall.ply", "meshes/pane.ply", "meshes/foam.ply"})
    if (!fs::exists(scratch() / name)) {
      const std::string text = triangle;
      (void)written(name, reinterpret_cast<const uint8_t*>(text.data()), text.size());
    }
  (void)scene::import_mitsuba(written("input.xml", data, size), {});
}
void read_picture(const uint8_t* data, size_t size) {
  Spending memory{budget::scene_textures};
  (void)scene::decode_picture({data, size}, "input", memory);
}
void read_npy(const uint8_t* data, size_t size) {
  (void)io::NpyFile(written("input.npy", data, size)).read();
}
void read_journal(const uint8_t* data, size_t size) {
  (void)io::parse_journal(std::string(reinterpret_cast<const char*>(data), size));
}
void read_dataset(const uint8_t* data, size_t size) {
  // The description of a data set without its arrays.
  const fs::path folder = written("dataset/dataset.json", data, size).parent_path();
  (void)io::DatasetReader(folder);
}
/// Reads a table of places and the packed bytes behind it. The first two bytes are the table's length.
void read_packed(const uint8_t* data, size_t size) {
  if (size < 2) return;
  const size_t table = std::min<size_t>(data[0] + 256u * data[1], size - 2);
  const ArraySpec arrays[] = {{"t", DType::i64, {-1}, "ns", ""},
                              {"points", DType::f32, {-1, 4}, "m", "", 0.01},
                              {"map", DType::f32, {3, 2}, "W", ""},
                              {"p", DType::u8, {-1}, "1", ""}};
  const fs::path places = written("packed.npy", data + 2, table),
                 packed = written("packed.h5", data + 2 + table, size - 2 - table);
  const io::PackedRecords records(packed, places, io::packed_columns(arrays));
  for (int64_t record = 0; record < std::min<int64_t>(records.records(), 100); ++record)
    for (size_t array = 0; array < std::size(arrays); ++array) (void)records.load(record, array);
}

constexpr Target list[] = {
    {"gltf", read_gltf},
    {"scenario", read_scenario},
    {"radio_material", read_radio_material},
    {"antenna", read_antenna},
    {"shots", read_shots},
    {"trajectory", read_trajectory},
    {"receivers", read_receivers},
    {"ply", read_ply},
    {"mitsuba", read_mitsuba},
    {"picture", read_picture},
    {"npy", read_npy},
    {"journal", read_journal},
    {"dataset", read_dataset},
    {"packed", read_packed},
    {"antenna_msi", read_antenna_msi},
    {"antenna_ffd", read_antenna_ffd},
    {"gpx", read_gpx},
    {"georeference", read_georeference},
};

}  // namespace

std::span<const Target> targets() { return list; }

void run(const Target& target, const uint8_t* data, size_t size) {
  try {
    target.read(data, size);
  } catch (const UserError&) {
  }
}

}  // namespace greatx::fuzz
