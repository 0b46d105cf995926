#include "certify/big_float.h"

namespace taut {
namespace {

constexpr mpfr_prec_t kDefaultPrecision = 128;
thread_local mpfr_prec_t precision = kDefaultPrecision;

}  // namespace

mpfr_prec_t working_precision() { return precision; }

PrecisionScope::PrecisionScope(mpfr_prec_t bits) : saved_(precision) { precision = bits; }
PrecisionScope::~PrecisionScope() { precision = saved_; }

}  // namespace taut
