// SPDX-License-Identifier: GPL-3.0-or-later
// Reads the JSON of a certificate in one pass that checks, digests, and hands over long lists element by element.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace taut::checker {

/// An element of one of the lists whose length depends on the path: `segments`, `stretches`, `path.waypoints`,
/// `path.tubes`, `path.pose_tubes` and `path.times`.
struct Element {
  std::string_view list;  ///< its name, as above
  std::size_t index = 0;
  const nlohmann::json& value;
  std::string_view text;  ///< where `value` is an object: its part of the text that is read
};

/// A certificate without the elements of these lists, which are empty in `json`, and without what is in `generator` and
/// `illustration`. The digests are those of canonical JSON.
struct Outline {
  nlohmann::json json;
  std::string problem;      ///< canonical JSON
  std::string body_sha256;  ///< of all but `footer` and `signature`
  std::string path_sha256;
  std::string problem_sha256;
};

/// Calls `visit` with each element of these lists, in the order of the text, and with what was read before it.
/// @throws Malformed for anything but one JSON value in UTF-8, and for a byte order mark, NUL bytes, numbers that are
/// no integers, nesting deeper than 32, and keys that do not stand in the order of their code points (`footer` and `signature`
/// may stand anywhere) or appear twice.
[[nodiscard]] Outline read_json(std::string_view text,
                                const std::function<void(const nlohmann::json& outline, const Element&)>& visit);

}  // namespace taut::checker
