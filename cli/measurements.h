// SPDX-License-Identifier: GPL-3.0-or-later
// Rows of measurements, as they come: a table with a header, from a file, a pipe or standard input.
#pragma once

#include <array>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "app/monitor.h"

namespace taut {

/// Lines of a file or a pipe, each as soon as it is complete.
class LineReader {
 public:
  /// @param path  "-": standard input. @throws InputError where it can't be opened.
  explicit LineReader(const std::string& path);
  ~LineReader();
  LineReader(const LineReader&) = delete;
  LineReader& operator=(const LineReader&) = delete;

  enum class Status {
    kLine,
    kCut,      ///< the last line, without a line end
    kTooLong,  ///< and left out
    kEnd,
    kInterrupted,  ///< `stop` asked for it
  };
  /// Waits for the next line, which has no line end; it is valid until the next call. @throws InputError where reading
  /// fails.
  [[nodiscard]] Status next(std::string_view& line, const std::stop_token& stop);
  /// The number of the last line, from 1.
  [[nodiscard]] std::size_t number() const { return number_; }
  [[nodiscard]] const std::string& name() const { return name_; }

 private:
  [[nodiscard]] bool refill(const std::stop_token& stop);

  std::string name_;  ///< for messages
  int descriptor_ = -1;
  bool is_ours_ = false;
  std::string buffer_;
  std::size_t at_ = 0;  ///< where in the buffer the next line begins
  std::size_t number_ = 0;
  bool at_end_ = false, skips_ = false;
};

/// The header of a table, and what its rows say by it.
class MeasurementTable {
 public:
  /// @param line  "t[s],L1[mm],L2[mm],…": names of docs/monitor.md, each once, with units in brackets or SI without;
  /// commas, semicolons or tabs between; `segment`, `s`, `v1` and so on, of the planner's own tables, are left out.
  /// @throws InputError naming file and line.
  MeasurementTable(std::string_view line, const std::string& file, std::size_t number);

  /// One row; or what is wrong with it, in `complaint`. Its time has to be at or after the last good row's.
  [[nodiscard]] std::optional<MeasuredRow> read(std::string_view line, std::string& complaint);

  /// "t, L1, L2 (left out: v1)": the columns, in order.
  [[nodiscard]] std::string columns() const;
  [[nodiscard]] bool has_time() const { return has_time_; }
  [[nodiscard]] bool has_lengths() const { return lengths_ > 0; }
  [[nodiscard]] bool has_pose() const { return has_pose_; }
  [[nodiscard]] std::size_t tensions() const { return tensions_; }

 private:
  enum class Role { kIgnored, kTime, kLength, kTension, kPosition, kTurn };
  struct Column {
    Role role = Role::kIgnored;
    std::size_t index = 0;
    std::string name;
    double to_si = 1;
  };
  [[nodiscard]] Column column(std::string_view cell, const std::string& place) const;

  char delimiter_ = ',';
  std::vector<Column> columns_;
  std::vector<std::string_view> cells_;
  bool has_time_ = false, has_pose_ = false;
  std::size_t lengths_ = 0, tensions_ = 0;
  std::optional<double> last_time_s_;
};

}  // namespace taut
