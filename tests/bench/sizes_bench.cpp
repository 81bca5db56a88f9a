// SPDX-License-Identifier: GPL-3.0-or-later
// Seconds and memory of reading and cleaning large models (make_sizes.py), beside what tinyobjloader and
// assimp take to read them: build/…/bench_sizes [--others] MODEL…
#include <assimp/Importer.hpp>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <sys/resource.h>
#include <tiny_obj_loader.h>

#include <chrono>
#include <cstdio>
#include <string>

#include <geometry/building.hpp>
#include <import/scene.hpp>

namespace clerestory {
namespace {

template <class Stage>
double secondsOf(const Stage& stage) {
  const auto begin = std::chrono::steady_clock::now();
  stage();
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
  return elapsed.count();
}

/// Most memory that this process ever had.
double peakGib() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / (1024.0 * 1024.0);  // Linux: KiB
}

void measure(const std::filesystem::path& file) {
  ModelOptions options;
  options.units = "m";
  Scene scene;
  CleanModel model;
  const double reading = secondsOf([&] { scene = readModel(file, options); });
  const double readingGib = peakGib();
  const std::size_t faces = scene.faces.size();
  const double cleaning = secondsOf([&] { model = cleanScene(scene); });
  std::printf(
      "%-14s %8zu faces  read %6.2f s, %5.2f GiB  clean and merge %6.2f s  %8zu polygons  peak %5.2f GiB\n",
      file.filename().c_str(), faces, reading, readingGib, cleaning, model.counts.polygons, peakGib());
}

void measureOthers(const std::filesystem::path& file) {
  if (file.extension() == ".obj") {
    tinyobj::ObjReader reader;
    tinyobj::ObjReaderConfig config;
    config.triangulate = false;
    bool isRead = false;
    const double seconds = secondsOf([&] { isRead = reader.ParseFromFile(file.string(), config); });
    std::printf("%-14s tinyobjloader %6.2f s, peak %5.2f GiB%s\n", file.filename().c_str(), seconds,
                peakGib(), isRead ? "" : ", refused");
  }
  Assimp::Importer importer;
  const aiScene* scene = nullptr;
  const double seconds = secondsOf([&] { scene = importer.ReadFile(file.string(), 0); });
  std::printf("%-14s assimp        %6.2f s, peak %5.2f GiB%s\n", file.filename().c_str(), seconds, peakGib(),
              scene != nullptr ? "" : ", refused");
}

}  // namespace
}  // namespace clerestory

/// One model for each run tells the peak of each.
int main(int argc, char** argv) {
  bool others = false;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument == "--others") {
      others = true;
    } else if (others) {
      clerestory::measureOthers(argument);
    } else {
      clerestory::measure(argument);
    }
  }
  return 0;
}
