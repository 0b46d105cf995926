// SPDX-License-Identifier: GPL-3.0-or-later
// A path file is refused with an InputError, or its rows are finite numbers, with times that rise.
#include "path_io/path_file.h"

#include <cmath>
#include <cstdint>
#include <memory>
#include <sstream>
#include <string>

#include "base/input_error.h"
#include "path_io/waypoint_maker.h"
#include "tests/support/robots.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace taut;
  static const Problem problem = testing::robot1_slice();
  try {
    PathFile file(std::make_unique<std::istringstream>(std::string(reinterpret_cast<const char*>(data), size)),
                  "fuzz.csv", problem.space, {size % 2 == 0});
    WaypointMaker maker(problem, file.header(), usual_law(file.header()), "fuzz.csv");
    double last = -HUGE_VAL;  // [s]
    for (PathRow row; file.next(row);) {
      for (const double x : row.x) {
        if (!std::isfinite(x)) __builtin_trap();
      }
      if (row.time_s) {
        const double time = ScalarTraits<double>::from_decimal(row.time_s->text());
        if (time < last) __builtin_trap();
        last = time;
      }
      static_cast<void>(maker.next(row, file.start()));
    }
  } catch (const InputError&) {  // NOLINT(bugprone-empty-catch): what bad input is for
  }
  return 0;
}
