// SPDX-License-Identifier: GPL-3.0-or-later
// The program as a user meets it: exit codes, messages, the files of a report, and the same bytes on every
// run.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

constexpr const char* kRoomMtl =
    "newmtl wall\nKd 0.5 0.5 0.5\n"
    "newmtl floor\nKd 0.2 0.2 0.2\n"
    "newmtl glass\nKd 0 0 0\nTf 0.7 0.7 0.7\nd 0.3\nillum 4\n";

// 4 x 3 x 3 m, one pane of 2 x 1 m in the wall at y = 0.
constexpr const char* kRoomObj =
    "mtllib room.mtl\n"
    "v 0 0 0\nv 4 0 0\nv 4 3 0\nv 0 3 0\nv 0 0 3\nv 4 0 3\nv 4 3 3\nv 0 3 3\n"
    "v 1 0 1\nv 3 0 1\nv 3 0 2\nv 1 0 2\n"
    "o floor\nusemtl floor\nf 1 2 3 4\n"
    "o shell\nusemtl wall\nf 5 8 7 6\nf 2 6 7 3\nf 3 7 8 4\nf 4 8 5 1\n"
    "f 1 2 10 9\nf 2 6 11 10\nf 6 5 12 11\nf 5 1 9 12\n"
    "o window\nusemtl glass\nf 9 10 11 12\n";

constexpr const char* kStudy =
    "[model]\nfile = \"room.obj\"\nunits = \"m\"\nup = \"z\"\n"
    "[materials.\"wall*\"]\nreflectance = 0.6\n"
    "[accuracy]\ntarget = \"draft\"\n"
    "[[grid]]\nname = \"Desks\"\nspacing = 0.5\n"
    "[[view]]\nname = \"in\"\neye = [2.0, 2.8, 1.6]\ntarget = [2.0, 0.0, 1.2]\nsize = [48, 32]\n";

constexpr const char* kSensorColumns =
    "grid,room,x_m,y_m,z_m,nx,ny,nz,illuminance_lx,direct_lx,reflected_lx,sky_lx,sun_lx,electric_lx,"
    "daylight_factor_pct,error_lx";
constexpr const char* kSurfaceColumns =
    "surface,room,material,area_m2,reflectance,illuminance_mean_lx,illuminance_min_lx,illuminance_max_lx,"
    "exitance_mean_lm_m2,luminance_mean_cd_m2,error_lx,elements";
constexpr const char* kRoomColumns =
    "room,floor_area_m2,volume_m3,grid,sensors,illuminance_mean_lx,illuminance_median_lx,illuminance_min_lx,"
    "uniformity,daylight_factor_mean_pct,daylight_factor_median_pct";
constexpr const char* kIterationColumns =
    "domain,iteration,links_required,links_cached,links_reused,visibility_tests,unshot_power_lm,elements,"
    "seconds";

std::string readFile(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

using Files = std::map<std::string, std::string>;

// Every file below `folder` with its bytes.
Files readFolder(const fs::path& folder) {
  Files files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) {
      files[fs::relative(entry.path(), folder).generic_string()] = readFile(entry.path());
    }
  }
  return files;
}

using Table = std::vector<std::vector<std::string>>;

// RFC 4180; an unclosed quote or a quote within a plain field fails the test.
Table parseCsv(const std::string& text) {
  Table table;
  std::vector<std::string> row;
  std::string field;
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quoted) {
      if (c != '"') {
        field += c;
      } else if (i + 1 < text.size() && text[i + 1] == '"') {
        field += text[++i];
      } else {
        quoted = false;
      }
    } else if (c == '"') {
      EXPECT_TRUE(field.empty()) << "a quote in the middle of a field of row " << table.size();
      quoted = true;
    } else if (c == ',' || c == '\n') {
      row.push_back(std::move(field));
      field.clear();
      if (c == '\n') {
        table.push_back(std::move(row));
        row.clear();
      }
    } else if (c != '\r') {
      field += c;
    }
  }
  EXPECT_FALSE(quoted) << "an unclosed quote";
  EXPECT_TRUE(row.empty() && field.empty()) << "the last row does not end";
  return table;
}

// The rows of a table whose first columns are `columns`, as many fields in each as in the first.
Table rowsOf(const std::string& text, const std::string& columns) {
  EXPECT_EQ(text.substr(0, columns.size()), columns);
  Table table = parseCsv(text);
  if (table.size() < 2) {
    ADD_FAILURE() << "no rows under " << columns;
    return {};
  }
  for (const auto& row : table) {
    EXPECT_EQ(row.size(), table.front().size());
  }
  table.erase(table.begin());
  return table;
}

struct Outcome {
  int exitCode;
  std::string output;
  std::string messages;
};

class Program : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "clerestory-test-XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
    write("room.mtl", kRoomMtl);
    write("room.obj", kRoomObj);
    write("study.toml", kStudy);
  }
  void TearDown() override { fs::remove_all(folder_); }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }

  // Runs the program in the test's own folder, as a shell would.
  [[nodiscard]] Outcome run(const std::string& arguments) const {
    const std::string command = "cd '" + folder_.string() + "' && '" CLERESTORY_PROGRAM "' " + arguments +
                                " >.output 2>.messages </dev/null";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, readFile(folder_ / ".output"),
            readFile(folder_ / ".messages")};
  }

  // Expects exit code `code` and one line of error that holds all of `words`.
  void expectFailure(const std::string& arguments, int code, const std::vector<std::string>& words) const {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.exitCode, code) << arguments << '\n' << outcome.messages;
    EXPECT_EQ(outcome.output, "") << arguments;
    std::istringstream lines(outcome.messages);
    std::vector<std::string> errors;
    for (std::string line; std::getline(lines, line);) {
      if (line.starts_with("clerestory: error: ")) {
        errors.push_back(line);
      }
    }
    ASSERT_EQ(errors.size(), 1U) << arguments << '\n' << outcome.messages;
    for (const std::string& word : words) {
      EXPECT_NE(errors.front().find(word), std::string::npos)
          << "no \"" << word << "\" in: " << errors.front();
    }
  }

  // The same beside an older report, which has to stay as it is.
  void expectFailureKeepsReport(const std::string& arguments, const std::vector<std::string>& words) const {
    const Outcome good = run("study study.toml -o report --quiet");
    ASSERT_EQ(good.exitCode, 0) << good.messages;
    const Files before = readFolder(folder_ / "report");
    expectFailure(arguments, 1, words);
    EXPECT_EQ(readFolder(folder_ / "report"), before);
  }

  fs::path folder_;
};

TEST_F(Program, HelpAndVersionSucceed) {
  for (const std::string arguments :
       {"--help", "study --help", "inspect --help", "compare --help", "--version"}) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.exitCode, 0) << arguments;
    EXPECT_NE(outcome.output.find("clerestory"), std::string::npos) << arguments;
    EXPECT_EQ(outcome.messages, "") << arguments;
  }
}

TEST_F(Program, WrongCommandLineSaysWhat) {
  EXPECT_EQ(run("").exitCode, 2);
  expectFailure("design room.obj", 2, {"design"});
  expectFailure("study", 2, {"STUDY.toml|MODEL"});
  expectFailure("study room.obj --accurate 5%", 2, {"--accurate"});
  expectFailure("study room.obj --accuracy sharp", 2, {"--accuracy", "sharp", "draft"});
  expectFailure("study room.obj --threads -1", 2, {"--threads", "-1"});
  expectFailure("study room.obj --threads two", 2, {"--threads", "two"});
  expectFailure("study room.obj --memory 4X", 2, {"--memory", "4X"});
  expectFailure("study room.obj --memory 1e400", 2, {"--memory", "1e400"});
  expectFailure("study room.obj --memory 64M --link-cache 65M", 2, {"--link-cache", "--memory"});
  expectFailure("study room.obj --link-cache -1", 2, {"--link-cache", "-1"});
  expectFailure("study room.obj --units km", 2, {"--units", "km", "mm"});
  expectFailure("study room.obj --up x", 2, {"--up", "x"});
  EXPECT_FALSE(fs::exists(folder_ / "room-report"));
}

TEST_F(Program, MissingFilesAreNamed) {
  expectFailureKeepsReport("study absent.glb -o report", {"absent.glb"});
  expectFailure("study absent.toml", 1, {"absent.toml"});
  expectFailure("inspect absent.obj", 1, {"absent.obj"});
}

TEST_F(Program, UnreadableModelIsNamed) {
  std::string garbage;
  for (unsigned i = 0; i < 4096; ++i) {
    garbage += static_cast<char>((i * 2654435761U) >> 24U);
  }
  write("broken.glb", garbage);
  expectFailureKeepsReport("study broken.glb -o report", {"broken.glb"});
  expectFailure("inspect broken.glb", 1, {"broken.glb"});
}

TEST_F(Program, UnknownKeyNamesTheNearest) {
  write("typo.toml", "[model]\nfile = \"room.obj\"\n[materials.\"wall*\"]\nreflectence = 0.5\n");
  expectFailureKeepsReport("study typo.toml -o report", {"typo.toml", "4", "reflectence", "reflectance"});
}

TEST_F(Program, ImpossibleReflectanceNamesTheMaterial) {
  write("bright.toml", "[model]\nfile = \"room.obj\"\n[materials.\"wall*\"]\nreflectance = 1.2\n");
  expectFailureKeepsReport("study bright.toml -o report", {"wall", "1.2"});
}

TEST_F(Program, FolderThatCannotBeWrittenIsNamed) {
  write("file", "not a folder");
  expectFailureKeepsReport("study study.toml -o file/sub", {"file/sub"});
  EXPECT_EQ(readFile(folder_ / "file"), "not a folder");
}

TEST_F(Program, FolderOfSomethingElseIsRefused) {
  fs::create_directory(folder_ / "holiday");
  write("holiday/beach.txt", "sand");
  expectFailure("study study.toml -o holiday", 1, {"holiday"});
  EXPECT_EQ(readFolder(folder_ / "holiday"), (Files{{"beach.txt", "sand"}}));
}

TEST_F(Program, HostileNamesDoNotReachTheTerminal) {
  write("evil\033[2J.toml", "nonsense");
  const Outcome outcome = run("study 'evil\033[2J.toml'");
  EXPECT_EQ(outcome.exitCode, 1);
  EXPECT_EQ(outcome.messages.find('\033'), std::string::npos);
}

TEST_F(Program, ModelAloneGivesAWholeReport) {
  const Outcome outcome = run("study room.obj --accuracy draft --json");
  ASSERT_EQ(outcome.exitCode, 0) << outcome.messages;
  const Files report = readFolder(folder_ / "room-report");
  for (const char* name : {"index.html", "sensors.csv", "surfaces.csv", "rooms.csv", "iterations.csv",
                           "study.json", "study.toml", "run.json"}) {
    EXPECT_TRUE(report.contains(name)) << name;
  }
  EXPECT_EQ(outcome.output, report.at("study.json"));
  EXPECT_NE(outcome.messages.find("room-report/index.html"), std::string::npos) << outcome.messages;
  EXPECT_NE(outcome.messages.find("daylight factor"), std::string::npos) << outcome.messages;

  rowsOf(report.at("surfaces.csv"), kSurfaceColumns);
  rowsOf(report.at("iterations.csv"), kIterationColumns);
  EXPECT_EQ(rowsOf(report.at("rooms.csv"), kRoomColumns).size(), 1U);
  for (const auto& sensor : rowsOf(report.at("sensors.csv"), kSensorColumns)) {
    const auto value = [&](std::size_t column) { return std::stod(sensor.at(column)); };
    EXPECT_NEAR(value(4), 0.85, 1e-6);
    EXPECT_GT(value(8), 0.0);
    EXPECT_NEAR(value(9) + value(10), value(8), 1e-4 * value(8));
    EXPECT_NEAR(value(11) + value(12) + value(13), value(8), 1e-4 * value(8));
    EXPECT_NEAR(value(14), 100.0 * value(11) / 10000.0, 1e-4 * value(14));
  }
}

TEST_F(Program, FoldersWithSpacesAndOfAnyLanguageWork) {
  fs::create_directory(folder_ / "B\u00FCro S\u00FCd");
  for (const char* file : {"study.toml", "room.obj", "room.mtl"})
    fs::copy_file(folder_ / file, folder_ / "B\u00FCro S\u00FCd" / file);
  const Outcome outcome = run("study 'B\u00FCro S\u00FCd/study.toml' -o '\u5831\u544A \u2116 1' --quiet");
  ASSERT_EQ(outcome.exitCode, 0) << outcome.messages;
  for (const char* file : {"index.html", "view-in.exr", "view-in.png", "luminance-in.png", "plan-Desks.png",
                           "scene.glb", "study.json"}) {
    EXPECT_GT(readFile(folder_ / "\u5831\u544A \u2116 1" / file).size(), 100U) << file;
  }
}

TEST_F(Program, ColourConfigThatCannotBeUsedStopsBeforeTheWork) {
  setenv("OCIO", "/nowhere/studio.ocio", 1);
  expectFailure("study study.toml -o report", 1, {"OCIO", "/nowhere/studio.ocio"});
  EXPECT_FALSE(fs::exists(folder_ / "report"));
  EXPECT_EQ(run("study study.toml -o report --no-pictures --quiet").exitCode, 0);
  unsetenv("OCIO");
}

TEST_F(Program, ReportHoldsTheStudyThatGivesItAgain) {
  ASSERT_EQ(run("study room.obj --accuracy draft --quiet").exitCode, 0);
  const Outcome outcome = run("study room-report/study.toml -o again --quiet");
  ASSERT_EQ(outcome.exitCode, 0) << outcome.messages;
  EXPECT_EQ(readFile(folder_ / "again/sensors.csv"), readFile(folder_ / "room-report/sensors.csv"));
  // The view that a model alone is given is part of that study.
  const std::string picture = readFile(folder_ / "room-report/view-Room-1.exr");
  EXPECT_GT(picture.size(), 1000U);
  EXPECT_EQ(readFile(folder_ / "again/view-Room-1.exr"), picture);
}

TEST_F(Program, QuietSaysNothing) {
  const Outcome outcome = run("study study.toml --quiet");
  EXPECT_EQ(outcome.exitCode, 0);
  EXPECT_EQ(outcome.output, "");
  EXPECT_EQ(outcome.messages, "");
}

TEST_F(Program, PicturesCanBeLeftOut) {
  ASSERT_EQ(run("study study.toml -o with --quiet").exitCode, 0);
  ASSERT_EQ(run("study study.toml -o without --quiet --no-pictures").exitCode, 0);
  const auto pictures = [&](const char* report) {
    const Files files = readFolder(folder_ / report);
    return std::count_if(files.begin(), files.end(),
                         [](const auto& file) { return fs::path(file.first).extension() == ".exr"; });
  };
  EXPECT_GT(pictures("with"), 0);
  EXPECT_EQ(pictures("without"), 0);
}

TEST_F(Program, CommandLineStandsOverTheModel) {
  // 40 x 30 x 30 would be a hall in metres too, so that only the option makes them feet.
  std::istringstream lines(kRoomObj);
  std::string drawn;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("v ")) {
      std::istringstream numbers(line.substr(2));
      line = "v";
      for (double number = 0.0; numbers >> number;) {
        line += " " + std::to_string(10.0 * number);
      }
    }
    drawn += line + "\n";
  }
  write("hall.obj", drawn);
  const Outcome outcome = run("study hall.obj --accuracy draft --units ft --quiet");
  ASSERT_EQ(outcome.exitCode, 0) << outcome.messages;
  const Table rooms = rowsOf(readFile(folder_ / "hall-report/rooms.csv"), kRoomColumns);
  ASSERT_EQ(rooms.size(), 1U);
  EXPECT_NEAR(std::stod(rooms[0].at(1)), 1200.0 * 0.3048 * 0.3048, 1e-3);
}

TEST_F(Program, InspectTellsWhatIsInTheModel) {
  const Outcome text = run("inspect room.obj");
  EXPECT_EQ(text.exitCode, 0) << text.messages;
  for (const char* word :
       {"wall", "floor", "glass", "12  points read", "10  faces read", "1 pane, 2.00 m2"}) {
    EXPECT_NE(text.output.find(word), std::string::npos) << word << " is not in\n" << text.output;
  }
  const Outcome json = run("inspect room.obj --json");
  EXPECT_EQ(json.exitCode, 0);
  EXPECT_EQ(json.output.find('{'), 0U);
  EXPECT_EQ(json.messages, "");
}

// `text` with `change` made to every line.
template <typename Change>
std::string linesOf(const std::string& text, Change change) {
  std::istringstream lines(text);
  std::string changed;
  for (std::string line; std::getline(lines, line);) {
    changed += change(line) + "\n";
  }
  return changed;
}

// A report without what may differ between runs: run.json and times, and with another cache what is counted
// of it. The page shows both.
Files results(const fs::path& folder, bool sameCache) {
  Files files = readFolder(folder);
  files.erase("run.json");
  if (!sameCache) {
    files.erase("iterations.csv");
    files.erase("index.html");
    return files;
  }
  files["iterations.csv"] = linesOf(files["iterations.csv"],
                                    [](const std::string& line) { return line.substr(0, line.rfind(',')); });
  files["index.html"] = linesOf(files["index.html"], [](const std::string& line) {
    return line.find("This run took") == std::string::npos ? line : "";
  });
  return files;
}

TEST_F(Program, SameBytesOnAnyNumberOfThreadsAndWithAnyCache) {
  const auto report = [&](const std::string& name, const std::string& options) {
    const Outcome outcome = run("study study.toml --quiet -o " + name + " " + options);
    EXPECT_EQ(outcome.exitCode, 0) << outcome.messages;
    return folder_ / name;
  };
  // The bytes themselves would fill the screen, so that only names of files are shown.
  const auto expectSame = [](const Files& a, const Files& b, const std::string& what) {
    for (const auto& [name, bytes] : a) {
      EXPECT_TRUE(b.contains(name) && b.at(name) == bytes) << name << " differs " << what;
    }
    EXPECT_EQ(a.size(), b.size()) << what;
  };

  const fs::path one = report("one", "--threads 1");
  for (const std::string threads : {"2", "3"}) {
    const fs::path other = report("threads-" + threads, "--threads " + threads);
    expectSame(results(one, true), results(other, true), "on " + threads + " threads");
  }
  for (const std::string cache : {"0", "64K", "1G"}) {
    const fs::path other = report("cache-" + cache, "--threads 2 --link-cache " + cache);
    expectSame(results(one, false), results(other, false), "with a cache of " + cache);
  }
}

TEST_F(Program, CompareTellsHowFarOneReportLiesFromAnother) {
  ASSERT_EQ(run("study study.toml -o report --no-pictures --quiet").exitCode, 0);
  // The same sensors by another program: a tenth more light at each, the first left out.
  const Table sensors = rowsOf(readFile(folder_ / "report" / "sensors.csv"), kSensorColumns);
  std::ofstream brighter(folder_ / "brighter.csv");
  brighter.precision(17);
  brighter << "x,y,z,lux\n";
  for (std::size_t row = 1; row < sensors.size(); ++row) {
    brighter << sensors[row][2] << ',' << sensors[row][3] << ',' << sensors[row][4] << ','
             << 1.1 * std::stod(sensors[row][8]) << '\n';
  }
  brighter.close();

  const Outcome same = run("compare report report");
  EXPECT_EQ(same.exitCode, 0) << same.messages;
  EXPECT_NE(same.output.find("Desks"), std::string::npos) << same.output;

  const Outcome outcome = run("compare brighter.csv report -o 'a b'");
  ASSERT_EQ(outcome.exitCode, 0) << outcome.messages;
  EXPECT_NE(outcome.output.find("1 only in the reference"), std::string::npos) << outcome.output;
  const Table figures = rowsOf(readFile(folder_ / "a b" / "compare.csv"), "grid,sensors,only_first,");
  ASSERT_EQ(figures.size(), 1U);
  EXPECT_EQ(figures[0][0], "Desks");
  EXPECT_EQ(figures[0][1], std::to_string(sensors.size() - 1));
  EXPECT_NEAR(std::stod(figures[0][6]), 10.0, 1e-4);  // bias, RMS and all: tables hold a float's digits
  EXPECT_NEAR(std::stod(figures[0][9]), 10.0, 1e-4);
  EXPECT_EQ(rowsOf(readFile(folder_ / "a b" / "differences.csv"), "grid,x_m,").size(), sensors.size() - 1);

  write("elsewhere.csv", "x_m,y_m,z_m,illuminance_lx\n100,100,100,5\n");
  expectFailure("compare report elsewhere.csv", 1, {"no sensor in common"});
  expectFailure("compare report .", 1, {"sensors.csv"});
  expectFailure("compare report missing.csv", 1, {"missing.csv"});
  expectFailure("compare report", 2, {"B"});
  expectFailure("compare report brighter.csv -o report", 1, {"choose another"});
}

TEST_F(Program, ChartGoesOnWhereItWasStopped) {
  const std::string command = "chart study.toml -o 'the chart' --finest 0.2 --longest 5";
  const Outcome outcome = run(command);
  ASSERT_EQ(outcome.exitCode, 0) << outcome.messages;
  for (const char* method : {"shooting", "gathering", "plain"})
    EXPECT_NE(outcome.output.find(method), std::string::npos) << outcome.output;
  const fs::path table = folder_ / "the chart" / "chart.csv";
  const std::string whole = readFile(table);
  const Table runs = rowsOf(whole, "series,method,setting,");
  EXPECT_GT(runs.size(), 20U);
  for (const auto& row : runs) {
    EXPECT_GT(std::stod(row[4]), 0.0) << row[2] << ": CPU time";
    EXPECT_LT(std::stod(row[12]), 60.0) << row[2] << ": RMS error in per cent";
  }
  EXPECT_NE(readFile(folder_ / "the chart" / "chart.html").find("<svg"), std::string::npos);

  // Stopped in the middle of a line.
  std::size_t end = 0;
  for (int line = 0; line < 10; ++line) end = whole.find('\n', end) + 1;
  std::ofstream(table, std::ios::binary | std::ios::trunc) << whole.substr(0, end + 7);
  const Outcome again = run(command);
  ASSERT_EQ(again.exitCode, 0) << again.messages;
  EXPECT_NE(again.messages.find("9 runs are there already"), std::string::npos) << again.messages;
  EXPECT_EQ(readFile(table).substr(0, end), whole.substr(0, end));
  EXPECT_EQ(rowsOf(readFile(table), "series,method,setting,").size(), runs.size());

  write("other.toml", std::string(kStudy) + "[ground]\nreflectance = 0.3\n");
  expectFailure("chart other.toml -o 'the chart' --finest 0.2", 1, {"another study"});
  expectFailure("chart study.toml -o .", 1, {"choose another folder"});
  write("points.csv", "method,cpu\n");
  expectFailure("chart study.toml --points points.csv", 1, {"points.csv", "line 1"});
}

}  // namespace
