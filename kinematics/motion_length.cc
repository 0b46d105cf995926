// SPDX-License-Identifier: GPL-3.0-or-later
#include "kinematics/motion_length.h"

namespace taut {

std::vector<double> curve_parameters(const Segment& segment, double s) {
  std::vector<double> result(segment.control[0]->parameters().x.size());
  for (std::size_t j = 0; j < result.size(); ++j) result[j] = coordinate_polynomial<double>(segment, j).at(s);
  return result;
}

double motion_length(const Path& path, const ParametersAt& parameters, const ShortDistance& distance, int pieces) {
  double fine = 0;
  double coarse = 0;
  for (std::size_t k = 0; k < path.segments(); ++k) {
    const Segment segment = path.segment(k);
    std::vector<double> even = parameters(segment, 0);
    for (int piece = 0; piece < pieces; piece += 2) {
      const std::vector<double> middle = parameters(segment, (piece + 1.0) / pieces);
      std::vector<double> next = parameters(segment, (piece + 2.0) / pieces);
      fine += distance(even, middle) + distance(middle, next);
      coarse += distance(even, next);
      even = std::move(next);
    }
  }
  return fine + (fine - coarse) / 3;  // the error of chords is proportional to the square of their length
}

}  // namespace taut
