// SPDX-License-Identifier: GPL-3.0-or-later
// Where results are written, so that those of two inputs never share a folder unless the user says so.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace taut {

/// Names of all files that a plan or an audit may write into its folder, path.csv as the last: it is never found beside
/// a certificate that is not its own.
inline constexpr std::array<const char*, 7> kResultFiles = {
    "certificate.json", "report.html", "controller.csv", "winches.csv", "poses.csv", "poses.tum", "path.csv"};

/// What results are about. Two runs have the same inputs if they ran one command on files of the same names and places.
class ResultInputs {
 public:
  /// @param command  "plan" or "audit"
  explicit ResultInputs(std::string_view command);
  /// Adds a file that is read, by its place in the file system. A pipe is never the same input again.
  void add_file(std::string_view role, const std::string& file);
  void add(std::string_view role, std::string_view value);

  [[nodiscard]] const std::string& text() const { return text_; }
  [[nodiscard]] bool may_recur() const { return may_recur_; }

 private:
  std::string text_;
  bool may_recur_ = true;
};

/// Makes the folder for results.
/// @param wanted  the user's own folder, which is taken as it is; its earlier results are replaced. If empty, it is
/// out/NAME or, where that holds anything else than results of these inputs, out/NAME-2, out/NAME-3 and so on. Such a
/// folder has a file inputs.txt, which says what its results are about.
/// @throws InputError
[[nodiscard]] std::filesystem::path make_result_folder(const std::string& wanted, const std::string& name,
                                                       const ResultInputs& inputs);

/// Checks that no file that a plan or an audit may write into `folder` is one that it reads. @throws InputError
void require_results_apart(const std::filesystem::path& folder, const std::vector<std::string>& read);

/// The files of earlier results in `folder` that must be gone before new ones are renamed into place, path.csv as the
/// last of them: path.csv, controller.csv, tables of a move and report.pdf, which must never stand beside a certificate
/// that is not their own, all of an earlier plan's legs, and inputs.txt where it is about other inputs.
[[nodiscard]] std::vector<std::filesystem::path> outdated_results(const std::filesystem::path& folder,
                                                                  const ResultInputs& inputs);

}  // namespace taut
