// SPDX-License-Identifier: GPL-3.0-or-later
// The page's scripts, put into the program when it is built.
#pragma once

#include <string_view>

namespace clerestory {

/// Tables, plans, exposure, theme: report/viewer/page.js as it stands.
extern const std::string_view pageScript;

/// The bundled viewer; empty where the program was built without npm.
extern const std::string_view viewerScript;

}  // namespace clerestory
