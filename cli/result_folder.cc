// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/result_folder.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <memory>
#include <optional>
#include <system_error>

#include "base/files.h"
#include "base/input_error.h"
#include "base/sanitize.h"
#include "path_io/controller_csv.h"
#include "path_io/move_tables.h"

namespace taut {
namespace {

namespace fs = std::filesystem;

constexpr const char* kInputsFile = "inputs.txt";
constexpr std::string_view kInputsBegin = "Results of taut ";

bool begins_with(const fs::path& file, std::string_view begin) {
  std::ifstream stream(file, std::ios::binary);
  std::string read(begin.size(), '\0');
  return stream.read(read.data(), static_cast<std::streamsize>(read.size())) && read == begin;
}

bool is_about(const fs::path& file, const ResultInputs& inputs) {
  std::error_code ignored;
  constexpr std::size_t kMostBytes = std::size_t{1} << 16U;
  if (!inputs.may_recur() || !fs::is_regular_file(file, ignored)) return false;
  return fs::file_size(file, ignored) <= kMostBytes && read_whole(file) == inputs.text();
}

/// Writes a file that no other run may have written meanwhile; false if one has.
bool write_new(const fs::path& file, const std::string& text) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream(std::fopen(file.c_str(), "wxe"), std::fclose);
  if (!stream && errno == EEXIST) return false;
  if (!stream || std::fwrite(text.data(), 1, text.size(), stream.get()) != text.size() ||
      std::fflush(stream.get()) != 0) {
    throw InputError(ErrorCode::kFile, fmt::format("{}: could not write: {}", file.string(), std::strerror(errno)),
                     {file.string()});
  }
  return true;
}

/// Whether the folder is that of these inputs, or nobody's and now theirs.
bool claim(const fs::path& folder, const ResultInputs& inputs) {
  const fs::path file = folder / kInputsFile;
  std::error_code error;
  if (fs::exists(fs::symlink_status(folder, error))) {
    if (!fs::is_directory(folder, error)) return false;
    if (is_about(file, inputs)) return true;
    if (!fs::is_empty(folder, error) || error) return false;
  }
  make_directories(folder);
  return write_new(file, inputs.text()) || is_about(file, inputs);
}

}  // namespace

ResultInputs::ResultInputs(std::string_view command) : text_(fmt::format("{}{}\n", kInputsBegin, command)) {}

void ResultInputs::add(std::string_view role, std::string_view value) {
  text_ += fmt::format("{}: {}\n", role, sanitize(value));
}

void ResultInputs::add_file(std::string_view role, const std::string& file) {
  std::error_code error;
  may_recur_ = may_recur_ && fs::is_regular_file(file, error);
  const fs::path place = fs::weakly_canonical(fs::absolute(file, error), error);
  add(role, error ? file : place.string());
}

fs::path make_result_folder(const std::string& wanted, const std::string& name, const ResultInputs& inputs) {
  if (!wanted.empty()) {
    make_directories(wanted);
    return wanted;
  }
  const fs::path all = "out";
  make_directories(all);
  constexpr int kMost = 10'000;
  for (int number = 1; number <= kMost; ++number) {
    fs::path folder = all / (number == 1 ? name : fmt::format("{}-{}", name, number));
    if (claim(folder, inputs)) return folder;
  }
  throw InputError(ErrorCode::kFile,
                   fmt::format("{}: got {} folders of other results, expected room for one more (or --out DIR)",
                               (all / name).string(), kMost));
}

void require_results_apart(const std::filesystem::path& folder, const std::vector<std::string>& read) {
  for (const char* name : kResultFiles) {
    for (const std::string& file : read) require_another(folder / name, file);
  }
}

namespace {

/// Whether a browser has printed a report of ours.
bool is_printed_report(const fs::path& file) {
  constexpr std::size_t kHead = 256;
  std::ifstream stream(file, std::ios::binary);
  std::string head(kHead, '\0');
  stream.read(head.data(), static_cast<std::streamsize>(head.size()));
  return head.starts_with("%PDF-") && head.find("/Title (Motion report: ") != std::string::npos;
}

std::vector<fs::path> results_in(const fs::path& folder) {
  std::vector<fs::path> result = {folder / "path.csv"};
  // What only has the name of a result of ours is the user's.
  if (begins_with(folder / "controller.csv", kControllerFileBegin)) result.push_back(folder / "controller.csv");
  for (const char* table : {"winches.csv", "poses.csv", "poses.tum"}) {
    if (begins_with(folder / table, kMoveTableBegin)) result.push_back(folder / table);
  }
  if (is_printed_report(folder / "report.pdf")) result.push_back(folder / "report.pdf");
  return result;
}

/// The folders of legs, "2-carry": of those whose certificate is a part of that in `folder`. Others are the user's.
std::vector<fs::path> leg_folders(const fs::path& folder) {
  constexpr std::size_t kMostBytes = std::size_t{1} << 28U;
  std::vector<fs::path> result;
  std::error_code error;
  const auto certificate = [&](const fs::path& of) -> std::string {
    const fs::path file = of / "certificate.json";
    if (!fs::is_regular_file(file, error) || fs::file_size(file, error) > kMostBytes) return "";
    std::ifstream stream(file, std::ios::binary);  // one that can't be read is left alone
    return {std::istreambuf_iterator<char>(stream), {}};
  };
  std::optional<std::string> whole;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    const std::size_t dash = name.find_first_not_of("0123456789");
    if (dash == 0 || dash == std::string::npos || name[dash] != '-') continue;
    const std::string of_leg = certificate(entry.path());
    if (!whole) whole = certificate(folder);
    if (!of_leg.empty() && whole->find(of_leg) != std::string::npos) result.push_back(entry.path());
  }
  return result;
}

}  // namespace

std::vector<fs::path> outdated_results(const fs::path& folder, const ResultInputs& inputs) {
  std::vector<fs::path> result = results_in(folder);
  for (const fs::path& leg : leg_folders(folder)) {
    for (const fs::path& file : results_in(leg)) result.push_back(file);
    for (const char* name : {"report.html", "certificate.json"}) result.push_back(leg / name);
  }
  const fs::path file = folder / kInputsFile;
  if (begins_with(file, kInputsBegin) && !is_about(file, inputs)) result.push_back(file);
  return result;
}

}  // namespace taut
