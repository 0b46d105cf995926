// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/xml_element.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <set>
#include <string_view>

#include "base/input_error.h"
#include "base/sanitize.h"

namespace taut {
namespace {

constexpr const char* kWhiteSpace = " \t\r\n";

std::string trimmed(const std::string& text) {
  const std::size_t begin = text.find_first_not_of(kWhiteSpace);
  if (begin == std::string::npos) return "";
  return text.substr(begin, text.find_last_not_of(kWhiteSpace) - begin + 1);
}

bool is_text(pugi::xml_node node) { return node.type() == pugi::node_pcdata || node.type() == pugi::node_cdata; }

bool is_one_of(const char* name, std::initializer_list<const char*> names) {
  return std::ranges::any_of(names, [&](const char* known) { return std::string_view(known) == name; });
}

std::string listed(std::initializer_list<const char*> names) {
  return names.size() == 0 ? "none" : fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace

XmlDocument::XmlDocument(std::string file, const std::string& text) : file_(std::move(file)) {
  for (std::size_t at = text.find('\n'); at != std::string::npos; at = text.find('\n', at + 1)) {
    line_ends_.push_back(static_cast<std::ptrdiff_t>(at));
  }
  const auto fail = [&](std::ptrdiff_t offset, const std::string& seen, const std::string& expected) {
    throw InputError(fmt::format("{}:{}: got {}, expected {}", file_, line(offset), seen, expected),
                     {file_, line(offset), {}});
  };
  const std::size_t valid = valid_utf8_prefix(text);
  if (valid < text.size()) fail(static_cast<std::ptrdiff_t>(valid), "a byte that is not UTF-8", "XML in UTF-8");
  const pugi::xml_parse_result parsed = document_.load_buffer(
      text.data(), text.size(),
      pugi::parse_default | pugi::parse_declaration | pugi::parse_doctype | pugi::parse_fragment, pugi::encoding_utf8);
  if (!parsed) {
    std::string what = parsed.description();
    what[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(what[0])));
    fail(parsed.offset, "no XML (" + what + ")", "a well-formed file");
  }
  require_one_root();
}

void XmlDocument::require_one_root() const {
  const auto fail = [&](pugi::xml_node node, const std::string& seen, const std::string& expected) {
    const std::size_t at = line(node.offset_debug());
    throw InputError(fmt::format("{}:{}: got {}, expected {}", file_, at, seen, expected), {file_, at, {}});
  };
  for (const pugi::xml_node node : document_.children()) {
    if (node.type() == pugi::node_doctype && std::string_view(node.value()).find("<!ENTITY") != std::string::npos) {
      fail(node, "a declaration of entities", "none: only numbers and names are read");
    }
    if (node.type() == pugi::node_element && node != root()) {
      fail(node, fmt::format("the second root element <{}>", excerpt(node.name())), "one root element");
    }
    if (is_text(node)) fail(node, "text outside of the root element", "none");
    std::string encoding = node.type() == pugi::node_declaration ? node.attribute("encoding").value() : "";
    std::ranges::transform(encoding, encoding.begin(), [](unsigned char c) { return std::tolower(c); });
    if (!encoding.empty() && encoding != "utf-8" && encoding != "us-ascii") {
      fail(node, fmt::format("the encoding '{}'", excerpt(encoding)), "utf-8");
    }
  }
}

std::size_t XmlDocument::line(std::ptrdiff_t offset) const {
  return static_cast<std::size_t>(std::ranges::lower_bound(line_ends_, offset) - line_ends_.begin()) + 1;
}

XmlElement::XmlElement(const XmlDocument& document, std::initializer_list<const char*> names)
    : XmlElement(document, document.root(), document.root().name()) {
  if (!is_one_of(node_.name(), names)) {
    fail(fmt::format("the root element <{}>", excerpt(name())), fmt::format("<{}>", fmt::join(names, "> or <")));
  }
}

void XmlElement::fail(const std::string& seen, const std::string& expected) const {
  const std::size_t line = document_->line(node_.offset_debug());
  throw InputError(fmt::format("{}:{}: {}: got {}, expected {}", file(), line, field_, seen, expected),
                   {file(), line, field_});
}

std::vector<XmlElement> XmlElement::children() const {
  std::map<std::string, int> total;
  for (const pugi::xml_node node : node_.children()) {
    if (is_text(node)) fail(fmt::format("the text '{}'", excerpt(trimmed(node.value()))), "elements only");
    if (node.type() == pugi::node_element) ++total[node.name()];
  }
  std::map<std::string, int> count;
  std::vector<XmlElement> result;
  for (const pugi::xml_node node : node_.children()) {
    if (node.type() != pugi::node_element) continue;
    const std::string number = total[node.name()] > 1 ? fmt::format("[{}]", ++count[node.name()]) : "";
    result.push_back(XmlElement(*document_, node, fmt::format("{}.{}{}", field_, node.name(), number)));
  }
  return result;
}

void XmlElement::require_known(std::initializer_list<const char*> elements,
                               std::initializer_list<const char*> attributes) const {
  for (const XmlElement& element : children()) {
    if (is_one_of(element.node_.name(), elements)) continue;
    element.fail(fmt::format("<{}>, which taut does not read", excerpt(element.name())), listed(elements));
  }
  std::set<std::string> seen;
  for (const pugi::xml_attribute attribute : node_.attributes()) {
    if (!is_one_of(attribute.name(), attributes)) {
      fail(fmt::format("the attribute '{}', which taut does not read", excerpt(attribute.name())), listed(attributes));
    }
    if (!seen.insert(attribute.name()).second) {
      fail(fmt::format("the attribute '{}' twice", attribute.name()), "it once");
    }
  }
}

XmlElement XmlElement::child(const char* name) const {
  const pugi::xml_node first = node_.child(name);
  if (!first) fail(fmt::format("no <{}>", name), "one");
  XmlElement result(*document_, first, fmt::format("{}.{}", field_, name));
  if (const pugi::xml_node second = first.next_sibling(name)) {
    XmlElement(*document_, second, result.field()).fail(fmt::format("a second <{}>", name), "one");
  }
  return result;
}

std::string XmlElement::text() const {
  std::string all;
  for (const pugi::xml_node node : node_.children()) {
    if (node.type() == pugi::node_element) fail(fmt::format("the element <{}>", excerpt(node.name())), "text only");
    if (is_text(node)) all += node.value();
  }
  return trimmed(all);
}

std::string XmlElement::attribute(const char* name) const {
  const pugi::xml_attribute found = node_.attribute(name);
  if (!found) fail(fmt::format("no attribute '{}'", name), "it");
  return trimmed(found.value());
}

}  // namespace taut
