// SPDX-License-Identifier: GPL-3.0-or-later
// What a case says for the head of a document. Nothing checks it, and no claim is about it.
#pragma once

#include <string>

namespace taut {

/// Each is empty where the case does not state it; else it is_label().
struct DocumentFields {
  std::string title;        ///< of the move: "Container to the second bay"
  std::string machine;      ///< "Portal 2, six winches"
  std::string site;         ///< "Hall B"
  std::string load_name;    ///< what is carried
  std::string document;     ///< the document's number; is_document_label() too
  std::string prepared_by;  ///< a person or an office
  bool operator==(const DocumentFields&) const = default;
};

/// A field and its name, in certificates and JSON.
struct NamedDocumentField {
  const char* name;
  std::string DocumentFields::*field;
};
/// All fields, in the order in which they are shown.
inline constexpr NamedDocumentField kDocumentFields[] = {
    {"title", &DocumentFields::title},       {"machine", &DocumentFields::machine},
    {"site", &DocumentFields::site},         {"load_name", &DocumentFields::load_name},
    {"document", &DocumentFields::document}, {"prepared_by", &DocumentFields::prepared_by}};

}  // namespace taut
