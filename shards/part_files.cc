// SPDX-License-Identifier: GPL-3.0-or-later
#include "shards/part_files.h"

#include <fmt/format.h>

#include <set>
#include <system_error>
#include <utility>

#include "base/files.h"
#include "base/input_error.h"
#include "base/sanitize.h"
#include "base/sha256.h"

namespace taut {
namespace {

using nlohmann::json;

constexpr const char* kPartFormat = "taut-part";
constexpr int kPartVersion = 1;
constexpr const char* kPartExtension = ".taut-part";

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& seen, const std::string& expected) {
  throw InputError(ErrorCode::kFile, fmt::format("{}: got {}, expected {}", file.string(), seen, expected),
                   {file.string()});
}

std::string line_of(const json& head) { return head.dump(-1, ' ', true) + "\n"; }

std::string digest(const json& head, const std::string& result) {
  Sha256 hash;
  hash.update(line_of(head));
  hash.update(result);
  return hash.hex();
}

/// A value of the head for messages.
std::string shown(const json& head, const char* key) {
  return head.contains(key) ? excerpt(head.at(key).dump(-1, ' ', true)) : "nothing";
}

}  // namespace

PartFiles::PartFiles(std::filesystem::path folder, json work, std::size_t parts)
    : folder_(std::move(folder)), work_(std::move(work)), parts_(parts) {
  make_directories(folder_);
}

std::filesystem::path PartFiles::file(std::size_t part) const {
  return folder_ / fmt::format("{:06}{}", part, kPartExtension);
}

json PartFiles::head(std::size_t part, std::size_t bytes) const {
  return {{"format", kPartFormat}, {"version", kPartVersion}, {"work", work_},
          {"part", part},          {"parts", parts_},         {"bytes", bytes}};
}

std::optional<std::string> PartFiles::read(std::size_t part) const {
  const std::filesystem::path path = file(part);
  std::error_code error;
  if (const auto status = std::filesystem::status(path, error);
      status.type() == std::filesystem::file_type::not_found) {
    return std::nullopt;
  }
  std::string text = read_whole(path);
  const std::size_t end = text.find('\n');
  json head = end == std::string::npos ? json() : json::parse(text.substr(0, end), nullptr, false);
  if (!head.is_object() || head.value("format", json()) != kPartFormat) {
    refuse(path, "another file or a damaged one", "a part that taut wrote; remove it to have it computed again");
  }
  if (head.value("version", json()) != kPartVersion) {
    refuse(path, "format version " + shown(head, "version"), fmt::format("{}", kPartVersion));
  }
  const json work = head.value("work", json());
  for (const auto& [key, value] : work_.items()) {
    if (const json seen = work.is_object() ? work.value(key, json()) : json(); seen != value) {
      refuse(path, fmt::format("a part of other work, of which '{}' is {}", key, excerpt(seen.dump(-1, ' ', true))),
             value.dump(-1, ' ', true));
    }
  }
  if (head.value("part", json()) != part || head.value("parts", json()) != parts_) {
    refuse(path, fmt::format("part {} of {}", shown(head, "part"), shown(head, "parts")),
           fmt::format("part {} of {}", part, parts_));
  }
  const std::string seen_digest = head.value("sha256", json()).dump();
  head.erase("sha256");
  text.erase(0, end + 1);
  if (head.value("bytes", json()) != text.size()) {
    refuse(path, fmt::format("{} bytes, which is not the whole part", text.size()), shown(head, "bytes"));
  }
  const json expected = this->head(part, text.size());
  if (head != expected || seen_digest != json(digest(expected, text)).dump()) {
    refuse(path, "a damaged part, whose SHA-256 is not the one that it states",
           "the part as taut wrote it; remove it to have it computed again");
  }
  return text;
}

void PartFiles::write(std::size_t part, const std::string& result) const {
  json line = head(part, result.size());
  line["sha256"] = digest(line, result);
  write_whole({{file(part), line_of(line) + result}});
}

void PartFiles::require_no_others() const {
  std::set<std::filesystem::path> own;
  for (std::size_t part = 0; part < parts_; ++part) own.insert(file(part));
  std::error_code error;
  for (std::filesystem::directory_iterator entry(folder_, error), end; !error && entry != end; entry.increment(error)) {
    const std::filesystem::path& path = entry->path();
    if (path.extension() == kPartExtension && !path.filename().string().starts_with(".") && !own.contains(path)) {
      refuse(path, "a part too many", fmt::format("{} parts, from 000000 on", parts_));
    }
  }
  if (error) throw InputError(ErrorCode::kFile, fmt::format("{}: {}", folder_.string(), error.message()));
}

std::vector<std::string> PartFiles::read_all() const {
  require_no_others();
  std::vector<std::string> results;
  std::size_t missing = 0, first_missing = 0;
  for (std::size_t part = 0; part < parts_; ++part) {
    std::optional<std::string> result = read(part);
    if (!result && missing++ == 0) first_missing = part;
    results.push_back(std::move(result).value_or(""));
  }
  if (missing > 0) {
    refuse(file(first_missing), fmt::format("no such file, and {} of {} parts missing in all", missing, parts_),
           "all parts; run the shards that have them");
  }
  return results;
}

}  // namespace taut
