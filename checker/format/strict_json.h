// SPDX-License-Identifier: GPL-3.0-or-later
// Reads the JSON of a certificate in one pass that checks, digests, and finds its long lists.
#pragma once

#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace taut::checker {

/// A certificate whose long parts are not read yet. The digests are those of canonical JSON.
struct Outline {
  /// The whole, but for the lists whose length depends on the path (`segments`, `stretches`, `legs`, and `waypoints`,
  /// `tubes`, `pose_tubes`, `times` and `directions` of `path`) and for `generator` and `illustration`: these are left
  /// empty.
  nlohmann::json json;
  std::map<std::string, std::string_view, std::less<>> lists;  ///< their text, where they are lists, by their key
  std::string body_sha256;                                     ///< of all but `footer` and `signature`
  std::string path_sha256;
};

/// @throws Malformed for anything but one JSON value in UTF-8, and for a byte order mark, NUL bytes, numbers that are
/// no integers, nesting deeper than 32, and keys that appear twice or that do not stand in the order of their code
/// points (at the top level `footer` and `signature` may stand anywhere).
[[nodiscard]] Outline read_json(std::string_view text);

/// Calls `visit` with each element of a list that read_json() found and, where it is an object, with its text. Only one
/// element is in memory at a time.
void for_each_element(std::string_view list,
                      const std::function<void(const nlohmann::json& element, std::string_view text)>& visit);

}  // namespace taut::checker
