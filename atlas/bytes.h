// SPDX-License-Identifier: GPL-3.0-or-later
// Copies plain values to bytes and back, in this machine's byte order.
#pragma once

#include <cstddef>
#include <cstring>
#include <span>
#include <string>
#include <type_traits>

namespace taut {

template <class T>
void append_values(std::string& bytes, const T* values, std::size_t count) {
  static_assert(std::is_trivially_copyable_v<T>);
  bytes.append(reinterpret_cast<const char*>(values), sizeof(T) * count);
}

/// Reads `count` values and removes them from `bytes`. @pre `bytes` holds as many.
template <class T>
void take_values(std::span<const std::byte>& bytes, T* values, std::size_t count) {
  static_assert(std::is_trivially_copyable_v<T>);
  std::memcpy(values, bytes.data(), sizeof(T) * count);
  bytes = bytes.subspan(sizeof(T) * count);
}

}  // namespace taut
