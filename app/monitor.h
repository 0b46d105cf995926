// SPDX-License-Identifier: GPL-3.0-or-later
// Watches a proved move while it is executed: rows of measurements in, and whether the machine is outside what was
// proved. No input, no output: cli/monitor_command.h reads rows and prints.
//
// What a row is held to is a necessary condition of what the theorem assumes: some place on the path, and some machine,
// load and gauge errors within what is stated, for which all of the row's numbers come out. An alarm says that there
// are none, so that there is none while the assumptions hold. docs/monitor.md has each condition with its derivation.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "app/place_table.h"
#include "app/proved_path.h"
#include "app/wrench_test.h"

namespace taut {

/// What gauges may be off by.
struct GaugeErrors {
  double length_m = 0, tension_N = 0, position_m = 0, orientation_rad = 0, time_s = 0;
};

struct MeasuredRow {
  std::optional<double> time_s;
  std::array<std::optional<double>, kCables> length_m{}, tension_N{};
  std::optional<RigidPose> pose;  ///< q of any length but 0
};

enum class AlarmKind {
  kLength,       ///< of a cable: no place on the path has it
  kPosition,     ///< no place on the path is so near
  kOrientation,  ///< likewise
  kAhead,        ///< it has come farther than the law allows in the time that has passed
  kBackwards,    ///< it is behind where it has been
  kWinchSpeed,   ///< of a cable
  kTension,      ///< of a cable
  kLoad,         ///< the wrench that all tensions take up
};
inline constexpr std::size_t kAlarmKinds = 8;
/// "length", "position", "orientation", "ahead of the law", "backwards", "winch speed", "tension", "load".
[[nodiscard]] const char* name(AlarmKind kind);

struct Alarm {
  AlarmKind kind = AlarmKind::kLength;
  int cable = -1;  ///< 0…5 where it is of one
  /// [m, rad, s, N]; of a position and an orientation how far off; of kAhead the time that the law takes; of kBackwards
  /// the place; of kWinchSpeed by how much the length has changed; of kLoad how far from the nominal load.
  double measured = 0;
  double lower = 0;  ///< what is allowed, likewise
  double upper = 0;
  double over_s = 0;                    ///< of kWinchSpeed: the time in which it has
  bool is_alone = false;                ///< of a length or a pose: all other measurements fit a place
  std::optional<LoadGuess> guess = {};  ///< of kLoad
};

/// Largest residuals, as shares of what is allowed; negative where nothing was compared.
struct ResidualShares {
  double place = -1;    ///< of lengths and pose, at the place that fits best
  double tension = -1;  ///< of how far a tension may be from the middle of its range
  double load = -1;
};

struct RowVerdict {
  std::optional<double> place;   ///< on the path, counting segments; nothing where nothing says where
  std::optional<double> law_s;   ///< when the law is there first [s]; of a move
  std::optional<double> lead_s;  ///< law_s less the row's time: negative where it lags
  ResidualShares shares;
  std::vector<Alarm> alarms;
  [[nodiscard]] bool is_good() const { return alarms.empty(); }
};

class Monitor {
 public:
  /// Encloses the path's tensions anew, on all cores: some tenths of a second.
  /// @throws InputError as make_model()
  Monitor(ProvedPath proved, const GaugeErrors& errors);

  /// Of the next row. @pre all numbers are finite; its time, if it has one, is not before the last row's; lengths or a
  /// pose are there.
  [[nodiscard]] RowVerdict judge(const MeasuredRow& row);

  [[nodiscard]] const ProvedPath& proved() const { return proved_; }
  [[nodiscard]] bool is_move() const { return proved_.path.timing.has_value(); }
  [[nodiscard]] bool is_length_controlled() const { return tolerances_.cable_length.has_value(); }
  [[nodiscard]] std::size_t cells() const { return table_.cells(); }
  /// How far a measured length may be from that of the place, the gauge's error included [m].
  [[nodiscard]] const std::array<double, kCables>& length_allowed() const { return length_allowed_; }
  [[nodiscard]] double position_allowed() const { return tolerances_.position + errors_.position_m; }
  [[nodiscard]] double orientation_allowed() const { return tolerances_.orientation + errors_.orientation_rad; }

 private:
  using Places = std::vector<PlaceInterval>;

  [[nodiscard]] PlaceTarget target_of(const MeasuredRow& row) const;
  [[nodiscard]] Places all_places(const PlaceTarget& target) const;
  /// Where it may be by now, of what it could reach since the last row.
  [[nodiscard]] Places reachable(double time_s) const;
  [[nodiscard]] Places places_among(const PlaceTarget& target, const Places& among) const;
  [[nodiscard]] const PlaceInterval& nearest(const Places& places) const;
  void add_off_path(const PlaceTarget& target, RowVerdict& verdict) const;
  [[nodiscard]] Alarm off_path_alarm(const PlaceTarget& target, std::size_t check, double s) const;
  void locate(const MeasuredRow& row, const PlaceTarget& target, Places& places, RowVerdict& verdict);
  void check_winches(const MeasuredRow& row, RowVerdict& verdict);
  [[nodiscard]] std::vector<Alarm> check_tensions(const MeasuredRow& row, const PlaceInterval& places, double s,
                                                  ResidualShares& shares) const;
  [[nodiscard]] std::vector<Alarm> check_load(const MeasuredRow& row, const PlaceInterval& places, double s,
                                              ResidualShares& shares) const;
  [[nodiscard]] double first_time(double s) const;
  [[nodiscard]] double last_time(double s) const;

  ProvedPath proved_;
  GaugeErrors errors_;
  PoseSampler sampler_;
  ToleranceNumbers tolerances_;
  std::array<double, kCables> length_allowed_{};  ///< of measured lengths, then
  std::array<double, kCables> pose_allowed_{};    ///< of those that a measured pose has, of length-controlled machines
  std::array<std::optional<double>, kCables> winch_speed_;
  PlaceTable table_;
  WrenchTest load_;

  double last_place_ = 0;
  bool has_place_ = false;
  Places places_;  ///< where it may have been at the last row, of a move with times
  std::optional<double> last_time_s_;
  struct LengthAt {
    double time_s = 0, length_m = 0;
  };
  /// The rows with the least L − v t and with the greatest L + v t so far; v is the limit of a cable's speed.
  struct Envelope {
    LengthAt least, greatest;
  };
  std::array<std::optional<Envelope>, kCables> envelopes_;
};

}  // namespace taut
