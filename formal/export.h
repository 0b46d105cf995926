// SPDX-License-Identifier: GPL-3.0-or-later
// A certificate as a file for Coq: exact data in the terms of formal/Certificate.v, and the theorem about them.
#pragma once

#include <string>
#include <vector>

#include "formal/search.h"

namespace taut::formal {

/// How Coq computes: with integers, on no axioms but those of the real numbers, or with the processor's binary64.
enum class Instance { kExact, kFast };

/// Whether what is proved of the file is all that the certificate claims, but for its margins and ranges of parameters.
/// @throws InputError naming the first thing in the certificate of which Statement.v knows nothing.
void require_in_scope(const Certificate& certificate);

/// The file. @pre require_in_scope() lets it pass; `boxes` are find_boxes(certificate)
/// @param sha256  the certificate's, of all its bytes
[[nodiscard]] std::string coq_file(const Certificate& certificate, const std::string& sha256,
                                   const std::vector<std::vector<Box>>& boxes, Instance instance);

/// The boxes alone, which taut-verify reads beside the certificate: {"bits", "boxes": [[{"upto", "scale", "inverse",
/// "densities"}, …], …]}, one list a segment.
[[nodiscard]] std::string boxes_file(const Certificate& certificate, const std::vector<std::vector<Box>>& boxes);

}  // namespace taut::formal
