// SPDX-License-Identifier: GPL-3.0-or-later
#include "path_io/path_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <span>
#include <utility>

#include "base/input_error.h"
#include "base/sanitize.h"
#include "problem/scalar.h"

namespace taut {
namespace {

constexpr std::size_t kMaxLineBytes = std::size_t{1} << 16U;
constexpr int kMaxHalfTurns = 1'000'000;     // certificates have the same limit
constexpr std::string_view kBlanks = " \t";  // a carriage return at the end of a line is removed before

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(kBlanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlanks) - begin + 1);
}

std::string join(const std::vector<std::string>& words) { return fmt::format("{}", fmt::join(words, ", ")); }

template <std::size_t N>
std::vector<std::string> names_of(const std::array<const char*, N>& names) {
  return {names.begin(), names.end()};
}

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

// --- Lines -----------------------------------------------------------------------------------------------------------

/// Reads lines in constant memory and checks that each is text.
class Lines {
 public:
  Lines(std::unique_ptr<std::istream> text, std::string file) : text_(std::move(text)), file_(std::move(file)) {}

  [[noreturn]] void fail(std::size_t line, const std::string& message, const std::string& column = {}) const {
    throw InputError(fmt::format("{}:{}: {}{}{}", file_, line, column, column.empty() ? "" : ": ", message),
                     {file_, line, column});
  }
  [[noreturn]] void fail(const std::string& message) const {
    throw InputError(fmt::format("{}: {}", file_, message), {file_});
  }

  /// Gets the next line that is neither blank nor a comment, without its end; it is valid until the next call. Returns
  /// false after the last line.
  bool next(std::string_view& line) {
    while (next_of_any_kind(line)) {
      const std::string_view content = trimmed(line);
      if (!content.empty() && content.front() != '#') return true;
    }
    return false;
  }
  [[nodiscard]] std::size_t number() const { return number_; }
  [[nodiscard]] std::uintmax_t bytes_read() const { return bytes_ - (end_ - at_); }

 private:
  bool next_of_any_kind(std::string_view& line) {
    line_.clear();
    bool any = false;
    while (at_ < end_ || refill()) {
      any = true;
      const char* const begin = buffer_.data() + at_;
      const auto* const stop = static_cast<const char*>(std::memchr(begin, '\n', end_ - at_));
      const std::size_t size = stop == nullptr ? end_ - at_ : static_cast<std::size_t>(stop - begin);
      line_.append(begin, size);
      at_ += size + (stop == nullptr ? 0 : 1);
      if (line_.size() > kMaxLineBytes) {
        fail(number_ + 1, fmt::format("got a line of more than {} bytes, expected a row of a path", kMaxLineBytes));
      }
      if (stop != nullptr) break;
    }
    if (!any) return false;
    ++number_;
    if (line_.ends_with('\r')) line_.pop_back();
    if (number_ == 1 && line_.starts_with("\xEF\xBB\xBF")) line_.erase(0, 3);  // byte order mark
    require_text();
    line = line_;
    return true;
  }

  bool refill() {
    if (!text_->good()) return false;
    text_->read(buffer_.data(), static_cast<std::streamsize>(buffer_.size()));
    if (text_->bad()) {
      throw InputError(ErrorCode::kFile, fmt::format("{}:{}: could not read on", file_, number_ + 1),
                       {file_, number_ + 1});
    }
    at_ = 0;
    end_ = static_cast<std::size_t>(text_->gcount());
    bytes_ += end_;
    return end_ > 0;
  }

  void require_text() const {
    const auto wrong = std::find_if(line_.begin(), line_.end(), [](char c) {
      const auto byte = static_cast<unsigned char>(c);
      return (byte < ' ' && c != '\t') || byte == 0x7F || byte == 0xFE || byte == 0xFF;
    });
    if (wrong == line_.end()) return;
    fail(number_, fmt::format("got the byte 0x{:02X}, expected text in UTF-8", static_cast<unsigned char>(*wrong)));
  }

  std::unique_ptr<std::istream> text_;
  std::string file_;
  std::vector<char> buffer_ = std::vector<char>(std::size_t{1} << 16U);
  std::size_t at_ = 0, end_ = 0;  ///< the part of the buffer that has not been handed out
  std::string line_;
  std::size_t number_ = 0;
  std::uintmax_t bytes_ = 0;
};

/// Splits a line at delimiters, or at runs of blanks if the delimiter is a space. Cells have no surrounding blanks or
/// quotes.
void split(std::string_view line, char delimiter, std::vector<std::string_view>& cells) {
  cells.clear();
  if (delimiter == ' ') {
    while (!(line = trimmed(line)).empty()) {
      const std::size_t size = std::min(line.find_first_of(kBlanks), line.size());
      cells.push_back(line.substr(0, size));
      line.remove_prefix(size);
    }
    return;
  }
  for (;;) {
    const std::size_t size = std::min(line.find(delimiter), line.size());
    std::string_view cell = trimmed(line.substr(0, size));
    if (cell.size() >= 2 && cell.front() == '"' && cell.back() == '"') cell = trimmed(cell.substr(1, cell.size() - 2));
    cells.push_back(cell);
    if (size == line.size()) return;
    line.remove_prefix(size + 1);
  }
}

// --- Columns ---------------------------------------------------------------------------------------------------------

/// The units that a column may have.
enum class Quantity { kLength, kAngle, kPlainAngle, kPure, kTime };

/// Units of time are known here only: case files have no times, and their t is a tonne.
std::optional<Unit> find_time_unit(std::string_view name) {
  for (const auto& [unit, factor] :
       {std::pair{"s", "1"}, {"ms", "1e-3"}, {"us", "1e-6"}, {"ns", "1e-9"}, {"min", "60"}}) {
    if (name == unit) return Unit{Dimension::kLength, unit, Decimal::parse(factor)};
  }
  return std::nullopt;
}

std::string expected_units(Quantity quantity) {
  switch (quantity) {
    case Quantity::kLength: return "a unit in brackets, one of " + unit_names(Dimension::kLength);
    case Quantity::kAngle: return "a unit in brackets, one of " + unit_names(Dimension::kAngle);
    case Quantity::kPlainAngle: return "no unit or one of " + unit_names(Dimension::kAngle);
    case Quantity::kTime: return "a unit in brackets, one of s, ms, us, ns, min";
    case Quantity::kPure: break;
  }
  return "no unit";
}

/// "px [mm]" is {"px", "mm"}.
struct Title {
  std::string name;
  std::string unit;
};

class Column {
 public:
  enum class Role { kIgnored, kIndex, kTime, kCoordinate, kHalfTurns, kStart };

  Column(Role role_, std::size_t index_, const Title& title, Unit unit)
      : role(role_), index(index_), name(title.name), to_si(std::move(unit)) {}

  [[nodiscard]] PathColumn description(const Title& title) const {
    constexpr double kRadiansPerDegree = 0.017453292519943295;
    const Unit& unit = to_si.unit();
    const double factor = ScalarTraits<double>::from_decimal(unit.factor.text());
    return {title.name, title.unit, unit.is_degree ? kRadiansPerDegree : factor};
  }

  Role role;
  std::size_t index;  ///< among the coordinates of its role
  std::string name;
  NearestSi to_si;
};

}  // namespace

// --- The reader ------------------------------------------------------------------------------------------------------

class PathFile::Implementation {
 public:
  Implementation(std::unique_ptr<std::istream> text, const std::string& name, const SpaceText& space)
      : lines_(std::move(text), name), space_(space), pose_names_(pose_names(space.angles.kind)) {
    header_.angles = space.angles;
    for (const Parameter& parameter : space.parameters) parameter_names_.push_back(parameter.name);
    std::string_view first;
    if (!lines_.next(first)) lines_.fail("got no rows, expected a path: a header and a row for each pose");
    if (trimmed(first).starts_with('{')) {
      lines_.fail(lines_.number(), "got '{', expected a table; a certificate's name ends in .json");
    }
    const std::string extension = std::filesystem::path(name).extension().string();
    const bool has_letters = std::any_of(first.begin(), first.end(),
                                         [](unsigned char c) { return std::isalpha(c) != 0 && c != 'e' && c != 'E'; });
    const bool has_delimiters = first.find_first_of(",;") != std::string_view::npos;
    const bool is_table = extension == ".csv" || extension == ".tsv" || has_letters || has_delimiters;
    if (extension == ".tum" || !is_table) {
      read_as_tum(first);
    } else {
      read_header(first);
    }
  }

  [[nodiscard]] const PathHeader& header() const { return header_; }
  [[nodiscard]] const std::vector<double>& start() const { return start_; }
  [[nodiscard]] std::uintmax_t bytes_read() const { return lines_.bytes_read(); }

  bool next(PathRow& row) {
    std::string_view line = first_row_;
    if (line.empty() && !lines_.next(line)) {
      if (rows_ == 0) lines_.fail("got a header and no rows, expected a row for each pose");
      return false;
    }
    split(line, delimiter_, cells_);
    read_row(row);
    first_row_.clear();
    ++rows_;
    last_time_s_ = row.time_s;
    last_line_ = row.line;
    return true;
  }

 private:
  /// Reports a fault in the current line.
  [[noreturn]] void fail(const std::string& column, const std::string& message) const {
    lines_.fail(lines_.number(), message, column);
  }

  // --- Headers -------------------------------------------------------------------------------------------------------

  void read_as_tum(std::string_view first) {
    delimiter_ = ' ';
    split(first, delimiter_, cells_);
    constexpr std::size_t kTumCells = 8;
    if (cells_.size() != kTumCells) {
      fail("", fmt::format("got '{}', expected a header such as {}, or the eight numbers of TUM: t x y z qx qy qz qw",
                           excerpt(first), header_of_poses()));
    }
    header_.format = PathFormat::kTum;
    header_.form = PathForm::kQuaternion;
    add(Column::Role::kTime, 0, {"t", "s"}, *find_time_unit("s"));
    for (std::size_t i = 0; i < kQuaternionNames.size(); ++i) {
      const Unit metre = si_unit(Dimension::kLength);  // the factor is 1, which is right for the quaternion, too
      add(Column::Role::kCoordinate, i, {kQuaternionNames[i], i < 3 ? "m" : ""}, metre);
    }
    first_row_ = std::string(first);
  }

  /// "px[mm],py[mm],pz[mm],phi[deg],theta[deg],sigma[deg]", in the case's angles.
  [[nodiscard]] std::string header_of_poses() const {
    std::string text;
    for (std::size_t i = 0; i < pose_names_.size(); ++i) {
      text += fmt::format("{}{}[{}]", i == 0 ? "" : ",", pose_names_[i], i < 3 ? "mm" : "deg");
    }
    return text;
  }

  [[nodiscard]] bool is_parameter(const std::string& name) const { return contains(parameter_names_, name); }

  /// Whether the column is the time. The case's own names have priority: if a parameter is called t, time is called
  /// time.
  [[nodiscard]] bool is_time(const std::string& name) const {
    return !is_parameter(name) && name == (is_parameter("t") ? "time" : "t");
  }

  /// The canonical name of a column: "time" becomes "t" and "d1" becomes "l1", unless the case has such parameters.
  [[nodiscard]] std::string canonical(const std::string& name) const {
    if (is_parameter(name)) return name;
    if (name == "time" && !is_parameter("t")) return "t";
    const bool is_length = name.size() == 2 && name[0] == 'd' && name[1] >= '1' && name[1] <= '6';
    const std::string as_length = is_length ? "l" + name.substr(1) : "";
    return is_length && !is_parameter(as_length) ? as_length : name;
  }

  [[nodiscard]] Title read_title(std::string_view cell) const {
    const std::size_t open = cell.find('[');
    Title title{std::string(trimmed(cell.substr(0, open))), ""};
    if (open != std::string_view::npos) {
      const std::string_view rest = cell.substr(open + 1);
      title.unit = std::string(trimmed(rest.substr(0, rest.find(']'))));
      if (!rest.ends_with(']') || rest.find(']') + 1 != rest.size() || title.unit.empty()) {
        fail("", fmt::format("got the column '{}', expected NAME[UNIT]", excerpt(cell)));
      }
    }
    return title;
  }

  void read_header(std::string_view line) {
    delimiter_ = line.find(';') != std::string_view::npos    ? ';'
                 : line.find('\t') != std::string_view::npos ? '\t'
                                                             : ',';
    split(line, delimiter_, cells_);
    std::vector<Title> titles;
    std::vector<std::string> names;
    for (const std::string_view cell : cells_) {
      titles.push_back(read_title(cell));
      Title& title = titles.back();
      title.name = canonical(title.name);
      if (title.name.empty()) fail("", fmt::format("got the column '{}', expected a name", excerpt(cell)));
      if (title.name.find_first_not_of("+-.0123456789eE ") == std::string::npos) {
        fail("", fmt::format("got '{}', expected a header such as {}", excerpt(line), header_of_poses()));
      }
      if (contains(names, title.name)) {
        fail("", fmt::format("got the column '{}' twice, expected each once{}", excerpt(title.name),
                             is_time(title.name) ? " (t and time are one)" : ""));
      }
      names.push_back(title.name);
    }
    if (names.front() == "waypoint" || names.front() == "control_point") {
      read_own_header(titles, names);
    } else {
      read_table_header(titles, names);
    }
  }

  void read_own_header(const std::vector<Title>& titles, const std::vector<std::string>& names) {
    header_.format = names.front() == "waypoint" ? PathFormat::kTautWaypoints : PathFormat::kTautControlPoints;
    // A move that was fitted to quaternions is in roll, pitch and yaw, whatever the case's angles are.
    const bool is_fitted = contains(names, "x.roll") && !is_parameter("roll");
    if (is_fitted) {
      header_.angles = {AngleKind::kRollPitchYaw};
      pose_names_ = pose_names(AngleKind::kRollPitchYaw);
    }
    // An audited path in pose coordinates.
    const bool is_of_poses = is_fitted || (contains(names, "x.px") && !is_parameter("px"));
    header_.form = is_of_poses ? PathForm::kAngles : PathForm::kParameters;
    const std::vector<std::string> coordinates = is_of_poses ? pose_names_ : parameter_names_;
    for (const std::string& coordinate : coordinates) {
      for (const std::string& name : {"x." + coordinate, "half_turns." + coordinate}) {
        if (!contains(names, name)) {
          fail("", fmt::format("got no column '{}', expected the parameters of the case: {}", name,
                               join(parameter_names_)));
        }
      }
    }
    const auto index_behind = [&](const std::string& name, const std::string& prefix) -> std::optional<std::size_t> {
      if (!name.starts_with(prefix)) return std::nullopt;
      const auto found = std::find(coordinates.begin(), coordinates.end(), name.substr(prefix.size()));
      if (found == coordinates.end()) return std::nullopt;
      return static_cast<std::size_t>(found - coordinates.begin());
    };
    const Unit one = si_unit(Dimension::kLength);
    for (std::size_t i = 0; i < titles.size(); ++i) {
      const std::string& name = names[i];
      const bool is_pose = contains(pose_names_, name);
      if (is_time(name)) {
        add(Column::Role::kTime, 0, titles[i], unit_of(titles[i], Quantity::kTime));
      } else if (const auto x = index_behind(name, "x.")) {
        add(Column::Role::kCoordinate, *x, {coordinates[*x], titles[i].unit}, unit_of(titles[i], Quantity::kPure));
      } else if (const auto turns = index_behind(name, "half_turns.")) {
        add(Column::Role::kHalfTurns, *turns, titles[i], unit_of(titles[i], Quantity::kPure));
      } else if (i == 0 || is_pose) {
        add(i == 0 ? Column::Role::kIndex : Column::Role::kIgnored, 0, titles[i], one);
      } else {
        fail("", fmt::format("got the unknown column '{}', expected x.NAME and half_turns.NAME with NAME one of {}",
                             excerpt(name), join(coordinates)));
      }
    }
  }

  /// A set of columns that together give a pose.
  struct PoseColumns {
    PathForm form;
    std::vector<std::string> names;
    std::string meaning;
  };

  [[nodiscard]] std::vector<PoseColumns> pose_columns() const {
    return {{PathForm::kParameters, parameter_names_, "the case's parameters"},
            {PathForm::kAngles, pose_names_, fmt::format("position and {}", angles_text(space_.angles.kind))},
            {PathForm::kQuaternion, names_of(kQuaternionNames), "position and quaternion"}};
  }

  void read_table_header(const std::vector<Title>& titles, const std::vector<std::string>& names) {
    const std::vector<PoseColumns> poses = pose_columns();
    const auto is_length = [&](const std::string& name) {
      return contains(names_of(kLengthNames), name) && !is_parameter(name);
    };
    // The place on the planned path, in controller.csv; it says nothing about the pose.
    const bool has_places =
        names.size() > 2 && names[0] == "segment" && names[1] == "s" && !is_parameter("segment") && !is_parameter("s");
    std::vector<std::string> coordinates;
    std::vector<std::string> lengths;
    for (const std::string& name : std::span(names).subspan(has_places ? 2 : 0)) {
      if (is_length(name)) {
        lengths.push_back(name);
      } else if (!is_time(name)) {
        coordinates.push_back(name);
      }
    }
    const PoseColumns* pose = nullptr;
    for (const PoseColumns& candidate : poses) {
      const bool fits = candidate.names.size() == coordinates.size() &&
                        std::all_of(coordinates.begin(), coordinates.end(),
                                    [&](const std::string& name) { return contains(candidate.names, name); });
      if (fits && pose == nullptr) pose = &candidate;
    }
    const bool has_lengths = !lengths.empty();
    const bool needs_pose = !has_lengths || !coordinates.empty();
    if (needs_pose && pose == nullptr) complain_of_columns(coordinates, poses);
    if (has_lengths && lengths.size() != kLengthNames.size()) {
      fail("",
           fmt::format("got the cable lengths {}, expected all of {}", join(lengths), join(names_of(kLengthNames))));
    }
    header_.form = has_lengths ? PathForm::kCableLengths : pose->form;
    if (has_lengths && pose != nullptr) header_.start = pose->form;
    for (std::size_t i = 0; i < titles.size(); ++i) {
      const std::string& name = names[i];
      if (has_places && i < 2) {
        add(Column::Role::kIgnored, 0, titles[i], unit_of(titles[i], Quantity::kPure));
      } else if (is_time(name)) {
        add(Column::Role::kTime, 0, titles[i], unit_of(titles[i], Quantity::kTime));
      } else if (is_length(name)) {
        const auto cable = static_cast<std::size_t>(name[1] - '1');
        add(Column::Role::kCoordinate, cable, titles[i], unit_of(titles[i], Quantity::kLength));
      } else {
        const auto at =
            static_cast<std::size_t>(std::find(pose->names.begin(), pose->names.end(), name) - pose->names.begin());
        add(has_lengths ? Column::Role::kStart : Column::Role::kCoordinate, at, titles[i],
            unit_of(titles[i], quantity(*pose, at)));
      }
    }
  }

  [[nodiscard]] Quantity quantity(const PoseColumns& pose, std::size_t at) const {
    if (pose.form == PathForm::kQuaternion) return at < 3 ? Quantity::kLength : Quantity::kPure;
    if (pose.form == PathForm::kAngles) return at < 3 ? Quantity::kLength : Quantity::kAngle;
    const Parameter& parameter = space_.parameters[at];
    for (std::size_t i = 0; i < pose_names_.size(); ++i) {
      if (parameter.name == pose_names_[i] && space_.pose[i] == pose_names_[i]) {
        return i < 3 ? Quantity::kLength : Quantity::kAngle;
      }
    }
    return parameter.kind == ParameterKind::kPeriodic ? Quantity::kAngle : Quantity::kPlainAngle;
  }

  [[noreturn]] void complain_of_columns(const std::vector<std::string>& seen,
                                        const std::vector<PoseColumns>& poses) const {
    std::string choices;
    const PoseColumns* nearest = nullptr;
    std::size_t most = 0;
    for (const PoseColumns& pose : poses) {
      choices += fmt::format("{} ({}), or ", join(pose.names), pose.meaning);
      const auto common = static_cast<std::size_t>(
          std::count_if(seen.begin(), seen.end(), [&](const std::string& name) { return contains(pose.names, name); }));
      if (common > most) {
        most = common;
        nearest = &pose;
      }
    }
    choices += "l1, l2, l3, l4, l5, l6 (cable lengths); and t, the time, or not";
    std::vector<std::string> unknown;
    for (const std::string& name : seen) {
      if (std::none_of(poses.begin(), poses.end(), [&](const auto& pose) { return contains(pose.names, name); })) {
        unknown.push_back(excerpt(name));
      }
    }
    const auto is_of_winches = [](const std::string& name) {
      if (name.empty() || name.back() < '1' || name.back() > '6') return false;
      const std::string what = name.substr(0, name.size() - 1);
      return what == "v" || what == "a" || what == "fmin" || what == "fmax";
    };
    if (!unknown.empty() && std::ranges::all_of(unknown, is_of_winches)) {
      fail("", fmt::format(
                   "got the column '{}', a rate of a winch, expected a path: of a winches.csv of taut its columns t "
                   "and l1 to l6 alone, or the poses.csv beside it",
                   unknown.front()));
    }
    if (!unknown.empty()) {
      const std::string hint = angles_hint(unknown.front(), space_.angles.kind);
      fail("", fmt::format("got the unknown column '{}', {}expected {}", unknown.front(), hint, choices));
    }
    std::vector<std::string> missing;
    for (const std::string& name : nearest != nullptr ? nearest->names : std::vector<std::string>{}) {
      if (!contains(seen, name)) missing.push_back(name);
    }
    fail("", fmt::format("got {}{}, expected {}", seen.empty() ? "no coordinates" : "the columns " + join(seen),
                         missing.empty() ? "" : " and no " + join(missing), choices));
  }

  [[nodiscard]] Unit unit_of(const Title& title, Quantity quantity) const {
    const auto complain = [&] {
      fail(excerpt(title.name),
           fmt::format("got {}, expected {}", title.unit.empty() ? "no unit" : "the unit '" + excerpt(title.unit) + "'",
                       expected_units(quantity)));
    };
    const bool may_be_bare = quantity == Quantity::kPure || quantity == Quantity::kPlainAngle;
    if (title.unit.empty()) {
      if (!may_be_bare) complain();
      return si_unit(Dimension::kAngle);
    }
    const std::optional<Unit> unit = quantity == Quantity::kTime ? find_time_unit(title.unit) : find_unit(title.unit);
    const bool fits = unit && quantity != Quantity::kPure &&
                      (quantity == Quantity::kTime ||
                       unit->dimension == (quantity == Quantity::kLength ? Dimension::kLength : Dimension::kAngle));
    if (!fits) complain();
    return *unit;
  }

  void add(Column::Role role, std::size_t index, const Title& title, Unit unit) {
    const Column& column = columns_.emplace_back(role, index, title, std::move(unit));
    if (role == Column::Role::kTime) header_.time = column.description(title);
    if (role == Column::Role::kStart) start_size_ = std::max(start_size_, index + 1);
    if (role != Column::Role::kCoordinate) return;
    header_.coordinates.resize(std::max(header_.coordinates.size(), index + 1));
    header_.coordinates[index] = column.description(title);
  }

  // --- Rows ----------------------------------------------------------------------------------------------------------

  void read_row(PathRow& row) {
    if (cells_.size() != columns_.size()) {
      fail("", fmt::format("got {} cells, expected {}, one for each column", cells_.size(), columns_.size()));
    }
    row.line = lines_.number();
    row.x.resize(header_.coordinates.size());
    row.half_turns.assign(row.x.size(), 0);
    row.time_s.reset();
    std::vector<double> start(start_size_);
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      const Column& column = columns_[i];
      const std::string_view cell = cells_[i];
      switch (column.role) {
        case Column::Role::kIgnored: break;
        case Column::Role::kIndex: read_index(column, cell); break;
        case Column::Role::kTime: row.time_s = read_time(column, cell); break;
        case Column::Role::kCoordinate: row.x[column.index] = read_coordinate(column, cell); break;
        case Column::Role::kHalfTurns: row.half_turns[column.index] = read_half_turns(column, cell); break;
        case Column::Role::kStart:
          if (rows_ == 0 || !cell.empty()) start[column.index] = read_number(column, cell);
          break;
      }
    }
    if (header_.form == PathForm::kQuaternion) require_unit_length(row.x);
    if (rows_ > 0) return;
    if (header_.start == PathForm::kQuaternion) require_unit_length(start);
    start_ = std::move(start);
  }

  template <class Read>
  auto in_cell(const Column& column, std::string_view cell, Read read) const {
    try {
      return read();
    } catch (const InputError& error) {  // "got …, expected …"
      const std::string message = error.what();
      const std::size_t expected = message.rfind(", expected");
      const bool has_comma = cell.find(',') != std::string_view::npos;
      fail(column.name,
           fmt::format("got '{}'{}{}", excerpt(cell),
                       expected == std::string::npos ? ", expected a decimal number" : message.substr(expected),
                       has_comma ? ", with a decimal point" : ""));
    }
  }

  [[nodiscard]] double read_number(const Column& column, std::string_view cell) const {
    return in_cell(column, cell, [&] { return column.to_si(cell); });
  }

  [[nodiscard]] double read_coordinate(const Column& column, std::string_view cell) const {
    const double value = read_number(column, cell);
    if (header_.form == PathForm::kCableLengths && !(value > 0)) {
      fail(column.name, fmt::format("got '{}', expected a cable length above 0", excerpt(cell)));
    }
    return value;
  }

  [[nodiscard]] Decimal read_time(const Column& column, std::string_view cell) {
    const Decimal time = in_cell(column, cell, [&] { return Decimal::parse(cell) * column.to_si.unit().factor; });
    if (rows_ > 0 && !(time > *last_time_s_)) {
      fail(column.name, fmt::format("got {} s behind the {} s of line {}, expected a later time", excerpt(time.text()),
                                    excerpt(last_time_s_->text()), last_line_));
    }
    return time;
  }

  [[nodiscard]] int read_whole(const Column& column, std::string_view cell, int most,
                               const std::string& expected) const {
    int value = 0;
    const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
    if (error != std::errc() || end != cell.data() + cell.size() || std::abs(value) > most) {
      fail(column.name, fmt::format("got '{}', expected {}", excerpt(cell), expected));
    }
    return value;
  }

  void read_index(const Column& column, std::string_view cell) const {
    const std::string expected = std::to_string(rows_);
    if (cell != expected) {
      fail(column.name, fmt::format("got '{}', expected {}: they are numbered from 0", excerpt(cell), expected));
    }
  }

  [[nodiscard]] int read_half_turns(const Column& column, std::string_view cell) const {
    const bool turns = header_.form == PathForm::kAngles
                           ? is_turn(header_.angles.kind, column.index)
                           : space_.parameters[column.index].kind == ParameterKind::kPeriodic;
    return read_whole(column, cell, turns ? kMaxHalfTurns : 0,
                      turns ? fmt::format("a whole number of at most {} either way", kMaxHalfTurns)
                            : "0, as the parameter is not periodic");
  }

  void require_unit_length(const std::vector<double>& x) const {
    const double norm = std::sqrt(x[3] * x[3] + x[4] * x[4] + x[5] * x[5] + x[6] * x[6]);
    if (std::abs(norm - 1) <= kNormTolerance) return;
    fail("", fmt::format(
                 "got the quaternion ({:.6g}, {:.6g}, {:.6g}, {:.6g}) of length {:.6g}, expected length 1 within {}",
                 x[3], x[4], x[5], x[6], norm, kNormTolerance));
  }

  Lines lines_;
  SpaceText space_;
  std::vector<std::string> parameter_names_;
  std::vector<std::string> pose_names_;  ///< px, py, pz and the case's angles
  PathHeader header_;
  std::vector<Column> columns_;
  char delimiter_ = ',';
  std::size_t start_size_ = 0;
  std::vector<double> start_;
  std::string first_row_;  ///< the line that told the format, if it is a row
  std::vector<std::string_view> cells_;
  std::optional<Decimal> last_time_s_;
  std::size_t last_line_ = 0;
  std::size_t rows_ = 0;
};

namespace {

std::unique_ptr<std::istream> open(const std::string& path) {
  errno = 0;
  auto file = std::make_unique<std::ifstream>(path, std::ios::binary);
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    throw InputError(ErrorCode::kFile, fmt::format("{}: got a directory, expected a path file", path), {path});
  }
  if (!*file) {
    throw InputError(ErrorCode::kFile, fmt::format("{}: could not read: {}", path, std::strerror(errno)), {path});
  }
  return file;
}

}  // namespace

PathFile::PathFile(const std::string& path, const SpaceText& space) : PathFile(open(path), path, space) {}
PathFile::PathFile(std::unique_ptr<std::istream> text, const std::string& name, const SpaceText& space)
    : self_(std::make_unique<Implementation>(std::move(text), name, space)) {}
PathFile::~PathFile() = default;
PathFile::PathFile(PathFile&&) noexcept = default;

const PathHeader& PathFile::header() const { return self_->header(); }
bool PathFile::next(PathRow& row) { return self_->next(row); }
const std::vector<double>& PathFile::start() const { return self_->start(); }
std::uintmax_t PathFile::bytes_read() const { return self_->bytes_read(); }

namespace {
constexpr std::string_view kCertificateLine = "# certificate.json SHA-256: ";
}

std::string certificate_line(std::string_view sha256) { return fmt::format("{}{}\n", kCertificateLine, sha256); }

std::string named_certificate(std::string_view text) {
  std::size_t at = text.rfind(kCertificateLine);
  while (at != std::string_view::npos && at != 0 && text[at - 1] != '\n') {
    at = text.rfind(kCertificateLine, at - 1);
  }
  if (at == std::string_view::npos) return "";
  const std::string_view rest = text.substr(at + kCertificateLine.size());
  return std::string(trimmed(rest.substr(0, rest.find('\n'))));
}

bool is_certificate_name(std::string_view path) { return path.ends_with(".json"); }

}  // namespace taut
