// SPDX-License-Identifier: GPL-3.0-or-later
#include "certify/lanes/kernel.h"

#include <cstdlib>
#include <string>

#include "base/input_error.h"
#include "certify/lanes/levels.h"

namespace taut::lanes {
namespace {

constexpr Level kLevels[] = {Level::kAvx512, Level::kAvx2, Level::kSse2};  // the best first

const Kernels& chosen() {
  const char* const asked = std::getenv("TAUT_SIMD");
  if (asked == nullptr || *asked == '\0') {
    for (const Level level : kLevels) {
      if (const Kernels* kernels = kernels_of(level)) return *kernels;
    }
  }
  for (const Level level : kLevels) {
    if (asked == nullptr || std::string(asked) != name(level)) continue;
    if (const Kernels* kernels = kernels_of(level)) return *kernels;
    throw InputError(ErrorCode::kUse,
                     std::string("TAUT_SIMD: got '") + asked + "', which this processor does not have");
  }
  throw InputError(ErrorCode::kUse, std::string("TAUT_SIMD: got '") + asked + "', expected sse2, avx2 or avx512");
}

}  // namespace

const char* name(Level level) {
  switch (level) {
    case Level::kSse2: return "sse2";
    case Level::kAvx2: return "avx2";
    case Level::kAvx512: break;
  }
  return "avx512";
}

// __builtin_cpu_supports asks the operating system, too, whether it keeps the registers.
const Kernels* kernels_of(Level level) {
  switch (level) {
    case Level::kSse2: return &kSse2Kernels;
    case Level::kAvx2: return __builtin_cpu_supports("avx2") ? &kAvx2Kernels : nullptr;
    case Level::kAvx512: break;
  }
  return __builtin_cpu_supports("avx512f") ? &kAvx512Kernels : nullptr;
}

const Kernels& kernels() {
  static const Kernels& best = chosen();
  return best;
}

}  // namespace taut::lanes
