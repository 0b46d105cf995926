// SPDX-License-Identifier: GPL-3.0-or-later
#include "atlas/atlas_file.h"

#define XXH_INLINE_ALL
#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <numeric>

#include "atlas/bytes.h"
#include "base/input_error.h"

namespace taut {
namespace {

static_assert(std::endian::native == std::endian::little && sizeof(int) == 4, "atlas files are little-endian");
static_assert(sizeof(NeighbourIndex::Entry) == 88 && std::is_trivially_copyable_v<NeighbourIndex::Entry>);

constexpr std::string_view kMagic = "tautatl\n";
// Files with more charts are refused. No atlas has had as many, and this is far from overflow.
constexpr int kMostCharts = 10'000'000;
// Least radius of a chart, as a fraction of the largest; around smaller ones the atlas would grow almost without end.
constexpr double kLeastRadius = 1e-6;
// Largest periodic coordinate; it keeps counts of half turns far from overflow.
constexpr double kLargestAngle = 1e8;
// Largest relative difference of a chart's ambient point between compilers.
constexpr double kSameMetric = 1e-9;

template <class T>
void append(std::string& bytes, const std::vector<T>& values) {
  append_values(bytes, values.data(), values.size());
}

/// Takes tables from a block of memory, one after the other; take() is false if the rest is too short.
class Cursor {
 public:
  explicit Cursor(std::span<const std::byte> bytes) : bytes_(bytes) {}
  template <class T>
  bool take(std::size_t count, std::span<const T>& table) {
    if (count > bytes_.size() / sizeof(T)) return false;
    table = {reinterpret_cast<const T*>(bytes_.data()), count};
    bytes_ = bytes_.subspan(table.size_bytes());
    return true;
  }
  [[nodiscard]] std::size_t rest() const { return bytes_.size(); }

 private:
  std::span<const std::byte> bytes_;
};

bool ascends_to(std::span<const std::uint64_t> ends, std::size_t last) {
  return std::ranges::is_sorted(ends) && ends.back() == last;
}

/// The part [ends[k - 1], ends[k]) of `all`; part 0 begins at 0.
template <class T>
std::span<const T> part(std::span<const T> all, std::span<const std::uint64_t> ends, int k) {
  const std::size_t begin = k == 0 ? 0 : ends[k - 1];
  return all.subspan(begin, ends[k] - begin);
}

}  // namespace

/// The beginning of the file. The tables follow, then the polytopes.
struct AtlasFile::Header {
  std::array<char, 8> magic;
  std::uint32_t version;
  std::uint32_t charts;
  std::uint64_t checksum;  ///< XXH3 of the header, with 0 in this place, and the tables
  std::uint64_t table_bytes, polytope_bytes, neighbours;
  std::array<char, 64> problem;
  double radius, epsilon, min_tangent_cosine, step;
  double parameter_weight, slack_weight, clearance_asked, clearance;
  std::int32_t max_halvings, dimension, coordinate_dimension, ambient_dimension;

  [[nodiscard]] static Header of(const AtlasKey& key) {
    Header header{};
    std::ranges::copy(kMagic, header.magic.begin());
    header.version = kAtlasFileVersion;
    key.problem.copy(header.problem.data(), header.problem.size());
    header.radius = key.options.radius;
    header.epsilon = key.options.epsilon;
    header.min_tangent_cosine = key.options.min_tangent_cosine;
    header.step = key.options.step;
    header.max_halvings = key.options.max_halvings;
    header.parameter_weight = key.weights.parameter;
    header.slack_weight = key.weights.slack;
    header.clearance_asked = key.weights.clearance;
    return header;
  }

  [[nodiscard]] std::uint64_t digest(std::span<const std::byte> tables) const {
    Header unsealed = *this;
    unsealed.checksum = 0;
    return XXH3_64bits_withSeed(tables.data(), tables.size(), XXH3_64bits(&unsealed, sizeof unsealed));
  }
};

std::string AtlasFile::bytes_of(const Atlas& atlas, const AtlasKey& key, double clearance) {
  const auto count = static_cast<std::size_t>(atlas.size());
  std::vector<double> coordinates, radii, circumradii;
  std::vector<std::uint64_t> polytope_ends, polytope_hashes, neighbour_ends;
  std::vector<int> neighbours;
  std::vector<std::uint8_t> complete;
  std::string polytopes;
  for (int id = 0; id < atlas.size(); ++id) {
    const Chart& chart = atlas.chart(id);
    const auto centre = chart.frame.coordinates();
    coordinates.insert(coordinates.end(), centre.begin(), centre.end());
    radii.push_back(chart.radius);
    circumradii.push_back(std::visit([](const auto& polytope) { return polytope.circumradius(); }, chart.polytope));
    complete.push_back(chart.complete ? 1 : 0);
    const std::vector<int> around = atlas.neighbours(id);
    neighbours.insert(neighbours.end(), around.begin(), around.end());
    neighbour_ends.push_back(neighbours.size());
    const std::size_t begin = polytopes.size();
    std::visit([&](const auto& polytope) { polytope.append_bytes(polytopes); }, chart.polytope);
    polytope_hashes.push_back(XXH3_64bits(polytopes.data() + begin, polytopes.size() - begin));
    polytope_ends.push_back(polytopes.size());
  }
  const auto point = atlas.chart(0).frame.point();

  std::string tables;
  append(tables, atlas.places());
  append_values(tables, point.data(), static_cast<std::size_t>(point.size()));
  append(tables, coordinates);
  append(tables, radii);
  append(tables, circumradii);
  append(tables, polytope_ends);
  append(tables, polytope_hashes);
  append(tables, neighbour_ends);
  append(tables, neighbours);
  append(tables, complete);

  Header header = Header::of(key);
  header.charts = static_cast<std::uint32_t>(count);
  header.table_bytes = tables.size();
  header.polytope_bytes = polytopes.size();
  header.neighbours = neighbours.size();
  header.clearance = clearance;
  header.dimension = atlas.manifold().dimension();
  header.coordinate_dimension = atlas.manifold().coordinate_dimension();
  header.ambient_dimension = atlas.manifold().ambient_dimension();
  header.checksum = header.digest(std::as_bytes(std::span(tables)));
  std::string file(reinterpret_cast<const char*>(&header), sizeof header);
  return file.append(tables).append(polytopes);
}

AtlasFile::AtlasFile(std::filesystem::path path, const AtlasKey& key) : path_(std::move(path)) {
  const Header header = read_header();
  read_tables(header);
  require_key(header, key);
  require_sound_tables(header.radius);
}

void AtlasFile::refuse(const std::string& why) const {
  throw InputError(ErrorCode::kAtlas, fmt::format("{}: {}", path_.string(), why), {path_.string()});
}

void AtlasFile::fail_at(int chart, const std::string& what) const {
  refuse(fmt::format("the atlas is damaged: chart {}: {}", chart, what));
}

void AtlasFile::read(std::size_t begin, std::span<std::byte> into) const {
  file_.clear();
  file_.seekg(static_cast<std::streamoff>(begin));
  file_.read(reinterpret_cast<char*>(into.data()), static_cast<std::streamsize>(into.size()));
  if (!file_) refuse("could not be read, or was cut while it was read");
}

AtlasFile::Header AtlasFile::read_header() const {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path_, error)) {
    if (!error) refuse("got something that is no regular file, expected an atlas file");
    throw InputError(ErrorCode::kFile, fmt::format("{}: could not read: {}", path_.string(), error.message()),
                     {path_.string()});
  }
  file_.rdbuf()->pubsetbuf(nullptr, 0);
  file_.open(path_, std::ios::binary);
  if (!file_) {
    throw InputError(ErrorCode::kFile, fmt::format("{}: could not read: {}", path_.string(), std::strerror(errno)),
                     {path_.string()});
  }
  const std::uintmax_t size = std::filesystem::file_size(path_, error);
  Header header{};
  const std::size_t version_end = offsetof(Header, charts);
  if (size < version_end) refuse(fmt::format("got a file of {} bytes, expected an atlas file", size));
  read(0, std::as_writable_bytes(std::span(&header, 1)).first(std::min<std::size_t>(size, sizeof header)));
  if (std::string_view(header.magic.data(), header.magic.size()) != kMagic) refuse("is no atlas file");
  if (header.version != kAtlasFileVersion) {
    refuse(
        fmt::format("got an atlas file of version {}, expected {}: save it again", header.version, kAtlasFileVersion));
  }
  const std::uintmax_t rest = size - std::min<std::uintmax_t>(size, sizeof header);
  if (size < sizeof header || header.table_bytes > rest || header.polytope_bytes != rest - header.table_bytes) {
    refuse(fmt::format("the atlas is damaged: got {} bytes, which are more or fewer than were written", size));
  }
  if (header.charts < 1 || header.charts > kMostCharts || header.dimension < 1 || header.dimension > kMaxDimension ||
      header.coordinate_dimension < 1 || header.coordinate_dimension > kMaxCoordinates ||
      header.ambient_dimension < 1 || header.ambient_dimension > 1000) {
    refuse("the atlas is damaged: it counts charts or dimensions that no atlas has");
  }
  return header;
}

void AtlasFile::read_tables(const Header& header) {
  try {
    tables_ = std::make_unique_for_overwrite<std::byte[]>(header.table_bytes);
  } catch (const std::bad_alloc&) {
    refuse(fmt::format("got tables of {} bytes, more than there is memory", header.table_bytes));
  }
  const std::span<std::byte> bytes(tables_.get(), header.table_bytes);
  read(sizeof header, bytes);
  if (header.digest(bytes) != header.checksum) refuse("the atlas is damaged: its checksum differs");
  const std::size_t count = header.charts;
  Cursor cursor(bytes);
  const bool all_there = cursor.take(count, places_) && cursor.take(header.ambient_dimension, first_point_) &&
                         cursor.take(count * header.coordinate_dimension, coordinates_) && cursor.take(count, radii_) &&
                         cursor.take(count, circumradii_) && cursor.take(count, polytope_ends_) &&
                         cursor.take(count, polytope_hashes_) && cursor.take(count, neighbour_ends_) &&
                         cursor.take(header.neighbours, neighbours_) && cursor.take(count, complete_);
  if (!all_there || cursor.rest() != 0 || !ascends_to(neighbour_ends_, neighbours_.size()) ||
      !ascends_to(polytope_ends_, header.polytope_bytes)) {
    refuse("the atlas is damaged: its tables do not fit each other");
  }
  dimension_ = header.dimension;
  coordinate_dimension_ = header.coordinate_dimension;
  clearance_ = header.clearance;
  polytopes_begin_ = sizeof header + header.table_bytes;
}

void AtlasFile::require_key(const Header& header, const AtlasKey& key) const {
  const Header expected = Header::of(key);
  if (header.problem != expected.problem) {
    refuse("the atlas is of another problem: its robot, load or space is not the case's");
  }
  const auto require = [&](const char* what, double seen, double wanted) {
    if (seen != wanted) refuse(fmt::format("the atlas was made with {} {}, expected {}", what, seen, wanted));
  };
  require("planner.radius", header.radius, expected.radius);
  require("planner.epsilon", header.epsilon, expected.epsilon);
  require("planner.clearance", header.clearance_asked, expected.clearance_asked);
  require("a least cosine of tangents of", header.min_tangent_cosine, expected.min_tangent_cosine);
  require("a step of", header.step, expected.step);
  require("a number of halvings of", header.max_halvings, expected.max_halvings);
  require("a weight of parameters of", header.parameter_weight, expected.parameter_weight);
  require("a weight of slack variables of", header.slack_weight, expected.slack_weight);
}

void AtlasFile::require_sound_tables(double largest_radius) const {
  if (!(clearance_ >= 0 && clearance_ < 1)) refuse("the atlas is damaged: its clearance is none");
  const auto finite = [](double x) { return std::isfinite(x); };
  if (!std::ranges::all_of(coordinates_, finite)) refuse("the atlas is damaged: its coordinates are not finite");
  // Points and reaches need not be right: an entry with a wrong point only hides its chart.
  std::vector<bool> seen(radii_.size());
  for (const NeighbourIndex::Entry& place : places_) {
    const bool known = place.id >= 0 && place.id < size() && !seen[place.id];
    if (!known || place.split < 0 || place.split >= NeighbourIndex::kDimension) {
      refuse("the atlas is damaged: its index of places is none");
    }
    seen[place.id] = true;
  }
  for (int id = 0; id < size(); ++id) {
    if (!(radii_[id] >= kLeastRadius * largest_radius && radii_[id] <= largest_radius)) fail_at(id, "radius");
    if (!finite(circumradii_[id])) fail_at(id, "size of its polytope");
    int before = -1;
    for (const int neighbour : neighbours(id)) {
      if (neighbour <= before || neighbour >= size() || neighbour == id) fail_at(id, "neighbours");
      before = neighbour;
    }
  }
}

Coordinates AtlasFile::coordinates(int chart) const {
  return Eigen::Map<const Coordinates>(&coordinates_[static_cast<std::size_t>(chart) * coordinate_dimension_],
                                       coordinate_dimension_);
}

std::span<const int> AtlasFile::neighbours(int chart) const { return part(neighbours_, neighbour_ends_, chart); }

bool AtlasFile::are_neighbours(int a, int b) const { return std::ranges::binary_search(neighbours(a), b); }

ChartPolytope AtlasFile::polytope(int chart) const {
  const std::size_t begin = chart == 0 ? 0 : polytope_ends_[chart - 1];
  std::vector<std::byte> bytes(polytope_ends_[chart] - begin);
  read(polytopes_begin_ + begin, bytes);
  if (XXH3_64bits(bytes.data(), bytes.size()) != polytope_hashes_[chart]) fail_at(chart, "its checksum differs");
  const auto sound = [&](auto result) -> ChartPolytope {
    if (!result || result->has_facet(chart)) fail_at(chart, "its polytope is none");
    return *std::move(result);
  };
  if (dimension_ > Polytope::kMaxDimension) return sound(SampledPolytope::from_bytes(dimension_, bytes, size()));
  return sound(Polytope::from_bytes(dimension_, bytes, size()));
}

void AtlasFile::require_on(const Manifold& manifold) const {
  if (manifold.dimension() != dimension_ || manifold.coordinate_dimension() != coordinate_dimension_ ||
      manifold.ambient_dimension() != static_cast<int>(first_point_.size())) {
    refuse("the atlas is of a manifold of other dimensions");
  }
  Frame frame;
  const Eigen::Map<const Eigen::VectorXd> point(first_point_.data(), static_cast<Eigen::Index>(first_point_.size()));
  if (!manifold.frame_at(coordinates(0), frame) ||
      !((frame.point() - point).lpNorm<Eigen::Infinity>() <= kSameMetric)) {
    refuse("the atlas was made with another metric, by another version of taut");
  }
  const CoordinateSymmetry symmetry = manifold.symmetry();
  for (std::size_t k = 0; k < coordinates_.size(); ++k) {
    const std::size_t j = k % static_cast<std::size_t>(coordinate_dimension_);
    if (symmetry.periodic[j] && std::abs(coordinates_[k]) > kLargestAngle) refuse("the atlas is damaged: an angle");
  }
}

}  // namespace taut
