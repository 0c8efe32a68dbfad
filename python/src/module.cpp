// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines greatx._native, on which the package python/greatx is a thin layer. Arrays go to NumPy through the
// buffer protocol, which works with any version of NumPy and copies nothing; descriptions go as JSON.
#include <chrono>
#include <cstring>
#include <pybind11/functional.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <unistd.h>

#include "assets/assets.h"
#include "core/watch.h"
#include "engine/session/path_set.h"
#include "engine/session/session.h"
#include "engine/session/stream.h"
#include "engine/session/varied_paths.h"
#include "python/src/log.h"
#include "sim/scenario/parse/load_scenario.h"

namespace greatx::python {

namespace py = pybind11;
using namespace engine;

namespace {

using Released = py::call_guard<py::gil_scoped_release>;

/// Owns the bytes of an array as long as a NumPy array refers to them.
struct Buffer {
  Array array;
};

const char* buffer_format(DType dtype) {
  switch (dtype) {
    case DType::u8:
      return "B";
    case DType::u16:
      return "H";
    case DType::u32:
      return "I";
    case DType::u64:
      return "Q";
    case DType::i8:
      return "b";
    case DType::i32:
      return "i";
    case DType::i64:
      return "q";
    case DType::f32:
      return "f";
    case DType::f64:
      return "d";
    case DType::complex64:
      return "Zf";
  }
  GREATX_CHECK(false, "type {}", static_cast<int>(dtype));
}

py::buffer_info describe(Buffer& buffer) {
  Array& array = buffer.array;
  const auto size = static_cast<py::ssize_t>(size_of(array.dtype));
  std::vector<py::ssize_t> shape(array.shape.begin(), array.shape.end()), strides(shape.size());
  py::ssize_t step = size;
  for (size_t axis = shape.size(); axis-- > 0; step *= shape[axis]) strides[axis] = step;
  return {array.bytes.data(),
          size,
          buffer_format(array.dtype),
          static_cast<py::ssize_t>(shape.size()),
          shape,
          strides};
}

py::object numpy(Array array) {
  return py::module_::import("numpy").attr("asarray")(py::cast(Buffer{std::move(array)}));
}

/// Returns [(name, unit, description, array)].
py::list numpy(NamedArrays arrays) {
  py::list list;
  for (NamedArray& named : arrays)
    list.append(py::make_tuple(named.name, named.unit, named.description, numpy(std::move(named.array))));
  return list;
}

std::vector<dvec3> points_of(const py::buffer& buffer) {
  const py::buffer_info info = buffer.request();
  if (info.format != "d" || info.ndim != 2 || info.shape[1] != 3 || info.strides[1] != 8 ||
      info.strides[0] != 24)
    throw_user_error("receivers: expected contiguous float64 [N, 3], found another array");
  std::vector<dvec3> points(static_cast<size_t>(info.shape[0]));
  static_assert(sizeof(dvec3) == 24);
  if (!points.empty()) std::memcpy(points.data(), info.ptr, points.size() * sizeof(dvec3));
  return points;
}

/// Checks for Ctrl-C and calls the caller's progress function from time to time, while the engine works
/// without the interpreter lock. As a Watch, also checks for Ctrl-C during long work (core/watch.h).
class CallWatch : public Watch {
 public:
  explicit CallWatch(py::object progress = py::none()) : progress_(std::move(progress)) {}
  GoOn go_on() {
    return [this](size_t done) { return tell(done); };
  }
  bool look(const WorkState&) noexcept override {
    if (stopped_) return false;
    const py::gil_scoped_acquire interpreter;
    stopped_ = PyErr_CheckSignals() != 0;
    return !stopped_;
  }
  /// Throws the Python exception that stopped the work, if any. Needs the interpreter lock.
  void check() const {
    if (stopped_) throw py::error_already_set();
  }

 private:
  bool tell(size_t done) {
    if (stopped_) return false;
    const auto now = std::chrono::steady_clock::now();
    if (now - last_ < std::chrono::milliseconds(100)) return true;
    last_ = now;
    const py::gil_scoped_acquire interpreter;
    stopped_ = PyErr_CheckSignals() != 0;
    if (!stopped_ && !progress_.is_none()) try {
        progress_(done);
      } catch (py::error_already_set& error) {
        error.restore();
        stopped_ = true;
      }
    return !stopped_;
  }

  py::object progress_;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
  bool stopped_ = false;
};

/// Calls work(GoOn) without the interpreter lock and returns its result. Throws the Python exception that
/// stopped it.
template <typename Work>
auto watched(const Work& work, py::object progress = py::none()) {
  CallWatch watch(std::move(progress));
  try {
    auto result = [&] {
      const py::gil_scoped_release released;
      const WatchScope scope(watch);
      return work(watch.go_on());
    }();
    watch.check();
    return result;
  } catch (const Interrupted&) {
    watch.check();
    throw;
  }
}

std::shared_ptr<PathSet> solve(Session& session, const std::string& channel, uint32_t sequence, int64_t tick,
                               const std::optional<py::buffer>& points, const std::string& antenna,
                               const py::object& progress) {
  std::optional<PointReceivers> receivers;
  if (points) receivers = PointReceivers{points_of(*points), antenna};
  return watched([&](const GoOn& go_on) { return session.solve(channel, sequence, tick, receivers, go_on); },
                 progress);
}

/// Returns (facts, arrays).
py::object radio_map(Session& session, const std::string& channel, uint32_t sequence, int64_t tick,
                     const std::optional<std::array<double, 2>>& min_m,
                     const std::optional<std::array<double, 2>>& max_m, double cell_m,
                     std::optional<double> z_m, double height_m, bool over_roofs,
                     const std::vector<double>& power_dbm, std::optional<double> bandwidth_hz,
                     double noise_figure_db, const std::string& precoder, std::optional<uint64_t> beam,
                     const std::optional<std::array<uint32_t, 2>>& oversampling, bool inside_solids,
                     bool beyond_scene, const std::string& antenna, const py::object& progress) {
  sim::MapRequest request;
  request.cell_m = cell_m;
  request.power_dbm = power_dbm;
  request.bandwidth_hz = bandwidth_hz;
  request.noise_figure_db = noise_figure_db;
  request.precoder = {sim::map_precoding(precoder), beam, oversampling};
  request.inside_solids = inside_solids;
  request.beyond_scene = beyond_scene;
  if (min_m) request.min_m = dvec2((*min_m)[0], (*min_m)[1]);
  if (max_m) request.max_m = dvec2((*max_m)[0], (*max_m)[1]);
  request.height = {z_m, height_m, over_roofs ? sim::MapOver::roofs : sim::MapOver::ground};
  std::optional<MapResult> result = watched(
      [&](const GoOn& go_on) { return session.radio_map(channel, sequence, tick, request, antenna, go_on); },
      progress);
  return py::make_tuple(result->facts, numpy(std::move(result->arrays)));
}

rf::PathSelection selection_of(const std::string& name) {
  if (name == "all") return rf::PathSelection::all;
  if (name == "line_of_sight") return rf::PathSelection::line_of_sight;
  if (name == "others") return rf::PathSelection::others;
  throw_user_error("select: expected one of all, line_of_sight, others, found '{}'", name);
}

/// Checks for a contiguous array of float64 and returns its values.
std::span<const double> doubles_of(const py::buffer_info& info, const char* name) {
  bool contiguous = info.format == "d";
  py::ssize_t step = 8;
  for (auto axis = static_cast<size_t>(info.ndim); axis-- > 0; step *= info.shape[axis])
    contiguous = contiguous && (info.strides[axis] == step || info.shape[axis] <= 1);
  if (!contiguous) throw_user_error("{}: expected a contiguous array of float64, found another", name);
  return {static_cast<const double*>(info.ptr), static_cast<size_t>(info.size)};
}

std::shared_ptr<VariedPaths> vary(const std::shared_ptr<PathSet>& set,
                                  const std::vector<std::pair<std::string, py::buffer>>& given) {
  std::vector<ParameterValues> values;
  for (const auto& [name, buffer] : given) {
    const py::buffer_info info = buffer.request();
    const std::span<const double> numbers = doubles_of(info, name.c_str());
    values.push_back({name, {numbers.begin(), numbers.end()}});
  }
  return watched([&](const GoOn&) { return std::make_shared<VariedPaths>(set, values); });
}

using RequestTuple = std::tuple<std::optional<double>, std::optional<uint32_t>, std::optional<uint32_t>,
                                std::optional<double>, std::string>;
ResponseRequest request_of(const RequestTuple& tuple) {
  const auto& [spacing_hz, subcarriers, time_samples, time_spacing_s, select] = tuple;
  return {spacing_hz, subcarriers, time_samples, time_spacing_s, selection_of(select)};
}

/// Returns (name, unit, description, values), with values in the shape of the parameter.
py::list parameters(const PathSet& set) {
  NamedArrays arrays;
  for (const PathParameter& parameter : set.parameters())
    arrays.push_back({parameter.name, parameter.unit, parameter.description,
                      Array::of<double>(parameter.shape, parameter.values)});
  return numpy(std::move(arrays));
}

/// Returns [(name, unit)] of the columns of these parameters.
py::list columns(const PathSet& set, const std::vector<std::string>& names) {
  py::list list;
  for (const std::string& name : names) {
    const PathParameter& parameter = find_parameter(set.parameters(), name);
    for (size_t column = 0; column < parameter.columns(); ++column)
      list.append(py::make_tuple(column_name(parameter, column), parameter.unit));
  }
  return list;
}

void bind_varied_paths(py::module_& module) {
  py::class_<VariedPaths, std::shared_ptr<VariedPaths>>(module, "VariedPaths")
      .def("facts", &VariedPaths::facts)
      .def("response",
           [](const VariedPaths& paths, const RequestTuple& request) {
             return numpy(
                 watched([&](const GoOn& go_on) { return paths.response(request_of(request), go_on); }));
           })
      .def("jacobian",
           [](const VariedPaths& paths, const RequestTuple& request, const std::vector<std::string>& names) {
             return numpy(watched(
                 [&](const GoOn& go_on) { return paths.jacobian(request_of(request), names, go_on); }));
           })
      .def("quantities",
           [](const VariedPaths& paths) {
             return numpy(watched([&](const GoOn&) { return paths.quantities(); }));
           })
      .def("quantity_slopes",
           [](const VariedPaths& paths, const std::vector<std::string>& names) {
             return numpy(watched([&](const GoOn&) { return paths.quantity_slopes(names); }));
           })
      .def("gradient", [](const VariedPaths& paths, const RequestTuple& request,
                          const std::vector<std::string>& names, const py::buffer& cotangent) {
        const py::buffer_info info = cotangent.request();
        const std::span<const double> numbers = doubles_of(info, "cotangent");
        return numpy(watched(
            [&](const GoOn& go_on) { return paths.gradient(request_of(request), names, numbers, go_on); }));
      });
}

/// Returns (tick, time_ns, [(sensor, sample, [arrays])]), or None at the end.
py::object next(Stream& stream) {
  std::optional<Packet> packet = watched([&](const GoOn&) { return stream.next(); });
  if (!packet) return py::none();
  py::list records;
  for (Record& record : packet->records) {
    py::list arrays;
    for (Array& array : record.arrays) arrays.append(numpy(std::move(array)));
    records.append(py::make_tuple(record.sensor, record.sample, arrays));
  }
  return py::make_tuple(packet->tick, packet->time_ns, records);
}

/// Deletes an object without holding the interpreter lock, because the destructor may have to wait for a
/// device that another thread uses. Deletes nothing in a fork of the process that made the object: the
/// device's threads and the threads that held its locks do not exist there, so that the destructor would wait
/// for ever.
struct ReleasedDelete {
  pid_t maker = ::getpid();
  template <typename T>
  void operator()(T* object) const {
    if (::getpid() != maker) return;
    const py::gil_scoped_release released;
    delete object;
  }
};
using SessionHolder = std::unique_ptr<Session, ReleasedDelete>;

gpu::DeviceOptions device_options(const std::string& device, bool validation, const std::string& tracer) {
  const std::optional<gpu::Tracer> named = gpu::tracer_of(tracer);
  if (!named) throw_user_error("tracer: expected auto, driver or tree, found '{}'", tracer);
  return {device, validation, *named};
}

void bind_session(py::module_& module) {
  py::class_<Session, SessionHolder>(module, "Session")
      .def_static(
          "load",
          [](const std::string& file, const std::string& assets, const std::string& device, bool validation,
             const std::string& tracer) {
            return SessionHolder(new Session(sim::load_scenario(file, assets), assets,
                                             device_options(device, validation, tracer)));
          },
          Released())
      .def_static(
          "parse",
          [](const std::string& text, const std::string& name, const std::string& assets,
             const std::string& device, bool validation, const std::string& tracer) {
            return SessionHolder(new Session(sim::parse_scenario(text, name, ".", assets), assets,
                                             device_options(device, validation, tracer)));
          },
          Released())
      .def("add_nodes", &Session::add_nodes, Released())
      .def("add_channels", &Session::add_channels, Released())
      .def("change", &Session::change, Released())
      .def("facts", &Session::facts, Released())
      .def("scene_facts", &Session::scene_facts, Released())
      .def("explain", &Session::explain, Released())
      .def("device_facts", &Session::device_facts, Released())
      .def("solve", &solve)
      .def("radio_map", &radio_map)
      .def("stream", [](Session& session, uint32_t sequence, int64_t first_tick) {
        std::unique_ptr<Stream> stream =
            watched([&](const GoOn&) { return session.stream(sequence, first_tick); });
        return std::shared_ptr<Stream>(stream.release(), ReleasedDelete{});
      });
}

void bind_path_set(py::module_& module) {
  py::class_<PathSet, std::shared_ptr<PathSet>>(module, "PathSet")
      .def("facts", &PathSet::facts)
      .def("take_arrays", [](PathSet& set) { return numpy(set.take_arrays()); })
      .def("parameters", &parameters)
      .def("columns", &columns)
      .def("vary", &vary)
      .def("cfr",
           [](const PathSet& set, std::optional<double> spacing_hz, std::optional<uint32_t> subcarriers,
              std::optional<uint32_t> time_samples, std::optional<double> time_spacing_s,
              const std::string& select) {
             const ResponseRequest request{spacing_hz, subcarriers, time_samples, time_spacing_s,
                                           selection_of(select)};
             return numpy(watched([&](const GoOn& go_on) { return set.response(request, go_on); }));
           })
      .def("taps",
           [](const PathSet& set, double bandwidth_hz, int32_t first, uint32_t taps, uint32_t time_samples,
              double time_spacing_s) {
             const TapsRequest request{bandwidth_hz, first, taps, time_samples, time_spacing_s};
             return numpy(watched([&](const GoOn& go_on) { return set.taps(request, go_on); }));
           })
      .def("statistics",
           [](const PathSet& set) { return numpy(watched([&](const GoOn&) { return set.statistics(); })); })
      .def("received",
           [](const PathSet& set, double power_w, double resistance_ohm, uint32_t transmit_port,
              uint32_t receive_port) {
             const ReceivedRequest request{power_w, resistance_ohm, transmit_port, receive_port};
             return numpy(watched([&](const GoOn&) { return set.received(request); }));
           })
      .def("coherence", [](const PathSet& set, double level) {
        return numpy(watched([&](const GoOn&) { return set.coherence(level); }));
      });
}

}  // namespace

void bind(py::module_& module) {
  keep_log();
  static PyObject* const error =
      py::object(py::module_::import("greatx.errors").attr("Error")).release().ptr();
  py::register_local_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const UserError& fault) {
      PyErr_SetString(error, fault.what());
    }
  });
  module.attr("version") = GREATX_VERSION;
  module.def("take_log", &take_log);
  module.def("embedded_scenarios", [] {
    py::dict texts;
    for (const EmbeddedScenario& scenario : embedded_scenarios())
      texts[py::str(std::string(scenario.name))] = std::string(scenario.text);
    return texts;
  });
  py::class_<Buffer>(module, "Buffer", py::buffer_protocol()).def_buffer(&describe);
  bind_session(module);
  bind_path_set(module);
  bind_varied_paths(module);
  py::class_<Stream, std::shared_ptr<Stream>>(module, "Stream")
      .def("sensors", &Stream::sensors, Released())
      .def("next", &next)
      .def("restart",
           [](Stream& stream, uint32_t sequence, int64_t first_tick) {
             watched([&](const GoOn&) {
               stream.restart(sequence, first_tick);
               return true;
             });
           })
      .def("summary", &Stream::summary, Released());
}

}  // namespace greatx::python

PYBIND11_MODULE(_native, module) {
  module.doc() = "The compiled half of greatx; use the package's own names (docs/python.md).";
  greatx::python::bind(module);
}
