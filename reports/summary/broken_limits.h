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
  bool is_singular = false;  ///< the force Jacobian is singular between `position` and `to`; no limit is named then
  std::optional<BodyDistance> bodies = {};  ///< which bodies are too near, in floating point; no limit is named then
  std::optional<RateId> rate = {};          ///< of a move: what is too fast; no margin is named then
  MarginId margin;                          ///< which limit of which cable; unless singular, of bodies or of a rate
  DecimalText limit;                        ///< [N, m]; of bodies their clearance; unless singular or of a rate
  double value = 0;  ///< what is beyond the limit [N, m]: for proved ones the end next to it; unless singular
  /// value − limit as a share of the width between the limits, of a rate of the limit; infinite if singular; of bodies
  /// more than that of any limit, and the more the nearer they are
  double severity = 0;
  double position = 0;        ///< k + s is the point s of segment k
  double to = 0;              ///< the other end, if singular; else the same
  std::size_t stretches = 0;  ///< how many of the certificate's stretches have a proved violation of it
  /// Whether the move is proved to pass the pose. Where poses are implied, witnesses of stretches are about the only
  /// pose in a tube that the certificate states, and it is not proved that the move leads there.
  bool is_reached = true;

  [[nodiscard]] bool is_proved() const { return proof.has_value(); }
  /// Whether it is a limit of the tension or the length of a cable.
  [[nodiscard]] bool is_of_cable() const { return !is_singular && !bodies && !rate; }
};

/// First the limits that witnesses of the certificate prove broken, the gravest first; then those proved of poses that
/// the move may not reach; then those that only samples show broken. A singular pose is graver than bodies that are too
/// near to each other, and that than any limit. Samples
/// are not looked at where no path was found or where cable lengths imply the poses, as those shown may not be poses of
/// the motion.
[[nodiscard]] std::vector<BrokenLimit> broken_limits(const ReportContext& scene);

/// A pair at a place of the path, in floating point. @pre scene.bodies
[[nodiscard]] BodyDistance distance_at(const ReportContext& scene, double position, std::size_t pair);

/// "below its slack limit, on a machine within the tolerances": what is broken, after the cable's name; of a singular
/// pose only the machine, if it is not the stated one.
[[nodiscard]] std::string what_text(const BrokenLimit& broken);
/// Whose it is: "Cable 3", "container / stack", "Singular pose".
[[nodiscard]] std::string subject_text(const ReportContext& scene, const BrokenLimit& broken);
/// "at most 0.0499 N; limit 0.05 N", or of samples "about −18.7 N; limit 0.05 N".
[[nodiscard]] std::string amount_text(const ReportContext& scene, const BrokenLimit& broken);
/// "segment 2 at s = 0.525, after 41° of turning; lines 7-8; in 2 stretches": to be understood without anything else.
[[nodiscard]] std::string where_text(const ReportContext& scene, const BrokenLimit& broken);
/// "proved", "proved of a pose in its tube, not that the move leads there", or "samples".
[[nodiscard]] std::string known_by(const BrokenLimit& broken);

/// "lines 5-6": where in the audited file a place of the path is. It is what the certificate's illustration says, which
/// nothing checks; empty where that says nothing.
[[nodiscard]] std::string rows_text(const ReportContext& scene, double position);
/// "robot1-bridging.csv": the name of that file, which nothing checks; empty where the path is of no file.
[[nodiscard]] std::string audited_file(const ReportContext& scene);
/// Of a move that was fitted to a table with times: what the rows have to do with it, as the program that audited it
/// says. Else empty.
[[nodiscard]] std::string table_text(const ReportContext& scene);

}  // namespace taut
