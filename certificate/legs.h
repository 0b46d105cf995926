// SPDX-License-Identifier: GPL-3.0-or-later
// Certificates of legs: "Legs" in docs/certificate-format.md.
#pragma once

#include <span>
#include <string>

#include "certificate/signature.h"

namespace taut {

/// The text of a certificate of these legs, in their order. Verdict and claim follow from theirs.
/// @param legs  texts of certificates as certificate_text() writes them, without a line feed at the end: they stand in
/// the whole byte by byte
/// @param key  signs the whole; null: it is not signed
[[nodiscard]] std::string legs_certificate_text(std::span<const std::string> legs, const SigningKey* key = nullptr);

}  // namespace taut
