// SPDX-License-Identifier: GPL-3.0-or-later
// study.toml, and the text that is written for it, which has to read again.
#include <import/study.hpp>

#include "readfile.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace clerestory;
  return readAsFile("a.toml", data, size, [](const auto& file) { studyToml(readStudy(file)); });
}
