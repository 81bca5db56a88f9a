// SPDX-License-Identifier: GPL-3.0-or-later
// The page's scripts, put into the program when it is built.
#pragma once

#include "embedded.hpp"

namespace clerestory {

/// Tables, plans, exposure, theme: report/viewer/page.js as it stands.
extern const EmbeddedFile pageScript;

/// The bundled viewer; its text is empty where the program was built without npm.
extern const EmbeddedFile viewerScript;

}  // namespace clerestory
