// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/sanitize.h"

#include <fmt/format.h>
#include <utf8.h>

#include <algorithm>
#include <array>
#include <cstdint>

namespace taut {
namespace {

struct CodePoints {
  std::uint32_t first, last;
};

/// Unicode 15: the general categories Cc, Cf, Zl and Zp.
constexpr std::array<CodePoints, 23> kEscaped = {
    {{0x00, 0x1F},       {0x7F, 0x9F},       {0xAD, 0xAD},       {0x600, 0x605},     {0x61C, 0x61C},
     {0x6DD, 0x6DD},     {0x70F, 0x70F},     {0x890, 0x891},     {0x8E2, 0x8E2},     {0x180E, 0x180E},
     {0x200B, 0x200F},   {0x2028, 0x202E},   {0x2060, 0x2064},   {0x2066, 0x206F},   {0xFEFF, 0xFEFF},
     {0xFFF9, 0xFFFB},   {0x110BD, 0x110BD}, {0x110CD, 0x110CD}, {0x13430, 0x1343F}, {0x1BCA0, 0x1BCA3},
     {0x1D173, 0x1D17A}, {0xE0001, 0xE0001}, {0xE0020, 0xE007F}}};

bool is_escaped(std::uint32_t character) {
  return std::ranges::any_of(kEscaped,
                             [=](const CodePoints& c) { return c.first <= character && character <= c.last; });
}

std::string escaped(std::string_view bytes) {
  std::string result;
  for (const char c : bytes) result += fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
  return result;
}

/// Of a result of more than `max_bytes`, its beginning and "…".
std::string sanitize_up_to(std::size_t max_bytes, std::string_view text) {
  std::string result;
  const char* const end = text.data() + text.size();
  const char* valid_end = text.data();
  for (const char* at = text.data(); at != end;) {
    if (at == valid_end) valid_end = utf8::find_invalid(at, end);
    const char* next = at;
    const bool is_plain = at != valid_end && !is_escaped(utf8::unchecked::next(next));
    if (at == valid_end) valid_end = ++next;  // a byte that is no part of a character
    const std::string_view bytes(at, static_cast<std::size_t>(next - at));
    const std::string piece = is_plain ? std::string(bytes) : escaped(bytes);
    if (piece.size() > max_bytes - result.size()) return result + "…";
    result += piece;
    at = next;
  }
  return result;
}

}  // namespace

std::string sanitize(std::string_view text) { return sanitize_up_to(std::string_view::npos, text); }

std::string sanitize_lines(std::string_view text) {
  std::string result;
  for (std::size_t at = 0;;) {
    const std::size_t end = text.find('\n', at);
    result += sanitize(text.substr(at, end - at));
    if (end == std::string_view::npos) return result;
    result += '\n';
    at = end + 1;
  }
}

std::string excerpt(std::string_view text) {
  constexpr std::size_t kMaxBytes = 60;
  return sanitize_up_to(kMaxBytes, text);
}

std::size_t characters(std::string_view text) {
  return static_cast<std::size_t>(
      std::ranges::count_if(text, [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

std::size_t valid_utf8_prefix(std::string_view text) {
  const auto invalid = static_cast<std::size_t>(utf8::find_invalid(text.begin(), text.end()) - text.begin());
  return std::min(invalid, text.find('\0'));
}

}  // namespace taut
