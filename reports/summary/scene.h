// SPDX-License-Identifier: GPL-3.0-or-later
// What a report is made from: the certificate, and floating-point samples of what it is about.
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
  /// Of a certificate as the checker left it: with a verdict where it made a theorem.
  /// @throws InputError where a report can't show what is in it. @pre the outcome is neither rejected nor malformed.
  explicit ReportContext(const checker::CheckResult& checked);
  /// Unless confirmed, all claims are taken out of the view.
  ReportContext(CertificateView certificate, Recheck checked);

  Recheck recheck;
  CertificateView view;
  Sampler sampler;
  std::vector<PathSample> samples;  ///< along the whole path
  Travel travel;                    ///< how far into the move a place is
  /// Of the certificate's boxes, computed anew: proved where the certificate is right. Floating point has no part in them.
  PathRanges ranges;
  /// Whether they are those of the whole path: the boxes are without gaps, and all of them were enclosed.
  bool ranges_are_whole = false;
};

/// "rad", "m" or "": the unit of parameter j, where it can be told.
[[nodiscard]] std::string unit(const SpaceText& space, std::size_t j);
/// "[rad]"; nothing for "".
[[nodiscard]] std::string in_brackets(const std::string& unit);

}  // namespace taut
