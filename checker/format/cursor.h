// SPDX-License-Identifier: GPL-3.0-or-later
// A JSON value that knows the path of keys that leads to it, so that an error names its place.
#pragma once

#include <array>
#include <concepts>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
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
  Cursor(const Json& json, std::string_view name, std::size_t index = kNoIndex)
      : json_(json), name_(name), index_(index) {}

  /// Reads an object that has these keys and no other: `json.object("s", s, "segment", segment)`. After each key comes
  /// what takes its value: a variable for which there is a read() below, or a function of its Cursor. A key that ends
  /// in '?' may be missing, and a key that is a null pointer is none of the object's.
  template <class... KeysAndTargets>
  void object(KeysAndTargets&&... fields) const {
    std::vector<std::string_view> keys;
    collect_keys(keys, fields...);
    require_keys(keys);
    read_fields(fields...);
  }
  /// Calls `read(element, index)` for each element of an array.
  template <class Read>
  void elements(const Read& read) const {
    for (std::size_t i = 0; i < size(); ++i) read(at(i), i);
  }

  /// A key that is there, or an index below size().
  Cursor operator[](std::string_view key) const& { return {json_.find(key).value(), key, this}; }
  Cursor at(std::size_t i) const& { return {json_[i], i, this}; }
  Cursor operator[](std::string_view) const&& = delete;
  Cursor at(std::size_t) const&& = delete;

  [[nodiscard]] bool has(std::string_view key) const { return json_.is_object() && json_.contains(key); }
  [[nodiscard]] bool is_null() const { return json_.is_null(); }
  [[nodiscard]] const Json& json() const { return json_; }
  [[nodiscard]] std::size_t size() const;     ///< of an array
  void require_size(std::size_t size) const;  ///< requires an array of this size
  void require(bool holds, const char* expected) const {
    if (!holds) fail(expected);
  }
  [[nodiscard]] const std::string& text() const;
  [[nodiscard]] std::int64_t integer(std::int64_t lowest, std::int64_t highest) const;
  /// The value that belongs to the text.
  template <class Value>
  [[nodiscard]] Value one_of(std::span<const std::pair<const char*, Value>> table, const char* expected) const {
    for (const auto& [name, value] : table) {
      if (text() == name) return value;
    }
    fail(expected);
  }
  /// The number that `parse` makes of the text. @param form  what `parse` expects
  template <class Number>
  [[nodiscard]] Number number(std::optional<Number> (*parse)(std::string_view), const char* form) const {
    std::optional<Number> result = parse(text());
    if (!result) throw_malformed("got '" + text().substr(0, 60) + "', expected " + form);
    return *std::move(result);
  }

  [[nodiscard]] std::string where() const;
  [[noreturn]] void fail(const std::string& expected) const { throw_malformed("expected " + expected); }

 private:
  static constexpr std::size_t kNoIndex = static_cast<std::size_t>(-1);
  Cursor(const Json& json, std::string_view name, const Cursor* parent) : json_(json), name_(name), parent_(parent) {}
  Cursor(const Json& json, std::size_t index, const Cursor* parent) : json_(json), index_(index), parent_(parent) {}

  static void collect_keys(std::vector<std::string_view>& /*keys*/) {}
  template <class Target, class... Rest>
  static void collect_keys(std::vector<std::string_view>& keys, const char* key, const Target&, const Rest&... rest) {
    if (key != nullptr) keys.emplace_back(key);
    collect_keys(keys, rest...);
  }
  void read_fields() const {}
  template <class Target, class... Rest>
  void read_fields(const char* key, Target&& target, Rest&&... rest) const;
  void require_keys(std::span<const std::string_view> keys) const;
  [[noreturn]] void throw_malformed(const std::string& what) const;

  const Json& json_;
  std::string_view name_;
  std::size_t index_ = kNoIndex;
  const Cursor* parent_ = nullptr;
};

// What the values of the format are read into: a decimal, a binary64, a text; arrays of a fixed size or of any; and
// something that may be null. Other types have a read() in parts.h.

inline void read(const Cursor& json, mpq_class& x) { x = json.number(&parse_decimal, kDecimalForm); }
inline void read(const Cursor& json, double& x) { x = json.number(&parse_binary64, kBinary64Form); }
inline void read(const Cursor& json, std::string& x) { x = json.text(); }
template <class T, std::size_t Extent>
void read(const Cursor& json, std::span<T, Extent> x) {
  json.require_size(x.size());
  json.elements([&](const Cursor& element, std::size_t i) { read(element, x[i]); });
}
template <class T, std::size_t N>
void read(const Cursor& json, std::array<T, N>& x) {
  read(json, std::span(x));
}
template <class T>
void read(const Cursor& json, std::vector<T>& x) {
  x.resize(json.size());
  read(json, std::span(x));
}
template <class T>
void read(const Cursor& json, std::optional<T>& x) {
  if (!json.is_null()) read(json, x.emplace());
}

// Functions for object() that read what the type does not tell.

/// A dyadic in [0, 1].
inline auto dyadic(mpq_class& x) {
  return [&x](const Cursor& json) { x = json.number(&parse_dyadic, kDyadicForm); };
}
/// A rational, or an array of these or of such arrays.
template <class T>
auto rational(T& x) {
  return [&x](const Cursor& json) {
    if constexpr (std::same_as<T, mpq_class>) {
      x = json.number(&parse_rational, kRationalForm);
    } else {
      json.require_size(x.size());
      json.elements([&](const Cursor& element, std::size_t i) { rational(x[i])(element); });
    }
  };
}
template <class T>
auto integer(T& x, std::int64_t lowest, std::int64_t highest) {
  return [=, &x](const Cursor& json) { x = static_cast<T>(json.integer(lowest, highest)); };
}
/// An integer that is known.
inline auto exactly(std::size_t n) {
  return [n](const Cursor& json) { (void)json.integer(static_cast<std::int64_t>(n), static_cast<std::int64_t>(n)); };
}
/// A text that is known.
inline auto exactly(std::string_view text, const char* expected) {
  return [=](const Cursor& json) { json.require(json.text() == text, expected); };
}
/// The text of so many bytes in lower-case hex.
inline auto hex(std::string& digits, std::size_t bytes) {
  return [=, &digits](const Cursor& json) {
    digits = json.text();
    if (digits.size() != 2 * bytes || digits.find_first_not_of("0123456789abcdef") != std::string::npos) {
      json.fail(std::to_string(2 * bytes) + " lower-case hex digits");
    }
  };
}

template <class Target, class... Rest>
void Cursor::read_fields(const char* key, Target&& target, Rest&&... rest) const {
  const std::string_view name = key == nullptr ? "" : std::string_view(key).substr(0, std::string_view(key).find('?'));
  if (key != nullptr && has(name)) {
    const Cursor value = (*this)[name];
    if constexpr (std::invocable<Target, const Cursor&>) {
      target(value);
    } else {
      read(value, target);
    }
  }
  read_fields(rest...);
}

}  // namespace taut::checker
