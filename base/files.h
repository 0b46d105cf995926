// SPDX-License-Identifier: GPL-3.0-or-later
// Files that appear whole or not at all.
#pragma once

#include <filesystem>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace taut {

struct FileContent {
  std::filesystem::path path;
  std::string content;
};

/// A file that is written piece by piece under a temporary name beside its own; it vanishes unless it is renamed into place.
/// Links are followed; devices and pipes are refused. Any number of them may be of one path at once, in any threads and processes; the last to be renamed stays.
/// What earlier runs that were killed left of it is removed.
/// Everything throws InputError naming the path and the system's reason.
class NewFile {
 public:
  explicit NewFile(const std::filesystem::path& path);
  ~NewFile();
  NewFile(NewFile&& other) noexcept;
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;
  NewFile& operator=(NewFile&&) = delete;

  void write(std::string_view text);
  /// To disk, all of it.
  void finish();
  /// Where it is meanwhile.
  [[nodiscard]] const std::filesystem::path& temporary() const { return temporary_; }
  /// Replaces any file of that name. @pre finish() was called last.
  void rename_into_place();
  /// @throws InputError where a folder has its name.
  void require_no_folder() const;

 private:
  void write_out();

  std::filesystem::path path_;
  std::filesystem::path temporary_;
  int descriptor_ = -1;
  std::string buffer_;
};

/// All of them in this order, none where a folder has one's name; of sets that threads and processes rename into one
/// folder, the last stays whole.
/// @param remove_first  files that are removed before anything is renamed, if they are there. A file that must never be
/// found beside others of another run is removed first and, if it is written again, renamed last.
void rename_into_place(std::span<NewFile* const> files, std::span<const std::filesystem::path> remove_first = {});

/// Writes all of them beside their paths, flushes them to disk, and only then removes and renames, as
/// rename_into_place(): none is replaced unless all could be written. @throws InputError naming the path and the
/// system's reason.
void write_whole(const std::vector<FileContent>& files, std::span<const std::filesystem::path> remove_first = {});

/// That a file may be written here, as far as can be told before it is. @throws InputError if not.
void require_writable(const std::filesystem::path& path);

/// That what is to be written is not the file that is read. @throws InputError if it is.
void require_another(const std::filesystem::path& written, const std::filesystem::path& read);

/// The whole of a file or pipe of at most `max_bytes`. Devices, which may never end, are refused.
/// @throws InputError naming the path and the system's reason, or that the file is larger; no more than it takes to see
/// that is read.
[[nodiscard]] std::string read_whole(const std::filesystem::path& path,
                                     std::size_t max_bytes = std::numeric_limits<std::size_t>::max());

/// The folder for temporary files. @throws InputError where TMPDIR names no folder.
[[nodiscard]] std::filesystem::path temporary_folder();

/// A new folder in it with a name of its own, "PREFIX-XXXXXX". @throws InputError likewise.
[[nodiscard]] std::filesystem::path make_temporary_folder(const std::string& prefix);

/// Makes a directory and its parents. @throws InputError likewise.
void make_directories(const std::filesystem::path& path);

}  // namespace taut
