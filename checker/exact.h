// The exact numbers of a certificate: all of them are strings, none is rounded when it is read.
#pragma once

#include <gmpxx.h>

#include <string>

namespace taut::checker {

/// "-0.0210", "1e-4": that rational number. At most 1000 digits and an exponent of at most 1000 either way.
/// @throws Malformed with `where` and the text seen; so do the others.
[[nodiscard]] mpq_class parse_decimal(const std::string& text, const std::string& where);

/// "0", "1", or "k/m" in (0, 1), in lowest terms, m a power of two up to 2^1000.
[[nodiscard]] mpq_class parse_dyadic(const std::string& text, const std::string& where);

/// A finite binary64 as printed by "%a", such as "-0x1.2666666666666p+1".
[[nodiscard]] double parse_binary64(const std::string& text, const std::string& where);

}  // namespace taut::checker
