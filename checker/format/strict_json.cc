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
class TextIterator {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  TextIterator(const char* at, const char** reached) : at_(at), reached_(reached) {}
  reference operator*() const { return *at_; }
  TextIterator& operator++() {
    *reached_ = ++at_;
    return *this;
  }
  bool operator==(const TextIterator& other) const { return at_ == other.at_; }

 private:
  const char* at_;
  const char** reached_;
};

/// Receives the events of the parser. For each it appends canonical text to what is digested, and builds the outline.
class Handler final : public nlohmann::json_sax<Json> {
 public:
  using Visit = std::function<void(const Json&, const Element&)>;

  Handler(std::string_view text, const Visit& visit) : text_(text), visit_(visit), reached_(text.data()) {}

  Outline read() {
    Json::sax_parse(TextIterator(text_.data(), &reached_), TextIterator(text_.data() + text_.size(), &reached_), this);
    flush();
    return {std::move(root_), std::move(problem_), body_.hex(), path_.hex(), problem_digest_.hex()};
  }

  bool null() override { return scalar("null", nullptr); }
  bool boolean(bool value) override { return scalar(value ? "true" : "false", value); }
  bool number_integer(number_integer_t value) override { return scalar(std::to_string(value), value); }
  bool number_unsigned(number_unsigned_t value) override { return scalar(std::to_string(value), value); }
  bool number_float(number_float_t /*value*/, const string_t& /*text*/) override {
    throw Malformed("a number that is no integer");
  }
  bool string(string_t& value) override {
    const std::string canonical = json_string(value);
    return scalar(canonical, std::move(value));
  }
  bool binary(binary_t& /*value*/) override { return false; }  // JSON has none
  bool start_object(std::size_t /*size*/) override { return open(false); }
  bool start_array(std::size_t /*size*/) override { return open(true); }
  bool end_object() override { return close("}"); }
  bool end_array() override { return close("]"); }

  bool key(string_t& name) override {
    Container& object = open_.back();
    const bool is_top = open_.size() == 1;
    // What is known last may stand last, out of its order.
    const bool is_closing = is_top && (name == "footer" || name == "signature");
    if ((!object.is_empty && name == object.last) || (is_closing && root_.contains(name))) {
      throw Malformed("the key '" + name + "' appears twice in one object");
    }
    if (!object.is_empty && !is_closing && name < object.last) {
      throw Malformed("the key '" + name + "' comes after '" + object.last + "': expected keys in code-point order");
    }
    if (is_top) choose_digests(!is_closing);
    write((object.is_empty ? "" : ",") + json_string(name) + ":");
    if (is_top && (name == "path" || name == "problem")) {
      flush();
      digests_.push_back(name == "path" ? &path_ : &problem_digest_);
      is_problem_ = name == "problem";
    }
    object.is_empty = false;
    if (!is_closing) object.last = name;
    object.key = std::move(name);
    return true;
  }

  bool parse_error(std::size_t position, const std::string& /*token*/,
                   const nlohmann::detail::exception& /*error*/) override {
    const auto end = text_.begin() + static_cast<std::ptrdiff_t>(std::min(position, text_.size()));
    throw Malformed("no JSON, or cut: line " + std::to_string(1 + std::count(text_.begin(), end, '\n')));
  }

 private:
  struct Container {
    Json* json = nullptr;  ///< null where the outline leaves its content out
    bool is_array = false;
    bool is_empty = true;
    std::string key{};   ///< the one whose value comes next, of an object
    std::string last{};  ///< the last one in code-point order
  };

  bool scalar(std::string_view canonical, Json value) {
    separate();
    write(canonical);
    place(std::move(value));
    visit_element({});
    return true;
  }

  bool open(bool is_array) {
    separate();
    write(is_array ? "[" : "{");
    if (open_.size() == kMaxNesting) throw Malformed("nested too deeply");
    if (open_.size() == list_depth_) element_begin_ = static_cast<std::size_t>(reached_ - text_.data()) - 1;
    const std::string list = is_array ? list_name() : "";
    Json* const json = place(is_array ? Json::array() : Json::object());
    const bool is_left_out = open_.size() == 1 && (open_[0].key == "generator" || open_[0].key == "illustration");
    open_.push_back({is_left_out ? nullptr : json, is_array});
    if (!list.empty()) {
      list_ = list;
      list_depth_ = open_.size();
      index_ = 0;
    }
    return true;
  }

  bool close(const char* bracket) {
    if (open_.size() == 1) choose_digests(true);
    write(bracket);
    if (open_.size() == list_depth_) list_depth_ = kNoList;
    open_.pop_back();
    visit_element(text_.substr(element_begin_, static_cast<std::size_t>(reached_ - text_.data()) - element_begin_));
    return true;
  }

  /// The name of the list that begins here, if its elements are to be visited.
  [[nodiscard]] std::string list_name() const {
    if (open_.size() == 1 && (open_[0].key == "segments" || open_[0].key == "stretches")) return open_[0].key;
    if (open_.size() != 2 || open_[0].key != "path" || open_[1].is_array) return "";
    const std::string& key = open_[1].key;
    return key == "waypoints" || key == "tubes" || key == "pose_tubes" || key == "times" ? "path." + key : "";
  }

  /// Hands over the value that was just completed, if it is an element of a list that is visited.
  void visit_element(std::string_view text) {
    if (open_.size() != list_depth_) return;
    Json& list = *open_.back().json;
    visit_(root_, {list_, index_++, list.back(), list.back().is_object() ? text : std::string_view()});
    list.clear();
  }

  /// Puts a value where it belongs in the outline.
  Json* place(Json value) {
    if (open_.empty()) return &(root_ = std::move(value));
    Container& parent = open_.back();
    if (parent.json == nullptr) return nullptr;
    if (!parent.is_array) return &((*parent.json)[parent.key] = std::move(value));
    parent.json->push_back(std::move(value));
    return &parent.json->back();
  }

  /// Writes the comma before every element of an array but the first.
  void separate() {
    if (open_.empty() || !open_.back().is_array) return;
    if (!open_.back().is_empty) write(",");
    open_.back().is_empty = false;
  }

  void choose_digests(bool has_body) {
    flush();
    digests_.clear();
    if (has_body) digests_.push_back(&body_);
    is_problem_ = false;
  }
  void write(std::string_view canonical) {
    buffer_ += canonical;
    if (buffer_.size() >= kMaxBuffer) flush();
  }
  void flush() {
    for (Sha256* digest : digests_) digest->update(buffer_);
    if (is_problem_) problem_ += buffer_;
    buffer_.clear();
  }

  static constexpr std::size_t kNoList = static_cast<std::size_t>(-1);
  std::string_view text_;
  const Visit& visit_;
  const char* reached_;
  Json root_;
  std::vector<Container> open_;
  std::string list_;                  ///< the one whose elements are being visited,
  std::size_t list_depth_ = kNoList;  ///< its depth,
  std::size_t index_ = 0;             ///< and its next element
  std::size_t element_begin_ = 0;
  std::string buffer_;
  Sha256 body_, path_, problem_digest_;
  std::vector<Sha256*> digests_ = {&body_};
  std::string problem_;
  bool is_problem_ = false;
};

}  // namespace

Outline read_json(std::string_view text, const std::function<void(const Json&, const Element&)>& visit) {
  // The library would skip a byte order mark, and take a NUL byte for the end.
  if (text.starts_with("\xEF\xBB\xBF")) throw Malformed("no JSON: it begins with a byte order mark");
  if (text.find('\0') != std::string_view::npos) throw Malformed("no JSON: it contains a NUL byte");
  try {
    return Handler(text, visit).read();
  } catch (const Json::exception& error) {
    throw Malformed(std::string("no JSON, or cut: ") + error.what());
  }
}

}  // namespace taut::checker
