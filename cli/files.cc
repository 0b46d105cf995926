#include "cli/files.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>
#include <utility>

#include "kinematics/input_error.h"

namespace taut {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, const char* action, int error) {
  throw InputError(fmt::format("{}: could not {}: {}", path.string(), action, std::strerror(error)));
}

/// A file under a temporary name beside `path`; removed unless it was renamed into place.
class TemporaryFile {
 public:
  explicit TemporaryFile(const FileContent& file) : path_(file.path), temporary_(file.path) {
    temporary_ += fmt::format(".{}.part", ::getpid());
    const int descriptor = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
    if (descriptor < 0) fail(path_, "write", errno);
    const int error = write_all(descriptor, file.content);
    ::close(descriptor);
    if (error != 0) {
      ::unlink(temporary_.c_str());
      fail(path_, "write", error);
    }
  }
  ~TemporaryFile() {
    if (!temporary_.empty()) ::unlink(temporary_.c_str());
  }
  TemporaryFile(TemporaryFile&& other) noexcept
      : path_(std::move(other.path_)), temporary_(std::exchange(other.temporary_, {})) {}
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  TemporaryFile& operator=(TemporaryFile&&) = delete;

  void rename_into_place() {
    if (::rename(temporary_.c_str(), path_.c_str()) != 0) fail(path_, "rename into place", errno);
    temporary_.clear();
  }

 private:
  /// @returns errno, 0 if all was written and flushed.
  static int write_all(int descriptor, const std::string& content) {
    std::size_t written = 0;
    while (written < content.size()) {
      const ssize_t n = ::write(descriptor, content.data() + written, content.size() - written);
      if (n < 0 && errno != EINTR) return errno;
      if (n > 0) written += static_cast<std::size_t>(n);
    }
    return ::fsync(descriptor) == 0 ? 0 : errno;
  }

  std::filesystem::path path_;
  std::filesystem::path temporary_;
};

}  // namespace

void write_whole(const std::vector<FileContent>& files) {
  std::vector<TemporaryFile> written;
  written.reserve(files.size());
  for (const FileContent& file : files) written.emplace_back(file);
  for (TemporaryFile& file : written) file.rename_into_place();
}

void require_writable(const std::filesystem::path& path) {
  if (std::filesystem::is_directory(path)) fail(path, "write", EISDIR);
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  if (::access(folder.c_str(), W_OK) != 0) fail(path, "write", errno);
}

std::string read_whole(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file || std::filesystem::is_directory(path)) fail(path, "read", std::filesystem::exists(path) ? EISDIR : ENOENT);
  std::ostringstream content;
  content << file.rdbuf();
  return content.str();
}

void make_directories(const std::filesystem::path& path) {
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (error || !std::filesystem::is_directory(path)) {
    throw InputError(fmt::format("{}: could not make the directory: {}", path.string(),
                                 error ? error.message() : "a file is in the way"));
  }
}

}  // namespace taut
