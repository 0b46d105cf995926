// SPDX-License-Identifier: GPL-3.0-or-later
// taut._taut: the library's interface for the Python package. Its public part is taut/__init__.py.
//
// Work is done in a thread of its own, with the interpreter released. The calling thread wakes up now and then, calls
// `progress` and looks for signals, so that Ctrl-C stops the work.
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <taut/taut.h>

#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <variant>
#include <vector>

namespace py = pybind11;

namespace {

using Array = py::array_t<double, py::array::c_style>;
using IntArray = py::array_t<int, py::array::c_style>;

// --- Running ---------------------------------------------------------------------------------------------------------

/// What the worker thread tells the calling thread.
class Desk {
 public:
  void report(const taut::Progress& progress) {
    const std::lock_guard lock(mutex_);
    latest_ = progress;
  }
  void finish() {
    const std::lock_guard lock(mutex_);
    finished_ = true;
    wake_.notify_all();
  }
  /// Waits for at most 50 ms. @returns whether the work is done.
  bool wait() {
    constexpr auto kWhile = std::chrono::milliseconds(50);
    std::unique_lock lock(mutex_);
    return wake_.wait_for(lock, kWhile, [&] { return finished_; });
  }
  std::optional<taut::Progress> take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(latest_, std::nullopt);
  }

 private:
  std::mutex mutex_;
  std::condition_variable wake_;
  std::optional<taut::Progress> latest_;
  bool finished_ = false;
};

/// Calls `work(stop, progress)` and returns its result. @param progress  a callable (stage, done, total), or None
template <class Work>
auto run(const py::object& progress, const Work& work) {
  using Result = decltype(work(std::stop_token(), taut::ProgressCallback()));
  std::optional<Result> result;
  std::exception_ptr failure;
  std::optional<py::error_already_set> raised;  // by the callback, or by a signal
  Desk desk;
  {
    std::jthread worker([&](const std::stop_token& stop) {
      try {
        result.emplace(work(stop, [&](const taut::Progress& at) { desk.report(at); }));
      } catch (...) {
        failure = std::current_exception();
      }
      desk.finish();
    });
    for (bool finished = false; !finished;) {
      {
        const py::gil_scoped_release released;
        finished = desk.wait();
      }
      if (raised) continue;
      try {
        if (const auto at = desk.take(); at && !progress.is_none()) progress(at->stage, at->done, at->total);
        if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      } catch (const py::error_already_set& error) {
        raised.emplace(error);
        worker.request_stop();
      }
    }
  }
  if (raised) throw std::move(*raised);
  if (failure) std::rethrow_exception(failure);
  return *std::move(result);
}

/// The same for work that reports no progress.
template <class Work>
auto run(const Work& work) {
  return run(py::none(), [&](const std::stop_token& stop, const taut::ProgressCallback&) { return work(stop); });
}

// --- Values ----------------------------------------------------------------------------------------------------------

taut::Interpolation interpolation_of(const std::string& name) {
  if (name == "straight") return taut::Interpolation::kStraight;
  if (name == "spline") return taut::Interpolation::kSpline;
  if (name == "geodesic") return taut::Interpolation::kGeodesic;
  if (name == "cable-lengths") return taut::Interpolation::kCableLengths;
  throw taut::InputError("interpolation: got '" + name + "', expected straight, spline, geodesic or cable-lengths", "",
                         0, "interpolation", "E1");
}

const char* name_of(taut::Interpolation law) {
  switch (law) {
    case taut::Interpolation::kStraight: break;
    case taut::Interpolation::kSpline: return "spline";
    case taut::Interpolation::kGeodesic: return "geodesic";
    case taut::Interpolation::kCableLengths: return "cable-lengths";
  }
  return "straight";
}

const char* name_of(taut::Verdict verdict) {
  switch (verdict) {
    case taut::Verdict::kProved: return "proved";
    case taut::Verdict::kRefuted: return "refuted";
    case taut::Verdict::kUndecided: return "undecided";
    case taut::Verdict::kNoPath: return "no path";
    case taut::Verdict::kUnchecked: break;
  }
  return "unchecked";
}

const char* name_of(taut::Outcome outcome) {
  switch (outcome) {
    case taut::Outcome::kAccepted: return "accepted";
    case taut::Outcome::kRejected: return "rejected";
    case taut::Outcome::kUndecided: return "undecided";
    case taut::Outcome::kUnchecked: return "unchecked";
    case taut::Outcome::kMalformed: break;
  }
  return "malformed";
}

/// A law in time: its step and its controls.
using Timing = std::pair<double, std::vector<double>>;

taut::Path path_of(const std::string& interpolation, const Array& x, const std::optional<IntArray>& half_turns,
                   std::vector<std::string> times, std::optional<Timing> timing) {
  taut::Path path = {interpolation_of(interpolation), {}, std::move(times)};
  if (timing) path.timing = {timing->first, std::move(timing->second)};
  const auto rows = static_cast<std::size_t>(x.shape(0));
  const auto columns = static_cast<std::size_t>(x.shape(1));
  for (std::size_t k = 0; k < rows; ++k) {
    taut::Waypoint& waypoint = path.waypoints.emplace_back();
    waypoint.x.assign(x.data() + k * columns, x.data() + (k + 1) * columns);
    if (half_turns)
      waypoint.half_turns.assign(half_turns->data() + k * columns, half_turns->data() + (k + 1) * columns);
  }
  return path;
}

template <class T, class Row>
py::array_t<T> array_of(const std::vector<Row>& rows, std::size_t columns) {
  py::array_t<T> array({rows.size(), columns});
  T* into = array.mutable_data();
  for (const Row& row : rows) into = std::copy(row.begin(), row.end(), into);
  return array;
}

/// The tuple (interpolation, waypoints, half turns or None, times, (step, controls) or None).
py::tuple path_tuple(const taut::Path& path) {
  std::vector<std::vector<double>> x;
  std::vector<std::vector<int>> half_turns;
  for (const taut::Waypoint& waypoint : path.waypoints) {
    x.push_back(waypoint.x);
    half_turns.push_back(waypoint.half_turns);
  }
  const std::size_t columns = x.empty() ? 0 : x.front().size();
  const bool has_turns = !half_turns.empty() && !half_turns.front().empty();
  return py::make_tuple(
      name_of(path.interpolation), array_of<double>(x, columns),
      has_turns ? py::object(array_of<int>(half_turns, columns)) : py::none(), path.times,
      path.timing ? py::object(py::make_tuple(path.timing->step_s, path.timing->controls)) : py::none());
}

py::tuple place_tuple(const taut::Place& place) { return py::make_tuple(place.index, place.s); }

py::dict witness_dict(const taut::Witness& witness) {
  const bool singular = witness.to.has_value();
  const bool contact = witness.kind == "contact";
  const auto of_limit = [&](auto value) { return singular || contact ? py::object(py::none()) : py::cast(value); };
  py::dict dict;
  dict["kind"] = witness.kind;
  dict["at"] = place_tuple(witness.at);
  dict["to"] = singular ? py::object(place_tuple(*witness.to)) : py::none();
  dict["cable"] = witness.cable == 0 ? py::object(py::none()) : of_limit(witness.cable);
  dict["value"] = of_limit(std::make_pair(witness.value_lower, witness.value_upper));
  dict["limit"] = of_limit(witness.limit);
  dict["deviates"] = witness.deviates;
  const auto& slowing = witness.slowing;
  dict["slowing"] = slowing ? py::object(py::make_tuple(slowing->speed_share, slowing->change)) : py::none();
  dict["bodies"] = contact ? py::object(py::make_tuple(witness.bodies[0], witness.bodies[1])) : py::none();
  dict["depth_m"] = contact ? py::cast(witness.depth_m) : py::none();
  return dict;
}

/// The tuple (verdict, claim, margins, witness, SHA-256), or None.
py::object theorem_tuple(const std::optional<taut::Theorem>& theorem) {
  if (!theorem) return py::none();
  const auto margins = theorem->margins();
  const auto witness = theorem->witness();
  return py::make_tuple(name_of(theorem->verdict()), theorem->claim(),
                        margins ? py::object(py::make_tuple(margins->tension_N, margins->length_m,
                                                            margins->wrench_scale, margins->clearance_m))
                                : py::none(),
                        witness ? py::object(witness_dict(*witness)) : py::none(), theorem->certificate_sha256());
}

py::list stretch_list(const std::vector<taut::Stretch>& stretches) {
  py::list list;
  for (const taut::Stretch& stretch : stretches) {
    py::object violations = py::none();
    if (stretch.violations) {
      violations = py::make_tuple(witness_dict(stretch.violations->first), witness_dict(stretch.violations->second));
    }
    list.append(py::make_tuple(place_tuple(stretch.begin), place_tuple(stretch.end), violations, stretch.reason,
                               stretch.reason_code));
  }
  return list;
}

py::dict samples_dict(const std::vector<taut::Sample>& samples) {
  std::vector<std::array<double, 1>> positions;
  std::vector<std::array<double, 3>> p;
  std::vector<std::array<double, 4>> q;
  std::vector<std::array<double, 6>> lower, upper, lengths;
  for (const taut::Sample& sample : samples) {
    positions.push_back({sample.position});
    p.push_back(sample.p_m);
    q.push_back(sample.quaternion);
    lengths.push_back(sample.length_m);
    std::array<double, 6> nothing{};
    nothing.fill(std::numeric_limits<double>::quiet_NaN());
    lower.push_back(sample.is_singular ? nothing : sample.tension_lower_N);
    upper.push_back(sample.is_singular ? nothing : sample.tension_upper_N);
  }
  py::dict dict;
  dict["position"] = array_of<double>(positions, 1).attr("ravel")();
  dict["p_m"] = array_of<double>(p, 3);
  dict["quaternion"] = array_of<double>(q, 4);
  dict["tension_lower_N"] = array_of<double>(lower, 6);
  dict["tension_upper_N"] = array_of<double>(upper, 6);
  dict["length_m"] = array_of<double>(lengths, 6);
  dict["time_s"] = py::none();
  if (!samples.empty() && samples.front().time_s) {
    std::vector<double> times;
    for (const taut::Sample& sample : samples) times.push_back(sample.time_s.value());
    dict["time_s"] = py::array_t<double>(static_cast<py::ssize_t>(times.size()), times.data());
  }
  return dict;
}

/// The rows of a table.
py::array_t<double> table_array(const taut::Table& table) {
  const std::size_t columns = table.columns.size();
  py::array_t<double> array({table.values.size() / columns, columns});
  std::copy(table.values.begin(), table.values.end(), array.mutable_data());
  return array;
}

py::object move_plan_dict(const std::optional<taut::MovePlan>& plan) {
  if (!plan) return py::none();
  py::dict dict;
  dict["planned_s"] = plan->planned_s;
  dict["speed_share"] = plan->speed_share;
  dict["fastest_s"] = plan->fastest_s;
  dict["tries"] = plan->tries;
  dict["refuted_share"] = plan->refuted_share;
  dict["witness"] = plan->witness ? py::object(witness_dict(*plan->witness)) : py::none();
  return dict;
}

py::array_t<double> limits_array(const std::array<std::array<double, 2>, 6>& limits) {
  return array_of<double>(std::vector<std::array<double, 2>>(limits.begin(), limits.end()), 2);
}

// --- Errors ----------------------------------------------------------------------------------------------------------

py::object error_type(const char* name) { return py::module_::import("taut._errors").attr(name); }

void translate(std::exception_ptr failure) {  // NOLINT(performance-unnecessary-value-param): pybind11 wants it so
  const auto raise = [](const char* type, const char* message) { PyErr_SetString(error_type(type).ptr(), message); };
  try {
    if (failure) std::rethrow_exception(failure);
  } catch (const taut::InputError& error) {
    const py::object type = error_type("InputError");
    PyErr_SetObject(type.ptr(), type(error.what(), error.file(), error.line(), error.field(), error.code()).ptr());
  } catch (const taut::Interrupted& error) {
    raise("Interrupted", error.what());
  } catch (const taut::UntrustworthyMachine& error) {
    raise("UntrustworthyMachine", error.what());
  } catch (const taut::InternalError& error) {
    raise("InternalError", error.what());
  }
}

using namespace py::literals;

void add_case(py::module_& module) {
  py::class_<taut::Case>(module, "Case")
      .def_static("load", &taut::Case::load, py::call_guard<py::gil_scoped_release>())
      .def_static("parse", &taut::Case::parse, py::call_guard<py::gil_scoped_release>())
      .def_property_readonly("name", &taut::Case::name)
      .def_property_readonly("document_fields", &taut::Case::document_fields)
      .def_property_readonly("description", &taut::Case::description)
      .def_property_readonly("parameters", &taut::Case::parameters)
      .def_property_readonly("query_waypoints", &taut::Case::query_waypoints)
      .def_property_readonly("legs", &taut::Case::legs)
      .def_property_readonly("bodies_statement", &taut::Case::bodies_statement)
      .def_property_readonly("load_statement", &taut::Case::load_statement)
      .def_property_readonly("time_statement", &taut::Case::time_statement)
      .def_property_readonly("warnings", &taut::Case::warnings)
      .def("summary", &taut::Case::summary)
      .def("summary_json", &taut::Case::summary_json)
      .def("drawing_svg", &taut::Case::drawing_svg)
      .def_property_readonly("tension_limits_N", [](const taut::Case& c) { return limits_array(c.tension_limits_N()); })
      .def_property_readonly("length_limits_m", [](const taut::Case& c) { return limits_array(c.length_limits_m()); });
}

void add_certificate(py::module_& module) {
  py::class_<taut::Certificate>(module, "Certificate")
      .def_static("load", &taut::Certificate::load, py::call_guard<py::gil_scoped_release>())
      .def_static("parse", &taut::Certificate::parse, py::call_guard<py::gil_scoped_release>())
      .def("save", &taut::Certificate::save, py::call_guard<py::gil_scoped_release>())
      .def_property_readonly("text", &taut::Certificate::text)
      .def_property_readonly("verdict", [](const taut::Certificate& c) { return name_of(c.verdict()); })
      .def_property_readonly("theorem", [](const taut::Certificate& c) { return theorem_tuple(c.theorem()); })
      .def_property_readonly("case_name", &taut::Certificate::case_name)
      .def_property_readonly("document_fields", &taut::Certificate::document_fields)
      .def_property_readonly("stretches", [](const taut::Certificate& c) { return stretch_list(c.stretches()); })
      .def_property_readonly("reason", &taut::Certificate::reason)
      .def_property_readonly("reason_code", &taut::Certificate::reason_code)
      .def_property_readonly("no_path_from", &taut::Certificate::no_path_from)
      .def_property_readonly("headroom", &taut::Certificate::headroom)
      .def_property_readonly("legs", &taut::Certificate::legs)
      .def_property_readonly("path", [](const taut::Certificate& c) { return path_tuple(c.path()); })
      .def_property_readonly("path_csv", &taut::Certificate::path_csv)
      .def("controller_csv", &taut::Certificate::controller_csv, py::call_guard<py::gil_scoped_release>())
      .def_property_readonly("duration_s", &taut::Certificate::duration_s)
      .def_property_readonly("move_plan", [](const taut::Certificate& c) { return move_plan_dict(c.move_plan()); })
      .def("winches",
           [](const taut::Certificate& c, double rate) {
             return table_array(run([&](const std::stop_token&) { return c.winches(rate); }));
           })
      .def("poses", [](const taut::Certificate& c,
                       double rate) { return table_array(run([&](const std::stop_token&) { return c.poses(rate); })); })
      .def("winches_csv", &taut::Certificate::winches_csv, py::call_guard<py::gil_scoped_release>())
      .def("poses_csv", &taut::Certificate::poses_csv, py::call_guard<py::gil_scoped_release>())
      .def("poses_tum", &taut::Certificate::poses_tum, py::call_guard<py::gil_scoped_release>())
      .def_property_readonly("segments", &taut::Certificate::segments)
      .def_property_readonly("boxes", &taut::Certificate::boxes)
      .def("samples", [](const taut::Certificate& c, std::size_t about) {
        return samples_dict(run([&](const std::stop_token&) { return c.samples(about); }));
      });
}

void add_plan_and_prove(py::module_& module) {
  module.def(
      "plan",
      [](const taut::Case& the_case, double budget_seconds, const std::string& atlas, const std::string& save_atlas,
         bool grow, const std::string& signing_key, double max_check_seconds, double headroom_seconds,
         double no_path_seconds, double speed_share, bool greatest_speed, const py::object& progress) {
        return run(progress, [&](const std::stop_token& stop, const taut::ProgressCallback& callback) {
          return taut::plan(the_case,
                            {budget_seconds, atlas, save_atlas, grow, signing_key, callback, stop, max_check_seconds,
                             headroom_seconds, no_path_seconds, speed_share, greatest_speed});
        });
      },
      "case"_a, "budget_seconds"_a, "atlas"_a, "save_atlas"_a, "grow"_a, "signing_key"_a, "max_check_seconds"_a,
      "headroom_seconds"_a, "no_path_seconds"_a, "speed_share"_a, "greatest_speed"_a, "progress"_a);

  module.def(
      "prove",
      [](const taut::Case& the_case, const std::string& interpolation, const Array& waypoints,
         const std::optional<IntArray>& half_turns, std::vector<std::string> times, std::optional<Timing> timing,
         long max_bits, const std::string& signing_key, double max_check_seconds) {
        const taut::Path path = path_of(interpolation, waypoints, half_turns, std::move(times), std::move(timing));
        return run([&](const std::stop_token& stop) {
          return taut::prove(the_case, path, {max_bits, signing_key, stop, max_check_seconds});
        });
      },
      "case"_a, "interpolation"_a, "waypoints"_a, "half_turns"_a, "times"_a, "timing"_a, "max_bits"_a, "signing_key"_a,
      "max_check_seconds"_a);
}

/// Of poses, or of cable lengths.
using Rounding = std::optional<std::variant<std::pair<double, double>, double>>;

taut::AuditOptions audit_options(const std::optional<std::string>& interpolation, long max_bits,
                                 const std::string& signing_key, double max_check_seconds, double headroom_seconds,
                                 bool timed, const Rounding& rounding) {
  taut::AuditOptions options;
  if (interpolation) options.interpolation = interpolation_of(*interpolation);
  options.max_bits = max_bits;
  options.signing_key_pem = signing_key;
  options.max_check_seconds = max_check_seconds;
  options.headroom_seconds = headroom_seconds;
  options.timed = timed;
  if (rounding) {
    if (const auto* of_poses = std::get_if<std::pair<double, double>>(&*rounding)) {
      options.rounding = {.position_m = of_poses->first, .angle_rad = of_poses->second};
    } else {
      options.rounding = {.length_m = std::get<double>(*rounding)};
    }
  }
  return options;
}

void add_audits(py::module_& module) {
  module.def(
      "audit_file",
      [](const taut::Case& the_case, const std::optional<std::string>& file,
         const std::optional<std::string>& interpolation, long max_bits, const std::string& signing_key,
         double max_check_seconds, double headroom_seconds, bool timed, const Rounding& rounding,
         const py::object& progress) {
        taut::AuditOptions options =
            audit_options(interpolation, max_bits, signing_key, max_check_seconds, headroom_seconds, timed, rounding);
        return run(progress, [&](const std::stop_token& stop, const taut::ProgressCallback& callback) {
          options.stop = stop;
          options.progress = callback;
          return file ? taut::audit(the_case, *file, options) : taut::audit(the_case, options);
        });
      },
      "case"_a, "file"_a, "interpolation"_a, "max_bits"_a, "signing_key"_a, "max_check_seconds"_a, "headroom_seconds"_a,
      "timed"_a, "rounding"_a, "progress"_a);
  module.def(
      "audit_table",
      [](const taut::Case& the_case, std::vector<std::string> columns, const Array& values, const std::string& name,
         const std::optional<std::string>& interpolation, long max_bits, const std::string& signing_key,
         double max_check_seconds, double headroom_seconds, bool timed, const Rounding& rounding,
         const py::object& progress) {
        const taut::Table table = {std::move(columns), {values.data(), values.data() + values.size()}};
        taut::AuditOptions options =
            audit_options(interpolation, max_bits, signing_key, max_check_seconds, headroom_seconds, timed, rounding);
        return run(progress, [&](const std::stop_token& stop, const taut::ProgressCallback& callback) {
          options.stop = stop;
          options.progress = callback;
          return taut::audit(the_case, table, options, name);
        });
      },
      "case"_a, "columns"_a, "values"_a, "name"_a, "interpolation"_a, "max_bits"_a, "signing_key"_a,
      "max_check_seconds"_a, "headroom_seconds"_a, "timed"_a, "rounding"_a, "progress"_a);
}

void add_sensitivity(py::module_& module) {
  module.def(
      "sensitivity",
      [](const taut::Case& the_case, const std::optional<std::string>& file,
         const std::optional<std::string>& interpolation, double budget_seconds, const py::object& progress) {
        return run(progress, [&](const std::stop_token& stop, const taut::ProgressCallback& callback) {
          taut::SensitivityOptions options;
          if (interpolation) options.interpolation = interpolation_of(*interpolation);
          options.budget_seconds = budget_seconds;
          options.progress = callback;
          options.stop = stop;
          return file ? taut::sensitivity(the_case, *file, options) : taut::sensitivity(the_case, options);
        });
      },
      "case"_a, "file"_a, "interpolation"_a, "budget_seconds"_a, "progress"_a);
}

void add_check(py::module_& module) {
  module.def(
      "check",
      [](const py::bytes& certificate, const std::optional<taut::Case>& the_case,
         const std::vector<std::string>& trusted_keys, const std::optional<double>& max_seconds) {
        const std::string text = certificate;
        const taut::CheckResult result = run([&](const std::stop_token& stop) {
          return taut::check(text, {the_case, trusted_keys, stop, max_seconds});
        });
        return py::make_tuple(name_of(result.outcome), result.message, theorem_tuple(result.theorem), result.signer,
                              result.is_trusted, result.segments, result.boxes, result.not_compared);
      },
      "certificate"_a, "case"_a, "trusted_keys"_a, "max_seconds"_a);
}

taut::ReportFormat format_of(const std::string& name) {
  if (name == "html") return taut::ReportFormat::kHtml;
  if (name == "text") return taut::ReportFormat::kText;
  if (name == "markdown") return taut::ReportFormat::kMarkdown;
  if (name == "json") return taut::ReportFormat::kJson;
  throw taut::InputError("format: got '" + name + "', expected html, text, markdown or json", "", 0, "format", "E1");
}

void add_report(py::module_& module) {
  module.def(
      "report",
      [](const taut::Certificate& certificate, const std::string& format, const std::string& document,
         const std::string& revision, const std::string& date, double max_check_seconds) {
        taut::ReportOptions options;
        options.format = format_of(format);
        options.document = document;
        options.revision = revision;
        options.date = date;
        options.max_check_seconds = max_check_seconds;
        return run([&](const std::stop_token& stop) {
          options.stop = stop;
          return taut::report(certificate, options);
        });
      },
      "certificate"_a, "format"_a, "document"_a, "revision"_a, "date"_a, "max_check_seconds"_a);
}

}  // namespace

PYBIND11_MODULE(_taut, module) {
  module.doc() = "What the package taut is made of.";
  module.attr("version") = taut::version();
  py::register_exception_translator(translate);
  add_case(module);
  add_certificate(module);
  add_plan_and_prove(module);
  add_audits(module);
  add_sensitivity(module);
  add_check(module);
  add_report(module);
}
