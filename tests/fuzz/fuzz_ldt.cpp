// SPDX-License-Identifier: GPL-3.0-or-later
// EULUMDAT files.
#include <import/photometry.hpp>

#include "readfile.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace clerestory;
  return readAsFile("a.ldt", data, size, [](const auto& file) {
    const Photometry photometry = readPhotometry(file);
    static_cast<void>(photometry.distribution.flux_lm());
  });
}
