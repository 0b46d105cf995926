// SPDX-License-Identifier: GPL-3.0-or-later
// Everything that a report is made from: the certificate, and floating-point samples of its path.
#pragma once

#include <string>
#include <vector>

#include "certificate/certificate_view.h"
#include "certify/box_ranges.h"
#include "checker/check.h"
#include "reports/summary/report_options.h"
#include "reports/summary/samples.h"
#include "reports/summary/travel.h"

namespace taut {

struct ReportContext {
  /// The context for a checked certificate; it has a verdict if the checker made a theorem.
  /// @throws InputError if a report can't show the content. @pre the outcome is neither rejected nor malformed.
  explicit ReportContext(const checker::CheckResult& checked);
  /// Unless confirmed, all claims are taken out of the view.
  ReportContext(CertificateView certificate, Recheck checked);

  Recheck recheck;
  CertificateView view;
  Sampler sampler;
  std::vector<PathSample> samples;  ///< along the whole path
  Travel travel;                    ///< the distance into the move at each position
  /// Ranges on the certificate's boxes, enclosed anew by interval arithmetic. They are proved if the certificate is
  /// right.
  PathRanges ranges;
  /// Whether these ranges cover the whole path: the boxes have no gaps, and all of them were enclosed.
  bool ranges_are_whole = false;
};

/// The unit of parameter j, "rad" or "m", or "" if it is not known.
[[nodiscard]] std::string unit(const SpaceText& space, std::size_t j);
/// The unit in brackets, "[rad]"; nothing for "".
[[nodiscard]] std::string in_brackets(const std::string& unit);

}  // namespace taut
