// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/measurements.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>

#include "base/input_error.h"
#include "base/sanitize.h"
#include "problem/scalar.h"
#include "problem/units.h"

namespace taut {
namespace {

constexpr std::size_t kMostLineBytes = std::size_t{1} << 16U;
constexpr std::size_t kChunk = std::size_t{1} << 16U;
constexpr int kWait_ms = 100;        // after which it is seen whether somebody asked to stop
constexpr double kAbsurd = 1e12;     // no time, length or force is as large, in SI units
constexpr double kLeastTurn = 1e-3;  // of the length of a quaternion
constexpr const char* kExpected = "t, L1 … L6, px, py, pz, qx, qy, qz, qw, f1 … f6";

std::string_view without_blanks(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r";
  const std::size_t begin = text.find_first_not_of(kBlanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlanks) - begin + 1);
}

void split(std::string_view line, char delimiter, std::vector<std::string_view>& cells) {
  cells.clear();
  for (;;) {
    const std::size_t size = std::min(line.find(delimiter), line.size());
    cells.push_back(without_blanks(line.substr(0, size)));
    if (size == line.size()) return;
    line.remove_prefix(size + 1);
  }
}

InputError unreadable(const std::string& name) {
  return {ErrorCode::kFile, fmt::format("{}: could not be read: {}", name, std::strerror(errno)), {name}};
}

}  // namespace

LineReader::LineReader(const std::string& path) : name_(path == "-" ? "standard input" : path) {
  if (path == "-") {
    descriptor_ = STDIN_FILENO;
    return;
  }
  descriptor_ = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor_ < 0) throw unreadable(name_);
  is_ours_ = true;
}

LineReader::~LineReader() {
  if (is_ours_) close(descriptor_);
}

bool LineReader::refill(const std::stop_token& stop) {
  buffer_.erase(0, at_);
  at_ = 0;
  while (!stop.stop_requested()) {
    pollfd waiting{descriptor_, POLLIN, 0};
    const int ready = poll(&waiting, 1, kWait_ms);
    if (ready < 0 && errno != EINTR) throw unreadable(name_);
    if (ready <= 0) continue;
    const std::size_t before = buffer_.size();
    buffer_.resize(before + kChunk);
    const ssize_t count = ::read(descriptor_, buffer_.data() + before, kChunk);
    buffer_.resize(before + static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
    if (count < 0 && errno != EINTR && errno != EAGAIN) throw unreadable(name_);
    if (count == 0) at_end_ = true;
    if (count >= 0) return true;
  }
  return false;
}

LineReader::Status LineReader::next(std::string_view& line, const std::stop_token& stop) {
  for (std::size_t searched = at_;;) {
    const std::size_t end = buffer_.find('\n', searched);
    if (end != std::string::npos) {
      line = std::string_view(buffer_).substr(at_, end - at_);
      at_ = end + 1;
      ++number_;
      const bool is_too_long = skips_ || line.size() > kMostLineBytes;
      skips_ = false;
      return is_too_long ? Status::kTooLong : Status::kLine;
    }
    if (at_end_) {
      line = std::string_view(buffer_).substr(at_);
      at_ = buffer_.size();
      if (line.empty() && !skips_) return Status::kEnd;
      ++number_;
      skips_ = false;
      return Status::kCut;
    }
    if (buffer_.size() - at_ > kMostLineBytes) {  // the rest of it is not kept
      at_ = buffer_.size();
      skips_ = true;
    }
    const std::size_t left = buffer_.size() - at_;
    if (!refill(stop)) return Status::kInterrupted;
    searched = left;
  }
}

MeasurementTable::Column MeasurementTable::column(std::string_view cell, const std::string& place) const {
  const auto fail = [&](const std::string& expected) {
    return InputError(ErrorCode::kPath,
                      fmt::format("{}: got the column '{}', expected {}", place, excerpt(cell), expected));
  };
  const std::size_t open = cell.find('[');
  std::string name(without_blanks(cell.substr(0, open)));
  Column result;
  result.role = Role::kIgnored;
  result.name = name;
  std::ranges::transform(name, name.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  Dimension dimension = Dimension::kLength;
  const bool is_numbered = name.size() == 2 && name[1] >= '1' && name[1] <= '6';
  const auto number = [&](std::string_view names) { return names.find(name[1]); };
  const bool is_commanded_rate = is_numbered && (name[0] == 'v' || name[0] == 'a');
  const bool is_proved_tension = name.size() == 5 && (name.starts_with("fmin") || name.starts_with("fmax")) &&
                                 name.back() >= '1' && name.back() <= '6';
  if (name == "segment" || name == "s" || is_commanded_rate || is_proved_tension) return result;
  if (name == "t" || name == "time") {
    result.role = Role::kTime;
    dimension = Dimension::kTime;
  } else if (is_numbered && (name[0] == 'l' || name[0] == 'f')) {
    result.role = name[0] == 'l' ? Role::kLength : Role::kTension;
    result.index = static_cast<std::size_t>(name[1] - '1');
    if (name[0] == 'f') dimension = Dimension::kForce;
  } else if (name.size() == 2 && name[0] == 'p' && number("xyz") != std::string_view::npos) {
    result.role = Role::kPosition;
    result.index = number("xyz");
  } else if (name.size() == 2 && name[0] == 'q' && number("xyzw") != std::string_view::npos) {
    result.role = Role::kTurn;
    result.index = number("xyzw");
  } else {
    throw fail(fmt::format("one of {}, with its unit in brackets or in SI units", kExpected));
  }
  if (open == std::string_view::npos) return result;
  const std::string_view rest = cell.substr(open + 1);
  const std::string unit_name(without_blanks(rest.substr(0, rest.find(']'))));
  const std::optional<Unit> unit = find_unit(unit_name);
  const bool fits = rest.ends_with(']') && unit && unit->dimension == dimension && result.role != Role::kTurn;
  if (!fits) {
    throw fail(result.role == Role::kTurn ? "no unit" : "a unit in brackets, one of " + unit_names(dimension));
  }
  result.to_si = ScalarTraits<double>::from_decimal(unit->factor.text());
  return result;
}

MeasurementTable::MeasurementTable(std::string_view line, const std::string& file, std::size_t number) {
  const std::string place = fmt::format("{}:{}", file, number);
  const auto fail = [&](const std::string& message) {
    return InputError(ErrorCode::kPath, fmt::format("{}: {}", place, message), {file, number});
  };
  if (line.starts_with("\xEF\xBB\xBF")) line.remove_prefix(3);  // byte order mark
  delimiter_ = line.find(';') != std::string_view::npos ? ';' : line.find('\t') != std::string_view::npos ? '\t' : ',';
  split(line, delimiter_, cells_);
  std::array<bool, 3> position{};
  std::array<bool, 4> turn{};
  std::array<bool, kCables> length{}, tension{};
  const auto mark = [&](bool& seen, const Column& column) {
    if (seen) throw fail(fmt::format("got the column '{}' twice, expected each once", excerpt(column.name)));
    seen = true;
  };
  for (const std::string_view cell : cells_) {
    const Column& added = columns_.emplace_back(column(cell, place));
    switch (added.role) {
      case Role::kIgnored: break;
      case Role::kTime: mark(has_time_, added); break;
      case Role::kLength: mark(length[added.index], added); break;
      case Role::kTension: mark(tension[added.index], added); break;
      case Role::kPosition: mark(position[added.index], added); break;
      case Role::kTurn: mark(turn[added.index], added); break;
    }
  }
  const auto count = [](const auto& flags) { return std::ranges::count(flags, true); };
  const auto of_pose = count(position) + count(turn);
  has_pose_ = of_pose == 7;
  lengths_ = static_cast<std::size_t>(count(length));
  tensions_ = static_cast<std::size_t>(count(tension));
  if (of_pose != 0 && !has_pose_) throw fail("got a part of a pose, expected px, py, pz, qx, qy, qz and qw");
  if (lengths_ == 0 && !has_pose_) {
    throw fail("got neither lengths nor a pose, expected some of L1 … L6, or px, py, pz, qx, qy, qz and qw");
  }
}

std::optional<MeasuredRow> MeasurementTable::read(std::string_view line, std::string& complaint) {
  split(line, delimiter_, cells_);
  const auto refuse = [&](const std::string& message) {
    complaint = message;
    return std::nullopt;
  };
  if (cells_.size() != columns_.size()) {
    return refuse(fmt::format("got {} fields, expected {}", cells_.size(), columns_.size()));
  }
  MeasuredRow row;
  std::array<double, 3> position{};
  std::array<double, 4> turn{};
  for (std::size_t k = 0; k < columns_.size(); ++k) {
    const Column& column = columns_[k];
    if (column.role == Role::kIgnored) continue;
    std::string_view cell = cells_[k];
    if (cell.starts_with('+')) cell.remove_prefix(1);
    double value = 0;
    const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
    const bool is_number = error == std::errc() && end == cell.data() + cell.size() && std::isfinite(value);
    value *= column.to_si;
    if (!is_number || std::abs(value) > kAbsurd) {
      return refuse(fmt::format("{}: got '{}', expected a number", column.name, excerpt(cells_[k])));
    }
    switch (column.role) {
      case Role::kIgnored: break;
      case Role::kTime: row.time_s = value; break;
      case Role::kLength:
        if (!(value > 0)) {
          return refuse(fmt::format("{}: got '{}', expected a length above 0", column.name, excerpt(cells_[k])));
        }
        row.length_m[column.index] = value;
        break;
      case Role::kTension: row.tension_N[column.index] = value; break;
      case Role::kPosition: position[column.index] = value; break;
      case Role::kTurn: turn[column.index] = value; break;
    }
  }
  if (has_pose_) {
    row.pose = RigidPose{{position[0], position[1], position[2]}, {turn[3], turn[0], turn[1], turn[2]}};
    if (!(row.pose->q.norm() > kLeastTurn)) return refuse("qx, qy, qz, qw: got all but 0, expected a quaternion");
  }
  if (row.time_s && last_time_s_ && *row.time_s < *last_time_s_) {
    return refuse(
        fmt::format("t: got {} s after {} s, expected a time that does not go back", *row.time_s, *last_time_s_));
  }
  last_time_s_ = row.time_s;
  return row;
}

std::string MeasurementTable::columns() const {
  std::vector<std::string> names, left_out;
  for (const Column& column : columns_) (column.role == Role::kIgnored ? left_out : names).push_back(column.name);
  const std::string read = fmt::format("{}", fmt::join(names, ", "));
  return left_out.empty() ? read : fmt::format("{} (left out: {})", read, fmt::join(left_out, ", "));
}

}  // namespace taut
