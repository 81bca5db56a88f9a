// SPDX-License-Identifier: GPL-3.0-or-later
// Runs that are ended in the middle, disks that fill, memory that is not there: an older report stays whole,
// and nothing else is left.
#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <random>
#include <set>
#include <string>
#include <thread>

#include "program.hpp"

namespace clerestory {
namespace {

namespace fs = std::filesystem;

constexpr const char* kRoom =
    "mtllib room.mtl\n"
    "v 0 0 0\nv 4 0 0\nv 4 3 0\nv 0 3 0\nv 0 0 3\nv 4 0 3\nv 4 3 3\nv 0 3 3\n"
    "v 1 0 1\nv 3 0 1\nv 3 0 2\nv 1 0 2\n"
    "usemtl wall\nf 1 2 3 4\nf 5 8 7 6\nf 2 6 7 3\nf 3 7 8 4\nf 4 8 5 1\n"
    "f 1 2 10 9\nf 2 6 11 10\nf 6 5 12 11\nf 5 1 9 12\n"
    "usemtl glass\nf 9 10 11 12\n";

class Faults : public testing::Test {
 protected:
  void SetUp() override {
    place_.write("room.mtl",
                 "newmtl wall\nKd 0.5 0.5 0.5\nnewmtl glass\nKd 0 0 0\nTf 0.7 0.7 0.7\nd 0.3\nillum 4\n");
    place_.write("room.obj", kRoom);
    place_.write("old.toml", studyOf("room.obj") + "[materials.\"wall\"]\nreflectance = 0.3\n" + kRest);
    place_.write("new.toml", studyOf("room.obj") + "[materials.\"wall\"]\nreflectance = 0.6\n" + kRest);
    old_ = reportOf("old");
    new_ = reportOf("new");
    ASSERT_NE(old_, new_);
  }

  /// Names and results of a report; what belongs to one run alone is left out.
  using Report = std::map<std::string, std::string>;
  [[nodiscard]] Report readReport() const {
    Report report;
    for (const auto& entry : fs::directory_iterator(place_.path() / "report")) {
      const std::string name = entry.path().filename().string();
      const bool isResult = name != "run.json" && name != "iterations.csv" && name != "index.html";
      report[name] = isResult ? bytesOf(entry.path()) : "";
      EXPECT_GT(entry.file_size(), 0U) << name;
    }
    return report;
  }

  [[nodiscard]] Report reportOf(const std::string& study) const {
    EXPECT_EQ(run("study " + study + ".toml -o report --quiet"), 0) << messages();
    return readReport();
  }

  /// Runs a command of the program through a shell; its exit code, or -1 where a signal ended it.
  [[nodiscard]] int run(const std::string& arguments, const std::string& before = "") const {
    const std::string command = "cd '" + place_.path().string() + "' && " + before +
                                " '" CLERESTORY_PROGRAM "' " + arguments +
                                " >output.txt 2>messages.txt </dev/null";
    const int status = std::system(command.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  [[nodiscard]] std::string messages() const { return bytesOf(place_.path() / "messages.txt"); }

  /// Starts the study new.toml into the folder `report` without a shell; gives its process.
  [[nodiscard]] pid_t start() const {
    const pid_t process = fork();
    if (process == 0) {
      const int output = open((place_.path() / "messages.txt").c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
      dup2(output, 1);
      dup2(output, 2);
      if (chdir(place_.path().c_str()) == 0) {
        execl(CLERESTORY_PROGRAM, "clerestory", "study", "new.toml", "-o", "report",
              static_cast<char*>(nullptr));
      }
      _exit(127);
    }
    return process;
  }

  [[nodiscard]] std::set<std::string> entries() const {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(place_.path()))
      names.insert(entry.path().filename().string());
    names.erase("output.txt");
    names.erase("messages.txt");
    return names;
  }

  static constexpr const char* kRest =
      "[accuracy]\ntarget = \"draft\"\n[[grid]]\nname = \"Desks\"\nspacing = 0.5\n"
      "[[view]]\nname = \"in\"\neye = [2.0, 2.8, 1.6]\ntarget = [2.0, 0.0, 1.2]\nsize = [96, 64]\n";
  Workplace place_;
  Report old_, new_;
};

/// Ends one run by `signal` after `delay_s`; gives its status as waitpid does.
int endAfter(pid_t process, double delay_s, int signal) {
  std::this_thread::sleep_for(std::chrono::duration<double>(delay_s));
  kill(process, signal);
  int status = 0;
  EXPECT_EQ(waitpid(process, &status, 0), process);
  return status;
}

TEST_F(Faults, EndedAtFiftyMomentsTheReportIsWhole) {
  const auto begin = std::chrono::steady_clock::now();
  int status = 0;
  const pid_t first = start();
  ASSERT_EQ(waitpid(first, &status, 0), first);
  const std::chrono::duration<double> whole = std::chrono::steady_clock::now() - begin;
  EXPECT_EQ(reportOf("old"), old_);
  const std::set<std::string> expected = entries();
  std::mt19937 random(1);
  std::uniform_real_distribution<double> moment(0.0,
                                                1.05 * whole.count());  // the last ones may be done before
  std::size_t ended = 0;
  for (int i = 0; i < 50; ++i) {
    const int signal = std::array{SIGINT, SIGTERM, SIGKILL}[static_cast<std::size_t>(i % 3)];
    const std::set<std::string> before = entries();  // a run killed earlier may have left something
    status = endAfter(start(), moment(random), signal);
    const bool isDone = WIFEXITED(status) && WEXITSTATUS(status) == 0;
    EXPECT_TRUE(isDone || (WIFSIGNALED(status) && WTERMSIG(status) == signal)) << status << messages();
    ended += isDone ? 0 : 1;
    const Report report = readReport();
    EXPECT_TRUE(report == new_ || (report == old_ && !isDone));
    const std::set<std::string> after = entries();
    if (signal != SIGKILL) {
      EXPECT_TRUE(std::ranges::includes(before, after)) << "something was left behind";
    }
    if (report == new_) {
      EXPECT_EQ(reportOf("old"), old_);
    }
  }
  EXPECT_GT(ended, 20U) << "hardly any run was ended in the middle";
  EXPECT_EQ(reportOf("old"), old_);
  EXPECT_EQ(entries(), expected) << "what killed runs left is gone with the next run";
}

TEST_F(Faults, InterruptedRunsSayIt) {
  const pid_t process = start();
  int status = 0;
  while (messages().empty() && waitpid(process, &status, WNOHANG) == 0) std::this_thread::yield();
  status = endAfter(process, 0.0, SIGTERM);
  ASSERT_TRUE(WIFSIGNALED(status)) << "it was done before it could be interrupted";
  EXPECT_EQ(WTERMSIG(status), SIGTERM);
  EXPECT_NE(messages().find("clerestory: interrupted"), std::string::npos) << messages();
}

TEST_F(Faults, FullDiskKeepsTheOlderReport) {
  EXPECT_EQ(reportOf("old"), old_);
  const std::set<std::string> expected = entries();
  // No file may grow beyond 1 kB, as if the disk were full.
  EXPECT_EQ(run("study new.toml -o report --quiet", "ulimit -f 2 &&"), 3) << messages();
  EXPECT_NE(messages().find("could not be written"), std::string::npos) << messages();
  EXPECT_EQ(readReport(), old_);
  EXPECT_EQ(entries(), expected);
}

TEST_F(Faults, WithoutMemoryTheProgramSaysSo) {
  EXPECT_EQ(reportOf("old"), old_);
  const std::set<std::string> expected = entries();
  const auto limited = [](int megabytes) { return "ulimit -v " + std::to_string(1024 * megabytes) + " &&"; };
  // Below this the system cannot even load the program's libraries.
  int least = 64;
  while (least < 4096 && run("--version", limited(least)) != 0) least += 32;
  for (int megabytes = least + 64; megabytes <= least + 1024; megabytes += 64) {
    const int code = run("study new.toml -o report --threads 2", limited(megabytes));
    EXPECT_TRUE(code == 0 || code == 3) << megabytes << " MB: " << code << '\n' << messages();
    const Report report = readReport();
    EXPECT_TRUE(report == old_ || (code == 0 && report == new_)) << megabytes;
    EXPECT_EQ(entries(), expected) << megabytes;
  }
}

/// What needs no pictures works without their library and does not pay for loading it; what does says so.
TEST_F(Faults, WithoutThePicturesLibraryOnlyPicturesFail) {
  fs::create_directory(place_.path() / "alone");
  fs::copy_file(CLERESTORY_PROGRAM, place_.path() / "alone" / "clerestory");
  EXPECT_EQ(run("--version; ./alone/clerestory inspect room.obj"), 0) << messages();
  EXPECT_EQ(run("--version; ./alone/clerestory study new.toml -o report --quiet"), 3);
  EXPECT_NE(messages().find("the library for pictures cannot be loaded"), std::string::npos) << messages();
  EXPECT_EQ(readReport(), new_) << "as it was";
}

TEST_F(Faults, VanishedFolderIsNamed) {
  EXPECT_EQ(run("study new.toml -o gone/report --quiet"), 1);
  EXPECT_NE(messages().find("gone"), std::string::npos) << messages();
}

TEST_F(Faults, TwoRunsIntoOneFolderLeaveOneReport) {
  const std::set<std::string> expected = entries();
  for (int i = 0; i < 5; ++i) {
    fs::remove_all(place_.path() / "report");
    const pid_t one = start();
    const pid_t other = start();
    for (const pid_t process : {one, other}) {
      int status = 0;
      EXPECT_EQ(waitpid(process, &status, 0), process);
      EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << messages();
    }
    EXPECT_EQ(readReport(), new_);
    EXPECT_EQ(entries(), expected);
  }
}

}  // namespace
}  // namespace clerestory
