// SPDX-License-Identifier: GPL-3.0-or-later
#include "case/table_rounding.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "base/input_error.h"
#include "base/sanitize.h"
#include "problem/nearest_si.h"

namespace taut {
namespace {

constexpr double kLeast = 1e-12;

bool is_sensible(double size, Dimension dimension) {
  return size >= kLeast && size <= (dimension == Dimension::kLength ? kMostRounding_m : kMostRounding_rad);
}

}  // namespace

std::string rounding_expected(Dimension dimension) {
  return dimension == Dimension::kLength
             ? fmt::format("a length from {} m to {} m, such as 0.1 mm", kLeast, kMostRounding_m)
             : fmt::format("an angle from {} to {} rad, such as 0.01 deg", kLeast, kMostRounding_rad);
}

std::optional<RoundingSize> read_rounding_size(const std::string& text, Dimension dimension,
                                               const std::optional<Unit>& bare) {
  auto [number, unit] = split_unit(text);
  if (!unit) unit = bare;
  if (!unit || unit->dimension != dimension) return std::nullopt;
  try {
    const double nearest = NearestSi(*unit)(number);
    if (!is_sensible(nearest, dimension)) return std::nullopt;
    return RoundingSize{std::nextafter(nearest, 0.0), fmt::format("{} {}", number, unit->name)};
  } catch (const InputError&) {
    return std::nullopt;
  }
}

TableRounding read_table_rounding(const std::string& text, const std::string& option) {
  const std::size_t comma = text.find(',');
  const auto read = [&](std::string part, Dimension dimension) {
    while (part.starts_with(' ')) part.erase(0, 1);
    while (part.ends_with(' ')) part.pop_back();
    return read_rounding_size(part, dimension);
  };
  const auto size = read(text.substr(0, comma), Dimension::kLength);
  if (size && comma == std::string::npos) return {.length_m = size->si, .length = size->text};
  const auto angle = read(comma == std::string::npos ? "" : text.substr(comma + 1), Dimension::kAngle);
  if (!size || !angle) {
    throw InputError(ErrorCode::kUse, fmt::format("{}: got '{}', expected {}, and {}, as in 0.1mm,0.01deg; or of a "
                                                  "table of cable lengths the length alone",
                                                  option, excerpt(text), rounding_expected(Dimension::kLength),
                                                  rounding_expected(Dimension::kAngle)));
  }
  return {.position_m = size->si, .angle_rad = angle->si, .position = size->text, .angle = angle->text};
}

TableRounding table_rounding(double position_m, double angle_rad, double length_m) {
  const auto require = [](const char* field, double size, Dimension dimension) {
    if (is_sensible(size, dimension)) return;
    throw InputError(fmt::format("{}: got {}, expected {}", field, size, rounding_expected(dimension)), {"", 0, field});
  };
  const auto metres = [](double size) { return fmt::format("{} m", size); };
  if (length_m != 0) {
    require("rounding.length_m", length_m, Dimension::kLength);
    for (const auto& [field, size] :
         {std::pair("rounding.position_m", position_m), {"rounding.angle_rad", angle_rad}}) {
      if (size == 0) continue;
      throw InputError(fmt::format("{}: got {} beside a rounding of cable lengths, expected 0", field, size),
                       {"", 0, field});
    }
    return {.length_m = std::nextafter(length_m, 0.0), .length = metres(length_m)};
  }
  require("rounding.position_m", position_m, Dimension::kLength);
  require("rounding.angle_rad", angle_rad, Dimension::kAngle);
  return {.position_m = std::nextafter(position_m, 0.0),
          .angle_rad = std::nextafter(angle_rad, 0.0),
          .position = metres(position_m),
          .angle = fmt::format("{} rad", angle_rad)};
}

}  // namespace taut
