// SPDX-License-Identifier: GPL-3.0-or-later
// A JSON value that knows the path of keys that leads to it, so that an error names its place.
#pragma once

#include <array>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "checker/format/exact.h"

namespace taut::checker {

using Json = nlohmann::json;

/// Refers to the value, its name and the Cursor of its parent, which must live as long. Every member function that
/// reads throws Malformed with the path, where the value is not what the function is named after.
class Cursor {
 public:
  /// The value called `name`, or the element `index` of the list called `name`.
  Cursor(const Json& json, std::string_view name) : json_(json), name_(name) {}
  Cursor(const Json& json, std::string_view name, std::size_t index) : json_(json), name_(name), index_(index) {}

  /// A key that object() has found, or an index below size().
  Cursor operator[](const char* key) const& { return {json_.find(key).value(), key, this}; }
  Cursor at(std::size_t i) const& { return {json_[i], i, this}; }
  Cursor operator[](const char*) const&& = delete;
  Cursor at(std::size_t) const&& = delete;

  /// Requires an object with these keys, and none besides but the optional ones.
  void object(const std::vector<std::string_view>& keys, const std::vector<std::string_view>& optional = {}) const;
  [[nodiscard]] bool has(const char* key) const { return json_.is_object() && json_.contains(key); }
  [[nodiscard]] bool is_null() const { return json_.is_null(); }
  [[nodiscard]] const Json& json() const { return json_; }
  [[nodiscard]] std::size_t size() const;  ///< of an array
  void array(std::size_t size) const;      ///< requires an array of this size
  [[nodiscard]] const std::string& text() const;
  [[nodiscard]] std::int64_t integer(std::int64_t lowest, std::int64_t highest) const;
  [[nodiscard]] mpq_class decimal() const { return number(&parse_decimal, kDecimalForm); }
  [[nodiscard]] mpq_class dyadic() const { return number(&parse_dyadic, kDyadicForm); }
  [[nodiscard]] double binary64() const { return number(&parse_binary64, kBinary64Form); }
  [[nodiscard]] std::vector<double> binary64s(std::size_t size) const;
  /// The text of so many bytes in lower-case hex.
  [[nodiscard]] const std::string& hex(std::size_t bytes) const;

  template <std::size_t N>
  [[nodiscard]] std::array<mpq_class, N> decimals() const {
    array(N);
    std::array<mpq_class, N> result;
    for (std::size_t i = 0; i < N; ++i) result[i] = at(i).decimal();
    return result;
  }
  template <std::size_t Rows, std::size_t N>
  [[nodiscard]] std::array<std::array<mpq_class, N>, Rows> decimal_rows() const {
    array(Rows);
    std::array<std::array<mpq_class, N>, Rows> result;
    for (std::size_t i = 0; i < Rows; ++i) result[i] = at(i).decimals<N>();
    return result;
  }
  /// The value that belongs to the text.
  template <class Value>
  [[nodiscard]] Value one_of(std::initializer_list<std::pair<const char*, Value>> table, const char* expected) const {
    for (const auto& [name, value] : table) {
      if (text() == name) return value;
    }
    fail(expected);
  }

  [[nodiscard]] std::string where() const;
  [[noreturn]] void fail(const std::string& expected) const;

 private:
  static constexpr std::size_t kNoIndex = static_cast<std::size_t>(-1);
  Cursor(const Json& json, std::string_view name, const Cursor* parent) : json_(json), name_(name), parent_(parent) {}
  Cursor(const Json& json, std::size_t index, const Cursor* parent) : json_(json), index_(index), parent_(parent) {}

  template <class Number>
  [[nodiscard]] Number number(std::optional<Number> (*parse)(std::string_view), const char* form) const {
    const std::optional<Number> result = parse(text());
    if (!result) fail_number(form);
    return *result;
  }
  [[noreturn]] void fail_number(const char* form) const;

  const Json& json_;
  std::string_view name_;
  std::size_t index_ = kNoIndex;
  const Cursor* parent_ = nullptr;
};

}  // namespace taut::checker
