// SPDX-License-Identifier: GPL-3.0-or-later
// Every diagnosis of reading: a small file that is named for it gives it, and a page lists it.
#include <set>

#include <import/photometry.hpp>
#include <import/scene.hpp>
#include <import/study.hpp>

#include "tempfolder.hpp"

namespace clerestory {
namespace {

std::vector<std::filesystem::path> fixtures() {
  std::vector<std::filesystem::path> files;
  const auto folder = std::filesystem::path(CLERESTORY_TEST_DATA) / "diagnoses";
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string ending = entry.path().extension().string();
    const bool isRead = ending == ".obj" || ending == ".gltf" || ending == ".toml" || ending == ".ldt";
    if (isRead && entry.path().filename().string().starts_with("C1")) {
      files.push_back(entry.path());
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::string codeOf(const std::filesystem::path& file) {
  return file.filename().string().substr(0, 4);
}

std::vector<Diagnosis> diagnosesOf(const std::filesystem::path& file) {
  if (file.extension() == ".ldt") {
    return readPhotometry(file).diagnoses;
  }
  const Study study = file.extension() == ".toml" ? readStudy(file) : studyOfModel(file);
  Scene scene = readModel(study.modelFile, study.model);
  applyMaterialRules(study, scene);
  return scene.diagnoses;
}

class Diagnoses : public testing::TestWithParam<std::filesystem::path> {};

TEST_P(Diagnoses, AreMadeByTheirFile) {
  const std::filesystem::path& file = GetParam();
  const std::vector<Diagnosis> diagnoses = diagnosesOf(file);
  EXPECT_GE(countOf(diagnoses, codeOf(file)), 1U);
  for (const Diagnosis& diagnosis : diagnoses) {
    EXPECT_NE(diagnosis.where, "") << diagnosis.code << ' ' << diagnosis.message;
  }
}

INSTANTIATE_TEST_SUITE_P(Of, Diagnoses, testing::ValuesIn(fixtures()), [](const auto& test) {
  std::string name = test.param.stem().string();
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

TEST(DiagnosesPage, ListsThoseThatHaveAFileAndNoOthers) {
  std::ifstream page(std::filesystem::path(CLERESTORY_SAMPLES).parent_path() / "docs" / "diagnoses.md");
  std::set<std::string> listed;
  for (std::string line; std::getline(page, line);) {
    if (line.starts_with("| C1")) {
      listed.insert(line.substr(2, 4));
    }
  }
  std::set<std::string> made;
  for (const auto& file : fixtures()) {
    made.insert(codeOf(file));
  }
  EXPECT_EQ(listed, made);
}

}  // namespace
}  // namespace clerestory
