// A problem in binary64: poses, statics and distances to the limits at points of its space.
//
// For what proposes and what draws; nothing here is proved.
#pragma once

#include <span>

#include "kinematics/statics.h"

namespace taut {

class PoseSampler {
 public:
  /// @throws InputError if the problem has no model in doubles.
  explicit PoseSampler(const Problem& problem);

  [[nodiscard]] const Model<double>& model() const { return model_; }
  [[nodiscard]] const ExpressionTape& tape() const { return tape_; }  ///< of the pose

  [[nodiscard]] Pose<double> pose(std::span<const double> parameters) const { return evaluate_pose(pose_, parameters); }
  [[nodiscard]] Statics<double> statics(const Pose<double>& pose) const { return taut::statics(model_, pose); }

  /// The least distance to a limit of any cable, over half the range between the limits: 0 on a limit, negative beyond
  /// one or where J is singular.
  [[nodiscard]] double clearance(const Statics<double>& statics) const;

 private:
  Model<double> model_;
  ExpressionTape tape_;
  Evaluator<double> pose_;
};

}  // namespace taut
