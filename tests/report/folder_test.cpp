// SPDX-License-Identifier: GPL-3.0-or-later
// A report is there whole or not at all, and never in the place of something else.
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "fake.hpp"

namespace clerestory {
namespace {

namespace fs = std::filesystem;
using fake::contentOf;

std::string messageOf(const std::function<void()>& action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  return "(no InputError)";
}

/// A case that fails in the midst of writing: a grid has fewer values than sensors.
fake::Case broken() {
  fake::Case made = fake::office();
  made.solution.grids[1].sensors.pop_back();
  return made;
}

TEST(Folder, HoldsTheWholeReportAndNothingBesides) {
  const fake::TemporaryFolder folder;
  checkReportFolder(folder.path() / "report");
  EXPECT_TRUE(folder.entries().empty());
  writeReport(folder.path() / "report", fake::office().input());
  EXPECT_EQ(folder.entries(), std::vector<std::string>{"report"});
  for (const char* file :
       {"index.html", "study.json", "run.json", "study.toml", "sensors.csv", "surfaces.csv", "rooms.csv",
        "iterations.csv", "scene.glb", "config.ocio", "view-entrance.exr", "view-entrance.png",
        "luminance-entrance.png", "illuminance-entrance.png", "plan-Desks.png", "plan-Shelves.png"}) {
    EXPECT_GT(fs::file_size(folder.path() / "report" / file), 100u) << file;
  }
}

TEST(Folder, HasTheSameBytesTwice) {
  const fake::TemporaryFolder folder;
  writeReport(folder.path() / "a", fake::office().input());
  writeReport(folder.path() / "b", fake::office().input());
  std::size_t files = 0;
  for (const auto& entry : fs::directory_iterator(folder.path() / "a")) {
    const fs::path other = folder.path() / "b" / entry.path().filename();
    EXPECT_TRUE(contentOf(entry.path()) == contentOf(other)) << entry.path().filename();
    ++files;
  }
  EXPECT_EQ(files, 16u);
}

/// Whether a spreadsheet would take a field of a table's text for a formula. Numbers may be negative.
bool holdsFormula(const std::string& csv) {
  bool isQuoted = false;
  char before = '\n';
  for (std::size_t i = 0; i < csv.size(); ++i) {
    const char own = csv[i];
    const bool begins = (!isQuoted && (before == '\n' || before == ',')) ||
                        (isQuoted && before == '"' && i > 1 && (csv[i - 2] == ',' || csv[i - 2] == '\n'));
    const bool isNumber = own == '-' && i + 1 < csv.size() && csv[i + 1] >= '0' && csv[i + 1] <= '9';
    if (begins && !isNumber && std::string("=+-@\t").find(own) != std::string::npos) return true;
    if (own == '"') isQuoted = !isQuoted;
    before = own;
  }
  return false;
}

// A model named as a script and a room named as a formula, everywhere that a name may stand.
TEST(Folder, NamesDoNoHarmInAnyFile) {
  const std::string script = "<script>alert(1)</script>";
  const std::string formula = "=cmd()";
  const fake::TemporaryFolder folder;
  fake::Case made = fake::office();
  made.study.modelFileAsWritten = script + ".obj";
  made.building.rooms[0].name = formula;
  made.building.rooms[1].name = script;
  made.building.grids[0].name = script;
  made.building.grids[1].name = formula;
  made.study.views[0].name = script;
  made.building.model.surfaces[0].name = formula;
  made.building.model.surfaces[1].name = script;
  for (Material& material : made.building.model.materials) material.name = formula;
  made.diagnoses.push_back({formula, script, script, 1});
  writeReport(folder.path() / "r", made.input());
  std::size_t tables = 0;
  for (const auto& entry : fs::directory_iterator(folder.path() / "r")) {
    const std::string name = entry.path().filename().string();
    EXPECT_EQ(name.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789.-_"),
              std::string::npos)
        << name;
    EXPECT_NE(name[0], '-');
    const std::string content = contentOf(entry.path());
    if (entry.path().extension() == ".csv") {
      EXPECT_FALSE(holdsFormula(content)) << name;
      ++tables;
    } else if (entry.path().extension() == ".html") {
      EXPECT_EQ(content.find(script), std::string::npos);
    } else if (entry.path().extension() == ".json") {
      EXPECT_TRUE(nlohmann::json::accept(content)) << name;
    }
  }
  EXPECT_EQ(tables, 4U);
  EXPECT_TRUE(holdsFormula("a,b\r\n1,=cmd()\r\n") && holdsFormula("a\n\"@x\"\n"));
  const nlohmann::json study = nlohmann::json::parse(contentOf(folder.path() / "r" / "study.json"));
  EXPECT_EQ(study.at("rooms").at(0).at("name"), formula);
  const std::string glb = contentOf(folder.path() / "r" / "scene.glb");
  EXPECT_TRUE(nlohmann::json::accept(glb.substr(20, static_cast<unsigned char>(glb[12]) +
                                                        256U * static_cast<unsigned char>(glb[13]) +
                                                        65536U * static_cast<unsigned char>(glb[14]))));
}

TEST(Folder, NamesOfFilesAreSafeAndUnique) {
  const fake::TemporaryFolder folder;
  fake::Case made = fake::office();
  made.building.grids[0].name = "../../A b";
  made.building.grids[1].name = "a/B";
  made.study.views[0].name = "..";
  writeReport(folder.path() / "report", made.input());
  EXPECT_EQ(folder.entries(), std::vector<std::string>{"report"});
  for (const char* file : {"plan-A-b.png", "plan-a-B-2.png", "view-unnamed.png"}) {
    EXPECT_TRUE(fs::exists(folder.path() / "report" / file)) << file;
  }
}

TEST(Folder, ReplacesAnOlderReportWhole) {
  const fake::TemporaryFolder folder;
  const fs::path report = folder.path() / "report";
  writeReport(report, fake::office().input());
  fake::Case made = fake::office();
  made.study.views.clear();
  made.solution.views.clear();
  made.building.rooms[0].name = "Renamed";
  checkReportFolder(report);
  writeReport(report / "", made.input());  // a slash at the end changes nothing
  EXPECT_NE(contentOf(report / "study.json").find("Renamed"), std::string::npos);
  EXPECT_FALSE(fs::exists(report / "view-entrance.png"));
  EXPECT_EQ(folder.entries(), std::vector<std::string>{"report"});
}

TEST(Folder, TakesAnEmptyFolder) {
  const fake::TemporaryFolder folder;
  fs::create_directory(folder.path() / "report");
  writeReport(folder.path() / "report", fake::office().input());
  EXPECT_TRUE(fs::exists(folder.path() / "report" / "index.html"));
}

TEST(Folder, FollowsALinkToAReport) {
  const fake::TemporaryFolder folder;
  writeReport(folder.path() / "real", fake::office().input());
  fs::create_directory_symlink("real", folder.path() / "link");
  fake::Case made = fake::office();
  made.building.rooms[0].name = "Renamed";
  writeReport(folder.path() / "link", made.input());
  EXPECT_TRUE(fs::is_symlink(folder.path() / "link"));
  EXPECT_NE(contentOf(folder.path() / "real" / "study.json").find("Renamed"), std::string::npos);
  EXPECT_EQ(folder.entries(), (std::vector<std::string>{"link", "real"}));
}

TEST(Folder, LeavesTheOlderReportWhenWritingFails) {
  const fake::TemporaryFolder folder;
  const fs::path report = folder.path() / "report";
  writeReport(report, fake::office().input());
  const std::string before = contentOf(report / "study.json");
  EXPECT_ANY_THROW(writeReport(report, broken().input()));
  EXPECT_EQ(contentOf(report / "study.json"), before);
  EXPECT_TRUE(fs::exists(report / "index.html"));
  EXPECT_EQ(folder.entries(), std::vector<std::string>{"report"});
}

TEST(Folder, LeavesNothingWhenTheFirstReportFails) {
  const fake::TemporaryFolder folder;
  EXPECT_ANY_THROW(writeReport(folder.path() / "report", broken().input()));
  EXPECT_TRUE(folder.entries().empty());
}

TEST(Folder, RefusesWhatIsNoReport) {
  const fake::TemporaryFolder folder;
  const fs::path place = folder.path() / "photos";
  fs::create_directory(place);
  std::ofstream(place / "cat.jpg") << "meow";
  const std::string refusal = "holds something else than a report (cat.jpg)";
  EXPECT_NE(messageOf([&] { checkReportFolder(place); }).find(refusal), std::string::npos);
  EXPECT_NE(messageOf([&] { writeReport(place, fake::office().input()); }).find(refusal), std::string::npos);
  EXPECT_EQ(contentOf(place / "cat.jpg"), "meow");
  EXPECT_EQ(folder.entries(), std::vector<std::string>{"photos"});
}

TEST(Folder, RefusesAReportThatSomebodyAddedTo) {
  const fake::TemporaryFolder folder;
  const fs::path report = folder.path() / "report";
  writeReport(report, fake::office().input());
  std::ofstream(report / "notes.txt") << "mine";
  EXPECT_NE(messageOf([&] { checkReportFolder(report); }).find("notes.txt"), std::string::npos);
  EXPECT_TRUE(fs::exists(report / "notes.txt"));
}

TEST(Folder, RefusesFilesThatAreOnlyNamedLikeAReports) {
  const fake::TemporaryFolder folder;
  const fs::path place = folder.path() / "other";
  fs::create_directory(place);
  std::ofstream(place / "sensors.csv") << "mine";
  EXPECT_NE(messageOf([&] { checkReportFolder(place); }).find("no study.json of a report"),
            std::string::npos);
  std::ofstream(place / "study.json") << "{\"generator\": \"somebody else\"}";
  EXPECT_NE(messageOf([&] { checkReportFolder(place); }).find("no study.json of a report"),
            std::string::npos);
}

TEST(Folder, RefusesAFileAndAMissingParent) {
  const fake::TemporaryFolder folder;
  std::ofstream(folder.path() / "file") << "x";
  EXPECT_NE(messageOf([&] { checkReportFolder(folder.path() / "file"); }).find("is a file"),
            std::string::npos);
  const std::string below = messageOf([&] { checkReportFolder(folder.path() / "file" / "report"); });
  EXPECT_NE(below.find((folder.path() / "file").string()), std::string::npos) << below;
  const std::string missing = messageOf([&] { checkReportFolder(folder.path() / "no" / "report"); });
  EXPECT_NE(missing.find("there is no folder"), std::string::npos) << missing;
  EXPECT_EQ(folder.entries(), std::vector<std::string>{"file"});
}

TEST(Folder, SaysWhyAParentCannotBeWritten) {
  if (!fs::is_directory("/proc/self")) GTEST_SKIP() << "no /proc on this system";
  const std::string check = messageOf([] { checkReportFolder("/proc/self/report"); });
  EXPECT_NE(check.find("/proc/self"), std::string::npos) << check;
  EXPECT_NE(check.find("cannot be written"), std::string::npos) << check;
  EXPECT_NE(
      messageOf([] { writeReport("/proc/self/report", fake::office().input()); }).find("cannot be written"),
      std::string::npos);
}

TEST(Folder, RefusesTheRootAndABrokenLink) {
  const fake::TemporaryFolder folder;
  EXPECT_NE(messageOf([] { checkReportFolder("/"); }).find("a folder of its own"), std::string::npos);
  fs::create_directory_symlink("nowhere", folder.path() / "link");
  EXPECT_NE(messageOf([&] { checkReportFolder(folder.path() / "link"); }).find("leads nowhere"),
            std::string::npos);
}

}  // namespace
}  // namespace clerestory
