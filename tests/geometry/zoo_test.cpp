// SPDX-License-Identifier: GPL-3.0-or-later
// Models with something wrong, a small file each: those of data/zoo draw one room, whatever is wrong with
// them, and those of data/diagnoses make the diagnosis of the clean-up that they are named for.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <set>

#include "../scenes.hpp"

namespace clerestory {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> filesIn(const std::string& folder, const std::string& beginning,
                              const std::set<std::string>& endings) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(fs::path(CLERESTORY_TEST_DATA) / folder)) {
    if (endings.contains(entry.path().extension().string()) &&
        entry.path().filename().string().starts_with(beginning)) {
      files.push_back(entry.path());
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::string nameOf(const testing::TestParamInfo<fs::path>& test) {
  std::string name = test.param.stem().string();
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

class Zoo : public testing::TestWithParam<fs::path> {};

// 4 x 3 x 2.5 m with a pane of 1.5 x 1 m. Gaps of 3 mm and corners off by 0.25 mm move areas by 2e-3 at most.
TEST_P(Zoo, IsOneRoomWithAWindow) {
  const Building building = drawn::buildingOf(readModel(GetParam(), {}));
  ASSERT_EQ(building.rooms.size(), 1U);
  const Room& room = building.rooms[0];
  EXPECT_NEAR(room.floorArea_m2, 12.0, 2e-3 * 12.0);
  EXPECT_NEAR(room.volume_m3, 30.0, 0.02 * 30.0);
  ASSERT_EQ(building.portals.size(), 1U);
  EXPECT_EQ(building.portals[0].room, 0);
  EXPECT_NEAR(building.model.pieces.area_m2[building.portals[0].piece], 1.5, 2e-3 * 1.5);
}

INSTANTIATE_TEST_SUITE_P(Of, Zoo, testing::ValuesIn(filesIn("zoo", "", {".obj"})), nameOf);

std::vector<fs::path> fixtures() {
  return filesIn("diagnoses", "G2", {".obj", ".toml"});
}

std::string codeOf(const fs::path& file) {
  return file.filename().string().substr(0, 4);
}

class CleaningDiagnoses : public testing::TestWithParam<fs::path> {};

TEST_P(CleaningDiagnoses, AreMadeByTheirFileAndNameThePlace) {
  const fs::path& file = GetParam();
  const Study study = file.extension() == ".toml" ? readStudy(file) : studyOfModel(file);
  Study withoutGrids = study;
  withoutGrids.grids.clear();
  const Building building = drawn::buildingOf(readModel(study.modelFile, study.model), withoutGrids);
  std::vector<Diagnosis> all = building.model.diagnoses;
  all.insert(all.end(), building.diagnoses.begin(), building.diagnoses.end());
  const auto found = std::find_if(all.begin(), all.end(),
                                  [&](const Diagnosis& diagnosis) { return diagnosis.code == codeOf(file); });
  ASSERT_NE(found, all.end());
  EXPECT_TRUE(found->place_m);
  EXPECT_EQ(found->where.empty(), found->code == "G251") << found->where;
  std::vector<Mark> marks = building.model.marks;
  marks.insert(marks.end(), building.marks.begin(), building.marks.end());
  EXPECT_TRUE(std::any_of(marks.begin(), marks.end(), [&](const Mark& mark) {
    return mark.code == found->code && glm::length(mark.place_m - *found->place_m) < 1e-9;
  }));
}

INSTANTIATE_TEST_SUITE_P(Of, CleaningDiagnoses, testing::ValuesIn(fixtures()), nameOf);

TEST(CleaningDiagnosesPage, ListsThoseThatHaveAFile) {
  std::ifstream page(fs::path(CLERESTORY_SAMPLES).parent_path() / "docs" / "diagnoses.md");
  std::set<std::string> listed;
  for (std::string line; std::getline(page, line);) {
    if (line.starts_with("| G2")) listed.insert(line.substr(2, 4));
  }
  std::set<std::string> made;
  for (const fs::path& file : fixtures()) made.insert(codeOf(file));
  EXPECT_EQ(listed, made);
}

}  // namespace
}  // namespace clerestory
