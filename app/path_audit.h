// SPDX-License-Identifier: GPL-3.0-or-later
// An audit, and the certificate that is handed out of it.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "app/audit.h"
#include "app/path_source.h"
#include "case/case_file.h"
#include "certificate/signature.h"
#include "certify/tolerance_limits.h"

namespace taut {

/// Of longer paths it is not tried how far tolerances could grow, which takes some tens of proofs of the whole path and all of it in
/// memory; nor is a report made of them unless somebody asks for one.
inline constexpr std::size_t kMostReported = 5'000;

/// The laws that may be asked for, by their names.
[[nodiscard]] const std::map<std::string, Interpolation>& audit_laws();

/// Which path is audited, and how it is read.
struct AuditRequest {
  PathInput path = std::string();    ///< without a name: that of the case
  std::optional<Interpolation> law;  ///< nothing: as the file suggests
  bool allow_repeats = false;
};

/// What the case's own `audit` says, where the request names no path. @param case_path  of the case's file
/// @throws InputError where the case has none.
[[nodiscard]] AuditRequest resolved(AuditRequest request, const Case& the_case, const std::string& case_path);

struct PathAudit {
  Audit audit;  ///< interrupted: then nothing else is meant, and what was written is of no use
  std::vector<ToleranceLimit> tolerance_limits;  ///< where the path is proved and the case states tolerances
  nlohmann::json witness;                        ///< the certificate's
};

struct PathAuditOptions {
  long max_bits = 4096;             ///< of the prover's last rung
  std::filesystem::path folder;     ///< for temporary files
  const SigningKey* key = nullptr;  ///< null: the certificate is not signed
};

/// @param source       at its first waypoint
/// @param certificate  takes the text of certificate.json, @param csv that of path.csv
/// @throws as audit()
[[nodiscard]] PathAudit audit_path(PathSource& source, const PathAuditOptions& options, const WriteText& certificate,
                                   const WriteText& csv, const AuditProgress& progress, const std::stop_token& stop);

}  // namespace taut
