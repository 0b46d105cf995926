#include "kinematics/shown.h"

#include <fmt/format.h>

#include <algorithm>

namespace taut {
namespace {

constexpr std::size_t kMaxShown = 60;  // characters of a wrong value in a message

}  // namespace

std::size_t utf8_character_length(std::string_view text) {
  const auto byte = [&](std::size_t i) -> unsigned {
    return i < text.size() ? static_cast<unsigned char>(text[i]) : 0;
  };
  const auto is_between = [](unsigned value, unsigned lowest, unsigned highest) {
    return lowest <= value && value <= highest;
  };
  const unsigned lead = byte(0);
  if (is_between(lead, 0x01, 0x7F)) return 1;
  if (!is_between(lead, 0xC2, 0xF4)) return 0;
  const unsigned lowest = lead == 0xE0 ? 0xA0 : lead == 0xF0 ? 0x90 : 0x80;   // else there is a shorter form
  const unsigned highest = lead == 0xED ? 0x9F : lead == 0xF4 ? 0x8F : 0xBF;  // no surrogates, none above U+10FFFF
  const std::size_t length = lead < 0xE0 ? 2 : lead < 0xF0 ? 3 : 4;
  if (!is_between(byte(1), lowest, highest)) return 0;
  for (std::size_t i = 2; i < length; ++i) {
    if (!is_between(byte(i), 0x80, 0xBF)) return 0;
  }
  return length;
}

std::string shorten(const std::string& text) {
  std::size_t end = std::min(text.size(), kMaxShown);
  while (end < text.size() && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) --end;
  return end < text.size() ? text.substr(0, end) + "…" : text;
}

std::string without_control_characters(const std::string& text) {
  std::string result;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    result += byte < ' ' || byte == 0x7F ? fmt::format("\\x{:02x}", byte) : std::string(1, c);
  }
  return result;
}

std::string shown(std::string_view text) {
  std::string valid;
  while (!text.empty() && valid.size() <= kMaxShown) {
    const std::size_t length = utf8_character_length(text);
    valid += length == 0 ? fmt::format("\\x{:02x}", static_cast<unsigned char>(text.front()))
                         : std::string(text.substr(0, length));
    text.remove_prefix(std::max<std::size_t>(length, 1));
  }
  return without_control_characters(shorten(valid));
}

}  // namespace taut
