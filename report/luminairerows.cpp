// SPDX-License-Identifier: GPL-3.0-or-later
// Counts luminaires by kind.
#include "luminairerows.hpp"

#include <algorithm>

#include "escape.hpp"
#include "numbers.hpp"
#include "page_parts.hpp"
#include "sha256.hpp"

namespace clerestory {

std::vector<LuminaireRow> luminaireRows(const ReportInput& input) {
  std::vector<LuminaireRow> rows;
  std::vector<const Photometry*> photometries;  // #rows
  for (const Luminaire& luminaire : input.building.luminaires) {
    const Photometry* own = luminaire.photometry.get();
    std::size_t i = 0;
    while (i < rows.size() &&
           !(photometries[i] == own && rows[i].name == luminaire.name && rows[i].factor == luminaire.factor))
      ++i;
    if (i == rows.size()) {
      const auto settings = std::find_if(input.study.luminaires.begin(), input.study.luminaires.end(),
                                         [&](const LuminaireSettings& other) {
                                           return other.photometry.get() == own && !other.file.empty();
                                         });
      const bool hasFile = settings != input.study.luminaires.end();
      rows.push_back({luminaire.name, hasFile ? settings->file : "", hasFile ? sha256(own->text) : "", 0,
                      own->distribution.flux_lm(), own->power_w, luminaire.factor});
      photometries.push_back(own);
    }
    ++rows[i].count;
  }
  return rows;
}

std::string luminairesSection(const ReportInput& input) {
  std::vector<std::vector<std::string>> cells;
  for (const LuminaireRow& row : luminaireRows(input)) {
    const auto count = static_cast<double>(row.count);
    cells.push_back({escapeHtml(row.name), row.file.empty() ? "stated intensity" : escapeHtml(row.file),
                     fixedNumber(count, 0), roundedNumber(row.flux_lm, 4),
                     row.power_w > 0.0 ? roundedNumber(row.power_w) : "", shortNumber(row.factor),
                     roundedNumber(count * row.factor * row.flux_lm, 4),
                     row.power_w > 0.0 ? roundedNumber(count * row.power_w) : ""});
  }
  if (cells.empty()) return {};
  return sectionOpening("luminaires", "Luminaires") +
         tableHtml("What gives electric light",
                   {{"Luminaire", "", false},
                    {"Photometry", "", false},
                    {"Count", ""},
                    {"Each", "lm"},
                    {"Each", "W"},
                    {"Light loss factor", ""},
                    {"Together", "lm"},
                    {"Together", "W"}},
                   cells) +
         "</section>\n";
}

}  // namespace clerestory
