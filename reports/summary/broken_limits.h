// SPDX-License-Identifier: GPL-3.0-or-later
// Which limits a path breaks, and where: those that the certificate proves, and those that only samples show.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "certify/path_proof.h"
#include "reports/summary/scene.h"

namespace taut {

/// A limit that is broken somewhere on the path, at the place where it is known to be broken most.
struct BrokenLimit {
  /// Proved by this witness of the certificate; nothing: only floating-point samples show it, and nothing is proved.
  std::optional<PathWitness> proof;
  bool is_singular = false;   ///< the force Jacobian is singular between `position` and `to`; no limit is named then
  MarginId margin;            ///< which limit of which cable; unless singular
  DecimalText limit;          ///< [N, m]; unless singular
  double value = 0;           ///< what is beyond the limit [N, m]: for proved ones the end next to it; unless singular
  double severity = 0;        ///< value − limit as a share of the width between the limits; infinite if singular
  double position = 0;        ///< k + s is the point s of segment k
  double to = 0;              ///< the other end, if singular; else the same
  std::size_t stretches = 0;  ///< how many of the certificate's stretches have a proved violation of it

  [[nodiscard]] bool is_proved() const { return proof.has_value(); }
};

/// First the limits that witnesses of the certificate prove broken, the gravest first; then those that only samples
/// show broken, likewise. A singular pose is graver than any limit. Samples are not looked at where no path was found
/// or where cable lengths imply the poses, as those shown may not be poses of the motion.
[[nodiscard]] std::vector<BrokenLimit> broken_limits(const ReportContext& scene);

/// "lines 5-6": where in the audited file a place of the path is. It is what the certificate's illustration says, which
/// nothing checks; empty where that says nothing.
[[nodiscard]] std::string rows_text(const ReportContext& scene, double position);
/// "robot1-bridging.csv": the name of that file, which nothing checks; empty where the path is of no file.
[[nodiscard]] std::string audited_file(const ReportContext& scene);

}  // namespace taut
