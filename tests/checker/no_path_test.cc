// SPDX-License-Identifier: GPL-3.0-or-later
// Which cells part two waypoints, against grid points that are given the name of their pose; trees that are none; and
// forms in three variables against samples.
#include "checker/no_path.h"

#include <gtest/gtest.h>

#include <map>
#include <numeric>
#include <random>

#include "checker/format/expression_parser.h"

namespace taut::checker {
namespace {

using Random = std::mt19937_64;

// ---- Parted or not --------------------------------------------------------------------------------------------------

constexpr int kMostDepth = 4;
constexpr int kGrid = 1 << (kMostDepth + 1);  ///< grid lines a range: cells have points in their middles, too

using Point = std::array<int, kCellAxes>;

struct Space {
  const char* name;
  std::vector<CellAxis::Kind> kinds;
  std::optional<CellFlip> flip;
};

using Kind = CellAxis::Kind;
const std::vector<Space> kSpaces = {
    {"two ranges", {Kind::kRange, Kind::kRange}, {}},
    {"a turn and a range", {Kind::kTurn, Kind::kRange}, {}},
    {"three turns", {Kind::kTurn, Kind::kTurn, Kind::kTurn}, {}},
    {"phi and theta", {Kind::kTurn, Kind::kTilt}, CellFlip{0, 1, {}}},
    {"theta, x and phi", {Kind::kTilt, Kind::kRange, Kind::kTurn}, CellFlip{2, 0, {}}},
    {"phi, theta and sigma", {Kind::kTurn, Kind::kTilt, Kind::kTurn}, CellFlip{0, 1, 2}}};

/// Of two points with the same pose the same, by the orientation Rz(phi) Ry(theta) Rz(sigma - phi).
Point pose_name(const Space& space, Point point) {
  for (std::size_t k = 0; k < space.kinds.size(); ++k) {
    if (space.kinds[k] == Kind::kTurn) point[k] %= kGrid;
  }
  if (!space.flip) return point;
  const auto [phi, theta, sigma] = *space.flip;
  if (point[theta] == 0) point[phi] = 0;
  if (point[theta] == kGrid) {
    if (sigma) point[*sigma] = ((point[*sigma] - 2 * point[phi]) % kGrid + kGrid) % kGrid;
    point[phi] = sigma ? 0 : point[phi] % (kGrid / 2);
  }
  return point;
}

struct Leaf {
  Point lower{}, upper{};
  bool is_open = false;
};

/// A random tree and its leaves.
struct RandomTree {
  RandomTree(Random& random, std::size_t axes, double share_open) {
    Leaf whole;
    whole.upper.fill(kGrid);
    grow(random, axes, share_open, whole);
  }
  void grow(Random& random, std::size_t axes, double share_open, const Leaf& at) {
    const std::size_t axis = random() % axes;
    const int width = at.upper[axis] - at.lower[axis];
    if (width > 2 && random() % 8 != 0) {
      text += static_cast<char>('0' + axis);
      Leaf lower = at, upper = at;
      lower.upper[axis] = upper.lower[axis] = at.lower[axis] + width / 2;
      grow(random, axes, share_open, lower);
      grow(random, axes, share_open, upper);
      return;
    }
    leaves.push_back(at);
    leaves.back().is_open = std::uniform_real_distribution<double>(0, 1)(random) < share_open;
    text += leaves.back().is_open ? '.' : 'A';
  }
  std::string text;
  std::vector<Leaf> leaves;
};

/// By joining all open leaves that hold points of one name.
bool is_parted_by_points(const Space& space, const std::vector<Leaf>& leaves, const Point& from, const Point& to) {
  std::vector<std::size_t> parent(leaves.size());
  std::iota(parent.begin(), parent.end(), std::size_t{0});
  const auto find = [&](std::size_t x) {
    while (parent[x] != x) x = parent[x] = parent[parent[x]];
    return x;
  };
  std::map<Point, std::size_t> leaf_of;
  for (std::size_t n = 0; n < leaves.size(); ++n) {
    if (!leaves[n].is_open) continue;
    Point most = leaves[n].upper;
    for (std::size_t k = space.kinds.size(); k < kCellAxes; ++k) most[k] = 0;
    Point at = leaves[n].lower;
    for (at[0] = leaves[n].lower[0]; at[0] <= most[0]; ++at[0]) {
      for (at[1] = leaves[n].lower[1]; at[1] <= most[1]; ++at[1]) {
        for (at[2] = leaves[n].lower[2]; at[2] <= most[2]; ++at[2]) {
          parent[find(leaf_of.try_emplace(pose_name(space, at), n).first->second)] = find(n);
        }
      }
    }
  }
  const auto first = leaf_of.find(pose_name(space, from)), second = leaf_of.find(pose_name(space, to));
  if (first == leaf_of.end() || second == leaf_of.end()) return true;
  return find(first->second) != find(second->second);
}

Expression constant(const std::string& text) { return parse_expression(text, {}, "test"); }

/// The coordinate at k grid lines, `turns` whole turns away.
Expression coordinate(Kind kind, int k, int turns) {
  const std::string share = "(" + std::to_string(k) + "/" + std::to_string(kGrid) + ")";
  switch (kind) {
    case Kind::kRange: return constant("-1 + 3*" + share);
    case Kind::kTurn: return constant("-pi + 2*pi*(" + share + "+" + std::to_string(turns) + ")");
    case Kind::kTilt: break;
  }
  return constant("pi*(" + share + "+" + std::to_string(2 * turns) + ")");
}

CellAxis axis(Kind kind) {
  switch (kind) {
    case Kind::kRange: return {kind, constant("-1"), constant("2")};
    case Kind::kTurn: return {kind, constant("-pi"), constant("pi")};
    case Kind::kTilt: break;
  }
  return {kind, constant("0"), constant("pi")};
}

Point random_point(Random& random, std::size_t axes) {
  Point point{};
  for (std::size_t k = 0; k < axes; ++k) point[k] = static_cast<int>(random() % (kGrid + 1));
  return point;
}

TEST(Parted, AsGridPointsOfOnePoseSay) {
  Random random(22);
  for (const Space& space : kSpaces) {
    const std::size_t n = space.kinds.size();
    std::array<int, 2> count{};
    for (int trial = 0; trial < 150; ++trial) {
      const RandomTree tree(random, n, 0.35 + 0.3 * (trial % 3) / 2);
      const Point from = random_point(random, n), to = random_point(random, n);
      NoPathCertificate certificate;
      certificate.problem.query.resize(2);
      for (std::size_t k = 0; k < n; ++k) {
        const int turns = static_cast<int>(random() % 5) - 2;
        certificate.axes.push_back(axis(space.kinds[k]));
        certificate.problem.query[0].push_back(coordinate(space.kinds[k], from[k], turns));
        certificate.problem.query[1].push_back(coordinate(space.kinds[k], to[k], -turns));
      }
      certificate.flip = space.flip;
      certificate.tree = CellTree(tree.text, n);
      const bool expected = is_parted_by_points(space, tree.leaves, from, to);
      EXPECT_EQ(is_parted(certificate, [] {}), expected) << space.name << ", trial " << trial << ": " << tree.text;
      ++count[expected ? 1 : 0];
    }
    EXPECT_GT(count[0], 15) << space.name;
    EXPECT_GT(count[1], 15) << space.name;
  }
}

TEST(Parted, AWaypointOutOfItsRangeIsRejected) {
  NoPathCertificate certificate;
  certificate.axes = {axis(Kind::kRange), axis(Kind::kRange)};
  certificate.problem.query = {{constant("0"), constant("0")}, {constant("0"), constant("2.001")}};
  EXPECT_THROW((void)is_parted(certificate, [] {}), Rejected);
}

TEST(CellTree, RefusesWhatIsNoTree) {
  for (const char* text : {".", "A", "0.x", "0.y", "10..l", "0L1m."}) EXPECT_NO_THROW(CellTree(text, 2)) << text;
  for (const char* text : {"", "0", "0.", "0...", "..", "2..", "0.?", "0.M", "0.3", "00..", "0 . ."}) {
    EXPECT_THROW(CellTree(text, 2), Malformed) << text;
  }
  std::string deep;
  for (int k = 0; k < CellTree::kMaxDepth; ++k) deep += '1';
  const std::string leaves(CellTree::kMaxDepth + 1, '.');
  EXPECT_NO_THROW(CellTree(deep + leaves, 2));
  EXPECT_THROW(CellTree(deep + '1' + leaves + '.', 2), Malformed);
}

// ---- Forms ----------------------------------------------------------------------------------------------------------

/// A random form, and the function of which it is the form: x + sum y_k u_k, exactly.
struct RandomForm {
  explicit RandomForm(Random& random) {
    std::uniform_real_distribution<double> number(0.5, 2), slope(-0.04, 0.04);
    form.at = Ball(x = number(random));
    for (std::size_t k = 0; k < kCellAxes; ++k) {
      y[k] = random() % 4 == 0 ? 0 : slope(random);
      form.slope[k] = Ball(y[k]);
    }
  }
  [[nodiscard]] Ball at(const std::array<double, 3>& u) const {
    Ball sum(x);
    for (std::size_t k = 0; k < kCellAxes; ++k) sum += Ball(y[k]) * Ball(u[k]);
    return sum;
  }
  CellForm form;
  double x = 0;
  std::array<double, 3> y{};
};

/// The value at u is one that the form says. (Both are balls, of which that of the value is far smaller.)
void expect_encloses(const CellForm& form, const std::array<double, 3>& u, const Ball& value, const char* name) {
  Ball stated = form.at;
  for (std::size_t k = 0; k < kCellAxes; ++k) stated += form.slope[k] * Ball(u[k]);
  EXPECT_NE(arb_overlaps(stated.get(), value.get()), 0) << name;
  EXPECT_NE(arb_overlaps(form.range().get(), value.get()), 0) << name;
}

TEST(CellForm, OperationsEncloseTheirValuesAtEveryPoint) {
  const WorkingPrecision precision(128);
  Random random(5);
  std::uniform_real_distribution<double> inner(-1, 1);
  for (int trial = 0; trial < 300; ++trial) {
    const RandomForm a(random), b(random);
    const CellForm sum = a.form + b.form, difference = a.form - b.form, product = a.form * b.form;
    const CellForm quotient = a.form / b.form, sine = apply(Function::kSin, a.form);
    const CellForm root = apply(Function::kSqrt, a.form), cube = power(a.form, 3), square = sqr(a.form);
    for (int point = 0; point < 8; ++point) {
      std::array<double, 3> u{};
      for (double& x : u) x = random() % 3 == 0 ? (random() % 2 == 0 ? -1 : 1) : inner(random);
      const Ball x = a.at(u), y = b.at(u);
      expect_encloses(sum, u, x + y, "sum");
      expect_encloses(difference, u, x - y, "difference");
      expect_encloses(product, u, x * y, "product");
      expect_encloses(quotient, u, x / y, "quotient");
      expect_encloses(sine, u, value(Function::kSin, x), "sine");
      expect_encloses(root, u, sqrt(x), "root");
      expect_encloses(cube, u, power(x, 3), "cube");
      expect_encloses(square, u, x * x, "square");
    }
  }
}

TEST(CellForm, ErrorsAreOfSecondOrder) {
  const WorkingPrecision precision(128);
  const auto error = [](double h) {
    CellForm x(Ball(0.7));
    x.slope = {Ball(h), Ball(h / 2), Ball(-h)};
    const CellForm f = apply(Function::kSin, x * x) / (x + CellForm(Ball(1)));
    return mag_get_d(arb_radref(f.at.get()));
  };
  EXPECT_NEAR(error(1e-3) / error(5e-4), 4, 0.3);
}

}  // namespace
}  // namespace taut::checker
