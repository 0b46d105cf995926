// SPDX-License-Identifier: GPL-3.0-or-later
// Forged atlas files with the right checksums, as one would make who means harm. What is known of the format here comes
// from docs/atlas-file.md.
#pragma once

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>

namespace taut::testing {

template <class T>
T number_at(const std::string& bytes, std::size_t place) {
  T value;
  std::memcpy(&value, bytes.data() + place, sizeof value);
  return value;
}

template <class T>
void set_number(std::string& bytes, std::size_t place, T value) {
  std::memcpy(bytes.data() + place, &value, sizeof value);
}

/// Where things stand in an atlas file that was not altered.
struct AtlasFilePlaces {
  static constexpr std::size_t kVersion = 8, kCharts = 12, kChecksum = 16, kTableBytes = 24, kTables = 192;
  std::size_t charts, polytope_ends, polytope_hashes, complete, polytopes;

  explicit AtlasFilePlaces(const std::string& bytes) : charts(number_at<std::uint32_t>(bytes, kCharts)) {
    const auto coordinates = number_at<std::uint32_t>(bytes, 184);
    const auto ambient = number_at<std::uint32_t>(bytes, 188);
    polytope_ends = kTables + charts * 88 + 8 * (ambient + charts * (coordinates + 2));
    polytope_hashes = polytope_ends + 8 * charts;
    polytopes = kTables + number_at<std::uint64_t>(bytes, kTableBytes);
    complete = polytopes - charts;
  }
};

/// Makes the checksums right again, as far as the bytes still have a place for them.
inline void seal(std::string& bytes, const AtlasFilePlaces& at) {
  if (bytes.size() < at.polytopes) return;
  for (std::size_t id = 0; id < at.charts; ++id) {
    const std::size_t begin = id == 0 ? 0 : number_at<std::uint64_t>(bytes, at.polytope_ends + 8 * (id - 1));
    const std::size_t end = number_at<std::uint64_t>(bytes, at.polytope_ends + 8 * id);
    if (begin > end || end > bytes.size() - at.polytopes) break;
    const XXH64_hash_t hash = XXH3_64bits(bytes.data() + at.polytopes + begin, end - begin);
    set_number<std::uint64_t>(bytes, at.polytope_hashes + 8 * id, hash);
  }
  set_number<std::uint64_t>(bytes, AtlasFilePlaces::kChecksum, 0);
  const XXH64_hash_t header = XXH3_64bits(bytes.data(), AtlasFilePlaces::kTables);
  const char* tables = bytes.data() + AtlasFilePlaces::kTables;
  set_number<std::uint64_t>(bytes, AtlasFilePlaces::kChecksum,
                            XXH3_64bits_withSeed(tables, at.polytopes - AtlasFilePlaces::kTables, header));
}

}  // namespace taut::testing
