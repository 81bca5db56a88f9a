// SPDX-License-Identifier: GPL-3.0-or-later
// The luminaires of a study, those of one kind together, for study.json and the page.
#pragma once

#include <string>
#include <vector>

#include <report/report.hpp>

namespace clerestory {

struct LuminaireRow {
  std::string name;
  std::string file;    ///< photometric, as the study names it; empty: an intensity is stated
  std::string sha256;  ///< of that file's text; empty without one
  std::size_t count = 0;
  double flux_lm = 0.0;  ///< of one, as the file states it, before the factor
  double power_w = 0.0;  ///< of one; 0: not stated
  double factor = 1.0;   ///< on the flux: ballast, maintenance and tilt
};

/// One row for all luminaires of one name, file and factor, in the building's order.
std::vector<LuminaireRow> luminaireRows(const ReportInput& input);

/// The page's section on them; nothing where there are none.
std::string luminairesSection(const ReportInput& input);

}  // namespace clerestory
