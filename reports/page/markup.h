// SPDX-License-Identifier: GPL-3.0-or-later
// HTML that its content can't break: text becomes markup by escaping only.
//
// Certificates come from anywhere, and a case may be called "<script>". Therefore markup has a type of its own. It is
// made from literal templates, which fmt checks at compile time. Arguments are escaped unless they are markup already.
#pragma once

#include <fmt/format.h>

#include <concepts>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace taut {

/// `&`, `<`, `>` and both quotes as entities; control characters, which HTML forbids, as U+FFFD.
[[nodiscard]] std::string escape(std::string_view text);

class Html {
 public:
  Html() = default;
  [[nodiscard]] const std::string& str() const { return markup_; }
  [[nodiscard]] bool empty() const { return markup_.empty(); }
  Html& operator+=(const Html& other) {
    markup_ += other.markup_;
    return *this;
  }
  [[nodiscard]] friend Html operator+(Html a, const Html& b) { return a += b; }

  /// The text that replaces an argument: numbers and markup unchanged, text escaped.
  template <class T>
  [[nodiscard]] static auto escaped(const T& value) {
    if constexpr (std::same_as<T, Html>) {
      return std::string_view(value.markup_);
    } else if constexpr (std::convertible_to<const T&, std::string_view>) {
      return escape(value);
    } else {
      static_assert(std::is_arithmetic_v<T>, "markup is made of markup, text and numbers");
      return value;
    }
  }
  template <class T>
  using Escaped = decltype(escaped(std::declval<const T&>()));

  /// @see html
  template <class... Args>
  [[nodiscard]] static Html from(fmt::format_string<Escaped<Args>...> literal, const Args&... args) {
    Html result;
    result.markup_ = fmt::format(literal, escaped(args)...);
    return result;
  }

 private:
  std::string markup_;
  friend Html without_tags(const Html& markup);
};

/// The words of some markup, for the value of an attribute.
[[nodiscard]] Html without_tags(const Html& markup);

/// html("<b class=\"{}\">{}</b>", kind, text): the template is a literal, the arguments are escaped.
template <class... Args>
[[nodiscard]] Html html(fmt::format_string<Html::Escaped<Args>...> literal, const Args&... args) {
  return Html::from<Args...>(literal, args...);
}

struct Column {
  Html head;
  bool number = false;  ///< set flush right, in figures of equal width
};

/// A table that scrolls sideways if it is wider than the page. The cells of each row are in the order of `columns`.
[[nodiscard]] Html table(const Html& caption, const std::vector<Column>& columns,
                         const std::vector<std::vector<Html>>& rows);

/// A box that scrolls sideways if `body` is wider than the page, by keys, too; `name` says what is in it.
[[nodiscard]] Html scrollable(const Html& name, const Html& body);

/// `body`, folded under `summary` if it is `long_`. On paper it is always shown in full.
[[nodiscard]] Html folded(bool long_, const Html& summary, const Html& body);

/// A section of the page, under a heading of the second level.
[[nodiscard]] Html section(const char* id, const char* title, const Html& body);

}  // namespace taut
