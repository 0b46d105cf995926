// SPDX-License-Identifier: GPL-3.0-or-later
#include "checker/format/cursor.h"

#include <algorithm>

#include "checker/kernel/errors.h"

namespace taut::checker {

void Cursor::require_keys(std::span<const std::string_view> keys) const {
  require(json_.is_object(), "an object");
  for (const std::string_view key : keys) {
    if (!key.ends_with('?') && !json_.contains(key)) fail("the key '" + std::string(key) + "'");
  }
  for (const auto& item : json_.items()) {
    const auto is_item = [&](std::string_view key) { return key.substr(0, key.find('?')) == item.key(); };
    if (std::ranges::none_of(keys, is_item)) fail("no key '" + item.key() + "'");
  }
}

std::size_t Cursor::size() const {
  require(json_.is_array(), "an array");
  return json_.size();
}

void Cursor::require_size(std::size_t size) const {
  if (!json_.is_array() || json_.size() != size) fail("an array of " + std::to_string(size));
}

const std::string& Cursor::text() const {
  require(json_.is_string(), "a string");
  return json_.get_ref<const std::string&>();
}

std::int64_t Cursor::integer(std::int64_t lowest, std::int64_t highest) const {
  const bool fits =
      json_.is_number_integer() && (!json_.is_number_unsigned() || json_.get<std::uint64_t>() <= INT64_MAX);
  if (!fits || json_.get<std::int64_t>() < lowest || json_.get<std::int64_t>() > highest) {
    fail("an integer from " + std::to_string(lowest) + " to " + std::to_string(highest));
  }
  return json_.get<std::int64_t>();
}

std::string Cursor::where() const {
  const std::string name = std::string(name_) + (index_ == kNoIndex ? "" : "[" + std::to_string(index_) + "]");
  if (parent_ == nullptr) return name;
  const std::string parent = parent_->where();
  return parent + (parent.empty() || name_.empty() ? "" : ".") + name;
}

void Cursor::throw_malformed(const std::string& what) const {
  const std::string place = where();
  throw Malformed((place.empty() ? "certificate" : place) + ": " + what);
}

}  // namespace taut::checker
