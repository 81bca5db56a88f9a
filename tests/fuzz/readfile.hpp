// SPDX-License-Identifier: GPL-3.0-or-later
// Bytes as a file for what reads files; what it refuses with a message of its own is fine.
#pragma once

#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

#include <import/error.hpp>

namespace clerestory {

/// A folder of this process that goes with it.
class FuzzFolder {
 public:
  FuzzFolder() {
    const std::filesystem::path memory = "/dev/shm";  // Linux: no disk is touched
    const auto base = std::filesystem::is_directory(memory) ? memory : std::filesystem::temp_directory_path();
    path_ = base / ("clerestory-fuzz-" + std::to_string(getpid()));
    std::filesystem::create_directories(path_);
  }
  ~FuzzFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  FuzzFolder(const FuzzFolder&) = delete;
  FuzzFolder& operator=(const FuzzFolder&) = delete;

  std::filesystem::path write(const std::string& name, const char* bytes, std::size_t size) const {
    const auto file = path_ / name;
    std::ofstream(file, std::ios::binary).write(bytes, static_cast<std::streamsize>(size));
    return file;
  }

 private:
  std::filesystem::path path_;
};

/// Calls `read` with a file of this name that holds the bytes. Anything but InputError is a finding.
template <typename Read>
int readAsFile(const std::string& name, const std::uint8_t* data, std::size_t size, const Read& read) {
  static const FuzzFolder folder;
  const auto file = folder.write(name, reinterpret_cast<const char*>(data), size);
  try {
    read(file);
  } catch (const InputError&) {
  }
  return 0;
}

}  // namespace clerestory
