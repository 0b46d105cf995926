// SPDX-License-Identifier: GPL-3.0-or-later
// A map of three coordinates as a page that shows one slice of it at a time.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "reports/map/map_result.h"

namespace taut {

/// A pose that is marked.
struct SliceMark {
  std::string name;
  std::array<double, 3> t;
};

/// An HTML page that needs nothing else: two coordinates as a picture, a slider for the third. The slider is moved by
/// keys, too, and any coordinate may be the third. Cells so fine that the page would have more than about 2 MB are
/// shown together as undecided, and the page says so. @pre the map has three axes
[[nodiscard]] std::string slices_page(const MapResult& result, const std::vector<SliceMark>& marks);

}  // namespace taut
