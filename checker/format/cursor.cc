// SPDX-License-Identifier: GPL-3.0-or-later
#include "checker/format/cursor.h"

#include <algorithm>

#include "checker/kernel/errors.h"

namespace taut::checker {

void Cursor::object(const std::vector<std::string_view>& keys, const std::vector<std::string_view>& optional) const {
  if (!json_.is_object()) fail("an object");
  for (const std::string_view key : keys) {
    if (!json_.contains(key)) fail("the key '" + std::string(key) + "'");
  }
  if (json_.size() == keys.size()) return;
  for (const auto& item : json_.items()) {
    const bool is_known =
        std::ranges::find(keys, item.key()) != keys.end() || std::ranges::find(optional, item.key()) != optional.end();
    if (!is_known) fail("no key '" + item.key() + "'");
  }
}

std::size_t Cursor::size() const {
  if (!json_.is_array()) fail("an array");
  return json_.size();
}

void Cursor::array(std::size_t size) const {
  if (!json_.is_array() || json_.size() != size) fail("an array of " + std::to_string(size));
}

const std::string& Cursor::text() const {
  if (!json_.is_string()) fail("a string");
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

std::vector<double> Cursor::binary64s(std::size_t size) const {
  array(size);
  std::vector<double> result(size);
  for (std::size_t i = 0; i < size; ++i) result[i] = at(i).binary64();
  return result;
}

const std::string& Cursor::hex(std::size_t bytes) const {
  const std::string& digits = text();
  if (digits.size() != 2 * bytes || digits.find_first_not_of("0123456789abcdef") != std::string::npos) {
    fail(std::to_string(2 * bytes) + " lower-case hex digits");
  }
  return digits;
}

std::string Cursor::where() const {
  const std::string index = index_ == kNoIndex ? "" : "[" + std::to_string(index_) + "]";
  const std::string name = std::string(name_) + index;
  if (parent_ == nullptr) return name;
  const std::string parent = parent_->where();
  return parent + (parent.empty() || name_.empty() ? "" : ".") + name;
}

void Cursor::fail(const std::string& expected) const {
  const std::string place = where();
  throw Malformed((place.empty() ? "certificate" : place) + ": expected " + expected);
}

void Cursor::fail_number(const char* form) const {
  throw Malformed(where() + ": got '" + text().substr(0, 60) + "', expected " + form);
}

}  // namespace taut::checker
