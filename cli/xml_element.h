// SPDX-License-Identifier: GPL-3.0-or-later
// XML from outside, read strictly, with file and line in every error.
#pragma once

#include <initializer_list>
#include <pugixml.hpp>
#include <string>
#include <vector>

namespace taut {

/// A parsed XML file. Nothing outside the text is read (no external DTD), and no entities but XML's own five are known.
class XmlDocument {
 public:
  /// @throws InputError if the text is not UTF-8, not well-formed, declares entities or has several root elements.
  XmlDocument(std::string file, const std::string& text);

  [[nodiscard]] const std::string& file() const { return file_; }
  [[nodiscard]] pugi::xml_node root() const { return document_.document_element(); }
  /// The line, from 1, of a position in the text.
  [[nodiscard]] std::size_t line(std::ptrdiff_t offset) const;

 private:
  void require_one_root() const;

  std::string file_;
  std::vector<std::ptrdiff_t> line_ends_;
  pugi::xml_document document_;
};

/// An element and where it is. Functions that read it throw InputError with file, line and the elements above it.
class XmlElement {
 public:
  /// The root element. @pre `document` outlives this. @throws InputError unless it has one of these names.
  XmlElement(const XmlDocument& document, std::initializer_list<const char*> names);

  [[nodiscard]] std::string name() const { return node_.name(); }
  [[nodiscard]] const std::string& field() const { return field_; }
  [[nodiscard]] const std::string& file() const { return document_->file(); }
  [[noreturn]] void fail(const std::string& seen, const std::string& expected) const;

  /// The child elements. @throws InputError if there is text between them.
  [[nodiscard]] std::vector<XmlElement> children() const;
  /// Checks that all child elements and attributes have one of these names, and no attribute is there twice.
  void require_known(std::initializer_list<const char*> elements, std::initializer_list<const char*> attributes) const;
  /// The only child element of this name. @throws InputError if there is none or several.
  [[nodiscard]] XmlElement child(const char* name) const;
  [[nodiscard]] bool has_child(const char* name) const { return node_.child(name); }

  /// The text, without white space around it. @throws InputError if there are elements in it.
  [[nodiscard]] std::string text() const;
  [[nodiscard]] bool has_attribute(const char* name) const { return node_.attribute(name); }
  /// @throws InputError if it is missing.
  [[nodiscard]] std::string attribute(const char* name) const;

 private:
  XmlElement(const XmlDocument& document, pugi::xml_node node, std::string field)
      : document_(&document), node_(node), field_(std::move(field)) {}

  const XmlDocument* document_;
  pugi::xml_node node_;
  std::string field_;
};

}  // namespace taut
