// A path file is refused with an InputError, or its rows are finite numbers, with times that rise.
#include "kinematics/path_file.h"

#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <sstream>
#include <string>

#include "kinematics/input_error.h"
#include "kinematics/waypoint_maker.h"
#include "tests/support/robots.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace taut;
  static const Problem problem = testing::robot1_slice();
  try {
    PathFile file(std::make_unique<std::istringstream>(std::string(reinterpret_cast<const char*>(data), size)),
                  "fuzz.csv", problem.space, {size % 2 == 0});
    WaypointMaker maker(problem, file.header(), usual_law(file.header()), "fuzz.csv");
    std::optional<Decimal> last;
    for (PathRow row; file.next(row);) {
      for (const double x : row.x) {
        if (!std::isfinite(x)) __builtin_trap();
      }
      if (last && row.time_s && (*row.time_s - *last).sign() <= 0) __builtin_trap();
      last = row.time_s;
      static_cast<void>(maker.next(row, file.start()));
    }
  } catch (const InputError&) {  // NOLINT(bugprone-empty-catch): what bad input is for
  }
  return 0;
}
