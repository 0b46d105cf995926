// SPDX-License-Identifier: GPL-3.0-or-later
// Plain values to bytes and back, in the order of memory; for files of this machine's kind.
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

/// Reads `count` values and moves `bytes` behind them. @pre there are as many.
template <class T>
void take_values(std::span<const std::byte>& bytes, T* values, std::size_t count) {
  static_assert(std::is_trivially_copyable_v<T>);
  std::memcpy(values, bytes.data(), sizeof(T) * count);
  bytes = bytes.subspan(sizeof(T) * count);
}

}  // namespace taut
