// SPDX-License-Identifier: GPL-3.0-or-later
// Path files: poses that another program planned, read row by row (docs/audits.md).
//
// The first line that is neither blank nor a comment decides the format:
//   a table           a header of named columns with units, then numbers; the delimiter is a comma, semicolon or tab.
//                     Columns are either the case's own parameters, or px py pz phi theta sigma, or px py pz qx qy qz
//                     qw, or cable lengths l1 … l6 (also d1 … d6), whose first row may also have the pose to start
//                     from; and optionally a time t (also time).
//   TUM               eight numbers between blanks: time [s], position [m], quaternion x y z w; no header
//   taut's path.csv   waypoint (or control_point), x.NAME, half_turns.NAME: what `taut plan` writes, bit for bit
// The extensions .csv and .tsv always mean tables, .tum always means TUM; with any other name the first line decides.
// Certificates are no path files: see is_certificate_name().
//
// Each number is read exactly, scaled exactly by its unit, and rounded once to the nearest binary64 (nearest_si.h).
// Memory doesn't depend on the number of rows.
#pragma once

#include <cstdint>
#include <istream>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/input_error.h"
#include "problem/decimal.h"
#include "problem/nearest_si.h"
#include "problem/problem.h"

namespace taut {

enum class PathFormat { kTable, kTum, kTautWaypoints, kTautControlPoints };

/// The coordinates that a row consists of, and their order.
enum class PathForm {
  kParameters,    ///< the case's own parameters
  kAngles,        ///< px, py, pz [m], phi, theta, sigma [rad], or other angles: PathHeader::angles
  kQuaternion,    ///< px, py, pz [m], qx, qy, qz, qw: | |q| − 1 | <= kNormTolerance; q and −q are one pose
  kCableLengths,  ///< l1 … l6 [m]
};

inline constexpr double kNormTolerance = 1e-3;  ///< of quaternions; exporters write three digits at least
inline constexpr std::array<const char*, 7> kQuaternionNames = {"px", "py", "pz", "qx", "qy", "qz", "qw"};
inline constexpr std::array<const char*, 6> kLengthNames = {"l1", "l2", "l3", "l4", "l5", "l6"};

/// A column of the file.
struct PathColumn {
  std::string name;
  std::string unit;     ///< as typed; empty if it has none
  double per_unit = 1;  ///< one such unit in SI, rounded
};

/// The file's columns.
struct PathHeader {
  PathFormat format = PathFormat::kTable;
  PathForm form = PathForm::kParameters;
  AnglesText angles;                    ///< of kAngles: the case's, or those of taut's own file
  std::vector<PathColumn> coordinates;  ///< in the form's order
  std::optional<PathColumn> time;
  /// For a table of cable lengths, the form of its first row's pose; nothing if it has none.
  std::optional<PathForm> start;
};

struct PathRow {
  std::size_t line = 0;           ///< of the file, from 1
  std::optional<Decimal> time_s;  ///< exactly what was typed, later than the row before
  std::vector<double> x;          ///< the form's coordinates, nearest binary64 of their values in SI
  std::vector<int> half_turns;  ///< λ_j = x_j + π half_turns_j; 0 except for periodic parameters in taut's own files
  bool operator==(const PathRow&) const = default;
};

/// Reads a path file. A row may repeat the one before: the platform rests. Every fault is an InputError with file,
/// line, column, the value seen and what was expected.
class PathFile {
 public:
  /// Opens the file and reads its header. @throws InputError
  PathFile(const std::string& path, const SpaceText& space);
  /// As above, from a stream; `name` stands for the file in messages.
  PathFile(std::unique_ptr<std::istream> text, const std::string& name, const SpaceText& space);
  ~PathFile();
  PathFile(PathFile&&) noexcept;
  PathFile(const PathFile&) = delete;
  PathFile& operator=(const PathFile&) = delete;
  PathFile& operator=(PathFile&&) = delete;

  [[nodiscard]] const PathHeader& header() const;

  /// Reads the next row into `row`; false after the last. A file without rows is an error. @throws InputError
  [[nodiscard]] bool next(PathRow& row);

  /// The coordinates, in header().start's order and SI, of the pose in the first row of a table of cable lengths. Empty
  /// if there is none or the first row has not been read yet.
  [[nodiscard]] const std::vector<double>& start() const;

  [[nodiscard]] std::uintmax_t bytes_read() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> self_;
};

/// The last line of path.csv: a comment that names the certificate written with it, by the SHA-256 of the certificate's
/// bytes.
[[nodiscard]] std::string certificate_line(std::string_view sha256);
/// The SHA-256 in the last such line of a path file's text; empty if there is none.
[[nodiscard]] std::string named_certificate(std::string_view text);

/// Whether a file of this name is to be read as a certificate: NAME.json.
[[nodiscard]] bool is_certificate_name(std::string_view path);

}  // namespace taut
