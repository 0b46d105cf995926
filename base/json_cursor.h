// SPDX-License-Identifier: GPL-3.0-or-later
// JSON from outside. Each value knows its place in the file, so that error messages can name it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

#include "base/input_error.h"

namespace taut {

/// A value and its place, "path.waypoints[3].x". A value that is not what a member asks for is a FieldError that names
/// the place, the value seen and what was expected. The cursor refers to the value, which must outlive it.
class JsonCursor {
 public:
  JsonCursor(const nlohmann::json& value, std::string where) : value_(&value), where_(std::move(where)) {}

  JsonCursor(nlohmann::json&& value, std::string where) = delete;

  [[nodiscard]] const nlohmann::json& value() const { return *value_; }
  [[nodiscard]] const std::string& where() const { return where_; }
  [[nodiscard]] bool is_null() const;

  /// Whether the object has this member. @throws FieldError if the value is no object
  [[nodiscard]] bool contains(const char* key) const;
  /// Member of an object.
  [[nodiscard]] JsonCursor at(const char* key) const;
  /// Checks that the value is an object with exactly these keys.
  const JsonCursor& expect_keys(std::initializer_list<const char*> keys) const {
    return expect_keys(std::vector<std::string>(keys.begin(), keys.end()));
  }
  const JsonCursor& expect_keys(const std::vector<std::string>& keys) const;

  /// Length of a list.
  [[nodiscard]] std::size_t size() const;
  /// Element of a list.
  [[nodiscard]] JsonCursor at(std::size_t index) const;
  /// All elements of a list.
  [[nodiscard]] std::vector<JsonCursor> elements() const;
  /// All elements of a list of `size` elements.
  [[nodiscard]] std::vector<JsonCursor> elements(std::size_t size) const;

  [[nodiscard]] const std::string& text() const;
  /// An integer from `least` to `most`, inclusive.
  [[nodiscard]] std::int64_t integer(std::int64_t least, std::int64_t most) const;

  /// @throws FieldError saying that another value was `expected`, such as "a list".
  [[noreturn]] void fail(const std::string& expected) const;

 private:
  const nlohmann::json* value_;
  std::string where_;
};

}  // namespace taut
