// SPDX-License-Identifier: GPL-3.0-or-later
#include "atlas/atlas_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "atlas/search.h"
#include "base/input_error.h"
#include "tests/atlas/sealed.h"
#include "tests/atlas/surfaces.h"
#include "tests/support/temporary_file.h"

namespace taut {
namespace {

using testing::AtlasFilePlaces;
using testing::coordinates;
using testing::kGreedy;

AtlasKey key() {
  AtlasKey key;
  key.problem = std::string(64, 'a');
  key.options.radius = 0.2;
  key.options.epsilon = 0.1;
  return key;
}

/// An atlas with a frontier: a path's charts, none of them beyond the goal.
template <class M>
Atlas half_grown(const M& manifold, const Coordinates& start, int charts) {
  Atlas atlas(manifold, key().options);
  const int first = *atlas.add(start);
  for (int id = first; atlas.size() < charts && id < atlas.size(); ++id) atlas.expand(id);
  return atlas;
}

std::string message_of(const std::string& bytes, const AtlasKey& wanted = key()) {
  const testing::TemporaryFile file(bytes);
  try {
    const AtlasFile opened(file.path(), wanted);
    return "accepted";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr(file.path().string()));
    return error.what();
  }
}

void expect_same(const Atlas& a, const Atlas& b) {
  ASSERT_EQ(a.size(), b.size());
  for (int id = 0; id < a.size(); ++id) {
    ASSERT_EQ(a.neighbours(id), b.neighbours(id)) << id;
    ASSERT_EQ(a.complete(id), b.complete(id)) << id;
    ASSERT_EQ(a.coordinates(id), b.coordinates(id)) << id;
    ASSERT_EQ(a.chart(id).radius, b.chart(id).radius) << id;
    std::string left, right;
    std::visit([&](const auto& polytope) { polytope.append_bytes(left); }, a.chart(id).polytope);
    std::visit([&](const auto& polytope) { polytope.append_bytes(right); }, b.chart(id).polytope);
    ASSERT_EQ(left, right) << id;
  }
}

double angle_between(const Coordinates& a, const Coordinates& b) { return (a - b).norm(); }

SearchProblem from_to(const Coordinates& start, const Coordinates& goal) {
  SearchProblem problem;
  problem.start = start;
  problem.goal = goal;
  problem.cost = angle_between;
  problem.heuristic = angle_between;
  problem.edge_ok = [](const Coordinates&, const Coordinates&) { return true; };
  return problem;
}

const testing::FlatTorus& torus(int dimension) {
  static const testing::FlatTorus two({0, 1.0}), three({0, 0, 0.5}), four({0, 0.5, 0.4, 0.4});
  return dimension == 2 ? two : dimension == 3 ? three : four;
}

TEST(AtlasFile, GivesTheSavedAtlasBitForBit) {
  for (const int n : {2, 3, 4}) {
    const Atlas saved = half_grown(torus(n), Coordinates::Zero(n), 150);
    const testing::TemporaryFile file(AtlasFile::bytes_of(saved, key(), 0.01));
    const AtlasFile opened(file.path(), key());
    EXPECT_EQ(opened.clearance(), 0.01);
    expect_same(saved, Atlas(torus(n), key().options, opened));
  }
}

TEST(AtlasFile, GoesOnAsTheSavedAtlasWould) {
  for (const int n : {2, 3, 4}) {
    for (const double weight : {1.0, kGreedy}) {
      Atlas saved = half_grown(torus(n), Coordinates::Zero(n), 150);
      const testing::TemporaryFile file(AtlasFile::bytes_of(saved, key(), 0));
      const AtlasFile opened(file.path(), key());
      Atlas loaded(torus(n), key().options, opened);
      for (const double to : {0.43, 2.9, -1.7}) {  // known ground, the far side, and back
        Coordinates goal = Coordinates::Constant(n, 0.31);
        goal[0] = to;
        const SearchResult one = search(saved, from_to(Coordinates::Constant(n, -0.123), goal), {.weight = weight});
        const SearchResult other = search(loaded, from_to(Coordinates::Constant(n, -0.123), goal), {.weight = weight});
        ASSERT_EQ(one.status, SearchStatus::kFound);
        EXPECT_EQ(one.cost, other.cost);
        EXPECT_EQ(one.charts, other.charts);
        ASSERT_EQ(one.path.size(), other.path.size());
        for (std::size_t k = 0; k < one.path.size(); ++k) EXPECT_EQ(one.path[k].coordinates, other.path[k].coordinates);
      }
      expect_same(saved, loaded);
    }
  }
}

TEST(AtlasFile, OfALoadedAtlasIsTheFileOfTheSavedOne) {
  Atlas saved = half_grown(torus(2), Coordinates::Zero(2), 100);
  const testing::TemporaryFile file(AtlasFile::bytes_of(saved, key(), 0));
  const AtlasFile opened(file.path(), key());
  Atlas loaded(torus(2), key().options, opened);
  EXPECT_TRUE(saved.grow_all());
  EXPECT_TRUE(loaded.grow_all());
  const testing::TemporaryFile first(AtlasFile::bytes_of(saved, key(), 0)),
      second(AtlasFile::bytes_of(loaded, key(), 0));
  const AtlasFile one(first.path(), key()), other(second.path(), key());
  expect_same(Atlas(torus(2), key().options, one), Atlas(torus(2), key().options, other));
}

TEST(AtlasFile, OfAWholeSurfaceNeedsNoChartButStartAndGoal) {
  Atlas saved = half_grown(torus(2), Coordinates::Zero(2), 1);
  ASSERT_TRUE(saved.grow_all());
  const testing::TemporaryFile file(AtlasFile::bytes_of(saved, key(), 0));
  const AtlasFile opened(file.path(), key());
  Atlas loaded(torus(2), key().options, opened);
  const auto found = search(loaded, from_to(coordinates({-2, -0.5}), coordinates({0.7, 0.6})), {});
  EXPECT_EQ(found.status, SearchStatus::kFound);
  EXPECT_EQ(found.charts, saved.size() + 2);
}

TEST(AtlasFile, OfAnotherKeyIsRefusedAndSaysWhy) {
  const std::string bytes = AtlasFile::bytes_of(half_grown(torus(2), Coordinates::Zero(2), 20), key(), 0.01);
  ASSERT_EQ(message_of(bytes), "accepted");
  AtlasKey other = key();
  other.options.max_charts = 3;
  EXPECT_EQ(message_of(bytes, other), "accepted");
  other.problem[63] = 'b';
  EXPECT_THAT(message_of(bytes, other), ::testing::HasSubstr("of another problem"));
  other = key();
  other.options.radius = 0.3;
  EXPECT_THAT(message_of(bytes, other), ::testing::HasSubstr("planner.radius 0.2, expected 0.3"));
  other = key();
  other.weights.clearance = 0.02;
  EXPECT_THAT(message_of(bytes, other), ::testing::HasSubstr("planner.clearance 0.01, expected 0.02"));
  for (double* value : {&other.options.epsilon, &other.options.min_tangent_cosine, &other.options.step,
                        &other.weights.parameter, &other.weights.slack}) {
    other = key();
    *value *= 0.99;
    EXPECT_THAT(message_of(bytes, other), ::testing::HasSubstr("expected")) << *value;
  }
  other = key();
  other.options.max_halvings = 2;
  EXPECT_THAT(message_of(bytes, other), ::testing::HasSubstr("halvings"));
}

TEST(AtlasFile, OfAnotherManifoldIsRefused) {
  const Atlas saved = half_grown(torus(2), coordinates({0.5, 0.25}), 20);
  const testing::TemporaryFile file(AtlasFile::bytes_of(saved, key(), 0));
  const AtlasFile opened(file.path(), key());
  EXPECT_THROW(Atlas(torus(3), key().options, opened), InputError);
  EXPECT_THROW(Atlas(testing::FlatTorus({0, 0}), key().options, opened), InputError);
  EXPECT_THROW(Atlas(testing::FlatTorus({0, 0.1}), key().options, opened), InputError);
}

TEST(AtlasFile, OfAnotherVersionOrNoneIsRefused) {
  std::string bytes = AtlasFile::bytes_of(half_grown(torus(2), Coordinates::Zero(2), 20), key(), 0);
  EXPECT_THAT(message_of(""), ::testing::HasSubstr("0 bytes"));
  EXPECT_THAT(message_of("taut"), ::testing::HasSubstr("4 bytes"));
  EXPECT_THAT(message_of(std::string(100000, '\0')), ::testing::HasSubstr("is no atlas file"));
  testing::set_number<std::uint32_t>(bytes, AtlasFilePlaces::kVersion, kAtlasFileVersion + 1);
  EXPECT_THAT(message_of(bytes), ::testing::HasSubstr("version"));
  for (const char* path : {"/nowhere/at/all", "/tmp", "/dev/zero"}) {
    EXPECT_THROW(AtlasFile(path, key()), InputError) << path;
  }
}

/// Whether anything noticed that the file was damaged: all of it is looked at.
bool refused(const std::string& bytes, const Manifold& manifold) {
  const testing::TemporaryFile file(bytes);
  try {
    const AtlasFile opened(file.path(), key());
    const Atlas loaded(manifold, key().options, opened);
    for (int id = 0; id < loaded.size(); ++id) static_cast<void>(loaded.chart(id));
    return false;
  } catch (const InputError&) {
    return true;
  }
}

TEST(AtlasFile, OneByteAlteredAnywhereIsNoticed) {
  const Atlas saved = half_grown(torus(2), Coordinates::Zero(2), 10);
  const std::string bytes = AtlasFile::bytes_of(saved, key(), 0);
  ASSERT_FALSE(refused(bytes, torus(2)));
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    std::string altered = bytes;
    altered[at] = static_cast<char>(altered[at] ^ (1 << (at % 8)));
    ASSERT_TRUE(refused(altered, torus(2))) << at;
  }
}

TEST(AtlasFile, CutOrExtendedIsNoticed) {
  const std::string bytes = AtlasFile::bytes_of(half_grown(torus(2), Coordinates::Zero(2), 10), key(), 0);
  for (std::size_t size = 0; size < bytes.size(); size += 7)
    ASSERT_TRUE(refused(bytes.substr(0, size), torus(2))) << size;
  for (const std::size_t more : {1, 8, 1000}) EXPECT_TRUE(refused(bytes + std::string(more, '\0'), torus(2)));
}

// Whatever a file says, with its checksums made right: it is refused, or searched to an end within the charts allowed.
TEST(AtlasFile, ForgedCostsTimeAtMost) {
  for (const int n : {2, 3, 4}) {
    const Atlas saved = half_grown(torus(n), Coordinates::Zero(n), 60);
    const std::string bytes = AtlasFile::bytes_of(saved, key(), 0);
    const AtlasFilePlaces places(bytes);
    std::string untouched = bytes;
    testing::seal(untouched, places);
    ASSERT_TRUE(untouched == bytes) << "the test knows the format";
    AtlasOptions options = key().options;
    options.max_charts = 400;
    std::mt19937 random(static_cast<unsigned>(n));
    int searched = 0;
    for (int round = 0; round < 300; ++round) {
      std::string forged = bytes;
      // Half of the rounds leave the tables alone that are checked in whole.
      const std::size_t from = round % 2 == 0 ? 0 : places.polytopes;
      for (int flips = 1 + static_cast<int>(random() % 8); flips > 0; --flips) {
        const std::size_t at = from + random() % (forged.size() - from);
        forged[at] = static_cast<char>(random() % 3 == 0 ? random() : forged[at] ^ (1u << random() % 8));
      }
      if (round % 50 == 0) forged.resize(random() % forged.size());
      testing::seal(forged, places);
      const testing::TemporaryFile file(forged);
      try {
        const AtlasFile opened(file.path(), key());
        Atlas loaded(torus(n), options, opened);
        Coordinates goal = Coordinates::Constant(n, 0.31);
        goal[0] = 1.2;
        const double weight = round % 4 < 2 ? 1.0 : kGreedy;
        EXPECT_LE(search(loaded, from_to(Coordinates::Constant(n, -0.1), goal), {.weight = weight}).charts, 402);
        loaded.grow_all();
        static_cast<void>(AtlasFile::bytes_of(loaded, key(), 0));
        ++searched;
      } catch (const InputError&) {
      }
    }
    EXPECT_GT(searched, 10) << "some forgeries are plausible";
  }
}

}  // namespace
}  // namespace taut
