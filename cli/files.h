// Files that appear whole or not at all.
#pragma once

#include <filesystem>
#include <string>

namespace taut {

/// Writes beside `path`, flushes to disk, and renames. @throws InputError naming the path and the system's reason.
void write_whole(const std::filesystem::path& path, const std::string& content);

/// @throws InputError naming the path and the system's reason.
[[nodiscard]] std::string read_whole(const std::filesystem::path& path);

/// Makes a directory and its parents. @throws InputError likewise.
void make_directories(const std::filesystem::path& path);

}  // namespace taut
