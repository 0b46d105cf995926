// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/parts.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/map/bodies.h"
#include "tests/map/problems.h"

namespace taut::testing {
namespace {

/// All parts, divided by so many halvings at a time.
std::vector<std::string> trees_of(const MapParts& parts, int first, int step) {
  std::vector<std::string> trees;
  for (std::size_t n = 0; n < parts.size(); ++n) {
    std::string tree = parts.start(n);
    for (int halvings = first; !parts.extent(n, tree).is_complete(); halvings += step) {
      tree = parts.refine(n, tree, halvings);
    }
    trees.push_back(tree);
  }
  return trees;
}

constexpr double kWidth = 1.0 / 256;

TEST(MapParts, MakeTheMapOfTheWholeWhateverStepsTheyAreDividedIn) {
  const Problem problem = robot1_slice();
  const MapSpace space = make_map_space(problem.space);
  const MapParts parts(problem, space, kWidth);
  ASSERT_GT(parts.size(), 50U);
  const std::vector<std::string> trees = trees_of(parts, 60, 1);
  EXPECT_EQ(trees, trees_of(parts, parts.halvings(), 1));
  EXPECT_EQ(trees, trees_of(parts, 14, 3));
  for (const double undecided : {0.0, 0.03, 0.2, 0.9}) {
    const SubdivisionOptions options{.least_width = kWidth, .undecided_share = undecided};
    EXPECT_TRUE(are_same(subdivide(problem, space, options), parts.assemble(trees, options))) << undecided;
  }
  const SubdivisionOptions few{.least_width = kWidth, .undecided_share = 0, .most_cells = 10'000};
  EXPECT_TRUE(are_same(subdivide(problem, space, few), parts.assemble(trees, few)));
}

/// Reasons are numbers of pairs, and which pairs are apart is known by other bits than margins are.
TEST(MapParts, MakeTheMapOfTheWholeWithBodies) {
  const Problem problem = with_bodies(robot1_slice());
  const MapSpace space = make_map_space(problem.space);
  const MapParts parts(problem, space, kWidth);
  const SubdivisionOptions options{.least_width = kWidth, .undecided_share = 0};
  const CellMap map = parts.assemble(trees_of(parts, 13, 2), options);
  EXPECT_TRUE(are_same(subdivide(problem, space, options), map));
  EXPECT_GT(map.share[static_cast<std::size_t>(CellKind::kContact)], 0.02);
}

TEST(MapParts, KnowHowFarTheyAreEnough) {
  const Problem problem = robot1_slice();
  const MapSpace space = make_map_space(problem.space);
  const MapParts parts(problem, space, kWidth);
  const CellMap map = subdivide(problem, space, {.least_width = kWidth, .undecided_share = 0});
  for (const std::size_t level : {12, 14, 15, 60}) {
    TreeExtent all = parts.top();
    std::vector<std::string> trees;
    for (std::size_t n = 0; n < parts.size(); ++n) {
      // Some are known further than others.
      trees.push_back(parts.refine(n, parts.start(n), static_cast<int>(level + n % 2)));
      all.add(parts.extent(n, trees.back()));
    }
    if (level == 60) {
      ASSERT_TRUE(all.is_complete());
      EXPECT_EQ(all.undecided(TreeExtent::kLevels - 1), map.share[0]);
      EXPECT_EQ(all.cells(TreeExtent::kLevels - 1), map.leaves());
      continue;
    }
    ASSERT_EQ(all.first_open, level);
    const double undecided = all.undecided(level - 1);
    EXPECT_GT(undecided, map.share[0]);
    const SubdivisionOptions enough{.least_width = kWidth, .undecided_share = undecided};
    EXPECT_TRUE(MapParts::is_enough(all, enough));
    EXPECT_TRUE(are_same(subdivide(problem, space, enough), parts.assemble(trees, enough))) << level;
    const SubdivisionOptions more{.least_width = kWidth, .undecided_share = std::nextafter(undecided, 0)};
    EXPECT_FALSE(MapParts::is_enough(all, more));
    EXPECT_THROW((void)parts.assemble(trees, more), std::logic_error) << level;
  }
}

TEST(MapParts, OfASpaceThatIsDecidedBeforeAreNone) {
  const Problem problem = robot1_slice();
  const MapSpace space = make_map_space(problem.space);
  const MapParts parts(problem, space, 1.0 / 4);
  EXPECT_EQ(parts.size(), 0U);
  const SubdivisionOptions options{.least_width = 1.0 / 4, .undecided_share = 0};
  EXPECT_TRUE(are_same(subdivide(problem, space, options), parts.assemble({}, options)));
}

TEST(MapParts, SayWhereTheyAreNotKnownFarEnough) {
  const Problem problem = robot1_slice();
  const MapSpace space = make_map_space(problem.space);
  const MapParts parts(problem, space, kWidth);
  std::vector<std::string> trees;
  for (std::size_t n = 0; n < parts.size(); ++n) trees.push_back(parts.refine(n, parts.start(n), 14));
  EXPECT_THROW((void)parts.assemble(trees, {.least_width = kWidth, .undecided_share = 0}), std::logic_error);
  trees.pop_back();
  EXPECT_THROW((void)parts.assemble(trees, {.least_width = kWidth, .undecided_share = 0.9}), std::exception);
}

/// No byte of a tree may be cut off, added, or changed into one that no tree has.
TEST(MapParts, RefuseATreeThatIsNone) {
  const Problem problem = robot1_slice();
  const MapSpace space = make_map_space(problem.space);
  const MapParts parts(problem, space, kWidth);
  std::size_t part = 0;
  std::string tree;
  do tree = parts.refine(part, parts.start(part), 60);
  while (tree.size() < 20 && ++part < parts.size());
  ASSERT_GE(tree.size(), 20U);
  const auto refused = [&](const std::string& bytes) {
    EXPECT_THROW((void)parts.extent(part, bytes), MalformedTree);
    EXPECT_THROW((void)parts.refine(part, bytes, 60), MalformedTree);
  };
  for (std::size_t size = 0; size < tree.size(); ++size) refused(tree.substr(0, size));
  refused(tree + tree[0]);
  refused(tree + std::string(1, '\0'));
  refused("\x0F" + tree.substr(1));                          // no kind
  refused("\x28" + tree.substr(1));                          // halved along the third of two axes
  refused(std::string(1, '\0'));                             // undecided, and wide enough to be halved
  refused(std::string(1, '\x81') + std::string(2, '\0'));    // a reason that is 0
  refused(std::string("\x11"));                              // inside, with an axis
  refused('\x47' + std::string(8, '\0'));                    // not judged, but regular
  refused(std::string(40, '\x08') + std::string(41, '\1'));  // halved below the least width
  const auto level = static_cast<std::size_t>(parts.cell(part).halvings());
  EXPECT_EQ(parts.extent(part, "\1").decided[level], parts.cell(part).volume());  // inside as a whole
  EXPECT_EQ(parts.extent(part, parts.start(part)).first_open, level);
}

}  // namespace
}  // namespace taut::testing
