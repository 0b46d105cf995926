// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/json_cursor.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>

#include "problem/problem.h"

namespace taut {
namespace {

using nlohmann::json;

/// What is said of the value that `use` asks something of.
template <class Use>
std::string complaint(const json& value, Use use) {
  try {
    use(JsonCursor(value, "a"));
  } catch (const FieldError& error) {
    return error.what();
  }
  return "";
}

TEST(JsonCursor, PlacesAreThoseOfTheMembers) {
  const json value = json::parse(R"({"b": [{"c": "x"}, {}]})");
  const JsonCursor a(value, "a");
  EXPECT_EQ(a.at("b").at(1).where(), "a.b[1]");
  EXPECT_EQ(a.at("b").elements()[0].at("c").where(), "a.b[0].c");
  EXPECT_EQ(a.at("b").elements(2)[0].at("c").text(), "x");
  EXPECT_FALSE(a.contains("c"));
}

TEST(JsonCursor, WhatIsNotAsAskedIsShownWithItsPlace) {
  EXPECT_EQ(complaint(json::parse(R"({"b": 1})"), [](const JsonCursor& a) { (void)a.at("c"); }),
            "a: expected the key 'c'");
  EXPECT_EQ(complaint(3, [](const JsonCursor& a) { (void)a.at("c"); }), "a: got 3, expected an object");
  EXPECT_EQ(complaint(json::parse(R"({"b": {}})"), [](const JsonCursor& a) { (void)a.at("b").size(); }),
            "a.b: got {}, expected a list");
  EXPECT_EQ(complaint(json::parse("[1]"), [](const JsonCursor& a) { (void)a.at(1); }),
            "a: got [1], expected a list of at least 2");
  EXPECT_EQ(complaint(json::parse("[1]"), [](const JsonCursor& a) { (void)a.elements(2); }),
            "a: got [1], expected a list of 2");
  EXPECT_EQ(complaint(nullptr, [](const JsonCursor& a) { (void)a.text(); }), "a: got null, expected a string");
  EXPECT_EQ(complaint(json::parse(R"({"b": 1, "c": 2})"), [](const JsonCursor& a) { a.expect_keys({"b"}); }),
            "a: got 'c', expected only known keys");
}

TEST(JsonCursor, IntegersAreWholeAndWithinBounds) {
  const auto said = [](const json& value) {
    return complaint(value, [](const JsonCursor& a) { (void)a.integer(-5, 5); });
  };
  for (const json& good : {json(-5), json(5), json(0), json(std::uint64_t{5})}) EXPECT_EQ(said(good), "") << good;
  for (const json& bad :
       {json(-6), json(6), json(0.5), json(1.0), json("1"), json(true), json(),
        json(std::numeric_limits<std::uint64_t>::max()), json(std::numeric_limits<std::int64_t>::min())}) {
    EXPECT_EQ(said(bad), "a: got " + bad.dump() + ", expected a whole number from -5 to 5");
  }
}

TEST(JsonCursor, LongValuesAreCut) {
  EXPECT_EQ(complaint(std::string(1000, 'x'), [](const JsonCursor& a) { (void)a.size(); }),
            "a: got \"" + std::string(59, 'x') + "…, expected a list");
}

}  // namespace
}  // namespace taut
