// SPDX-License-Identifier: GPL-3.0-or-later
// The report's page: one file that needs nothing else, on screen and on paper.
#pragma once

#include <string>
#include <vector>

#include <report/report.hpp>

namespace clerestory {

/// A view as the page shows it.
struct PageView {
  std::string name;
  std::string fileStem;  ///< of the .exr and .png in the report
  std::string png;       ///< the file's bytes
  double white_cd_m2;    ///< luminance of 1.0 in the scene-linear picture
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
