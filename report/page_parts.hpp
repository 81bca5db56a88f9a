// SPDX-License-Identifier: GPL-3.0-or-later
// The pieces that the page's sections are made of. Text that is handed in is HTML already: escape names
// first.
#pragma once

#include <glm/vec3.hpp>

#include <string>
#include <vector>

#include <report/report.hpp>

#include "metrics.hpp"
#include "plan.hpp"

namespace clerestory {

/// A table's column; numbers stand to the right.
struct Column {
  std::string title;
  std::string unit;  ///< may be empty
  bool isNumber = true;
};

/// A table with a caption, a header row, and a row header in each first cell. `ids` (#rows, or none) are the
/// rows' ids; a long table shows `mostRows` of its rows until the reader asks for all.
std::string tableHtml(const std::string& caption, const std::vector<Column>& columns,
                      const std::vector<std::vector<std::string>>& rows,
                      const std::vector<std::string>& ids = {}, std::size_t mostRows = 1'000'000);

/// One figure with its label, for a list of figures.
std::string figureHtml(const std::string& label, const std::string& value, const std::string& unit);

/// A grid's estimated error: 95 of 100 sensors are off by less. [%]
std::string errorText(const GridMetrics& metrics);

std::string sectionOpening(const std::string& id, const std::string& title, const std::string& style = "");

/// A square in the colour of a surface under white light.
std::string swatchHtml(const glm::dvec3& reflectance);

/// A name from the model, escaped, that a line may break after each of its underscores.
std::string nameHtml(const std::string& name);

/// What a light domain is to a reader: the rooms in it, or the outside.
std::string domainName(const Building& building, std::int32_t domain);

/// The section on accuracy: error estimates, convergence, energy balance.
std::string accuracySection(const ReportInput& input);

/// Whether the page carries the 3D viewer: the program was built with it and the solution is not too large.
bool hasViewer(const ReportInput& input);

/// The part of the content security policy that lets the page's own scripts run, and no others.
std::string scriptPolicy(const ReportInput& input);

/// The page's scripts, to stand at its end.
std::string scriptsHtml(const ReportInput& input);

/// The section with the building in 3D, or with the reason why there is none.
std::string viewerSection(const ReportInput& input, const PlanScale& scale);

}  // namespace clerestory
