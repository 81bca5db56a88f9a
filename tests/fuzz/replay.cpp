// SPDX-License-Identifier: GPL-3.0-or-later
// Runs a fuzz target on the files of folders, and on every truncation of the small ones: no fuzzer is needed.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

constexpr std::size_t kSmall = 2048;

void run(const std::string& bytes) {
  // A copy of its own, so that a sanitizer sees what reads beyond its end.
  const std::vector<char> exact(bytes.begin(), bytes.end());
  LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(exact.data()), exact.size());
}

std::size_t replay(const std::filesystem::path& folder, bool truncate) {
  std::vector<std::filesystem::path> files;
  if (std::filesystem::is_directory(folder)) {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
      if (entry.is_regular_file()) files.push_back(entry.path());
    }
  }
  std::sort(files.begin(), files.end());
  for (const auto& file : files) {
    std::ifstream stream(file, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
    std::printf("%s\n", file.c_str());
    std::fflush(stdout);
    run(bytes);
    for (std::size_t length = 0; truncate && bytes.size() <= kSmall && length < bytes.size(); ++length) {
      run(bytes.substr(0, length));
    }
  }
  return files.size();
}

}  // namespace

/// replay [--truncate] FOLDER…
int main(int argc, char** argv) {
  std::size_t count = 0;
  bool truncate = false;
  try {
    for (int i = 1; i < argc; ++i) {
      const std::string argument = argv[i];
      truncate = truncate || argument == "--truncate";
      count += argument == "--truncate" ? 0 : replay(argument, truncate);
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "not an error of the input: %s\n", error.what());
    return 1;
  }
  if (count == 0) std::fprintf(stderr, "there was no file to run\n");
  return count == 0 ? 1 : 0;
}
