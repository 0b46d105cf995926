// SPDX-License-Identifier: GPL-3.0-or-later
// Reads a certificate that no path exists, and checks its form: "No path" in docs/certificate-format.md. Proves nothing
// about the robot.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "checker/format/strict_json.h"
#include "checker/kernel/outside.h"
#include "checker/kernel/statement.h"

namespace taut::checker {

inline constexpr std::string_view kNoPathFormat = "taut-no-path-certificate";
inline constexpr int kNoPathVersion = 1;            ///< of the format
inline constexpr int kNoPathVersionWithBodies = 2;  ///< where the problem states bodies

/// One coordinate of the space, lambda = lower + t (upper - lower) with t in [0, 1].
struct CellAxis {
  enum class Kind {
    kRange,  ///< a parameter's range, whose ends are walls
    kTurn,   ///< from -pi to pi, of a parameter along which all poses repeat after 2 pi: t = 0 and t = 1 are one
    kTilt,   ///< theta from 0 to pi, where (phi, theta) and (phi + pi, -theta) are one pose
  };
  Kind kind = Kind::kRange;
  Expression lower, upper;  ///< constants
};

/// The axes of phi and theta, and of sigma where that is free, too.
struct CellFlip {
  std::size_t phi = 0, theta = 0;
  std::optional<std::size_t> sigma;
};

/// A tree of halvings in preorder: a node, then what is below its lower half, then what is below its upper half.
class CellTree {
 public:
  static constexpr int kMaxDepth = 30;  ///< of an axis

  /// @throws Malformed unless the text is a tree over so many axes: "map" in docs/certificate-format.md.
  CellTree(std::string text, std::size_t axes);

  [[nodiscard]] std::size_t size() const { return text_.size(); }  ///< nodes
  [[nodiscard]] bool is_leaf(std::size_t node) const { return text_[node] < '0' || text_[node] > '2'; }
  /// @pre not a leaf
  [[nodiscard]] std::size_t axis(std::size_t node) const { return static_cast<std::size_t>(text_[node] - '0'); }
  [[nodiscard]] static std::size_t lower(std::size_t node) { return node + 1; }
  [[nodiscard]] std::size_t upper(std::size_t node) const { return upper_[node]; }
  /// Whether it is said of a leaf why none of its poses is feasible.
  [[nodiscard]] bool is_outside(std::size_t leaf) const;
  /// Whether what is said is that two bodies touch: the next one of NoPathCertificate::contact_of_leaf tells more.
  [[nodiscard]] bool is_contact(std::size_t leaf) const;
  /// What is said; nothing where is_contact() or where nothing is.
  [[nodiscard]] std::optional<OutsideReason> reason(std::size_t leaf) const;

 private:
  std::string text_;                  ///< a letter a node
  std::vector<std::uint32_t> upper_;  ///< of leaves nothing
};

/// The letter of a leaf: 'A' to 'L' for lengths, 'a' to 'l' and 'm' to 'x' for balances that follow or are fixed.
[[nodiscard]] char letter(const OutsideReason& reason);
inline constexpr char kOpenLeaf = '.';
inline constexpr char kContactLeaf = 'y';

struct NoPathCertificate {
  Problem problem;
  nlohmann::json problem_json;  ///< `problem` as the file states it
  std::size_t from = 0;         ///< the waypoint of the query; the other is the next
  int bits = 64;                ///< working precision of all reasons
  CellTree tree{".", 2};
  std::vector<ContactReason> contacts;         ///< where the problem has bodies, as the next
  std::vector<std::size_t> contact_of_leaf{};  ///< of each leaf that is_contact(), in the tree's order
  std::vector<CellAxis> axes;                  ///< one a parameter
  std::optional<CellFlip> flip;
  std::string signer;  ///< the public key, 64 hex digits; empty where there is no signature
};

/// The axes that a space has.
struct CellSpace {
  std::vector<CellAxis> axes;
  std::optional<CellFlip> flip;
};
/// @throws Malformed where the space has not two or three parameters, has constraints, or is not bounded.
[[nodiscard]] CellSpace cell_space(const Problem& problem);

/// The text that states "no path" of a problem.
[[nodiscard]] std::string no_path_claim(const Problem& problem);

/// @throws Malformed naming the key.
[[nodiscard]] NoPathCertificate read_no_path(Outline outline);

}  // namespace taut::checker
