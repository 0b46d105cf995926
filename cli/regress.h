// SPDX-License-Identifier: GPL-3.0-or-later
// Regression proofs: every case of a folder is planned or audited, each by a taut of its own, and held to what it
// declares and to what an earlier run measured.
#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

namespace taut {

/// What a run of a case came to: a verdict, and numbers by the names of kBoundQuantities (SI); what was not measured is
/// missing.
struct Measurement {
  std::string verdict;
  std::map<std::string, double> quantities;
};

struct RegressedCase {
  std::string name;                        ///< the file, seen from the folder
  std::optional<Measurement> measurement;  ///< none where there was no result
  std::string expected;                    ///< the declared verdict; empty where the case could not be read
  bool has_budget = false;                 ///< a planner with a budget: what it finds may differ from run to run
  std::vector<std::string> differences;    ///< from what was declared or is in the baseline
  std::string error;                       ///< bad input, a crash, too long; empty where there is a result
  bool is_bad_input = false;
  double seconds = 0;

  [[nodiscard]] bool is_as_declared() const { return error.empty() && differences.empty(); }
};

struct RegressOptions {
  int jobs = 0;                  ///< cases at a time; 0: one a core
  double most_seconds = 600;     ///< for one case
  std::optional<double> budget;  ///< seconds of planning, before each case's own
  bool check = false;            ///< have each certificate proved again by taut-check
  std::filesystem::path out;     ///< keeps the results, a folder a case; empty: they are thrown away
};

/// Measurements of an earlier run, by case.
struct Baseline {
  std::map<std::string, Measurement> cases;
  /// Relative change of a number for the worse that is let pass: less margin, more of all else.
  double tolerance = 0.05;
};

/// *.yaml in `folder` and all below it, sorted; the file itself where it is one. @throws InputError if there is none.
[[nodiscard]] std::vector<std::filesystem::path> find_cases(const std::filesystem::path& folder);

/// A folder that is gone with its object, unless the user wants to keep it.
class CaseResults {
 public:
  /// @param wanted  to keep; empty: a temporary one. @throws InputError
  explicit CaseResults(const std::filesystem::path& wanted);
  ~CaseResults();
  CaseResults(const CaseResults&) = delete;
  CaseResults& operator=(const CaseResults&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  bool is_kept_;
  std::filesystem::path path_;
};

/// The name of a case: its file, seen from the folder.
[[nodiscard]] std::string case_name(const std::filesystem::path& folder, const std::filesystem::path& file);

/// Runs a case; where `stop` is requested, it is cut short. Thread-safe.
/// @param results  folder of all cases' results
[[nodiscard]] RegressedCase regress_case(const std::string& name, const std::filesystem::path& file,
                                         const RegressOptions& options, const std::filesystem::path& results,
                                         const std::stop_token& stop);

/// Adds to each case's differences what is worse than in the baseline.
/// @returns cases of the baseline that are no more.
[[nodiscard]] std::vector<std::string> compare(const Baseline& baseline, std::vector<RegressedCase>& cases);

/// Whether a file with this text was meant as one.
[[nodiscard]] bool is_baseline(const std::string& text);
/// @throws InputError, naming the file, where it is none.
[[nodiscard]] Baseline read_baseline(const std::filesystem::path& path);
[[nodiscard]] std::string baseline_text(const std::vector<RegressedCase>& cases);

/// JUnit's XML: one suite, a test case for each case, its measurements as properties.
[[nodiscard]] std::string junit_text(const std::string& suite, const std::vector<RegressedCase>& cases,
                                     const std::vector<std::string>& gone);

[[nodiscard]] nlohmann::json to_json(const RegressedCase& regressed);

}  // namespace taut
