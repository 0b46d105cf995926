// SPDX-License-Identifier: GPL-3.0-or-later
// Confirms all statements of a certificate by the kernel: which boxes, which witnesses, and that the path is the
// query's.
//
// Nothing is searched: each box and each witness is proved at one go at the precision that the certificate states, or
// it is not confirmed. So the work is proportional to the size of the file.
#pragma once

#include <functional>

#include "checker/format/reader.h"
#include "checker/theorem.h"

namespace taut::checker {

struct ConfirmOptions {
  unsigned threads = 1;
  std::function<void()> before_box = [] {};  ///< may throw, in any thread, to stop
};

/// Confirms the claim of a certificate that says "proved" or "refuted".
/// @throws Rejected naming the first statement that is false or was not confirmed; whatever `before_box` throws.
Theorem::Counts confirm(const Certificate& certificate, const ConfirmOptions& options);

}  // namespace taut::checker
