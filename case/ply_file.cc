// SPDX-License-Identifier: GPL-3.0-or-later
#include "case/ply_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <locale>
#include <optional>
#include <sstream>
#include <string_view>
#include <vector>

#include "base/input_error.h"
#include "base/sanitize.h"

namespace taut {
namespace {

[[noreturn]] void fail_as_ply(const std::string& message) { throw InputError(ErrorCode::kCase, message); }
[[noreturn]] void fail_as_cut() { fail_as_ply("which is no whole ply file, expected a mesh"); }

// --- Header --------------------------------------------------------------------------------------------------------

enum class Number { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat, kDouble };

bool is_float(Number number) { return number == Number::kFloat || number == Number::kDouble; }

struct NumberName {
  std::string_view name;
  Number number;
};
constexpr std::array<NumberName, 16> kNumberNames = {{{"char", Number::kInt8},
                                                      {"int8", Number::kInt8},
                                                      {"uchar", Number::kUint8},
                                                      {"uint8", Number::kUint8},
                                                      {"short", Number::kInt16},
                                                      {"int16", Number::kInt16},
                                                      {"ushort", Number::kUint16},
                                                      {"uint16", Number::kUint16},
                                                      {"int", Number::kInt32},
                                                      {"int32", Number::kInt32},
                                                      {"uint", Number::kUint32},
                                                      {"uint32", Number::kUint32},
                                                      {"float", Number::kFloat},
                                                      {"float32", Number::kFloat},
                                                      {"double", Number::kDouble},
                                                      {"float64", Number::kDouble}}};

struct Property {
  std::string name;
  Number number{};
  std::optional<Number> count;  ///< of a list
};

/// What a file may hold.
enum class Part { kPoints, kFaces, kEdges };

struct Element {
  Part part{};
  std::size_t count = 0;
  std::vector<Property> properties;
};

enum class Format { kText, kLittleEndian, kBigEndian };

struct Header {
  Format format{};
  std::vector<Element> elements;
  std::size_t size = 0;  ///< with the end of its last line
};

Number number_of(const std::string& name) {
  const auto* const found = std::ranges::find(kNumberNames, name, &NumberName::name);
  if (found == kNumberNames.end()) {
    fail_as_ply(fmt::format("in which numbers are of the type '{}', expected a mesh", excerpt(name)));
  }
  return found->number;
}

Format format_of(std::istringstream& words) {
  std::string format, version;
  words >> format >> version;
  if (version == "1.0") {
    if (format == "ascii") return Format::kText;
    if (format == "binary_little_endian") return Format::kLittleEndian;
    if (format == "binary_big_endian") return Format::kBigEndian;
  }
  fail_as_ply(fmt::format("which is of the format '{}', expected ascii 1.0 or binary_little_endian 1.0",
                          excerpt(format + " " + version)));
}

Part part_of(const std::string& name) {
  if (name == "vertex" || name == "vertices") return Part::kPoints;
  if (name == "face" || name == "faces") return Part::kFaces;
  if (name == "edge") return Part::kEdges;
  fail_as_ply(fmt::format("which has elements that are called '{}', expected points and faces", excerpt(name)));
}

Element element_of(std::istringstream& words) {
  std::string name, digits;
  if (!(words >> name >> digits)) fail_as_ply("in which an element has no count, expected a mesh");
  Element element;
  element.part = part_of(name);
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), element.count);
  if (error != std::errc() || end != digits.data() + digits.size()) {
    fail_as_ply(fmt::format("in which '{}' is no count of elements, expected a mesh", excerpt(digits)));
  }
  return element;
}

Property property_of(std::istringstream& words) {
  Property property;
  std::string type;
  words >> type;
  if (type == "list") {
    std::string count;
    words >> count >> type;
    property.count = number_of(count);
    if (is_float(*property.count)) fail_as_ply("in which the length of a list is no integer, expected a mesh");
  }
  property.number = number_of(type);
  if (!(words >> property.name)) fail_as_ply("in which a property has no name, expected a mesh");
  return property;
}

Header read_header(const std::string& bytes) {
  std::istringstream lines(bytes);
  std::string line;
  std::string word;
  Header header;
  bool has_format = false;
  for (bool is_first = true; std::getline(lines, line); is_first = false) {
    std::istringstream words(line);
    word.clear();
    words >> word;
    if (is_first) {
      if (word != "ply") fail_as_cut();
      continue;
    }
    if (word == "end_header") {
      if (!has_format || lines.eof()) fail_as_cut();
      header.size = static_cast<std::size_t>(lines.tellg());
      return header;
    }
    if (word == "format" && !has_format) {
      header.format = format_of(words);
      has_format = true;
    } else if (word == "element") {
      header.elements.push_back(element_of(words));
    } else if (word == "property" && !header.elements.empty()) {
      header.elements.back().properties.push_back(property_of(words));
    } else if (word != "comment" && word != "obj_info") {
      fail_as_ply(fmt::format("in whose header '{}' is not known, expected a mesh", excerpt(word)));
    } else {
      continue;
    }
    if (words >> word) fail_as_ply(fmt::format("in whose header '{}' is not known, expected a mesh", excerpt(word)));
  }
  fail_as_cut();
}

/// Refuses what could be taken for one thing or another.
void require_distinct(const Header& header) {
  for (const Element& element : header.elements) {
    if (std::ranges::count(header.elements, element.part, &Element::part) > 1) {
      fail_as_ply("in which points, faces or edges are there twice, expected a mesh");
    }
    if (element.count > 0 && element.properties.empty())
      fail_as_ply("in which elements have no properties, expected a mesh");
    for (const Property& property : element.properties) {
      if (std::ranges::count(element.properties, property.name, &Property::name) > 1) {
        fail_as_ply(fmt::format("in which a property '{}' is there twice, expected a mesh", excerpt(property.name)));
      }
    }
  }
}

// --- Numbers -------------------------------------------------------------------------------------------------------

/// Reads one number after another.
class Numbers {
 public:
  Numbers(const std::string& bytes, const Header& header)
      : rest_(std::string_view(bytes).substr(header.size)), format_(header.format) {}

  /// The number that is next, as a binary64 number, which all of them are. @throws InputError if there is none
  double next(Number number) {
    if (format_ == Format::kText) return number == Number::kFloat ? of_text<float>() : of_text<double>();
    switch (number) {
      case Number::kInt8: return of_bytes<std::int8_t>();
      case Number::kUint8: return of_bytes<std::uint8_t>();
      case Number::kInt16: return of_bytes<std::int16_t>();
      case Number::kUint16: return of_bytes<std::uint16_t>();
      case Number::kInt32: return of_bytes<std::int32_t>();
      case Number::kUint32: return of_bytes<std::uint32_t>();
      case Number::kFloat: return of_bytes<float>();
      case Number::kDouble: return of_bytes<double>();
    }
    return 0;
  }

  /// The same of a length or an index, which is no less than 0 and an integer.
  std::size_t next_index(Number number) {
    const double value = next(number);
    if (!(value >= 0 && value <= UINT32_MAX && value == std::floor(value))) {
      fail_as_ply(fmt::format("in which {} is no length of a list and no index, expected a mesh", value));
    }
    return static_cast<std::size_t>(value);
  }

  /// Whether nothing but blanks and ends of lines is left.
  [[nodiscard]] bool is_at_end() const { return std::ranges::all_of(rest_, is_blank); }

 private:
  static bool is_blank(char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; }

  std::string_view take(std::size_t size) {
    if (rest_.size() < size) fail_as_cut();
    const std::string_view taken = rest_.substr(0, size);
    rest_.remove_prefix(size);
    return taken;
  }

  template <class T>
  double of_bytes() {
    std::array<char, sizeof(T)> bytes;
    std::ranges::copy(take(sizeof(T)), bytes.begin());
    const bool is_native = (format_ == Format::kLittleEndian) == (std::endian::native == std::endian::little);
    if (!is_native) std::ranges::reverse(bytes);
    return static_cast<double>(std::bit_cast<T>(bytes));
  }

  template <class T>
  double of_text() {
    const auto* const begin = std::ranges::find_if_not(rest_, is_blank);
    rest_.remove_prefix(static_cast<std::size_t>(begin - rest_.begin()));
    if (rest_.empty()) fail_as_cut();
    const auto* const end = std::ranges::find_if(rest_, is_blank);
    const std::string_view word = take(static_cast<std::size_t>(end - rest_.begin()));
    return number_in<T>(word);
  }

  /// The number of type T that is nearest to what the word says. What is too large is refused.
  template <class T>
  static double number_in(std::string_view word) {
    const std::string_view digits = word.substr(word.starts_with('+') ? 1 : 0);
    T value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    const bool is_whole = end == digits.data() + digits.size();
    if (is_whole && error == std::errc()) return static_cast<double>(value);
    std::istringstream stream{std::string(digits)};  // takes what is too small for 0, and not what is too large
    stream.imbue(std::locale::classic());
    if (is_whole && error == std::errc::result_out_of_range && stream >> value) return static_cast<double>(value);
    fail_as_ply(fmt::format("in which '{}' is no number, expected a mesh", excerpt(word)));
  }

  std::string_view rest_;
  Format format_;
};

// --- Points and faces ----------------------------------------------------------------------------------------------

/// Passes over what the mesh does not need, such as a colour.
void skip(const Property& property, Numbers& numbers) {
  const std::size_t count = property.count ? numbers.next_index(*property.count) : 1;
  for (std::size_t k = 0; k < count; ++k) static_cast<void>(numbers.next(property.number));
}

void read_points(const Element& element, Numbers& numbers, PolygonSoup& soup) {
  constexpr std::array<const char*, 3> kCoordinates = {"x", "y", "z"};
  std::vector<std::size_t> axes;  // of each property; 3: none
  for (const Property& property : element.properties) {
    const auto* const axis = std::ranges::find(kCoordinates, property.name);
    const bool is_coordinate = !property.count && is_float(property.number);
    axes.push_back(is_coordinate ? static_cast<std::size_t>(axis - kCoordinates.begin()) : kCoordinates.size());
  }
  for (std::size_t k = 0; k < kCoordinates.size(); ++k) {
    if (std::ranges::find(axes, k) != axes.end()) continue;
    fail_as_ply(fmt::format("in which points have no floating-point number '{}', expected a mesh", kCoordinates[k]));
  }
  for (std::size_t i = 0; i < element.count; ++i) {
    std::array<double, 3>& point = soup.points.emplace_back();
    for (std::size_t k = 0; k < axes.size(); ++k) {
      if (axes[k] < point.size()) {
        point[axes[k]] = numbers.next(element.properties[k].number);
      } else {
        skip(element.properties[k], numbers);
      }
    }
  }
}

void read_faces(const Element& element, Numbers& numbers, PolygonSoup& soup) {
  const auto has_corners = [](const Property& property) {
    return property.count && !is_float(property.number) &&
           (property.name == "vertex_indices" || property.name == "vertex_index");
  };
  if (std::ranges::count_if(element.properties, has_corners) != 1) {
    fail_as_ply("in which faces have no list of integers 'vertex_indices', or two, expected a mesh");
  }
  if (element.count > kMostMeshTriangles) {
    fail_as_ply(fmt::format("a mesh of {} faces, expected at most {}", element.count, kMostMeshTriangles));
  }
  for (std::size_t i = 0; i < element.count; ++i) {
    std::vector<std::size_t>& face = soup.faces.emplace_back();
    for (const Property& property : element.properties) {
      if (!has_corners(property)) {
        skip(property, numbers);
        continue;
      }
      const std::size_t count = numbers.next_index(*property.count);
      for (std::size_t k = 0; k < count; ++k) face.push_back(numbers.next_index(property.number));
    }
  }
}

void read_element(const Element& element, Numbers& numbers, PolygonSoup& soup) {
  switch (element.part) {
    case Part::kPoints: return read_points(element, numbers, soup);
    case Part::kFaces: return read_faces(element, numbers, soup);
    case Part::kEdges: break;
  }
  for (std::size_t i = 0; i < element.count; ++i) {
    for (const Property& property : element.properties) skip(property, numbers);
  }
}

}  // namespace

PolygonSoup read_ply(const std::string& bytes) {
  const Header header = read_header(bytes);
  require_distinct(header);
  Numbers numbers(bytes, header);
  PolygonSoup soup;
  for (const Element& element : header.elements) read_element(element, numbers, soup);
  if (!numbers.is_at_end()) fail_as_ply("which holds more than its header says, expected a mesh");
  return soup;
}

}  // namespace taut
