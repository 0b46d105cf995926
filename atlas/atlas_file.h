// SPDX-License-Identifier: GPL-3.0-or-later
// Atlas files: charts made for one query and used again by the next (docs/atlas-file.md).
//
// An atlas only proposes, so nothing in a file can make a proof wrong. The file is checked so that one that is damaged,
// belongs to another problem or was made by somebody else causes an error message, never a crash.
//
// The small data that a search needs of every chart are read and checked at once: the centre's coordinates, the
// neighbours, the index of charts near a point. For the few charts that a query looks at closely, polytopes are read
// and frames, which are closed form, are computed again.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <span>
#include <string>

#include "atlas/atlas.h"
#include "atlas/wrench_feasible_manifold.h"

namespace taut {

/// Raise this with every change of the format, of the meaning of charts and polytopes, or of the metric.
inline constexpr unsigned kAtlasFileVersion = 1;

/// Everything that charts depend on. A file belongs to one key.
struct AtlasKey {
  std::string problem;    ///< digest of robot, load and space, 64 characters
  MetricWeights weights;  ///< as the case asks; a query closer to a limit may have needed a smaller clearance
  AtlasOptions options;   ///< max_charts is not part of the key
};

class AtlasFile {
 public:
  /// @throws InputError naming the file and why it is refused: it can't be read, is no atlas file, has another version,
  /// was cut, extended or damaged, or belongs to another key (naming the part, the value there and the one expected).
  AtlasFile(std::filesystem::path path, const AtlasKey& key);

  /// The content of a file with all charts of `atlas`. @pre at least one chart.
  /// @param clearance  the clearance that `atlas.manifold()` was made with: the key's or less.
  [[nodiscard]] static std::string bytes_of(const Atlas& atlas, const AtlasKey& key, double clearance);

  [[nodiscard]] int size() const { return static_cast<int>(radii_.size()); }
  /// The clearance that the charts' manifold was made with.
  [[nodiscard]] double clearance() const { return clearance_; }
  [[nodiscard]] Coordinates coordinates(int chart) const;
  [[nodiscard]] double radius(int chart) const { return radii_[chart]; }
  [[nodiscard]] double circumradius(int chart) const { return circumradii_[chart]; }
  [[nodiscard]] bool complete(int chart) const { return complete_[chart] != 0; }
  /// Neighbours of a chart, ascending.
  [[nodiscard]] std::span<const int> neighbours(int chart) const;
  [[nodiscard]] bool are_neighbours(int a, int b) const;
  /// The centres with their reach, as one tree of the neighbour index.
  [[nodiscard]] std::span<const NeighbourIndex::Entry> places() const { return places_; }
  /// Reads a chart's polytope from the file. @throws InputError if it is damaged.
  [[nodiscard]] ChartPolytope polytope(int chart) const;

  /// @throws InputError unless dimensions, coordinates and the first chart's ambient point are the manifold's.
  void require_on(const Manifold& manifold) const;
  /// @throws InputError naming file and chart.
  [[noreturn]] void fail_at(int chart, const std::string& what) const;

 private:
  struct Header;

  [[noreturn]] void refuse(const std::string& why) const;
  void read(std::size_t begin, std::span<std::byte> into) const;
  [[nodiscard]] Header read_header() const;
  void read_tables(const Header& header);
  void require_key(const Header& header, const AtlasKey& key) const;
  void require_sound_tables(double largest_radius) const;

  std::filesystem::path path_;
  mutable std::ifstream file_;
  int dimension_ = 0;
  int coordinate_dimension_ = 0;
  double clearance_ = 0;
  std::size_t polytopes_begin_ = 0;
  std::unique_ptr<std::byte[]> tables_;  ///< the memory of the spans below
  std::span<const NeighbourIndex::Entry> places_;
  std::span<const double> first_point_, coordinates_, radii_, circumradii_;
  std::span<const std::uint64_t> polytope_ends_, polytope_hashes_, neighbour_ends_;
  std::span<const int> neighbours_;
  std::span<const std::uint8_t> complete_;
};

}  // namespace taut
