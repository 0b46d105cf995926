// SPDX-License-Identifier: GPL-3.0-or-later
#include "api/taut/taut.h"

#include <fmt/format.h>
#include <immintrin.h>
#include <mpfr.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cfenv>
#include <cmath>
#include <exception>
#include <filesystem>
#include <mutex>
#include <new>

#include "app/audit.h"
#include "app/legs.h"
#include "app/meshes.h"
#include "app/plan.h"
#include "app/prove.h"
#include "app/proved_path.h"
#include "app/recheck.h"
#include "app/report.h"
#include "app/sensitivity_json.h"
#include "app/timed_audit.h"
#include "base/files.h"
#include "base/input_error.h"
#include "base/sanitize.h"
#include "case/case_of_legs.h"
#include "certificate/certificate_reader.h"
#include "certificate/certificate_writer.h"
#include "certify/arithmetic/interval.h"
#include "certify/arithmetic/rounding.h"
#include "certify/undecided.h"
#include "checker/check.h"
#include "checker/format/legs.h"
#include "checker/format/no_path.h"
#include "checker/format/signature.h"
#include "checker/kernel/errors.h"
#include "kinematics/move_sampler.h"
#include "kinematics/pose_conversion.h"
#include "kinematics/time_limits.h"
#include "path_io/controller_csv.h"
#include "path_io/move_tables.h"
#include "path_io/path_csv.h"
#include "problem/expression.h"
#include "reports/page/robot_drawing.h"
#include "reports/summary/bodies_statement.h"
#include "reports/summary/case_summary.h"
#include "reports/summary/display_units.h"
#include "reports/summary/headroom_of_legs.h"
#include "reports/summary/illustration.h"
#include "reports/summary/load_statement.h"
#include "reports/summary/samples.h"
#include "reports/summary/shown_bodies.h"
#include "reports/summary/time_statement.h"

namespace taut::v0 {

struct Case::Content {
  CaseOfLegs of;
  std::string file;  ///< or what stands for it
};

struct Theorem::Content {
  checker::Theorem theorem;
  std::string claim;
  std::optional<taut::Margins> margins;
  std::optional<PathWitness> witness;
  Problem problem;
};

struct TheoremMaker {
  static Theorem make(const checker::Theorem& theorem) {
    if (theorem.verdict() == checker::Theorem::Verdict::kNoPath || theorem.is_of_legs()) {
      return Theorem(std::make_shared<const Theorem::Content>(Theorem::Content{theorem, theorem.claim(), {}, {}, {}}));
    }
    const taut::Certificate certificate = read_certificate(theorem.certificate());
    std::optional<PathWitness> witness;
    if (certificate.witness) witness = certificate.witness->violation;
    return Theorem(std::make_shared<const Theorem::Content>(
        Theorem::Content{theorem, certificate.claim, certificate.margins, std::move(witness), certificate.problem}));
  }
};

struct Certificate::Content {
  std::string text;
  checker::CheckResult checked;  ///< of this text
  taut::Certificate stated;      ///< without segments
  std::size_t boxes = 0;
  std::optional<std::size_t> no_path_from;  ///< of a certificate that no path exists, which has no path
  std::optional<Theorem> theorem;
  std::optional<MoveStatistics> move;                          ///< of a move that plan() made
  std::vector<std::pair<std::string, Certificate>> legs = {};  ///< of a certificate of legs, which has no path
};

namespace {

// --- Into taut and out of it -----------------------------------------------------------------------------------------

/// Round to nearest, no traps, no flushing to zero while in scope; then what was before.
class DefaultFloatingPoint {
 public:
  DefaultFloatingPoint() : mxcsr_(_mm_getcsr()) {
    std::fegetenv(&environment_);
    std::fesetenv(FE_DFL_ENV);
    _mm_setcsr(rounding_detail::kNearest);
  }
  ~DefaultFloatingPoint() {
    std::fesetenv(&environment_);
    _mm_setcsr(mxcsr_);
  }
  DefaultFloatingPoint(const DefaultFloatingPoint&) = delete;
  DefaultFloatingPoint& operator=(const DefaultFloatingPoint&) = delete;

 private:
  unsigned mxcsr_;
  std::fenv_t environment_{};
};

/// MPFR keeps constants for each thread: those of a caller's thread go when it ends.
struct MpfrConstants {
  MpfrConstants() = default;
  ~MpfrConstants() { mpfr_free_cache2(MPFR_FREE_LOCAL_CACHE); }
  MpfrConstants(const MpfrConstants&) = delete;
  MpfrConstants& operator=(const MpfrConstants&) = delete;
};

void test_rounding_once() {
  static std::once_flag tested;
  std::call_once(tested, rounding_self_test);
}

/// Carries what a progress callback throws around taut, which is asked to stop meanwhile.
class ProgressBridge {
 public:
  ProgressBridge(const ProgressCallback& callback, const std::stop_token& stop)
      : callback_(callback), on_stop_(stop, [this] { source_.request_stop(); }) {}

  [[nodiscard]] std::stop_token token() const { return source_.get_token(); }
  void report(const Progress& progress) {
    if (!callback_ || thrown_) return;
    try {
      callback_(progress);
    } catch (...) {
      thrown_ = std::current_exception();
      source_.request_stop();
    }
  }
  void rethrow() const {
    if (thrown_) std::rethrow_exception(thrown_);
  }

 private:
  const ProgressCallback& callback_;
  std::stop_source source_;
  std::exception_ptr thrown_;
  std::stop_callback<std::function<void()>> on_stop_;
};

[[noreturn]] void throw_outside(const taut::InputError& error, ErrorCode code) {
  const InputPlace& place = error.place();
  throw InputError(error.what(), place.file, place.line, place.field, text(code));
}

/// Calls `work` in a floating-point environment and with threads of its own, and turns taut's exceptions into those of
/// the interface.
/// @param code  of wrong input, where an error has none
template <class Work>
auto within(ErrorCode code, const Work& work) {
  const DefaultFloatingPoint environment;
  thread_local const MpfrConstants constants;
  try {
    tbb::task_arena threads;  // begins with this thread's environment, whatever that of the caller's own tasks is
    return threads.execute(work);
  } catch (const taut::InputError& error) {
    throw_outside(error, error.code().value_or(code));
  } catch (const std::filesystem::filesystem_error& error) {
    throw_outside(taut::InputError(error.what()), ErrorCode::kFile);
  } catch (const checker::Malformed& error) {  // of keys
    throw_outside(taut::InputError(error.what()), ErrorCode::kKey);
  } catch (const checker::Interrupted& error) {
    throw Interrupted(error.what());
  } catch (const taut::UntrustworthyMachine& error) {
    throw UntrustworthyMachine(error.what());
  } catch (const InputError&) {
    throw;
  } catch (const Interrupted&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    throw InternalError(error.what());
  }
}

/// The same, for what proves: on a machine that rounds as told.
template <class Work>
auto prove_within(ErrorCode code, const Work& work) {
  return within(code, [&] {
    test_rounding_once();
    return work();
  });
}

std::optional<SigningKey> signing_key(const std::string& pem) {
  return pem.empty() ? std::nullopt : std::optional<SigningKey>(std::in_place, pem, "signing_key_pem");
}

// --- Types from one side to the other --------------------------------------------------------------------------------

taut::Interpolation inner(Interpolation law) {
  switch (law) {
    case Interpolation::kStraight: return taut::Interpolation::kStraight;
    case Interpolation::kSpline: return taut::Interpolation::kCubicBSpline;
    case Interpolation::kGeodesic: return taut::Interpolation::kGeodesic;
    case Interpolation::kCableLengths: return taut::Interpolation::kCableLengths;
  }
  throw taut::InputError("interpolation: got an unknown one", {"", 0, "interpolation"});
}

Interpolation outer(taut::Interpolation law) {
  switch (law) {
    case taut::Interpolation::kStraight: break;
    case taut::Interpolation::kCubicBSpline: return Interpolation::kSpline;
    case taut::Interpolation::kGeodesic: return Interpolation::kGeodesic;
    case taut::Interpolation::kCableLengths: return Interpolation::kCableLengths;
  }
  return Interpolation::kStraight;
}

taut::Waypoint inner(const Waypoint& waypoint, taut::Interpolation law, std::size_t k) {
  const auto& [x, half_turns] = waypoint;
  const auto fail = [&](const char* field, std::size_t got, std::size_t expected) {
    const std::string where = fmt::format("waypoints[{}].{}", k, field);
    throw taut::InputError(fmt::format("{}: got {} numbers, expected {}", where, got, expected), {"", 0, where});
  };
  if (!has_poses(law)) {
    return taut::ParameterPoint{x, half_turns.empty() ? std::vector<int>(x.size(), 0) : half_turns};
  }
  if (x.size() != number_count(law, 0)) fail("x", x.size(), number_count(law, 0));
  if (!half_turns.empty()) fail("half_turns", half_turns.size(), 0);
  return waypoint_of(law, x, {});
}

taut::Path inner(const Path& path) {
  taut::Path result;
  result.interpolation = inner(path.interpolation);
  result.times = path.times;
  if (path.timing) result.timing = {path.timing->step_s, path.timing->controls};
  for (const Waypoint& waypoint : path.waypoints) {
    result.waypoints.push_back(inner(waypoint, result.interpolation, result.waypoints.size()));
  }
  return result;
}

ReportForm inner(ReportFormat format) {
  switch (format) {
    case ReportFormat::kHtml: break;
    case ReportFormat::kText: return ReportForm::kText;
    case ReportFormat::kMarkdown: return ReportForm::kMarkdown;
    case ReportFormat::kJson: return ReportForm::kJson;
  }
  return ReportForm::kPage;
}

std::string code_of(const std::string& reason) {
  const std::optional<Undecided> known = undecided_reason(reason);
  return known ? code(*known) : "";
}

double below(const std::string& decimal) { return ScalarTraits<Interval>::from_decimal(decimal).lower(); }
double above(const std::string& decimal) { return ScalarTraits<Interval>::from_decimal(decimal).upper(); }

Place outer(const PathPoint& point) {
  Place place;
  place.index = static_cast<std::size_t>(point.index);
  if (point.on_segment) place.s = point.s.approx();
  return place;
}

Witness outer(const PathWitness& witness, const Problem& problem) {
  Witness result;
  result.at = outer(witness.at);
  if (witness.singular) {
    result.kind = "singular";
    result.to = outer(witness.to);
    return result;
  }
  if (witness.contact) {
    result.kind = "contact";
    result.bodies = names(*problem.bodies, pairs(*problem.bodies).at(witness.contact->pair));
    result.depth_m = below(witness.depth_m);
    return result;
  }
  result.value_lower = below(witness.value_lower);
  result.value_upper = above(witness.value_upper);
  result.deviates = witness.deviation != nullptr;
  if (const auto& slowing = witness.slowing) {
    result.slowing = {ScalarTraits<double>::from_decimal(slowing->speed), slowing->change};
  }
  if (witness.rate) {
    const RateId id = *witness.rate;
    result.kind = name(id.kind);
    if (is_of_winch(id.kind)) result.cable = id.cable + 1;
    result.limit = evaluate_constant<double>(limit_of(problem.time.value(), id));
    return result;
  }
  result.kind = name(witness.margin.kind);
  result.cable = witness.margin.cable + 1;
  result.limit = ScalarTraits<double>::from_decimal(witness.limit);
  return result;
}

std::array<std::array<double, 2>, 6> outer(const std::array<Limits, kCables>& limits) {
  std::array<std::array<double, 2>, 6> result{};
  for (std::size_t i = 0; i < result.size(); ++i) {
    result[i] = {ScalarTraits<double>::from_decimal(limits[i].lower),
                 ScalarTraits<double>::from_decimal(limits[i].upper)};
  }
  return result;
}

bool is_no_path(const nlohmann::json& certificate) {
  return certificate.is_object() && certificate.value("format", nlohmann::json()) == checker::kNoPathFormat;
}

/// Reads a certificate that no path exists into one without a path. @pre the checker has found its form right
void read_no_path(const nlohmann::json& certificate, Certificate::Content& content) {
  content.stated.problem = problem_from_json(certificate.at("problem"));
  content.stated.illustration = certificate.at("illustration");
  content.no_path_from = certificate.at("waypoints").at(0).get<std::size_t>();
  const auto& tree = certificate.at("map").at("tree").get_ref<const std::string&>();
  const auto is_reason = [](char node) { return (node < '0' || node > '2') && node != checker::kOpenLeaf; };
  content.boxes = static_cast<std::size_t>(std::ranges::count_if(tree, is_reason));
}

bool is_of_legs(const nlohmann::json& certificate) {
  return certificate.is_object() && certificate.value("version", nlohmann::json()) == checker::kVersionOfLegs;
}

/// "carry" of the problem "CASE, leg carry"; a name that says no leg is that of the case.
struct LegName {
  explicit LegName(const std::string& problem) : of_case(problem) {
    constexpr std::string_view kBefore = ", leg ";
    const std::size_t at = problem.rfind(kBefore);
    if (at == std::string::npos) return;
    of_case = problem.substr(0, at);
    leg = problem.substr(at + kBefore.size());
  }
  std::string of_case, leg;
};

Certificate certificate_of(std::string text, checker::CheckResult checked,
                           std::vector<std::optional<MoveStatistics>> moves = {});
checker::CheckResult unchecked(const std::string& text, const std::string& name);

/// Reads the legs, each a certificate of its own. @pre the checker has found the form of the whole right
void read_legs(const std::string& text, const checker::CheckResult& checked,
               std::vector<std::optional<MoveStatistics>> moves, Certificate::Content& content) {
  const checker::Outline outline = checker::read_json(text);
  const std::vector<std::string_view> texts = checker::leg_texts(outline);
  moves.resize(texts.size());
  for (std::size_t k = 0; k < texts.size(); ++k) {
    std::string leg(texts[k]);
    checker::CheckResult of_leg =
        k < checked.legs.size() ? checked.legs[k] : unchecked(leg, fmt::format("legs[{}]", k));
    Certificate certificate = certificate_of(std::move(leg), std::move(of_leg), {std::move(moves[k])});
    const LegName name(certificate.case_name());
    content.stated.problem.name = name.of_case;
    content.boxes += certificate.boxes();
    if (!content.stated.undecided) content.stated.undecided = certificate.content().stated.undecided;
    content.legs.emplace_back(name.leg, std::move(certificate));
  }
  const bool is_undecided = checked.certificate->value("verdict", nlohmann::json()) == "undecided";
  content.stated.verdict = is_undecided ? taut::Verdict::kUndecided : taut::Verdict::kProved;  // what it states
  if (!is_undecided) content.stated.undecided.reset();
}

/// A certificate that the checker has read.
/// @param moves  of a move that was planned, or of each leg
Certificate certificate_of(std::string text, checker::CheckResult checked,
                           std::vector<std::optional<MoveStatistics>> moves) {
  Certificate::Content content;
  if (is_no_path(*checked.certificate)) {
    read_no_path(*checked.certificate, content);
  } else if (is_of_legs(*checked.certificate)) {
    read_legs(text, checked, std::move(moves), content);
  } else {
    if (!moves.empty()) content.move = std::move(moves.front());
    content.stated = read_certificate(*checked.certificate);
    content.boxes = count_boxes(content.stated);
    content.stated.segments = {};  // nobody asks for them, and they are long
  }
  if (checked.theorem) content.theorem = TheoremMaker::make(*checked.theorem);
  content.text = std::move(text);
  content.checked = std::move(checked);
  return Certificate(std::make_shared<const Certificate::Content>(std::move(content)));
}

/// That a certificate that no path exists, or one of legs, has the form of one, on which its reader relies.
void require_form(const std::string& text, bool is_of_legs) {
  try {
    checker::Outline outline = checker::read_json(text);
    if (is_of_legs) {
      (void)checker::read_legs(outline);
    } else {
      (void)checker::read_no_path(std::move(outline));
    }
  } catch (const checker::Malformed& error) {
    throw taut::InputError(fmt::format("got {}, expected a certificate", sanitize(error.what())));
  }
}

/// A certificate whose form is right, and of which nothing was proved.
checker::CheckResult unchecked(const std::string& text, const std::string& name) {
  checker::CheckResult result;
  nlohmann::json certificate = parse_certificate(text, name);
  if (is_no_path(certificate) || is_of_legs(certificate)) require_form(text, is_of_legs(certificate));
  result.certificate = std::make_shared<const nlohmann::json>(std::move(certificate));
  result.sha256 = checker::sha256(text);
  result.outcome = checker::Outcome::kUnchecked;
  result.message = "it was loaded";
  return result;
}

/// A certificate that was just made, once the checker has confirmed it.
Certificate checked_certificate(std::string text, const taut::Problem& problem, double max_seconds,
                                const std::stop_token& stop) {
  checker::CheckResult checked = recheck(text, max_seconds, stop, meshes_of(problem));
  require_confirmed(checked);
  if (checked.outcome == checker::Outcome::kUnchecked && stop.stop_requested()) throw Interrupted("interrupted");
  return certificate_of(std::move(text), std::move(checked));
}

void require_seconds(double seconds, const char* field) {
  if (seconds >= 0 && std::isfinite(seconds)) return;
  throw taut::InputError(fmt::format("{}: got {}, expected a number of seconds", field, seconds), {"", 0, field});
}

/// That what is asked of a move is possible, and the case's plans are moves.
void require_move(const PlanOptions& options, const taut::Case& the_case, const std::string& file) {
  const double share = options.speed_share;
  if (!(share >= kLeastSpeed && share <= 1)) {
    throw taut::InputError(fmt::format("speed_share: got {}, expected a number from {} to 1", share, kLeastSpeed),
                           {"", 0, "speed_share"});
  }
  const char* const field = options.greatest_speed ? "greatest_speed" : "speed_share";
  if (options.greatest_speed && share != 1) {
    throw taut::InputError(fmt::format("greatest_speed: got a speed_share of {}, too, expected one of the two", share),
                           {"", 0, field});
  }
  if ((options.greatest_speed || share != 1) && !the_case.problem.time) {
    throw taut::InputError(
        fmt::format("{}: got the case {} without the key 'time', expected one that says what winches and load may do",
                    field, file),
        {"", 0, field});
  }
}

/// The case for what looks at poses alone: without limits in time, and without inertia.
taut::Case at_rest(taut::Case the_case) {
  the_case.problem = without_time(std::move(the_case.problem));
  return the_case;
}

/// The table as the text of a path file; its decimals read back as the same binary64.
std::shared_ptr<const std::string> text_of(const Table& table) {
  const std::size_t columns = table.columns.size();
  if (columns == 0 || table.values.size() % columns != 0) {
    throw taut::InputError(
        fmt::format("values: got {} numbers, expected {} for each row", table.values.size(), columns),
        {"", 0, "values"});
  }
  for (const std::string& column : table.columns) {
    if (column.find_first_of(",;\t\r\n#\"") != std::string::npos) {
      throw taut::InputError(fmt::format("columns: got '{}', expected NAME or NAME[UNIT]", column), {"", 0, "columns"});
    }
  }
  std::string text = fmt::format("{}\n", fmt::join(table.columns, ","));
  for (auto row = table.values.begin(); row != table.values.end(); row += static_cast<std::ptrdiff_t>(columns)) {
    text += fmt::format("{}\n", fmt::join(row, row + static_cast<std::ptrdiff_t>(columns), ","));
  }
  return std::make_shared<const std::string>(std::move(text));
}

}  // namespace

// --- Errors ----------------------------------------------------------------------------------------------------------

const char* version() noexcept { return TAUT_VERSION; }

InputError::InputError(const std::string& message, std::string file, std::size_t line, std::string field,
                       std::string code)
    : std::runtime_error(message),
      file_(std::move(file)),
      line_(line),
      field_(std::move(field)),
      code_(std::move(code)) {}
InputError::InputError(const InputError&) = default;
InputError::~InputError() = default;
Interrupted::~Interrupted() = default;
UntrustworthyMachine::~UntrustworthyMachine() = default;
InternalError::~InternalError() = default;

// --- Cases -----------------------------------------------------------------------------------------------------------

namespace {

/// The fields that are not empty, by their names.
std::vector<std::pair<std::string, std::string>> stated_fields(const DocumentFields& fields) {
  std::vector<std::pair<std::string, std::string>> result;
  for (const auto& [name, member] : kDocumentFields) {
    if (!(fields.*member).empty()) result.emplace_back(name, fields.*member);
  }
  return result;
}

}  // namespace

Case::Case(std::shared_ptr<const Content> content) : content_(std::move(content)) {}

Case Case::load(const std::string& file) {
  return within(ErrorCode::kCase, [&] {
    return Case(std::make_shared<const Content>(Content{load_case_of_legs(file), file}));
  });
}

Case Case::parse(const std::string& yaml, const std::string& name) {
  return within(ErrorCode::kCase, [&] {
    return Case(std::make_shared<const Content>(Content{parse_case_of_legs(yaml, name), name}));
  });
}

const std::string& Case::name() const { return content_->of.whole.problem.name; }
std::vector<std::pair<std::string, std::string>> Case::document_fields() const {
  return stated_fields(content_->of.whole.document_fields);
}
const std::string& Case::description() const { return content_->of.whole.description; }

std::vector<std::string> Case::parameters() const {
  std::vector<std::string> names;
  for (const Parameter& parameter : content_->of.whole.problem.space.parameters) names.push_back(parameter.name);
  return names;
}

std::vector<std::pair<std::string, Case>> Case::legs() const {
  return within(ErrorCode::kCase, [&] {
    std::vector<std::pair<std::string, Case>> result;
    for (const CaseLeg& leg : content_->of.legs) {
      result.emplace_back(leg.name, Case(std::make_shared<const Content>(Content{{leg.content, {}}, content_->file})));
    }
    return result;
  });
}

std::size_t Case::query_waypoints() const { return content_->of.whole.problem.query.size(); }

std::array<std::array<double, 2>, 6> Case::tension_limits_N() const {
  return within(ErrorCode::kCase, [&] { return outer(content_->of.whole.problem.robot.tension_N); });
}

std::array<std::array<double, 2>, 6> Case::length_limits_m() const {
  return within(ErrorCode::kCase, [&] { return outer(content_->of.whole.problem.robot.length_m); });
}

namespace {

/// What `state` says of a case; of a case of legs what it says of each, with the leg's name before it.
template <class State>
std::vector<std::string> stated_of(const CaseOfLegs& of, const State& state) {
  if (of.legs.empty()) return state(of.whole);
  std::vector<std::string> result;
  for (const CaseLeg& leg : of.legs) {
    for (const std::string& line : state(leg.content)) result.push_back(fmt::format("leg {}: {}", leg.name, line));
  }
  return result;
}

}  // namespace

std::vector<std::string> Case::bodies_statement() const {
  return within(ErrorCode::kCase, [&] {
    return stated_of(content_->of, [](const taut::Case& the_case) {
      const std::optional<CaseBodies>& bodies = the_case.bodies;
      return bodies ? lines(taut::bodies_statement(*bodies)) : std::vector<std::string>();
    });
  });
}

std::string Case::time_statement() const {
  return within(ErrorCode::kCase, [&]() -> std::string {
    const taut::Case& the_case = content_->of.whole;
    return the_case.problem.time ? time_limits_text(*the_case.problem.time, DisplayUnits(the_case.units)) : "";
  });
}

std::vector<std::string> Case::load_statement() const {
  return within(ErrorCode::kCase, [&] {
    return stated_of(content_->of, [](const taut::Case& the_case) { return lines(taut::load_statement(the_case)); });
  });
}

std::vector<std::string> Case::warnings() const { return content_->of.whole.warnings; }

std::string Case::summary() const {
  return within(ErrorCode::kCase, [&] { return to_text(content_->of, summaries_of(content_->of)); });
}

std::string Case::summary_json() const {
  return within(ErrorCode::kCase, [&] {
    const nlohmann::json json = to_json(content_->of, summaries_of(content_->of));
    return json.dump(1, ' ', true, nlohmann::json::error_handler_t::replace) + "\n";
  });
}

std::string Case::drawing_svg() const {
  return within(ErrorCode::kCase, [&] {
    const CaseOfLegs& of = content_->of;
    return robot_drawing(CaseSummary(of.legs.empty() ? of.whole : of.legs.front().content));
  });
}

// --- Certificates ----------------------------------------------------------------------------------------------------

Certificate::Certificate(std::shared_ptr<const Content> content) : content_(std::move(content)) {}

Certificate Certificate::load(const std::string& file) {
  return parse(within(ErrorCode::kCertificate, [&] { return read_whole(file); }), file);
}

Certificate Certificate::parse(const std::string& text, const std::string& name) {
  return within(ErrorCode::kCertificate, [&] {
    return taut::with_error_code(ErrorCode::kCertificate, name,
                                 [&] { return certificate_of(text, unchecked(text, name)); });
  });
}

void Certificate::save(const std::string& file) const {
  within(ErrorCode::kCertificate, [&] { write_whole({{file, content_->text}}); });
}

const std::string& Certificate::text() const { return content_->text; }

std::optional<Theorem> Certificate::theorem() const { return content_->theorem; }

Verdict Certificate::verdict() const {
  if (content_->theorem) return content_->theorem->verdict();
  if (content_->no_path_from) return Verdict::kUnchecked;
  return content_->stated.verdict == taut::Verdict::kUndecided ? Verdict::kUndecided : Verdict::kUnchecked;
}

const std::string& Certificate::case_name() const { return content_->stated.problem.name; }
std::vector<std::pair<std::string, std::string>> Certificate::document_fields() const {
  if (!content_->legs.empty()) return content_->legs.front().second.document_fields();
  const nlohmann::json& illustration = content_->stated.illustration;
  if (!illustration.is_object() || !illustration.contains("document_fields")) return {};
  return stated_fields(document_fields_from_json(illustration.at("document_fields")));
}

Theorem::Theorem(std::shared_ptr<const Content> content) : content_(std::move(content)) {}

Verdict Theorem::verdict() const {
  switch (content_->theorem.verdict()) {
    case checker::Theorem::Verdict::kProved: return Verdict::kProved;
    case checker::Theorem::Verdict::kRefuted: return Verdict::kRefuted;
    case checker::Theorem::Verdict::kNoPath: break;
  }
  return Verdict::kNoPath;
}

const std::string& Theorem::claim() const { return content_->claim; }
const std::string& Theorem::certificate_sha256() const { return content_->theorem.sha256(); }

std::optional<Margins> Theorem::margins() const {
  const std::optional<taut::Margins>& margins = content_->margins;
  if (!margins) return std::nullopt;
  return within(ErrorCode::kCertificate, [&] {
    Margins result{below(margins->tension_N), below(margins->length_m), below(margins->wrench_scale), {}};
    const std::optional<BodiesText>& bodies = content_->problem.bodies;
    if (bodies && margins->clearance_m && !pairs(*bodies).empty()) result.clearance_m = below(*margins->clearance_m);
    return result;
  });
}

std::optional<Witness> Theorem::witness() const {
  if (!content_->witness) return std::nullopt;
  return within(ErrorCode::kCertificate, [&] { return outer(*content_->witness, content_->problem); });
}

std::vector<Stretch> Certificate::stretches() const {
  return within(ErrorCode::kCertificate, [&] {
    std::vector<Stretch> result;
    if (verdict() == Verdict::kUnchecked) return result;
    for (const taut::Stretch& stretch : content_->stated.stretches) {
      Stretch& copy = result.emplace_back();
      copy.begin = outer(stretch.begin);
      copy.end = outer(stretch.end);
      if (const auto& found = stretch.violations) {
        const Problem& problem = content_->stated.problem;
        copy.violations = {outer(found->first.violation, problem), outer(found->second.violation, problem)};
      }
      copy.reason = stretch.reason;
      copy.reason_code = code_of(stretch.reason);
    }
    return result;
  });
}

const std::string& Certificate::reason() const {
  static const std::string none;
  return content_->stated.undecided ? content_->stated.undecided->reason : none;
}

std::optional<std::size_t> Certificate::no_path_from() const { return content_->no_path_from; }

std::string Certificate::reason_code() const { return code_of(reason()); }

std::vector<std::pair<std::string, Certificate>> Certificate::legs() const { return content_->legs; }

namespace {

/// The least of the legs' headroom; empty where it is not known of each.
std::string headroom_of(const std::vector<std::pair<std::string, Certificate>>& legs) {
  std::vector<Illustration> illustrations;
  for (const auto& [name, leg] : legs) {
    const taut::Certificate& stated = leg.content().stated;
    illustrations.emplace_back(stated.illustration, stated.problem.space.parameters.size());
  }
  std::vector<LegHeadroom> found;
  for (std::size_t k = 0; k < legs.size(); ++k) {
    found.push_back({legs[k].first, illustrations[k].headroom, legs[k].second.content().stated.problem});
  }
  const nlohmann::json json = headroom_json(found);
  return json.is_null() ? "" : json.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
}

}  // namespace

std::string Certificate::headroom() const {
  if (!content_->legs.empty()) return within(ErrorCode::kCertificate, [&] { return headroom_of(content_->legs); });
  const nlohmann::json& illustration = content_->stated.illustration;
  if (!illustration.is_object() || !illustration.contains("headroom")) return "";
  return illustration.at("headroom").dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
}

Path Certificate::path() const {
  const taut::Path& path = content_->stated.path;
  Path result;
  result.interpolation = outer(path.interpolation);
  for (const taut::Waypoint& waypoint : path.waypoints) {
    result.waypoints.push_back({numbers(waypoint), half_turns(waypoint)});
  }
  result.times = path.times;
  if (path.timing) result.timing = {path.timing->step_s, path.timing->controls};
  return result;
}

std::optional<double> Certificate::duration_s() const {
  if (!content_->legs.empty()) {
    double sum = 0;
    for (const auto& [name, leg] : content_->legs) {
      const std::optional<double> of_leg = leg.duration_s();
      if (!of_leg) return std::nullopt;
      sum += *of_leg;
    }
    return sum;
  }
  const std::optional<taut::TimeLaw>& law = content_->stated.path.timing;
  return law ? std::optional(law->duration_s()) : std::nullopt;
}

std::optional<MovePlan> Certificate::move_plan() const {
  const std::optional<MoveStatistics>& move = content_->move;
  if (!move) return std::nullopt;
  return within(ErrorCode::kCertificate, [&] {
    MovePlan result;
    result.planned_s = move->planned_s;
    result.speed_share = move->speed_share;
    result.fastest_s = move->fastest_s;
    result.tries = static_cast<std::size_t>(move->tries);
    if (const std::optional<GreatestSpeed>& greatest = move->greatest) {
      result.refuted_share = greatest->refuted;
      if (greatest->witness) result.witness = outer(*greatest->witness, content_->stated.problem);
    }
    return result;
  });
}

namespace {

void require_one_path(const Certificate& certificate, const char* what) {
  if (certificate.content().legs.empty()) return;
  throw taut::InputError(fmt::format("{}: got a certificate of several legs, expected that of one: legs()", what));
}

}  // namespace

std::string Certificate::path_csv() const {
  return within(ErrorCode::kCertificate, [&] {
    if (content_->no_path_from) {
      throw taut::InputError("path_csv: got a certificate that no path exists, expected one of a path");
    }
    require_one_path(*this, "path_csv");
    return taut::path_csv(content_->stated.problem, content_->stated.path, content_->checked.sha256);
  });
}

std::string Certificate::controller_csv(double step_m) const {
  return within(ErrorCode::kUse, [&] {
    require_one_path(*this, "controller_csv");
    if (verdict() != Verdict::kProved) {
      throw taut::InputError(
          "controller_csv: got a certificate without a theorem that the path is proved, expected a "
          "proved one: what is not proved is not for a machine to follow");
    }
    const ControllerStep step = read_controller_step(fmt::format("{:.17f} m", step_m), "controller_csv");
    return taut::controller_csv(content_->stated.problem, content_->stated.path,
                                {step.metres, fmt::format("{:.12g} mm", 1e3 * step_m)}, content_->checked.sha256);
  });
}

namespace {

/// Checks that the move is proved, and its tables at this rate are not too long.
void require_move_table(const Certificate& certificate, double rate_Hz, const char* table) {
  const std::optional<double> duration_s = certificate.duration_s();
  if (certificate.verdict() != Verdict::kProved || !duration_s) {
    throw taut::InputError(fmt::format(
        "{}: got a certificate without a theorem that a move in time is proved, expected a proved one: what is not "
        "proved is not for a machine to follow",
        table));
  }
  constexpr double kMostHz = 10'000;
  if (!(rate_Hz > 0 && rate_Hz <= kMostHz)) {
    throw taut::InputError(fmt::format("rate_Hz: got {}, expected a number above 0, at most {}", rate_Hz, kMostHz),
                           {"", 0, "rate_Hz"});
  }
  if (!(*duration_s * rate_Hz < kMostMoveRows)) {
    throw taut::InputError(
        fmt::format("rate_Hz: got {}, at which a table of a move of {:.6g} s takes more than {} rows, expected a lower "
                    "rate",
                    rate_Hz, *duration_s, kMostMoveRows),
        {"", 0, "rate_Hz"});
  }
}

template <std::size_t kColumns>
Table table_of(const std::array<std::string_view, kColumns>& columns,
               const std::vector<std::array<double, kColumns>>& rows) {
  Table table;
  table.columns.assign(columns.begin(), columns.end());
  table.values.reserve(kColumns * rows.size());
  for (const auto& row : rows) table.values.insert(table.values.end(), row.begin(), row.end());
  return table;
}

/// Whether a table is asked for proved tensions, which take a while.
enum class Tensions { kNeeded, kNotNeeded };

std::vector<TensionPiece> pieces_of(const Certificate& certificate, Tensions tensions) {
  if (tensions == Tensions::kNotNeeded) return {};
  return tension_pieces(certificate.content().checked);
}

/// The legs of a certificate of legs.
std::vector<MoveLeg> moves_of(const Certificate& certificate, Tensions tensions) {
  std::vector<MoveLeg> result;
  for (const auto& [name, leg] : certificate.content().legs) {
    const taut::Certificate& stated = leg.content().stated;
    result.push_back({stated.problem, stated.path, name, pieces_of(leg, tensions)});
  }
  return result;
}

MoveRows move_rows_of(const Certificate& certificate, double rate_Hz, const char* table, Tensions tensions) {
  require_move_table(certificate, rate_Hz, table);
  const taut::Certificate& stated = certificate.content().stated;
  const std::vector<MoveLeg> legs = moves_of(certificate, tensions);
  if (!legs.empty()) return move_rows(legs, rate_Hz);
  return move_rows(stated.problem, stated.path, pieces_of(certificate, tensions), rate_Hz);
}

MoveTables move_tables_of(const Certificate& certificate, double rate_Hz, const char* table, Tensions tensions) {
  require_move_table(certificate, rate_Hz, table);
  const taut::Certificate& stated = certificate.content().stated;
  const std::string& sha256 = certificate.content().checked.sha256;
  const std::vector<MoveLeg> legs = moves_of(certificate, tensions);
  if (!legs.empty()) return move_tables(legs, stated.problem.name, rate_Hz, sha256);
  return move_tables(stated.problem, stated.path, pieces_of(certificate, tensions), rate_Hz, sha256);
}

}  // namespace

Table Certificate::winches(double rate_Hz) const {
  return within(ErrorCode::kUse, [&] {
    return table_of(kWinchColumns, move_rows_of(*this, rate_Hz, "winches", Tensions::kNeeded).winches);
  });
}

Table Certificate::poses(double rate_Hz) const {
  return within(ErrorCode::kUse, [&] {
    return table_of(kPoseColumns, move_rows_of(*this, rate_Hz, "poses", Tensions::kNotNeeded).poses);
  });
}

std::string Certificate::winches_csv(double rate_Hz) const {
  return within(ErrorCode::kUse,
                [&] { return move_tables_of(*this, rate_Hz, "winches_csv", Tensions::kNeeded).winches_csv; });
}

std::string Certificate::poses_csv(double rate_Hz) const {
  return within(ErrorCode::kUse,
                [&] { return move_tables_of(*this, rate_Hz, "poses_csv", Tensions::kNotNeeded).poses_csv; });
}

std::string Certificate::poses_tum(double rate_Hz) const {
  return within(ErrorCode::kUse,
                [&] { return move_tables_of(*this, rate_Hz, "poses_tum", Tensions::kNotNeeded).poses_tum; });
}

std::size_t Certificate::segments() const {
  std::size_t result = content_->stated.path.segments();
  for (const auto& [name, leg] : content_->legs) result += leg.segments();
  return result;
}
std::size_t Certificate::boxes() const { return content_->boxes; }

std::vector<Sample> Certificate::samples(std::size_t about) const {
  return within(ErrorCode::kCertificate, [&] {
    std::vector<Sample> result;
    if (content_->stated.path.waypoints.empty()) return result;
    const Sampler sampler(content_->stated.problem);
    for (const PathSample& sample : sampler.along(content_->stated.path, about)) {
      Sample& copy = result.emplace_back();
      copy.position = sample.position;
      const RigidPose pose = sampler.rigid_pose(sample);
      copy.p_m = {pose.p(0), pose.p(1), pose.p(2)};
      copy.quaternion = {pose.q.x(), pose.q.y(), pose.q.z(), pose.q.w()};
      copy.is_singular = !sample.statics.regular;
      copy.length_m = sample.statics.length;
      if (sample.in_time) copy.time_s = sample.in_time->time_s;
      for (std::size_t i = 0; i < copy.length_m.size() && !copy.is_singular; ++i) {
        copy.tension_lower_N[i] = sample.statics.tension[i] - sample.statics.tension_below[i];
        copy.tension_upper_N[i] = sample.statics.tension[i] + sample.statics.tension_above[i];
      }
    }
    return result;
  });
}

// --- What taut does --------------------------------------------------------------------------------------------------

namespace {

/// For what is about one path. @param what  that asks for it
void require_one_path(const Case& the_case, const char* what) {
  const Case::Content& content = the_case.content();
  if (content.of.legs.empty()) return;
  throw taut::InputError(
      fmt::format("{}: got the case {} with legs, expected one without them, or one of its legs(), a case of its own",
                  what, content.file),
      {content.file, 0, "query.legs"});
}

void require_plan(const Case& the_case) {
  try {
    for (const CaseLeg& leg : the_case.content().of.legs) require_plannable(leg.content);
    if (the_case.content().of.legs.empty()) require_plannable(the_case.content().of.whole);
  } catch (const FieldError& error) {
    const std::string& file = the_case.content().file;
    throw taut::InputError(fmt::format("{}: {}", file, error.what()), {file, 0, error.field()});
  }
}

}  // namespace

namespace {

void set_budget(double seconds, taut::Case& the_case) {
  if (!(seconds > 0)) return;
  the_case.planner.max_seconds = seconds;
  the_case.planner.has_budget = true;
}

PlannedCaseOptions inner(const PlanOptions& options, const SigningKey* key) {
  return {.grow = options.grow,
          .key = key,
          .max_seconds = options.max_check_seconds,
          .headroom_seconds = options.headroom_seconds,
          .no_path_seconds = options.no_path_seconds,
          .move = {options.speed_share, options.greatest_speed}};
}

/// Of a case of legs.
Certificate plan_all_legs(const CaseOfLegs& of, const PlanOptions& options, const SigningKey* key,
                          const taut::Progress& progress, const std::stop_token& stop) {
  if (!options.atlas.empty() || !options.save_atlas.empty()) {
    const char* const field = options.atlas.empty() ? "save_atlas" : "atlas";
    throw taut::InputError(
        fmt::format("{}: got a case with legs, each of which has an atlas of its own, expected one without legs",
                    field),
        {"", 0, field});
  }
  std::vector<CaseLeg> legs = of.legs;
  for (CaseLeg& leg : legs) set_budget(options.budget_seconds, leg.content);
  PlannedLegs made = plan_legs(
      legs, inner(options, key), [](std::size_t) {}, progress, stop);
  std::vector<std::optional<MoveStatistics>> moves;
  for (PlannedLeg& leg : made.legs) moves.push_back(std::move(leg.planned.plan.move));
  return certificate_of(std::move(made.text), std::move(made.checked), std::move(moves));
}

}  // namespace

Certificate plan(const Case& the_case, const PlanOptions& options) {
  ProgressBridge relay(options.progress, options.stop);
  Certificate result = prove_within(ErrorCode::kCase, [&] {
    require_plan(the_case);
    taut::Case planned = the_case.content().of.whole;
    require_seconds(options.budget_seconds, "budget_seconds");
    require_seconds(options.max_check_seconds, "max_check_seconds");
    require_seconds(options.headroom_seconds, "headroom_seconds");
    require_seconds(options.no_path_seconds, "no_path_seconds");
    require_move(options, planned, the_case.content().file);
    set_budget(options.budget_seconds, planned);
    const std::optional<SigningKey> key = signing_key(options.signing_key_pem);
    const auto progress = [&](const PlanProgress& at) {
      const bool is_move = at.move_tries > 0;
      relay.report({is_move ? "proving the move" : "planning",
                    static_cast<std::size_t>(is_move ? at.move_tries : at.charts), 0});
    };
    const SigningKey* const by = key ? &*key : nullptr;
    const CaseOfLegs& of = the_case.content().of;
    if (!of.legs.empty()) return plan_all_legs(of, options, by, progress, relay.token());
    if (!options.save_atlas.empty()) require_writable(options.save_atlas);
    Planner planner(planned, options.atlas);
    PlannedCase made = plan_case(planned, planner, inner(options, by), progress, relay.token());
    if (!options.save_atlas.empty() && planner.atlas().size() > 0) {
      write_whole({{options.save_atlas, planner.atlas_bytes()}});
    }
    return certificate_of(std::move(made.text), std::move(made.checked), {std::move(made.plan.move)});
  });
  relay.rethrow();
  return result;
}

Certificate prove(const Case& the_case, const Path& path, const ProveOptions& options) {
  return prove_within(ErrorCode::kPath, [&] {
    require_seconds(options.max_check_seconds, "max_check_seconds");
    require_one_path(the_case, "prove");
    const std::optional<SigningKey> key = signing_key(options.signing_key_pem);
    const taut::Case about = path.timing ? the_case.content().of.whole : at_rest(the_case.content().of.whole);
    const Decoration decoration = read_meshes(about.decoration);
    taut::Certificate certificate = prove_waypoints(about.problem, inner(path), options.max_bits, options.stop);
    certificate.illustration = {{"kind", "proof"}};
    add_stated(certificate.illustration, about, decoration);
    if (options.stop.stop_requested()) throw Interrupted("interrupted");
    return checked_certificate(certificate_text(certificate, key ? &*key : nullptr), about.problem,
                               options.max_check_seconds, options.stop);
  });
}

namespace {

/// The path that is meant: the one given, else the case's.
AuditRequest audit_request(const Case::Content& content, const PathInput& path,
                           const std::optional<Interpolation>& interpolation) {
  AuditRequest request{path, std::nullopt};
  if (interpolation) request.law = inner(*interpolation);
  return resolved(request, content.of.whole, content.file);
}

/// Does the work on a path. Where the caller's progress threw, and so interrupted it, that is thrown again.
template <class Work>
auto prove_path_within(ProgressBridge& relay, const Work& work) {
  try {
    return prove_within(ErrorCode::kPath, work);
  } catch (const Interrupted&) {
    relay.rethrow();
    throw;
  }
}

/// A move in time. @param request  whose `timed` is true
Certificate audit_in_time(const taut::Case& the_case, const AuditRequest& request, const AuditOptions& options,
                          const std::stop_token& stop) {
  require_timed(request, the_case, "timed");
  const std::optional<SigningKey> key = signing_key(options.signing_key_pem);
  const MoveSource source = read_move(the_case.problem, request.path, request.rounding);
  TimedAudit audited =
      audit_move(source, the_case, {options.max_bits, key ? &*key : nullptr, options.max_check_seconds}, stop);
  if (audited.interrupted) throw Interrupted("interrupted");
  return certificate_of(std::move(audited.text), std::move(audited.checked));
}

Certificate audit_input(const Case& the_case, const PathInput& path, const AuditOptions& options) {
  ProgressBridge relay(options.progress, options.stop);
  const auto work = [&] {
    require_one_path(the_case, "audit");
    AuditRequest request = audit_request(the_case.content(), path, options.interpolation);
    request.timed |= options.timed;
    if (const auto& rounding = options.rounding) {
      request.rounding = table_rounding(rounding->position_m, rounding->angle_rad, rounding->length_m);
    }
    if (request.timed) {
      require_seconds(options.max_check_seconds, "max_check_seconds");
      relay.report({"proving the move", 0, 0});
      return audit_in_time(the_case.content().of.whole, request, options, relay.token());
    }
    if (options.rounding) {
      throw taut::InputError("rounding: got it without timed, expected both", {"", 0, "rounding"});
    }
    const Case::Content content{{at_rest(the_case.content().of.whole), {}}, the_case.content().file};
    require_seconds(options.max_check_seconds, "max_check_seconds");
    require_seconds(options.headroom_seconds, "headroom_seconds");
    const std::optional<SigningKey> key = signing_key(options.signing_key_pem);
    PathSource source(content.of.whole.problem, request.path, request.law);
    std::string text;
    const auto progress = [&](std::size_t done) { relay.report({"auditing", done, source.segments()}); };
    const Audit audited = audit_path(
        source,
        {content.of.whole, read_meshes(content.of.whole.decoration), options.max_bits, temporary_folder(),
         key ? &*key : nullptr, options.headroom_seconds},
        [&](std::string_view piece) { text += piece; }, [](std::string_view) {}, progress, relay.token());
    if (audited.interrupted) throw Interrupted("interrupted");
    return checked_certificate(std::move(text), content.of.whole.problem, options.max_check_seconds, relay.token());
  };
  return prove_path_within(relay, work);
}

}  // namespace

Certificate audit(const Case& the_case, const std::string& path_file, const AuditOptions& options) {
  return audit_input(the_case, PathInput(path_file), options);
}

Certificate audit(const Case& the_case, const Table& table, const AuditOptions& options, const std::string& name) {
  return audit_input(the_case, PathInput(name, within(ErrorCode::kPath, [&] { return text_of(table); })), options);
}

Certificate audit(const Case& the_case, const AuditOptions& options) {
  return audit_input(the_case, PathInput(std::string()), options);
}

namespace {

std::string sensitivity_of(const Case& the_case, const PathInput& path, const SensitivityOptions& options) {
  ProgressBridge relay(options.progress, options.stop);
  const auto progress = [&](const char* stage, std::size_t done, std::size_t all) { relay.report({stage, done, all}); };
  const auto work = [&]() -> std::string {
    require_seconds(options.budget_seconds, "budget_seconds");
    require_one_path(the_case, "sensitivity");
    const std::optional<AuditedPath>& audited = the_case.content().of.whole.audit;
    if (path.name.empty() && audited && audited->timed) {
      throw taut::InputError(
          "sensitivity: audit.timed: got true, expected a path at rest: changes are sought for paths that are passed "
          "slowly, without the inertia of a move",
          {the_case.content().file, 0, "audit.timed"});
    }
    const Case::Content content{{at_rest(the_case.content().of.whole), {}}, the_case.content().file};
    nlohmann::json found;
    if (!path.name.empty() || content.of.whole.audit) {
      const AuditRequest request = audit_request(content, path, options.interpolation);
      PathSource source(content.of.whole.problem, request.path, request.law);
      found = to_json(source.problem(),
                      audit_sensitivity(content.of.whole, source, options.budget_seconds, progress, relay.token()));
    } else {
      require_plan(the_case);
      found = to_json(content.of.whole.problem,
                      plan_sensitivity(content.of.whole, options.budget_seconds, progress, relay.token()));
    }
    if (relay.token().stop_requested()) throw Interrupted("interrupted");
    return found.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
  };
  return prove_path_within(relay, work);
}

}  // namespace

std::string sensitivity(const Case& the_case, const SensitivityOptions& options) {
  return sensitivity_of(the_case, PathInput(std::string()), options);
}

std::string sensitivity(const Case& the_case, const std::string& path_file, const SensitivityOptions& options) {
  return sensitivity_of(the_case, PathInput(path_file), options);
}

CheckResult check(const std::string& certificate_text, const CheckOptions& options) {
  return within(ErrorCode::kUse, [&] {
    std::vector<std::string> trusted;
    for (const std::string& pem : options.trusted_keys_pem) {
      trusted.push_back(checker::read_public_key(pem, "trusted_keys_pem"));
    }
    checker::CheckOptions request;
    request.trusted = std::move(trusted);
    request.stop = options.stop;
    if (options.max_seconds) require_seconds(*options.max_seconds, "max_seconds");
    request.max_seconds = options.max_seconds;
    nlohmann::json problem;
    if (options.the_case) {
      const CaseOfLegs& of = options.the_case->content().of;
      if (of.legs.empty()) {
        problem = to_json(of.whole.problem);
        request.meshes = meshes_of(of.whole.problem);
      } else {
        problem = nlohmann::json::array();
        for (const CaseLeg& leg : of.legs) problem.push_back(to_json(leg.content.problem));
        request.meshes = meshes_of(of.legs);
      }
      request.problem = &problem;
    }
    const checker::CheckResult checked = checker::check(certificate_text, request);
    CheckResult result;
    switch (checked.outcome) {
      case checker::Outcome::kAccepted: result.outcome = Outcome::kAccepted; break;
      case checker::Outcome::kRejected: result.outcome = Outcome::kRejected; break;
      case checker::Outcome::kUndecided: result.outcome = Outcome::kUndecided; break;
      case checker::Outcome::kUnchecked: result.outcome = Outcome::kUnchecked; break;
      case checker::Outcome::kMalformed: result.outcome = Outcome::kMalformed; break;
    }
    result.message = checked.message;
    if (checked.theorem) result.theorem = TheoremMaker::make(*checked.theorem);
    result.signer = checked.signer;
    result.is_trusted = checked.is_trusted;
    result.segments = checked.counts.segments;
    result.boxes = checked.counts.boxes;
    result.not_compared = checked.not_compared;
    return result;
  });
}

CheckResult check(const Certificate& certificate, const CheckOptions& options) {
  return check(certificate.text(), options);
}

std::string report(const Certificate& certificate, const ReportOptions& options) {
  return prove_within(ErrorCode::kCertificate, [&]() -> std::string {
    require_seconds(options.max_check_seconds, "max_check_seconds");
    const taut::ReportOptions request{options.document, options.revision,
                                      options.date.empty() ? report_date() : options.date};
    const Certificate::Content& content = certificate.content();
    const checker::CheckResult checked =
        content.theorem ? content.checked : recheck(content.text, options.max_check_seconds, options.stop);
    if (options.stop.stop_requested()) throw Interrupted("interrupted");
    if (checked.certificate == nullptr || checked.outcome == checker::Outcome::kRejected) {
      throw taut::InputError(fmt::format("certificate: {}. No report is made of it.", sentence(checked)));
    }
    return make_report(checked, request, inner(options.format));
  });
}

}  // namespace taut::v0
