#include "cli/files.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>

#include "kinematics/input_error.h"

namespace taut {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, const char* action, int error) {
  throw InputError(fmt::format("{}: could not {}: {}", path.string(), action, std::strerror(error)));
}

}  // namespace

void write_whole(const std::filesystem::path& path, const std::string& content) {
  std::filesystem::path temporary = path;
  temporary += fmt::format(".{}.part", ::getpid());
  const int file = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (file < 0) fail(path, "write", errno);
  const auto give_up = [&](int error) {
    ::close(file);
    ::unlink(temporary.c_str());
    fail(path, "write", error);
  };
  std::size_t written = 0;
  while (written < content.size()) {
    const ssize_t n = ::write(file, content.data() + written, content.size() - written);
    if (n < 0 && errno != EINTR) give_up(errno);
    if (n > 0) written += static_cast<std::size_t>(n);
  }
  if (::fsync(file) != 0) give_up(errno);
  ::close(file);
  if (::rename(temporary.c_str(), path.c_str()) != 0) {
    const int error = errno;
    ::unlink(temporary.c_str());
    fail(path, "rename into place", error);
  }
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
