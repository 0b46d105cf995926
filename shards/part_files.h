// SPDX-License-Identifier: GPL-3.0-or-later
// Results of parts in a folder, a file each, so that work that was ended goes on, and others may do a share of it.
//
// A file is a line of JSON and the bytes of the result. The line says what the work is ("work": all that determines
// results), which part of how many this is, how many bytes follow, and the SHA-256 of itself (without that key) and
// the bytes.
#pragma once

#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace taut {

class PartFiles {
 public:
  /// Makes the folder where it is not there. @param work  a flat object: what determines the results of all parts.
  /// @throws InputError
  PartFiles(std::filesystem::path folder, nlohmann::json work, std::size_t parts);

  [[nodiscard]] std::filesystem::path file(std::size_t part) const;
  /// The result of a part; nothing where there is no file. @throws InputError, naming the file, where it is not whole,
  /// is of another part or another work, or can't be read.
  [[nodiscard]] std::optional<std::string> read(std::size_t part) const;
  /// Replaces the part's file. Whoever ends this, the file is whole or the one before. @throws InputError
  void write(std::size_t part, const std::string& result) const;
  /// The results of all parts. @throws InputError naming parts that are missing, files in the folder that are named as
  /// parts and are none of this work, and as read().
  [[nodiscard]] std::vector<std::string> read_all() const;

 private:
  [[nodiscard]] nlohmann::json head(std::size_t part, std::size_t bytes) const;
  void require_no_others() const;

  std::filesystem::path folder_;
  nlohmann::json work_;
  std::size_t parts_;
};

}  // namespace taut
