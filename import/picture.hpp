// SPDX-License-Identifier: GPL-3.0-or-later
// Picture files as small grids of mean colours: all that a texture means for the light in a room.
#pragma once

#include <string>
#include <string_view>

#include <import/picturefiles.hpp>

namespace clerestory {

/// Reads a picture. Throws InputError where the bytes are no whole picture.
Picture readPicture(std::string_view bytes, const std::string& name, PictureEncoding encoding);

}  // namespace clerestory
