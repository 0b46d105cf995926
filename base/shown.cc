#include "base/shown.h"

#include <fmt/format.h>

#include <algorithm>

namespace taut {
namespace {

constexpr std::size_t kMaxShown = 60;  // characters of a wrong value in a message

/// ASCII's and C1, marks and overrides of direction, separators of lines.
bool is_control(std::string_view character) {
  const auto lead = static_cast<unsigned char>(character.front());
  if (character.size() == 1) return lead < ' ' || lead == 0x7F;
  if (character.size() == 2) return lead == 0xC2 && static_cast<unsigned char>(character[1]) < 0xA0;
  return (character >= "\u200E" && character <= "\u200F") || (character >= "\u2028" && character <= "\u202E") ||
         (character >= "\u2066" && character <= "\u2069");
}

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
  for (std::string_view rest = text; !rest.empty();) {
    const std::string_view character = rest.substr(0, std::max<std::size_t>(utf8_character_length(rest), 1));
    if (is_control(character)) {
      for (const char c : character) result += fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
    } else {
      result += character;
    }
    rest.remove_prefix(character.size());
  }
  return result;
}

std::string valid_utf8(std::string_view text) {
  std::string valid;
  while (!text.empty()) {
    const std::size_t length = utf8_character_length(text);
    valid += length == 0 ? fmt::format("\\x{:02x}", static_cast<unsigned char>(text.front()))
                         : std::string(text.substr(0, length));
    text.remove_prefix(std::max<std::size_t>(length, 1));
  }
  return valid;
}

std::string shown(std::string_view text) {
  constexpr std::size_t kLongest = 4;  // bytes of a character
  return without_control_characters(shorten(valid_utf8(text.substr(0, kMaxShown + kLongest))));
}

}  // namespace taut
