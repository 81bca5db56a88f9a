// SPDX-License-Identifier: GPL-3.0-or-later
// Files of sensor points, by a study that names one.
#include <import/study.hpp>

#include "readfile.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace clerestory;
  static const FuzzFolder folder;
  folder.write("a.csv", reinterpret_cast<const char*>(data), size);
  static const std::string study = "[model]\nfile = \"a.obj\"\n[[grid]]\nname = \"a\"\npoints = \"a.csv\"\n";
  static const std::filesystem::path file = folder.write("a.toml", study.data(), study.size());
  try {
    readStudy(file);
  } catch (const InputError&) {
  }
  return 0;
}
