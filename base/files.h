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

/// A file that is written piece by piece under a temporary name in the same folder. It vanishes unless it is renamed
/// into place. Links are followed; devices and pipes are refused. Several threads and processes may write to one path
/// at the same time; the file renamed last stays. The constructor removes temporary files of earlier runs that were
/// killed. All members throw InputError naming the path and the system's reason.
class NewFile {
 public:
  explicit NewFile(const std::filesystem::path& path);
  ~NewFile();
  NewFile(NewFile&& other) noexcept;
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;
  NewFile& operator=(NewFile&&) = delete;

  void write(std::string_view text);
  /// Flushes everything to disk.
  void finish();
  /// The temporary name.
  [[nodiscard]] const std::filesystem::path& temporary() const { return temporary_; }
  /// Replaces any file of that name. @pre finish() was called last.
  void rename_into_place();
  /// @throws InputError if a folder has the file's name.
  void require_no_folder() const;

 private:
  void write_out();

  std::filesystem::path path_;
  std::filesystem::path temporary_;
  int descriptor_ = -1;
  std::string buffer_;
};

/// Renames all files into place, in this order; renames none if a folder has the name of one. If several threads or
/// processes rename sets of files into one folder, the last set stays whole.
/// @param remove_first  files that are removed before anything is renamed, if they exist. A file that must never be
/// found beside others of another run is removed first and, if it is written again, renamed last.
void rename_into_place(std::span<NewFile* const> files, std::span<const std::filesystem::path> remove_first = {});

/// Writes all files under temporary names, flushes them to disk, and only then removes and renames, as
/// rename_into_place() does: none is replaced unless all could be written. @throws InputError naming the path and the
/// system's reason.
void write_whole(const std::vector<FileContent>& files, std::span<const std::filesystem::path> remove_first = {});

/// Checks that a file can be written here, as far as this is known before writing. @throws InputError if it can't.
void require_writable(const std::filesystem::path& path);

/// Checks that the two paths name different files. @throws InputError if `written` is the file that is read.
void require_another(const std::filesystem::path& written, const std::filesystem::path& read);

/// Reads a whole file or pipe of at most `max_bytes`. Devices are refused, because they may never end.
/// @throws InputError naming the path and the system's reason, or saying that the file is larger; it then reads no more
/// than it takes to see that.
[[nodiscard]] std::string read_whole(const std::filesystem::path& path,
                                     std::size_t max_bytes = std::numeric_limits<std::size_t>::max());

/// The folder for temporary files. @throws InputError if TMPDIR names no folder.
[[nodiscard]] std::filesystem::path temporary_folder();

/// Makes a folder with a new name, "PREFIX-XXXXXX", in temporary_folder(). @throws InputError if it can't be made.
[[nodiscard]] std::filesystem::path make_temporary_folder(const std::string& prefix);

/// Makes a directory and its parents. @throws InputError if one can't be made.
void make_directories(const std::filesystem::path& path);

}  // namespace taut
