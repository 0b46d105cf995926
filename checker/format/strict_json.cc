// SPDX-License-Identifier: GPL-3.0-or-later
#include "checker/format/strict_json.h"

#include <algorithm>
#include <iterator>
#include <vector>

#include "base/sha256.h"
#include "checker/kernel/errors.h"

namespace taut::checker {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kMaxNesting = 32;       ///< a certificate needs about 9
constexpr std::size_t kMaxBuffer = 1U << 16;  ///< bytes

/// The canonical text of a string.
std::string json_string(const std::string& text) {
  const auto is_plain = [](char c) { return c >= ' ' && c <= '~' && c != '"' && c != '\\'; };
  return std::ranges::all_of(text, is_plain) ? '"' + text + '"' : Json(text).dump(-1, ' ', true);
}

/// Iterates over a text and tells others how far it has come.
struct TextIterator {
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  reference operator*() const { return *at; }
  TextIterator& operator++() {
    *reached = ++at;
    return *this;
  }
  bool operator==(const TextIterator& other) const { return at == other.at; }

  const char* at;
  const char** reached;
};

/// Receives the events of the parser. For each it appends canonical text to what is digested.
class Handler final : public nlohmann::json_sax<Json> {
 public:
  explicit Handler(std::string_view text) : text_(text), reached_(text.data()) {}

  Outline read() {
    const char* const end = text_.data() + text_.size();
    Json::sax_parse(TextIterator{text_.data(), &reached_}, TextIterator{end, &reached_}, this);
    flush();
    outline_.body_sha256 = body_.hex();
    outline_.path_sha256 = path_.hex();
    return std::move(outline_);
  }

  bool null() override { return scalar("null", nullptr); }
  bool boolean(bool value) override { return scalar(value ? "true" : "false", value); }
  bool number_integer(number_integer_t value) override { return scalar(std::to_string(value), value); }
  bool number_unsigned(number_unsigned_t value) override { return scalar(std::to_string(value), value); }
  bool number_float(number_float_t /*value*/, const string_t& /*text*/) override {
    throw Malformed("a number that is no integer");
  }
  bool string(string_t& value) override { return scalar(json_string(value), value); }
  bool binary(binary_t& /*value*/) override { return false; }  // JSON has none
  bool start_object(std::size_t /*size*/) override { return open('{'); }
  bool start_array(std::size_t /*size*/) override { return open('['); }
  bool end_object() override { return close('}'); }
  bool end_array() override { return close(']'); }

  bool key(string_t& name) override {
    Container& object = open_.back();
    const bool is_top = open_.size() == 1;
    // What is known last may stand anywhere, out of its order.
    const bool is_closing = is_top && (name == "footer" || name == "signature");
    if (is_closing ? outline_.json.contains(name) : !object.is_empty && name == object.last) {
      throw Malformed("the key '" + name + "' appears twice in one object");
    }
    if (!object.is_empty && !is_closing && name < object.last) {
      throw Malformed("the key '" + name + "' comes after '" + object.last + "': expected keys in code-point order");
    }
    if (is_top) digest_from_here(!is_closing, false);
    write((object.is_empty ? "" : ",") + json_string(name) + ":");
    if (is_top && name == "path") digest_from_here(true, true);
    if (!is_closing) {
      object.is_empty = false;
      object.last = name;
    }
    object.key = name;
    return true;
  }

  bool parse_error(std::size_t position, const std::string& /*token*/,
                   const nlohmann::detail::exception& /*error*/) override {
    const auto end = text_.begin() + static_cast<std::ptrdiff_t>(std::min(position, text_.size()));
    throw Malformed("no JSON, or cut: line " + std::to_string(1 + std::count(text_.begin(), end, '\n')));
  }

 private:
  struct Container {
    bool is_array = false;
    bool is_empty = true;
    std::string key{};   ///< the one whose value comes next, of an object
    std::string last{};  ///< the last one in code-point order
  };

  /// Where the outline keeps the value that comes next, if it keeps it by itself.
  [[nodiscard]] Json* slot() {
    if (open_.empty()) return &outline_.json;
    if (open_[0].is_array || open_.size() > 2) return nullptr;
    Json& of_top = outline_.json[open_[0].key];
    if (open_.size() == 1) return &of_top;
    return open_[0].key == "path" && !open_[1].is_array ? &of_top[open_[1].key] : nullptr;
  }

  bool scalar(std::string_view canonical, const Json& value) {
    separate();
    write(canonical);
    if (Json* const kept = slot()) *kept = value;
    return true;
  }

  bool open(char bracket) {
    separate();
    write({&bracket, 1});
    if (open_.size() == kMaxNesting) throw Malformed("nested too deeply");
    if (Json* const kept = slot()) {
      *kept = bracket == '[' ? Json::array() : Json::object();
      begin_ = reached_ - 1;
    }
    open_.push_back({.is_array = bracket == '['});
    return true;
  }

  bool close(char bracket) {
    if (open_.size() == 1) digest_from_here(true, false);
    write({&bracket, 1});
    open_.pop_back();
    Json* const kept = slot();
    if (open_.empty() || kept == nullptr) return true;
    const std::string& key = open_.back().key;
    const std::string_view value(begin_, static_cast<std::size_t>(reached_ - begin_));
    const bool is_timing = open_.size() == 2 && key == "timing" && !kept->is_array();
    if (key == "segments" || key == "stretches" || key == "legs" || (open_.size() == 2 && !is_timing)) {
      if (kept->is_array()) outline_.lists[key] = value;
    } else if (key != "path" && key != "generator" && key != "illustration") {
      *kept = Json::parse(value);
    }
    return true;
  }

  /// Writes the comma before every element of an array but the first.
  void separate() {
    if (open_.empty() || !open_.back().is_array) return;
    if (!open_.back().is_empty) write(",");
    open_.back().is_empty = false;
  }

  void digest_from_here(bool is_body, bool is_path) {
    flush();
    is_body_ = is_body;
    is_path_ = is_path;
  }
  void write(std::string_view canonical) {
    buffer_ += canonical;
    if (buffer_.size() >= kMaxBuffer) flush();
  }
  void flush() {
    if (is_body_) body_.update(buffer_);
    if (is_path_) path_.update(buffer_);
    buffer_.clear();
  }

  std::string_view text_;
  const char* reached_;
  const char* begin_ = nullptr;  ///< of the value that the outline keeps
  Outline outline_;
  std::vector<Container> open_;
  std::string buffer_;  ///< canonical text that is not digested yet
  Sha256 body_, path_;
  bool is_body_ = true;
  bool is_path_ = false;
};

}  // namespace

Outline read_json(std::string_view text) {
  // The library would skip a byte order mark, and take a NUL byte for the end.
  if (text.starts_with("\xEF\xBB\xBF")) throw Malformed("no JSON: it begins with a byte order mark");
  if (text.find('\0') != std::string_view::npos) throw Malformed("no JSON: it contains a NUL byte");
  return Handler(text).read();
}

void for_each_element(std::string_view list, const std::function<void(const Json&, std::string_view)>& visit) {
  const char* reached = list.data();
  const char* begin = reached;
  const auto take = [&](int depth, Json::parse_event_t event, const Json& value) {
    using Event = Json::parse_event_t;
    if (depth == 1 && event == Event::object_start) begin = reached - 1;
    if (depth != 1 || (event != Event::value && event != Event::object_end && event != Event::array_end)) return true;
    visit(value, value.is_object() ? std::string_view(begin, reached) : std::string_view());
    return false;  // the list forgets it
  };
  [[maybe_unused]] const Json emptied =
      Json::parse(TextIterator{list.data(), &reached}, TextIterator{list.data() + list.size(), &reached}, take);
}

}  // namespace taut::checker
