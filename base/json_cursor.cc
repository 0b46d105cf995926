// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/json_cursor.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/sanitize.h"

namespace taut {

using nlohmann::json;

bool JsonCursor::is_null() const { return value_->is_null(); }

bool JsonCursor::contains(const char* key) const {
  if (!value_->is_object()) fail("an object");
  return value_->contains(key);
}

JsonCursor JsonCursor::at(const char* key) const {
  if (!contains(key)) throw FieldError(where_, "", fmt::format("expected the key '{}'", key));
  return {(*value_)[key], fmt::format("{}.{}", where_, key)};
}

const JsonCursor& JsonCursor::expect_keys(const std::vector<std::string>& keys) const {
  for (const std::string& key : keys) {
    if (!contains(key.c_str())) throw FieldError(where_, "", fmt::format("expected the key '{}'", key));
  }
  for (const auto& [key, member] : value_->items()) {
    if (std::find(keys.begin(), keys.end(), key) == keys.end()) {
      throw FieldError(where_, "'" + excerpt(key) + "'", "expected only known keys");
    }
  }
  return *this;
}

std::size_t JsonCursor::size() const {
  if (!value_->is_array()) fail("a list");
  return value_->size();
}

JsonCursor JsonCursor::at(std::size_t index) const {
  if (index >= size()) fail(fmt::format("a list of at least {}", index + 1));
  return {(*value_)[index], fmt::format("{}[{}]", where_, index)};
}

std::vector<JsonCursor> JsonCursor::elements() const {
  std::vector<JsonCursor> result;
  result.reserve(size());
  for (std::size_t i = 0; i < value_->size(); ++i) result.push_back(at(i));
  return result;
}

std::vector<JsonCursor> JsonCursor::elements(std::size_t size) const {
  if (!value_->is_array() || value_->size() != size) fail(fmt::format("a list of {}", size));
  return elements();
}

const std::string& JsonCursor::text() const {
  if (!value_->is_string()) fail("a string");
  return value_->get_ref<const std::string&>();
}

std::int64_t JsonCursor::integer(std::int64_t least, std::int64_t most) const {
  const bool fits = value_->is_number_integer() &&
                    (!value_->is_number_unsigned() || std::in_range<std::int64_t>(value_->get<std::uint64_t>()));
  if (!fits || value_->get<std::int64_t>() < least || value_->get<std::int64_t>() > most) {
    fail(fmt::format("a whole number from {} to {}", least, most));
  }
  return value_->get<std::int64_t>();
}

void JsonCursor::fail(const std::string& expected) const {
  constexpr std::size_t kShown = 60;
  std::string seen = value_->dump(-1, ' ', true, json::error_handler_t::replace);
  if (seen.size() > kShown) seen = seen.substr(0, kShown) + "…";
  throw FieldError(where_, seen, "expected " + expected);
}

}  // namespace taut
