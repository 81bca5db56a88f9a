// SPDX-License-Identifier: GPL-3.0-or-later
// The report's page: one file that needs nothing else, on screen and on paper.
#pragma once

#include <string>
#include <vector>

#include <report/report.hpp>

namespace clerestory {

/// A view as the page shows it.
struct PageView {
  std::size_t index = 0;  ///< into Solution::views
  std::string name;
  std::string fileName;                           ///< without view-, luminance-, illuminance- and ending
  std::string png, luminancePng, illuminancePng;  ///< the files' bytes
  double white_cd_m2 = 1.0;                       ///< luminance of 1.0 in the scene-linear picture
  double exposure_ev = 0.0;                       ///< at ISO 100
  int width = 0, height = 0;
};

struct PagePictures {
  std::vector<PageView> views;
  std::vector<std::string>
      plans;  ///< per grid: the bytes of its PNG, or empty where the page draws it as SVG
};

/// index.html.
std::string pageHtml(const ReportInput& input, const PagePictures& pictures);

}  // namespace clerestory
