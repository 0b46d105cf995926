// SPDX-License-Identifier: GPL-3.0-or-later
#include "certificate/certificate.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace taut {

std::size_t count_boxes(const Certificate& certificate) {
  std::size_t count = 0;
  for (const CertificateSegment& segment : certificate.segments) count += segment.boxes.size();
  return count;
}

std::vector<DyadicBox> dyadic_boxes(std::span<const checker::Box> boxes) {
  const auto depth_of = [](const mpq_class& x) { return static_cast<int>(mpz_sizeinbase(x.get_den_mpz_t(), 2)) - 1; };
  std::vector<DyadicBox> result;
  for (const checker::Box& box : boxes) {
    const int depth = std::max(depth_of(box.begin), depth_of(box.end));
    const mpq_class scale(mpz_class(1) << static_cast<unsigned long>(depth));
    if (depth > DyadicBox::kMaxDepth || (box.end - box.begin) * scale != 1) continue;
    const mpq_class k = box.begin * scale;
    result.push_back({boost::multiprecision::cpp_int(k.get_num().get_str()), depth});
  }
  return result;
}

mpq_class to_rational(const Dyadic& x) {
  mpq_class result(mpz_class(x.k.str()), mpz_class(1) << static_cast<unsigned long>(x.depth));
  result.canonicalize();
  return result;
}

const char* name(Verdict verdict) {
  switch (verdict) {
    case Verdict::kProved: return "proved";
    case Verdict::kRefuted: return "refuted";
    case Verdict::kUndecided: break;
  }
  return "undecided";
}

const char* interpolation_name(Interpolation law) {
  switch (law) {
    case Interpolation::kStraight: return "straight-in-parameters";
    case Interpolation::kCubicBSpline: return "cubic-b-spline";
    case Interpolation::kGeodesic: return "geodesic";
    case Interpolation::kCableLengths: break;
  }
  return "straight-in-cable-lengths";
}

std::string hex_float(double x) {
  std::array<char, 32> digits{};
  const auto [end, error] =
      std::to_chars(digits.data(), digits.data() + digits.size(), std::abs(x), std::chars_format::hex);
  return (std::signbit(x) ? "-0x" : "0x") + std::string(digits.data(), end);
}

}  // namespace taut
