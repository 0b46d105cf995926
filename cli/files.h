// Files that appear whole or not at all.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace taut {

struct FileContent {
  std::filesystem::path path;
  std::string content;
};

/// Writes all of them beside their paths, flushes them to disk, and only then renames: none is replaced unless all could be
/// written. @throws InputError naming the path and the system's reason.
void write_whole(const std::vector<FileContent>& files);

/// That a file may be written here, as far as can be told before it is. @throws InputError if not.
void require_writable(const std::filesystem::path& path);

/// @throws InputError naming the path and the system's reason.
[[nodiscard]] std::string read_whole(const std::filesystem::path& path);

/// Makes a directory and its parents. @throws InputError likewise.
void make_directories(const std::filesystem::path& path);

}  // namespace taut
