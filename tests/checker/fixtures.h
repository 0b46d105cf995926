// SPDX-License-Identifier: GPL-3.0-or-later
// What the checker's tests share: the cases of tests/certificates, and how to seal an altered one.
#pragma once

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/sha256.h"

namespace taut::checker {

inline std::string read_text(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error("cannot read " + path.string());
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

/// Sanitizers take ten times as long: in .ci/run they see a part of what is proved again and again, by night all of it.
inline bool is_sampled() { return std::getenv("TAUT_SAMPLED") != nullptr; }

/// The cases of tests/certificates with the outcome `folder`, in order; where sampled all that are malformed, and every
/// fourth of the others.
inline std::vector<std::filesystem::path> certificates(const std::string& folder) {
  std::vector<std::filesystem::path> result;
  for (const auto& entry : std::filesystem::directory_iterator(TAUT_CERTIFICATES "/" + folder)) {
    if (entry.path().extension() == ".json") result.push_back(entry.path());
  }
  std::sort(result.begin(), result.end());
  if (!is_sampled() || folder == "malformed") return result;
  std::vector<std::filesystem::path> part;
  for (std::size_t k = 0; k < result.size(); k += 4) part.push_back(result[k]);
  return part;
}

inline nlohmann::json accepted(const std::string& name) {
  return nlohmann::json::parse(read_text(TAUT_CERTIFICATES "/accepted/" + name + ".json"));
}

/// Makes counts and digests right again, as far as what they count is still there.
inline void seal(nlohmann::json& certificate) {
  if (!certificate.is_object()) return;
  const auto size_of = [](const nlohmann::json& json) { return json.is_array() ? json.size() : 0; };
  if (certificate.contains("problem")) certificate["problem_sha256"] = taut::sha256(certificate["problem"]);
  std::size_t waypoints = 0;
  if (certificate.contains("path")) {
    certificate["path_sha256"] = taut::sha256(certificate["path"]);
    if (certificate["path"].is_object()) waypoints = size_of(certificate["path"].value("waypoints", nlohmann::json()));
  }
  std::size_t boxes = 0;
  const nlohmann::json segments = certificate.value("segments", nlohmann::json());
  if (segments.is_array()) {
    for (const auto& segment : segments) {
      if (segment.is_object()) boxes += size_of(segment.value("boxes", nlohmann::json()));
    }
  }
  certificate.erase("footer");
  const std::string digest = taut::sha256(certificate);
  certificate["footer"] = {
      {"waypoints", waypoints}, {"segments", size_of(segments)}, {"boxes", boxes}, {"sha256", digest}};
}

/// The same of a certificate of legs, whose legs may have been altered.
inline void seal_legs(nlohmann::json& certificate) {
  for (nlohmann::json& leg : certificate["legs"]) seal(leg);
  certificate.erase("footer");
  const std::string digest = taut::sha256(certificate);
  certificate["footer"] = {{"legs", certificate["legs"].size()}, {"sha256", digest}};
}

}  // namespace taut::checker
