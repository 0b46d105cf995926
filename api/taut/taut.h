// SPDX-License-Identifier: GPL-3.0-or-later
// taut as a library: plans motions of cable-driven hexapods, proves them, and hands out certificates (docs/library.md).
//
//   const taut::Case crane = taut::Case::load("crane.yaml");
//   const taut::Certificate certificate = taut::plan(crane);
//   if (certificate.verdict() == taut::Verdict::kProved) certificate.save("certificate.json");
//
// A verdict is the independent checker's: plan(), prove() and audit() ask it before they return, and a certificate that
// was loaded has none until check() has proved it again.
//
// What comes out is what the commands `taut plan` and `taut audit` write for the same input, byte for byte. SI and
// radians everywhere.
//
// Errors. That something is not proved is a verdict, no error. Exceptions: InputError where what was given is wrong in
// some way, Interrupted where the caller asked to stop, UntrustworthyMachine where directed rounding fails or numbers
// have no decimal point, InternalError where taut does. What a progress callback throws comes through as it is.
//
// Threads. Everything may be called from any thread, in any rounding mode, which is as it was on return. A const object
// may be used by several threads at once. Work is spread over all cores.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <stop_token>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#define TAUT_EXPORT __attribute__((visibility("default")))

namespace taut {
// The inner namespace's name says which ABI this is. Where headers of the layers (taut::certify and so on) are used as
// well, which have names of their own in namespace taut, these have to be called taut::v0::Case and so on; the layers'
// CMake targets see to it.
#ifdef TAUT_WITH_LAYERS
namespace v0 {
#else
inline namespace v0 {
#endif

/// "0.1.0": of the library, which writes it into certificates.
[[nodiscard]] TAUT_EXPORT const char* version() noexcept;

// --- Errors ----------------------------------------------------------------------------------------------------------

/// A case, path, certificate, key or option is wrong in some way. what() has the place, what was seen and what was
/// expected: "crane.yaml:12:9: load.mass: got 'NaN', expected …".
class TAUT_EXPORT InputError : public std::runtime_error {
 public:
  InputError(const std::string& message, std::string file, std::size_t line, std::string field, std::string code);
  ~InputError() override;
  InputError(const InputError&);
  InputError& operator=(const InputError&) = delete;
  [[nodiscard]] const std::string& file() const noexcept { return file_; }    ///< may be empty
  [[nodiscard]] std::size_t line() const noexcept { return line_; }           ///< from 1; 0: unknown, or the whole file
  [[nodiscard]] const std::string& field() const noexcept { return field_; }  ///< "load.mass", a column; may be empty
  [[nodiscard]] const std::string& code() const noexcept { return code_; }  ///< "E3": `taut explain` has more about it

 private:
  std::string file_;
  std::size_t line_;
  std::string field_;
  std::string code_;
};

/// The caller asked to stop.
class TAUT_EXPORT Interrupted : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
  ~Interrupted() override;
};

/// This machine does not round as told: nothing can be proved.
class TAUT_EXPORT UntrustworthyMachine : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
  ~UntrustworthyMachine() override;
};

/// Something failed in taut itself.
class TAUT_EXPORT InternalError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
  ~InternalError() override;
};

// --- Cases and paths -------------------------------------------------------------------------------------------------

/// A robot, its load, the space of its poses, and maybe a query (docs/case-format.md). Copies are cheap.
class TAUT_EXPORT Case {
 public:
  /// @throws InputError
  [[nodiscard]] static Case load(const std::string& file);
  /// From the text of a case file. @param name  stands for the file in messages
  /// @throws InputError
  [[nodiscard]] static Case parse(const std::string& yaml, const std::string& name = "case");

  [[nodiscard]] const std::string& name() const;
  /// What the case states for the head of a report, name and text: title, machine, site, load_name, document,
  /// prepared_by. Nothing checks it.
  [[nodiscard]] std::vector<std::pair<std::string, std::string>> document_fields() const;
  [[nodiscard]] const std::string& description() const;       ///< the file's leading comment
  [[nodiscard]] std::vector<std::string> parameters() const;  ///< their names, in the order of waypoints
  [[nodiscard]] std::size_t query_waypoints() const;          ///< 0: there is nothing to plan, or there are legs
  /// Of a case of legs, paths that follow one another with loads and bodies of their own: their names, and each as a
  /// case of its own, "CASE, leg NAME". None of any other case. What is said of loads and bodies below names the legs.
  [[nodiscard]] std::vector<std::pair<std::string, Case>> legs() const;

  /// Lower and upper limit of each cable, rounded to the nearest binary64: for plots.
  [[nodiscard]] std::array<std::array<double, 2>, 6> tension_limits_N() const;
  [[nodiscard]] std::array<std::array<double, 2>, 6> length_limits_m() const;

  /// The load as it was understood, in kg, t, N, kN, N m and m, a sentence each: in all, the extremes of each
  /// component, then item by item, as `taut show` prints it. Read it before you rely on a verdict: a slip of units
  /// shows there. Its numbers are `load` in summary_json().
  /// @throws InputError for numbers beyond the range of binary64.
  [[nodiscard]] std::vector<std::string> load_statement() const;
  /// What may not touch what, as it was understood, in m, mm and degrees, a sentence each; empty where the case states
  /// no bodies: then nothing is proved of collisions. Read it as you read the load.
  [[nodiscard]] std::vector<std::string> bodies_statement() const;
  /// What winches and load may do in time, as it was understood; empty where the case does not limit it: then its plans
  /// are paths that are passed slowly. Read it as you read the load.
  [[nodiscard]] std::string time_statement() const;
  /// What may not be meant as it was typed, each with its place in the file: what the commands print as warnings.
  [[nodiscard]] std::vector<std::string> warnings() const;

  /// What the case was understood to say, with tensions, lengths and margins at the query's waypoints in floating
  /// point: what `taut show` prints. Nothing is proved here. @throws InputError
  [[nodiscard]] std::string summary() const;
  /// The same as JSON, in SI: `taut show --json`.
  [[nodiscard]] std::string summary_json() const;
  /// The robot at the query's first waypoint, an SVG document: `taut show --out`. @throws InputError where there is no
  /// query.
  [[nodiscard]] std::string drawing_svg() const;

  struct Content;  // the library's own
  [[nodiscard]] const Content& content() const { return *content_; }

 private:
  explicit Case(std::shared_ptr<const Content> content);
  std::shared_ptr<const Content> content_;
};

/// What happens between waypoints (docs/audits.md).
enum class Interpolation {
  kStraight,     ///< the case's parameters go from value to value at constant rates, all at once
  kSpline,       ///< the waypoints are control points of a cubic B-spline in the case's parameters
  kGeodesic,     ///< the platform moves straight and turns about one axis, at constant rates
  kCableLengths  ///< each cable's length changes at a constant rate
};

/// Exact: these binary64 numbers are what is proved.
struct Waypoint {
  /// One a parameter of the case [m, rad]; geodesic: px, py, pz [m], qx, qy, qz, qw; cable lengths: these, and the
  /// lengths l1 … l6 [m], where the pose tells which of those that have them is meant, and is refined if it is rough.
  std::vector<double> x;
  /// One a parameter, which is then x + π half_turns; not 0 for periodic ones only. Empty: all 0.
  std::vector<int> half_turns;
};

/// When a move is where on its path: a uniform cubic B-spline of time, whose values count segments. It never falls, and
/// runs from 0 to the number of segments; exactly (docs/certificate-format.md).
struct TimeLaw {
  double step_s = 0;             ///< between knots [s], above 0
  std::vector<double> controls;  ///< three more than pieces of the law; 4 to 20,000
  /// How long the move takes, rounded.
  [[nodiscard]] double duration_s() const {
    return controls.size() < 4 ? 0 : step_s * static_cast<double>(controls.size() - 3);
  }
};

struct Path {
  Interpolation interpolation = Interpolation::kStraight;
  std::vector<Waypoint> waypoints;
  std::vector<std::string> times;  ///< decimals [s], ascending, one a waypoint, or none; no part of any claim
  /// Of a move in time (docs/moves.md), in a case with the key `time`; but for splines it rests at each waypoint.
  /// Nothing: the path is passed slowly.
  std::optional<TimeLaw> timing = {};
};

/// A table of numbers with a row for each waypoint.
struct Table {
  /// With units, as docs/audits.md has them: "t[s]", "phi[deg]", "px[m]", "qw", "l1[mm]".
  std::vector<std::string> columns;
  std::vector<double> values;  ///< row by row; rows times columns
};

// --- Certificates ----------------------------------------------------------------------------------------------------

enum class Verdict {
  kProved,     ///< the claim holds along the whole path
  kRefuted,    ///< it does not, and that is proved
  kUndecided,  ///< nothing is claimed; that does not mean that the path is unsafe
  kUnchecked,  ///< the independent checker was not asked, or not given the time: nothing is known of what is claimed
  kNoPath      ///< no motion at all leads from one waypoint of a query to the next
};

/// Proved lower bounds, rounded down. Those of a move are with the load's inertia, at every time.
struct Margins {
  double tension_N = 0;     ///< every tension stays so far inside its limits, for every wrench
  double length_m = 0;      ///< and every length
  double wrench_scale = 0;  ///< the ellipsoid of wrenches could be larger by this factor; 1 of a move
  /// The bodies of every checked pair are farther apart than their clearance by this much; nothing where no pair is.
  std::optional<double> clearance_m;
};

/// A place on a path: the point s of a segment, or a waypoint.
struct Place {
  std::size_t index = 0;    ///< of the segment or waypoint
  std::optional<double> s;  ///< from 0 to 1; nothing: a waypoint
  [[nodiscard]] double position() const { return static_cast<double>(index) + s.value_or(0); }
};

/// A proved violation.
struct Witness {
  /// How a move that may be slowed down is run there.
  struct Slowing {
    double speed_share = 1;  ///< between 0 and 1, of its speed
    int change = 0;          ///< -1: braked as hard as the case's stopping time allows; 1: speeding up as fast
  };
  /// "tension_min", "tension_max", "length_min", "length_max", "singular" or "contact"; of a move also what is too
  /// fast,
  /// "winch_speed", "winch_acceleration", "winch_power", "load_speed", "load_acceleration", "load_angular_speed" or
  /// "load_angular_acceleration"
  std::string kind;
  Place at;
  std::optional<Place> to;  ///< singular: somewhere from `at` to here; the rest is then empty
  int cable = 0;            ///< 1 to 6; 0 of the load
  double value_lower = 0;   ///< the tension [N], length [m] or rate [SI] lies between these two
  double value_upper = 0;
  double limit = 0;
  bool deviates = false;  ///< the machine is not the stated one, but within the case's tolerances
  std::optional<Slowing> slowing;
  /// "contact": two bodies that are nearer than their clearance, by at least so much; then cable, value and limit are
  /// empty. Empty else.
  std::array<std::string, 2> bodies;
  double depth_m = 0;
};

/// What the independent checker has proved. Only the checker makes one, so whoever has one has a verdict. Copies are
/// cheap.
class TAUT_EXPORT Theorem {
 public:
  [[nodiscard]] Verdict verdict() const;                 ///< kProved, kRefuted or kNoPath
  [[nodiscard]] const std::string& claim() const;        ///< in words
  [[nodiscard]] std::optional<Margins> margins() const;  ///< only if proved, of one path
  [[nodiscard]] std::optional<Witness> witness() const;  ///< likewise if refuted; the gravest that was found
  /// SHA-256 of the text of the certificate that was proved, 64 lower-case hex digits.
  [[nodiscard]] const std::string& certificate_sha256() const;

  struct Content;  // the library's own

 private:
  friend struct TheoremMaker;
  explicit Theorem(std::shared_ptr<const Content> content);
  std::shared_ptr<const Content> content_;
};

/// A stretch of an audited path that is not proved.
struct Stretch {
  Place begin, end;                                       ///< outside of them a refuted path is proved
  std::optional<std::pair<Witness, Witness>> violations;  ///< the first and the last proved one
  std::string reason;                                     ///< why it is open; empty where there are violations
  std::string reason_code;                                ///< "U5": `taut explain` has more about it; may be empty
};

/// A pose of a path in floating point. For plots: nothing here is proved. Of a move, tensions are those with the load's
/// inertia at that time.
struct Sample {
  double position = 0;  ///< k + s: the point s of segment k
  std::array<double, 3> p_m{};
  std::array<double, 4> quaternion{};       ///< x, y, z, w
  bool is_singular = false;                 ///< then tensions mean nothing
  std::array<double, 6> tension_lower_N{};  ///< over all wrenches of the ellipsoid
  std::array<double, 6> tension_upper_N{};
  std::array<double, 6> length_m{};
  std::optional<double> time_s;  ///< of a move: when
};

/// How plan() made a move; nothing of this is in the certificate. Shares are of the speed of the law that was proved
/// first.
struct MovePlan {
  double planned_s = 0;             ///< how long that law takes
  double speed_share = 1;           ///< at which the move runs
  std::optional<double> fastest_s;  ///< the fastest law without a limit of jerk, in floating point; if one was found
  std::size_t tries = 0;            ///< laws that were to be proved
  /// Where the greatest speed was sought: the smallest share that was refuted, if any, and what is violated then.
  std::optional<double> refuted_share;
  std::optional<Witness> witness;
};

/// A claim with all that is needed to prove it again (docs/certificate-format.md). Copies are cheap.
///
/// A certificate that was loaded or parsed is one whose digest fits, no more: unless it claims nothing it is unchecked,
/// and whether it is true is check()'s to say.
class TAUT_EXPORT Certificate {
 public:
  /// @throws InputError where the file can't be read, is no certificate, or was cut or altered.
  [[nodiscard]] static Certificate load(const std::string& file);
  /// @param name  stands for the file in messages
  [[nodiscard]] static Certificate parse(const std::string& text, const std::string& name = "certificate");

  /// Writes the file as a whole, or not at all. @throws InputError
  void save(const std::string& file) const;
  /// What a file of it holds, byte for byte: JSON.
  [[nodiscard]] const std::string& text() const;

  /// The theorem that the checker made of this text for plan(), prove() or audit(); nothing of a certificate that was
  /// loaded.
  [[nodiscard]] std::optional<Theorem> theorem() const;
  [[nodiscard]] Verdict verdict() const;               ///< the theorem's; kUndecided or kUnchecked without one
  [[nodiscard]] const std::string& case_name() const;  ///< free text
  /// As Case::document_fields(), from the certificate's illustration: free text, no part of the claim.
  [[nodiscard]] std::vector<std::pair<std::string, std::string>> document_fields() const;
  [[nodiscard]] std::vector<Stretch> stretches() const;  ///< of an audit that is not proved; none of an unchecked one
  [[nodiscard]] const std::string& reason() const;       ///< only if undecided
  [[nodiscard]] std::string reason_code() const;         ///< "U5": `taut explain` has more about it; may be empty
  /// Of a certificate that no path exists: the waypoint of the query from which no motion leads to the next. Such a
  /// certificate has no path, no segments and no samples.
  [[nodiscard]] std::optional<std::size_t> no_path_from() const;
  /// What stands in the way of a proof, or how far it reaches: JSON (docs/sensitivity.md), or empty where that was not
  /// sought; of legs what is provable in all of them. The program that wrote the certificate says so; it is no part of
  /// the claim, and nothing checks it.
  [[nodiscard]] std::string headroom() const;
  [[nodiscard]] Path path() const;  ///< bit for bit
  /// Of a certificate of legs: their names, and each as a certificate of its own, with a theorem where there is one of
  /// it. None of any other. A certificate of legs has no path, samples, margins or witness: its legs have.
  [[nodiscard]] std::vector<std::pair<std::string, Certificate>> legs() const;
  /// How long the move takes, or all legs together; nothing of a path without a law in time.
  [[nodiscard]] std::optional<double> duration_s() const;
  /// How plan() made the move; nothing of what it did not make, and of a certificate that was loaded.
  [[nodiscard]] std::optional<MovePlan> move_plan() const;
  /// As `taut plan` writes it of a proved path, for a machine to follow; its last line names this certificate's
  /// SHA-256.
  [[nodiscard]] std::string path_csv() const;
  /// controller.csv, as `taut plan` writes it of a proved path: poses and cable lengths so dense that neither the
  /// platform's origin nor a cable's end on it travels more than `step_m` [m] from row to row. The rows are on the path
  /// that is proved but for rounding; what a controller does between them is not proved.
  /// @throws InputError unless the theorem is there and says "proved", and `step_m` is from 1e-9 to 1e6, and enough for
  /// 200,000 rows.
  [[nodiscard]] std::string controller_csv(double step_m = 0.01) const;
  /// A proved move in time, for the drives that follow it (docs/moves.md): t; lengths l1 … l6 [m], and their first two
  /// derivatives v1 … [m/s] and a1 … [m/s^2]; and fmin1 … and fmax1 … [N], between which each tension is proved to be
  /// from the row to the next, for all loads and deviations. Rows are at t = 0, 1/rate, 2/rate, … and where the move
  /// ends. They are on the move but for rounding; what drives do between them is proved where the case says so
  /// (between_rows). Of legs, times go on from leg to leg.
  /// @throws InputError unless the theorem is there and says "proved" of a move, and `rate_Hz` is above 0, at most
  /// 10,000, and low enough for 500,000 rows.
  [[nodiscard]] Table winches(double rate_Hz = 100) const;
  /// The same rows as poses: t, px, py, pz [m], qx, qy, qz, qw. @throws  as winches()
  [[nodiscard]] Table poses(double rate_Hz = 100) const;
  /// The same as the files that `taut plan` writes at this rate: winches.csv, poses.csv and poses.tum.
  /// @throws  as winches()
  [[nodiscard]] std::string winches_csv(double rate_Hz = 100) const;
  [[nodiscard]] std::string poses_csv(double rate_Hz = 100) const;
  [[nodiscard]] std::string poses_tum(double rate_Hz = 100) const;
  [[nodiscard]] std::size_t segments() const;
  [[nodiscard]] std::size_t boxes() const;  ///< pieces of the proof; of no path, cells without a feasible pose

  /// About so many poses along the path, in order, with both ends; of a move equally spaced in time.
  [[nodiscard]] std::vector<Sample> samples(std::size_t about = 200) const;

  struct Content;  // the library's own
  [[nodiscard]] const Content& content() const { return *content_; }
  explicit Certificate(std::shared_ptr<const Content> content);

 private:
  std::shared_ptr<const Content> content_;
};

// --- What taut does --------------------------------------------------------------------------------------------------

struct Progress {
  /// "planning", "proving the move", "auditing", "seeking provable shares" or "trying changes"
  const char* stage = "";
  std::size_t done = 0;   ///< charts made, laws tried, segments judged, shares found, or changes tried
  std::size_t total = 0;  ///< 0: nobody knows
};

/// Called every now and then, by one thread at a time, which need not be the caller's.
using ProgressCallback = std::function<void(const Progress&)>;

/// The checker's budget if nobody says [s]: a check takes about as long as the proof did.
inline constexpr double kCheckSeconds = 300;

/// The budget for finding what stands in the way of a proof, or how far it reaches, if nobody says [s].
inline constexpr double kHeadroomSeconds = 30;

/// The budget for proving that no path exists, where the search found none, if nobody says [s].
inline constexpr double kNoPathSeconds = 10;

struct PlanOptions {
  double budget_seconds = 0;    ///< for planning and proving; 0: the case's own
  std::string atlas;            ///< begin with the charts of this file (docs/atlas-file.md); empty: with none
  std::string save_atlas;       ///< write all charts into this file; empty: into none
  bool grow = false;            ///< make all charts that can be reached before they are saved
  std::string signing_key_pem;  ///< sign the certificate with this Ed25519 private key; empty: don't
  ProgressCallback progress = {};
  /// Asks for the best path so far: without one the certificate says undecided, "interrupted".
  std::stop_token stop = {};
  double max_check_seconds = kCheckSeconds;    ///< that the checker may take before the certificate is unchecked
  double headroom_seconds = kHeadroomSeconds;  ///< for finding provable shares; 0: they are not sought
  double no_path_seconds = kNoPathSeconds;     ///< for proving that no path exists; 0: that is not tried
  /// Of a move: run it at this share of the planned speed, from 0.001 to 1, or slower where that is not proved.
  double speed_share = 1;
  /// Of a move: run its law as fast as that is proved, and seek what stands in the way of more. Goes with share 1.
  bool greatest_speed = false;
};

/// Plans through the case's query and proves the path: `taut plan`. In a case with the key `time` it is a move. Where
/// the search finds no path, it tries to prove that none exists (kNoPath); where that is not proved either, the case is
/// undecided. A case of legs has one certificate over all legs; budgets are for each, and that no path exists is not
/// tried to prove.
/// @throws InputError, also where the case has no query, a speed is asked for and the case has no key `time`, or a case
/// of legs is given an atlas.
[[nodiscard]] TAUT_EXPORT Certificate plan(const Case& the_case, const PlanOptions& options = {});

struct ProveOptions {
  long max_bits = 4096;  ///< precision beyond which the prover gives up; 128 at least
  std::string signing_key_pem;
  std::stop_token stop = {};
  double max_check_seconds = kCheckSeconds;  ///< that the checker may take before the certificate is unchecked
};

/// Proves a path that the caller has made. One that is not proved is refuted at the first violation found, or undecided
/// at the first piece that is: audit() tells of all. The case's query has no part in it. A path with a law in time is
/// proved as a move, one without as passed slowly, also where the case limits moves.
/// @throws InputError where the path does not fit the case; Interrupted.
[[nodiscard]] TAUT_EXPORT Certificate prove(const Case& the_case, const Path& path, const ProveOptions& options = {});

/// How far rows of a table with times may be from the move that is fitted to them: of poses a position and an angle, of
/// cable lengths a length. What is not stated is 0.
struct Rounding {
  double position_m = 0;  ///< by which the platform's origin may be displaced
  double angle_rad = 0;   ///< by which the platform may be turned
  double length_m = 0;    ///< by which each cable may be longer or shorter
};

struct AuditOptions {
  std::optional<Interpolation> interpolation;  ///< nothing: as the file suggests
  long max_bits = 4096;                        ///< precision beyond which the prover gives up; 128 at least
  std::string signing_key_pem;
  ProgressCallback progress = {};
  std::stop_token stop = {};
  double max_check_seconds = kCheckSeconds;    ///< that the checker may take before the certificate is unchecked
  double headroom_seconds = kHeadroomSeconds;  ///< for finding provable shares; 0: they are not sought
  /// Audit a move in time, in a case with the key `time`: a certificate's path with its law, or a move that is fitted
  /// to a table with times, within `rounding` of all its rows (docs/audits.md). There are no stretches then,
  /// and no provable shares.
  bool timed = false;
  std::optional<Rounding> rounding = {};  ///< of a table; nothing: the case's own
};

/// Proves a path or says of every stretch that is not proved where it is and why: `taut audit`. The path is passed
/// slowly, also where the case limits moves, unless it is audited in time. Memory grows with the path here; the
/// command's does not.
/// @throws InputError with the file's line where the path is wrong, or no move is within the rounding; Interrupted.
[[nodiscard]] TAUT_EXPORT Certificate audit(const Case& the_case, const std::string& path_file,
                                            const AuditOptions& options = {});
/// A table of the caller's. @param name  stands for the file in messages, whose line 1 are the columns, and in the
/// certificate
[[nodiscard]] TAUT_EXPORT Certificate audit(const Case& the_case, const Table& table, const AuditOptions& options = {},
                                            const std::string& name = "table");
/// The path that the case itself names.
[[nodiscard]] TAUT_EXPORT Certificate audit(const Case& the_case, const AuditOptions& options = {});

struct SensitivityOptions {
  std::optional<Interpolation> interpolation;  ///< of a path file; nothing: as the file suggests
  double budget_seconds = 60;                  ///< for what follows the plan: shares and changes
  ProgressCallback progress = {};
  std::stop_token stop = {};
};

/// What to change so that the path is proved, as JSON (docs/sensitivity.md): `taut sensitivity`. The path is that which
/// the case names, else a plan; where none is found, the straight way through the query's waypoints.
/// @throws InputError; Interrupted.
[[nodiscard]] TAUT_EXPORT std::string sensitivity(const Case& the_case, const SensitivityOptions& options = {});
/// Of the path in a file.
[[nodiscard]] TAUT_EXPORT std::string sensitivity(const Case& the_case, const std::string& path_file,
                                                  const SensitivityOptions& options = {});

enum class Outcome {
  kAccepted,   ///< the claim, "proved" or "refuted", was proved again
  kRejected,   ///< a statement could not be confirmed, or is about another case, or by another signer, than was asked
  kUndecided,  ///< well formed, and the certificate itself claims nothing
  kUnchecked,  ///< well formed, but the budget ran out: nothing is known of its claim
  kMalformed   ///< unreadable, cut, altered, or no certificate
};

struct CheckResult {
  Outcome outcome = Outcome::kMalformed;
  std::string message;             ///< one line
  std::optional<Theorem> theorem;  ///< present exactly where accepted
  std::string signer;              ///< public key whose signature was verified, 64 hex digits, or empty
  bool is_trusted = false;         ///< whether the signer is one of those asked for
  std::size_t segments = 0;
  std::size_t boxes = 0;
  /// "case" or "path file" where the certificate was not compared with one, and what of the case does not matter to an
  /// audit.
  std::vector<std::string> not_compared;
};

struct CheckOptions {
  std::optional<Case> the_case = {};               ///< that the certificate must be about, to the last digit
  std::vector<std::string> trusted_keys_pem = {};  ///< unless empty: Ed25519 public keys, one of which must have signed
  std::stop_token stop = {};
  std::optional<double> max_seconds = {};  ///< budget; nothing: no end
};

/// Proves a certificate again, by the independent checker: what `taut-check` says. Takes the text, since a certificate
/// may be no certificate. Who wants to rely on it should run taut-check: it is another program, and small.
/// @throws InputError for keys; Interrupted. Never because of what the text says.
[[nodiscard]] TAUT_EXPORT CheckResult check(const std::string& certificate_text, const CheckOptions& options = {});
[[nodiscard]] TAUT_EXPORT CheckResult check(const Certificate& certificate, const CheckOptions& options = {});

enum class ReportFormat { kHtml, kText, kMarkdown, kJson };

struct ReportOptions {
  ReportFormat format = ReportFormat::kHtml;
  std::string document;  ///< its number; empty: one made from the certificate's digest
  std::string revision;  ///< empty: a line to write on
  std::string date;      ///< empty: today in UTC, or the day of SOURCE_DATE_EPOCH
  std::stop_token stop = {};
  double max_check_seconds = kCheckSeconds;  ///< that the checker may take; else the page is headed UNCHECKED
};

/// A page for people, made from the certificate alone: `taut report`. UTF-8. The checker proves the certificate again
/// first, unless it has a theorem already.
/// @throws InputError where the checker rejects the certificate, or a report can't show what is in it; Interrupted,
/// before the page is made.
[[nodiscard]] TAUT_EXPORT std::string report(const Certificate& certificate, const ReportOptions& options = {});

}  // namespace v0
}  // namespace taut
