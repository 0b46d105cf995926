// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/page/margins.h"

#include <algorithm>
#include <numeric>

#include "reports/page/table_sizes.h"
#include "reports/summary/numbers.h"
#include "reports/summary/time_statement.h"
#include "reports/summary/wording.h"

namespace taut {
namespace {

constexpr std::size_t kLeastShown = 20;  ///< segments with the least margins, beside the blocks of a long path

/// By how much loads could grow is claimed of no move in time.
bool has_growth(const Certificate& certificate) { return !is_move(certificate); }

/// The printed row of a segment, or of several consecutive ones.
struct MarginRow {
  std::size_t first = 0, last = 0;  ///< segments
  std::size_t boxes = 0;
  int depth = 0;                     ///< of the narrowest box: it is 2^-depth wide
  const Margins* tension = nullptr;  ///< that of the segment where this margin is least; null without any box
  const Margins* length = nullptr;
  const Margins* scale = nullptr;
  const Margins* clearance = nullptr;
};

MarginRow margin_row(const ReportContext& scene, std::size_t first, std::size_t last) {
  MarginRow row{first, last};
  for (std::size_t k = first; k <= last; ++k) {
    const CertificateSegment& segment = scene.certificate.segments[k];
    row.boxes += segment.boxes.size();
    for (const DyadicBox& box : scene.boxes[k]) row.depth = std::max(row.depth, box.depth);
    if (!segment.margins) continue;
    const Margins& margins = *segment.margins;
    const auto keep_least = [&](const Margins*& least, DecimalText Margins::*margin) {
      if (least == nullptr || nearest_double(margins.*margin) < nearest_double(least->*margin)) least = &margins;
    };
    keep_least(row.tension, &Margins::tension_N);
    keep_least(row.length, &Margins::length_m);
    keep_least(row.scale, &Margins::wrench_scale);
    if (margins.clearance_m && (row.clearance == nullptr ||
                                nearest_double(*margins.clearance_m) < nearest_double(*row.clearance->clearance_m))) {
      row.clearance = &margins;
    }
  }
  return row;
}

/// In bold where it is the least of the whole path.
Html marked(const Certificate& certificate, const Margins* least, DecimalText Margins::*margin,
            const std::string& text) {
  const bool is_least = certificate.margins && least->*margin == (*certificate.margins).*margin;
  return is_least ? html("<b>{}</b>", text) : html("{}", text);
}

/// The least clearance left, as `text_of` has it; in bold likewise.
template <class TextOf>
Html clearance_cell(const Certificate& certificate, const Margins* least, const TextOf& text_of) {
  if (least == nullptr) return html("–");
  const std::string text = text_of(*least->clearance_m);
  const bool is_least = certificate.margins && certificate.margins->clearance_m == least->clearance_m;
  return is_least ? html("<b>{}</b>", text) : html("{}", text);
}

Html segments_text(const MarginRow& row) {
  return row.first == row.last ? html("{}", row.first) : html("{} – {}", row.first, row.last);
}

Html rounded_table(const ReportContext& scene, const std::string& caption, const std::vector<MarginRow>& rows) {
  const Certificate& certificate = scene.certificate;
  const DisplayUnits& units = scene.illustration.units;
  const auto cell = [&](const Margins* least, DecimalText Margins::*margin, const auto& text_of) {
    return least == nullptr ? html("–") : marked(certificate, least, margin, text_of(least->*margin));
  };
  const auto in = [](const DisplayUnit& unit) {
    return [&unit](const DecimalText& si) { return truncated(unit.exact(si)); };
  };
  std::vector<std::vector<Html>> cells;
  cells.reserve(rows.size());
  for (const MarginRow& row : rows) {
    cells.push_back({segments_text(row),
                     html("{} → {}", row.first, row.last + control_points(certificate.path.interpolation) - 1),
                     html("{}", row.boxes), cell(row.tension, &Margins::tension_N, in(units.force)),
                     cell(row.length, &Margins::length_m, in(units.length))});
    if (has_growth(certificate)) cells.back().push_back(cell(row.scale, &Margins::wrench_scale, growth_text));
    if (certificate.problem.bodies) {
      cells.back().push_back(clearance_cell(certificate, row.clearance, in(units.length)));
    }
  }
  std::vector<Column> columns = {{html("Segment"), true},
                                 {html("Waypoints"), true},
                                 {html("Boxes"), true},
                                 {html("Tension to its nearer limit [{}]", units.force.name()), true},
                                 {html("Length to its nearer limit [{}]", units.length.name()), true}};
  if (has_growth(certificate)) columns.push_back({html("Loads could grow to"), true});
  if (certificate.problem.bodies) columns.push_back({html("Clearance left [{}]", units.length.name()), true});
  return table(html("{}", caption), columns, cells);
}

Html exact_table(const Certificate& certificate, const std::string& caption, const std::vector<MarginRow>& rows) {
  std::vector<std::vector<Html>> cells;
  cells.reserve(rows.size());
  for (const MarginRow& row : rows) {
    const auto cell = [&](const Margins* least, DecimalText Margins::*margin) {
      return least == nullptr ? html("–") : marked(certificate, least, margin, least->*margin);
    };
    cells.push_back({segments_text(row),
                     row.boxes == 0   ? html("–")
                     : row.depth == 0 ? html("1")
                                      : html("2<sup>−{}</sup>", row.depth),
                     cell(row.tension, &Margins::tension_N), cell(row.length, &Margins::length_m)});
    if (has_growth(certificate)) cells.back().push_back(cell(row.scale, &Margins::wrench_scale));
    if (certificate.problem.bodies) {
      cells.back().push_back(clearance_cell(certificate, row.clearance, [](const DecimalText& si) { return si; }));
    }
  }
  std::vector<Column> columns = {
      {html("Segment"), true}, {html("Narrowest box"), true}, {html("tension_N"), true}, {html("length_m"), true}};
  if (has_growth(certificate)) columns.push_back({html("wrench_scale"), true});
  if (certificate.problem.bodies) columns.push_back({html("clearance_m"), true});
  return table(html("{}", caption), columns, cells);
}

std::vector<MarginRow> rows_of(const ReportContext& scene, std::size_t step) {
  std::vector<MarginRow> rows;
  const std::size_t count = scene.certificate.segments.size();
  for (std::size_t k = 0; k < count; k += step) rows.push_back(margin_row(scene, k, std::min(k + step, count) - 1));
  return rows;
}

/// The segments whose loads may grow least, of a move those with the least margins of tension, in order along the path.
std::vector<MarginRow> least_segments(const ReportContext& scene) {
  const Certificate& certificate = scene.certificate;
  std::vector<std::size_t> all;
  for (std::size_t k = 0; k < certificate.segments.size(); ++k) {
    if (certificate.segments[k].margins) all.push_back(k);
  }
  std::vector<double> scale(certificate.segments.size());
  const DecimalText Margins::*const margin = has_growth(certificate) ? &Margins::wrench_scale : &Margins::tension_N;
  for (const std::size_t k : all) scale[k] = nearest_double((*certificate.segments[k].margins).*margin);
  const std::size_t count = std::min(kLeastShown, all.size());
  std::ranges::partial_sort(all, all.begin() + static_cast<std::ptrdiff_t>(count), {},
                            [&](std::size_t k) { return scale[k]; });
  all.resize(count);
  std::ranges::sort(all);
  std::vector<MarginRow> rows;
  for (const std::size_t k : all) rows.push_back(margin_row(scene, k, k));
  return rows;
}

const char* least_caption(const Certificate& certificate) {
  return has_growth(certificate) ? "The segments whose loads may grow least"
                                 : "The segments with the least margins of tension";
}

}  // namespace

Html margins(const ReportContext& scene) {
  const Certificate& certificate = scene.certificate;
  const std::size_t count = certificate.segments.size();
  if (count_boxes(certificate) == 0) return {};
  const std::size_t step = step_for(count);
  const std::vector<MarginRow> rows = rows_of(scene, step);
  const Html tables =
      step == 1
          ? folded(count > kLongTable, html("{}", plural(count, "segment")),
                   rounded_table(scene, "Proved margins of each segment", rows))
          : folded(true, html("{}", plural(rows.size(), "block")),
                   rounded_table(
                       scene, fmt::format("The least proved margins of blocks of {}", plural(step, "segment")), rows)) +
                folded(true, html("{}", least_caption(certificate)),
                       rounded_table(scene, least_caption(certificate), least_segments(scene)));
  return section(
      "margins", "Proved margins",
      html("<p>Lower bounds that hold at every pose of a segment, for all six cables and every load, rounded down{}. "
           "{}{}The true margins may be larger: a bound is as sharp as the proof needed it. Boxes are the "
           "intervals of a segment that were proved at one go.</p>\n",
           certificate.margins ? "" : ", for those parts of the path that are proved",
           has_growth(certificate)
               ? "Loads could grow by the factor by which the semi-axes of their set may grow before a tension reaches "
                 "its limit. "
               : "",
           certificate.margins ? "The least of each column is set in bold. " : "") +
          tables);
}

Html exact_margins(const ReportContext& scene) {
  const Certificate& certificate = scene.certificate;
  const std::size_t count = certificate.segments.size();
  if (count_boxes(certificate) == 0) return {};
  const bool has_all = count <= kMostRows;
  const Html whole =
      certificate.margins
          ? html("<p>Of the whole path: <code>tension_N</code> {}, <code>length_m</code> {}{}{}.</p>\n",
                 certificate.margins->tension_N, certificate.margins->length_m,
                 has_growth(certificate) ? html(", <code>wrench_scale</code> {}", certificate.margins->wrench_scale)
                                         : Html(),
                 certificate.margins->clearance_m
                     ? html(", <code>clearance_m</code> {}", *certificate.margins->clearance_m)
                     : Html())
          : Html();
  const char* const caption = has_all ? "Margins of each segment, exact" : "The least margins of segments, exact";
  return section(
      "exact-margins", "Margins as the certificate states them",
      whole +
          (has_all ? Html()
                   : html("<p>The certificate has all {}. Here are those with the least "
                          "<code>{}</code>.</p>\n",
                          plural(count, "segment"), has_growth(certificate) ? "wrench_scale" : "tension_N")) +
          folded(count > kLongTable, html("{}", caption),
                 exact_table(certificate, caption, has_all ? rows_of(scene, 1) : least_segments(scene))));
}

}  // namespace taut
