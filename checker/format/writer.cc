// SPDX-License-Identifier: GPL-3.0-or-later
#include "checker/format/writer.h"

#include "checker/format/exact.h"

namespace taut::checker {
namespace {

using Json = nlohmann::json;

Json to_json(std::span<const double> numbers) {
  Json result = Json::array();
  for (const double x : numbers) result.push_back(print_binary64(x));
  return result;
}

}  // namespace

Json to_json(const NearZero& near) {
  return {{"at", to_json(near.at)},
          {"slope", to_json(near.slope)},
          {"radius", print_binary64(near.radius)},
          {"narrowings", near.narrowings}};
}

Json to_json(const Direction& direction) {
  const auto& [x, y, z] = direction.u;
  return {direction.axes == Axes::kWorld ? "W" : "P", x, y, z};
}

Json apart_to_json(const std::vector<std::size_t>& directions) {
  if (directions.empty()) return nullptr;
  return directions.size() == 1 ? Json(directions.front()) : Json(directions);
}

Json apart_to_json(const Apart& apart) {
  Json result = Json::array();
  for (const auto& directions : apart) result.push_back(apart_to_json(directions));
  return result;
}

Json apart_to_json(const ApartChanges& changes) {
  Json result = Json::array();
  for (const auto& [pair, directions] : changes) result.push_back({pair, apart_to_json(directions)});
  return result;
}

Json proof_to_json(const Box& box) {
  Json result = {{"bits", box.bits}};
  if (box.near) result["near"] = to_json(*box.near);
  return result;
}

Json to_json(const Box& box, bool has_tolerances) {
  Json result = proof_to_json(box);
  result["s"] = {box.begin.get_str(), box.end.get_str()};
  if (has_tolerances) {
    result["parts"] = box.parts;
    result["guesses"] = box.guesses;
  }
  return result;
}

Json to_json(const MotionBox& motion) {
  Json result = to_json(motion.box, false);
  result["segment"] = motion.segment;
  return result;
}

Json way_to_json(const WitnessDeviation& deviation) {
  if (deviation.boxes.empty()) return nullptr;
  Json poses = Json::array();
  for (const InnerPose& pose : deviation.poses) {
    const std::span<const double, 7> x = pose.x;
    const auto& [position, turn] = pose.tube;
    poses.push_back({{"tau", pose.s.get_str()},
                     {"position", to_json(x.first<3>())},
                     {"quaternion", to_json(x.last<4>())},
                     {"tube", {{"position", print_binary64(position)}, {"turn", print_binary64(turn)}}}});
  }
  Json boxes = Json::array();
  for (const Box& box : deviation.boxes) boxes.push_back(to_json(box, false));
  return {{"poses", std::move(poses)}, {"boxes", std::move(boxes)}};
}

}  // namespace taut::checker
