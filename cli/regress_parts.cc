// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/regress_parts.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "base/files.h"
#include "base/input_error.h"
#include "base/sanitize.h"
#include "base/sha256.h"
#include "case/case_of_legs.h"
#include "cli/parts_options.h"

namespace taut {
namespace {

using nlohmann::json;

/// A file's SHA-256; empty where it can't be read, which its case then says.
std::string file_digest(const std::filesystem::path& file) {
  try {
    Sha256 hash;
    hash.update(read_whole(file));
    return hash.hex();
  } catch (const InputError&) {
    return "";
  }
}

/// The digests of a case and of the path that it has audited.
json case_digest(const std::string& name, const std::filesystem::path& file) {
  json digest = {sanitize(name), file_digest(file)};  // a name need not be text
  try {
    const CaseOfLegs of = load_case_of_legs(file.string());
    const Case& declared = of.whole;
    if (declared.audit) digest.push_back(file_digest(file.parent_path() / declared.audit->file));
    const auto add_meshes = [&](const Case& the_case) {
      if (!the_case.bodies) return;
      for (const MeshOfBody& mesh : the_case.bodies->meshes) digest.push_back(mesh.mesh->sha256);
    };
    add_meshes(declared);
    for (const CaseLeg& leg : of.legs) add_meshes(leg.content);
  } catch (const InputError&) {
    // its run says what is wrong with it
  }
  return digest;
}

std::string part_text(const RegressedCase& regressed) {
  json measurement;
  if (regressed.measurement) {
    measurement = {{"verdict", regressed.measurement->verdict}, {"quantities", regressed.measurement->quantities}};
  }
  return json{{"measurement", measurement},         {"expected", regressed.expected},
              {"has_budget", regressed.has_budget}, {"differences", regressed.differences},
              {"error", regressed.error},           {"is_bad_input", regressed.is_bad_input},
              {"seconds", regressed.seconds}}
             .dump(-1, ' ', true, json::error_handler_t::replace) +
         "\n";
}

/// All but the name.
RegressedCase read_part(const json& part) {
  RegressedCase result;
  if (const json& measurement = part.at("measurement"); !measurement.is_null()) {
    result.measurement = Measurement{measurement.at("verdict"), measurement.at("quantities")};
  }
  result.expected = part.at("expected");
  result.has_budget = part.at("has_budget");
  result.differences = part.at("differences");
  result.error = part.at("error");
  result.is_bad_input = part.at("is_bad_input");
  result.seconds = part.at("seconds");
  return result;
}

}  // namespace

RegressParts::RegressParts(const std::filesystem::path& folder, std::vector<std::filesystem::path> files,
                           const RegressOptions& options, const std::string& parts)
    : files_(std::move(files)), options_(options) {
  json cases = json::array();
  for (const std::filesystem::path& file : files_) {
    names_.push_back(case_name(folder, file));
    cases.push_back(case_digest(names_.back(), file));
  }
  const json work = {{"command", "regress"},
                     {"taut", TAUT_VERSION},
                     {"check", options.check},
                     {"timeout", options.most_seconds},
                     {"budget", options.budget ? json(*options.budget) : json()},
                     {"cases_sha256", sha256(cases)}};
  digest_ = sha256(work);
  if (!parts.empty()) parts_.emplace(parts, work, files_.size());
}

std::string RegressParts::run(std::size_t number, const std::filesystem::path& results,
                              const std::stop_token& stop) const {
  const RegressedCase result = regress_case(names_.at(number), files_.at(number), options_, results, stop);
  return stop.stop_requested() ? "" : part_text(result);
}

RegressedCase RegressParts::read(std::size_t number, const std::string& text) const {
  try {
    RegressedCase result = read_part(json::parse(text));
    result.name = names_.at(number);
    return result;
  } catch (const json::exception& error) {
    throw InputError(ErrorCode::kFile, fmt::format("{}: got {}, expected the result of a case",
                                                   parts_ ? parts_->file(number).string() : "part", error.what()));
  }
}

std::vector<RegressedCase> RegressParts::make(const Shard& shard, Ranks* ranks,
                                              const std::function<void(std::size_t)>& done,
                                              const std::stop_token& stop) {
  std::vector<std::optional<RegressedCase>> cases(files_.size());
  std::vector<Task> tasks;
  std::size_t count = 0;
  for (std::size_t n = 0; n < files_.size(); ++n) {
    if (!shard.has(n)) continue;
    if (const auto known = parts_ ? parts_->read(n) : std::nullopt) {
      cases[n] = read(n, *known);
      if (cases[n]->error.empty()) {
        ++count;
        continue;
      }
      cases[n].reset();
    }
    tasks.push_back({n, ""});
  }
  const CaseResults results(options_.out);
  const RunTask run_task = [&](const Task& task) { return run(task.part, results.path(), stop); };
  const TaskDone take = [&](std::size_t task, const std::string& text) {
    if (text.empty()) return;  // it was cut short
    const std::size_t n = tasks[task].part;
    cases[n] = read(n, text);
    if (parts_) parts_->write(n, text);
    done(++count);
  };
  if (ranks != nullptr) {
    ranks->deal(digest_, tasks, run_task, take, stop);
  } else {
    const std::size_t jobs = options_.jobs > 0 ? static_cast<std::size_t>(options_.jobs) : usable_threads();
    deal_to_threads(tasks, jobs, run_task, take, stop);
  }
  std::vector<RegressedCase> ended;
  for (std::optional<RegressedCase>& regressed : cases) {
    if (regressed) ended.push_back(std::move(*regressed));
  }
  return ended;
}

std::vector<RegressedCase> RegressParts::merge() const {
  std::vector<RegressedCase> cases;
  for (const std::string& text : parts_->read_all()) cases.push_back(read(cases.size(), text));
  return cases;
}

}  // namespace taut
