// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/files.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <utility>

#include "base/input_error.h"

namespace taut {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, const char* action, int error) {
  throw InputError(ErrorCode::kFile, fmt::format("{}: could not {}: {}", path.string(), action, std::strerror(error)),
                   {path.string()});
}

/// The status of `path`. If the system can't tell, because a link leads to itself or a name is too long, `action`
/// fails.
std::filesystem::file_status status_of(const std::filesystem::path& path, const char* action) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (!std::filesystem::status_known(status)) fail(path, action, error.value());
  return status;
}

constexpr std::string_view kPart = ".part";

/// A name that no other file being written has, in this process or another: it contains the process and a number.
std::filesystem::path temporary_name(const std::filesystem::path& path) {
  static std::atomic<unsigned> number = 0;
  return path.string() + fmt::format(".{}-{}{}", ::getpid(), number++, kPart);
}

/// The target of a link, if it has one; else the path itself.
std::filesystem::path target_of(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::is_symlink(path, error)) return path;
  const std::filesystem::path target = std::filesystem::canonical(path, error);
  return error ? path : target;
}

/// The process that made the temporary file `name` for a file named `file`; 0 if `name` is not a temporary name for it.
pid_t maker(std::string_view name, const std::string& file) {
  const std::string prefix = file + ".";
  if (!name.starts_with(prefix) || !name.ends_with(kPart) || name.size() <= prefix.size() + kPart.size()) return 0;
  name.remove_prefix(prefix.size());
  name.remove_suffix(kPart.size());
  pid_t process = 0;
  unsigned number = 0;
  const char* const end = name.data() + name.size();
  const auto [read, error] = std::from_chars(name.data(), end, process);
  if (error != std::errc() || read == end || *read != '-') return 0;
  const auto [read_all, no_number] = std::from_chars(read + 1, end, number);
  return no_number == std::errc() && read_all == end ? process : 0;
}

/// Removes temporary files for `path` that killed runs left behind: their process is gone and nobody locks the file.
void remove_leftovers(const std::filesystem::path& path) {
  std::error_code ignored;
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  for (auto entry = std::filesystem::directory_iterator(folder, ignored);
       entry != std::filesystem::directory_iterator(); entry.increment(ignored)) {
    const pid_t process = maker(entry->path().filename().string(), path.filename().string());
    if (process <= 0 || ::kill(process, 0) == 0 || errno != ESRCH) continue;
    const int descriptor = ::open(entry->path().c_str(), O_WRONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (descriptor < 0) continue;
    if (::flock(descriptor, LOCK_EX | LOCK_NB) == 0) ::unlink(entry->path().c_str());
    ::close(descriptor);
  }
}

}  // namespace

NewFile::NewFile(const std::filesystem::path& path) : path_(target_of(path)) {
  if (std::filesystem::is_other(status_of(path_, "write"))) {
    fail(path_, "write", EINVAL);  // a device or pipe must not be replaced by a file
  }
  remove_leftovers(path_);
  do {
    temporary_ = temporary_name(path_);
    descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
  } while (descriptor_ < 0 && errno == EEXIST);  // left by a process of the same number, maybe in another container
  if (descriptor_ < 0) fail(path_, "write", errno);
  static_cast<void>(::flock(descriptor_, LOCK_EX | LOCK_NB));  // tells remove_leftovers() that the file is in use
}

NewFile::~NewFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

NewFile::NewFile(NewFile&& other) noexcept
    : path_(std::move(other.path_)),
      temporary_(std::exchange(other.temporary_, {})),
      descriptor_(std::exchange(other.descriptor_, -1)),
      buffer_(std::move(other.buffer_)) {}

void NewFile::write(std::string_view text) {
  constexpr std::size_t kBuffer = std::size_t{1} << 18U;
  buffer_ += text;
  if (buffer_.size() >= kBuffer) write_out();
}

void NewFile::write_out() {
  for (std::size_t written = 0; written < buffer_.size();) {
    const ssize_t n = ::write(descriptor_, buffer_.data() + written, buffer_.size() - written);
    if (n < 0 && errno != EINTR) fail(path_, "write", errno);
    if (n > 0) written += static_cast<std::size_t>(n);
  }
  buffer_.clear();
}

void NewFile::finish() {
  write_out();
  if (::fsync(descriptor_) != 0) fail(path_, "write", errno);
}

void NewFile::require_no_folder() const {
  if (std::filesystem::is_directory(status_of(path_, "write"))) fail(path_, "write", EISDIR);
}

void NewFile::rename_into_place() {
  if (::rename(temporary_.c_str(), path_.c_str()) != 0) fail(path_, "rename into place", errno);
  temporary_.clear();
}

namespace {

/// A lock on a folder that only one thread of one process holds at a time, if the file system supports locks.
class FolderLock {
 public:
  explicit FolderLock(const std::filesystem::path& folder)
      : descriptor_(::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
    if (descriptor_ >= 0) static_cast<void>(::flock(descriptor_, LOCK_EX));
  }
  ~FolderLock() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;
  FolderLock(FolderLock&&) = delete;
  FolderLock& operator=(FolderLock&&) = delete;

 private:
  int descriptor_;
};

}  // namespace

void rename_into_place(std::span<NewFile* const> files, std::span<const std::filesystem::path> remove_first) {
  for (const NewFile* file : files) file->require_no_folder();
  if (files.empty()) return;
  const FolderLock lock(files.front()->temporary().parent_path());
  for (const std::filesystem::path& old : remove_first) {
    std::error_code error;
    const std::filesystem::path target = target_of(old);  // a link to the file stays
    if (!std::filesystem::is_directory(target, error)) std::filesystem::remove(target, error);
    if (error) fail(old, "remove", error.value());
  }
  for (NewFile* file : files) file->rename_into_place();
}

void write_whole(const std::vector<FileContent>& files, std::span<const std::filesystem::path> remove_first) {
  std::vector<NewFile> written;
  written.reserve(files.size());
  for (const FileContent& file : files) {
    NewFile& next = written.emplace_back(file.path);
    next.write(file.content);
    next.finish();
  }
  std::vector<NewFile*> all;
  all.reserve(written.size());
  for (NewFile& file : written) all.push_back(&file);
  rename_into_place(all, remove_first);
}

void require_writable(const std::filesystem::path& path) {
  if (std::filesystem::is_directory(status_of(path, "write"))) fail(path, "write", EISDIR);
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  if (::access(folder.c_str(), W_OK) != 0) fail(path, "write", errno);
}

void require_another(const std::filesystem::path& written, const std::filesystem::path& read) {
  std::error_code ignored;
  const bool is_there = std::filesystem::equivalent(written, read, ignored);
  const std::filesystem::path name = std::filesystem::weakly_canonical(written, ignored);
  if (!is_there && (ignored || name != std::filesystem::weakly_canonical(read, ignored))) return;
  throw InputError(ErrorCode::kUse,
                   fmt::format("{}: got the file that is read, expected another to be written", written.string()),
                   {written.string()});
}

std::string read_whole(const std::filesystem::path& path, std::size_t max_bytes) {
  const std::filesystem::file_status status = status_of(path, "read");
  if (std::filesystem::is_directory(status)) fail(path, "read", EISDIR);
  if (std::filesystem::is_character_file(status) || std::filesystem::is_block_file(status)) {
    throw InputError(ErrorCode::kFile, fmt::format("{}: got a device, expected a file", path.string()),
                     {path.string()});
  }
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) fail(path, "read", errno != 0 ? errno : ENOENT);
  std::string content;
  std::error_code unknown;
  if (const std::uintmax_t size = std::filesystem::file_size(path, unknown); !unknown && size <= max_bytes) {
    content.reserve(size);
  }
  std::vector<char> piece(std::size_t{1} << 16U);
  while (file.read(piece.data(), static_cast<std::streamsize>(piece.size())) || file.gcount() > 0) {
    content.append(piece.data(), static_cast<std::size_t>(file.gcount()));
    if (content.size() > max_bytes) {
      throw InputError(ErrorCode::kFile,
                       fmt::format("{}: got more than {} bytes, expected a smaller file", path.string(), max_bytes),
                       {path.string()});
    }
  }
  if (file.bad()) fail(path, "read", errno != 0 ? errno : EIO);
  return content;
}

void make_directories(const std::filesystem::path& path) {
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (error || !std::filesystem::is_directory(path, error)) {
    throw InputError(ErrorCode::kFile,
                     fmt::format("{}: could not make the directory: {}", path.string(),
                                 error ? error.message() : "a file is in the way"),
                     {path.string()});
  }
}

std::filesystem::path temporary_folder() {
  std::error_code error;
  const std::filesystem::path folder = std::filesystem::temp_directory_path(error);
  if (error) {
    const char* const chosen = std::getenv("TMPDIR");
    throw InputError(ErrorCode::kFile, fmt::format("TMPDIR: got '{}', expected a folder for temporary files",
                                                   chosen != nullptr ? chosen : "nothing, and no /tmp"));
  }
  return folder;
}

std::filesystem::path make_temporary_folder(const std::string& prefix) {
  std::string name = (temporary_folder() / (prefix + "-XXXXXX")).string();
  if (::mkdtemp(name.data()) == nullptr) fail(name, "make the directory", errno);
  return name;
}

}  // namespace taut
