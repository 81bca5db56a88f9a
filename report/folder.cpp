// SPDX-License-Identifier: GPL-3.0-or-later
// Writes a report's folder beside its final name and exchanges it with an older one.
#include "folder.hpp"

#include <cerrno>
#include <charconv>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <mutex>
#include <system_error>

#ifdef _WIN32
#include <process.h>
#else
#include <fcntl.h>
#include <signal.h>
#include <unistd.h>
#endif

#include <import/error.hpp>
#include <report/report.hpp>

namespace clerestory {
namespace {

namespace fs = std::filesystem;

std::string lastError() {
  return std::error_code(errno, std::generic_category()).message();
}

int processId() {
#ifdef _WIN32
  return _getpid();
#else
  return getpid();
#endif
}

/// Name of this machine, where it is known.
std::string hostName() {
#ifdef _WIN32
  return "host";
#else
  char name[256] = "host";
  if (gethostname(name, sizeof(name) - 1) != 0) return "host";
  return name;
#endif
}

/// Whether a process of this machine is certainly gone.
bool isGone([[maybe_unused]] int process) {
#ifdef _WIN32
  return false;
#else
  return kill(process, 0) != 0 && errno == ESRCH;
#endif
}

/// The folder that is being written, for the thread that ends the program in the middle of it.
struct Unfinished {
  std::mutex mutex;
  fs::path folder;  ///< empty: none
};

Unfinished& unfinished() {
  static Unfinished one;
  return one;
}

void setUnfinished(const fs::path& folder) {
  const std::lock_guard lock(unfinished().mutex);
  unfinished().folder = folder;
}

bool startsAndEnds(const std::string& name, std::string_view start, std::string_view end) {
  return name.size() >= start.size() + end.size() && name.starts_with(start) && name.ends_with(end);
}

/// Whether a report of ours may hold a file of this name.
bool isReportFile(const std::string& name) {
  for (const char* known :
       {"index.html", "study.json", "run.json", "study.toml", "sensors.csv", "surfaces.csv", "rooms.csv",
        "iterations.csv", "scene.glb", "config.ocio", ".DS_Store", "Thumbs.db"}) {
    if (name == known) return true;
  }
  return startsAndEnds(name, "view-", ".exr") || startsAndEnds(name, "view-", ".png") ||
         startsAndEnds(name, "luminance-", ".png") || startsAndEnds(name, "illuminance-", ".png") ||
         startsAndEnds(name, "plan-", ".png") || startsAndEnds(name, "points-", ".csv") ||
         startsAndEnds(name, "photometry-", ".ies") || startsAndEnds(name, "photometry-", ".ldt");
}

/// The name of something in `folder` that no report of ours holds, or nothing.
std::string foreignEntry(const fs::path& folder) {
  bool isEmpty = true;
  std::string foreign;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    isEmpty = false;
    const std::string name = entry.path().filename().string();
    const bool known = isReportFile(name) && !entry.is_directory();
    if (!known && (foreign.empty() || name < foreign)) foreign = name;
  }
  if (isEmpty || !foreign.empty()) return foreign;
  std::ifstream in(folder / "study.json", std::ios::binary);
  std::string head(256, '\0');
  in.read(head.data(), static_cast<std::streamsize>(head.size()));
  const std::string mark = "\"generator\": \"" + std::string(generatorMark) + '"';
  return head.find(mark) == std::string::npos ? "no study.json of a report" : "";
}

/// Where the folder really lies: absolute, without a slash at its end, symbolic links followed.
fs::path resolved(const fs::path& folder) {
  std::error_code failure;
  fs::path path = fs::absolute(folder, failure).lexically_normal();
  if (!path.has_filename()) path = path.parent_path();
  if (fs::is_symlink(path, failure)) {
    const fs::path target = fs::canonical(path, failure);
    if (failure)
      throw InputError(folder.string() + ": this link leads nowhere; remove it or choose another folder");
    path = target;
  }
  if (!path.has_filename() || !path.has_relative_path()) {
    throw InputError(folder.string() + ": a report needs a folder of its own; choose another with -o");
  }
  return path;
}

/// How the names of unfinished reports beside `folder` begin that this machine writes.
std::string partialStart(const fs::path& folder) {
  return "." + folder.filename().string() + ".partial-" + hostName() + "-";
}

/// Makes a new empty folder `.NAME.partial-HOST-PID-n` beside `folder`.
fs::path makePartial(const fs::path& folder) {
  const std::string start = partialStart(folder) + std::to_string(processId()) + "-";
  for (int number = 0; number < 1000; ++number) {
    const fs::path partial = folder.parent_path() / (start + std::to_string(number));
    std::error_code failure;
    if (fs::create_directory(partial, failure)) return partial;
    if (!failure || failure == std::errc::file_exists) continue;
    const std::string text = folder.string() + ": the report cannot be written into " +
                             folder.parent_path().string() + ": " + failure.message();
    if (failure == std::errc::no_space_on_device || failure == std::errc::io_error) throw MachineError(text);
    throw InputError(text + "; choose another folder with -o");
  }
  throw InputError(folder.string() + ": too many unfinished reports beside it; remove those named " + start +
                   "*");
}

/// Removes what runs of this machine left beside `folder` that were killed before they could.
void removeLeftovers(const fs::path& folder) {
  const std::string start = partialStart(folder);
  std::error_code ignored;
  std::vector<fs::path> leftovers;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder.parent_path(), ignored)) {
    const std::string name = entry.path().filename().string();
    int process = 0;
    if (!name.starts_with(start)) continue;
    const auto [end, error] = std::from_chars(name.data() + start.size(), name.data() + name.size(), process);
    if (error == std::errc{} && *end == '-' && process > 0 && isGone(process))
      leftovers.push_back(entry.path());
  }
  for (const fs::path& leftover : leftovers) fs::remove_all(leftover, ignored);
}

void checkResolved(const fs::path& folder) {
  std::error_code failure;
  const fs::path parent = folder.parent_path();
  if (!fs::is_directory(parent, failure)) {
    throw InputError(folder.string() + ": the report cannot be written: there is no folder " +
                     parent.string() + "; make it, or choose another with -o");
  }
  const fs::file_status status = fs::status(folder, failure);
  if (!fs::exists(status)) return;
  if (!fs::is_directory(status)) {
    throw InputError(folder.string() + ": is a file, and a report is a folder; choose another name with -o");
  }
  const std::string foreign = foreignEntry(folder);
  if (!foreign.empty()) {
    throw InputError(folder.string() + ": holds something else than a report (" + foreign +
                     "); choose another folder with -o, or remove it");
  }
}

/// Puts `partial` where `folder` is; afterwards `partial` is gone or holds the older report.
void exchange(const fs::path& partial, const fs::path& folder) {
  // Nobody ends the program between two steps.
  const std::lock_guard lock(unfinished().mutex);
  std::error_code failure;
  fs::rename(partial, folder, failure);
  if (!failure) return;  // there was none, or an empty one
#ifdef RENAME_EXCHANGE
  // One step of the file system: at no moment is there no report.
  if (renameat2(AT_FDCWD, partial.c_str(), AT_FDCWD, folder.c_str(), RENAME_EXCHANGE) == 0) return;
#endif
  const fs::path aside = partial.string() + "-old";
  fs::rename(folder, aside);
  try {
    fs::rename(partial, folder);
  } catch (const fs::filesystem_error&) {
    fs::rename(aside, folder);
    throw;
  }
  fs::rename(aside, partial);
}

}  // namespace

void checkReportFolder(const fs::path& folder) {
  try {
    const fs::path place = resolved(folder);
    checkResolved(place);
    removeLeftovers(place);
    fs::remove(makePartial(place));  // only trying tells whether the file system lets us
  } catch (const fs::filesystem_error& error) {
    throw InputError(folder.string() + ": cannot be looked at: " + error.code().message());
  }
}

void writeBeside(const fs::path& folder, const std::function<void(const fs::path&)>& write) {
  fs::path partial;
  const auto clear = [&partial] {
    std::error_code ignored;  // that an older report lingers is no failure
    if (!partial.empty()) fs::remove_all(partial, ignored);
    setUnfinished({});
  };
  try {
    const fs::path place = resolved(folder);
    checkResolved(place);
    partial = makePartial(place);
    setUnfinished(partial);
    write(partial);
    exchange(partial, place);
  } catch (const fs::filesystem_error& error) {
    clear();
    throw MachineError(folder.string() + ": the report could not be written: " + error.code().message());
  } catch (...) {
    clear();
    throw;
  }
  clear();
}

void abandonReport() {
  unfinished().mutex.lock();  // for ever: what else writes waits for the end
  const fs::path& partial = unfinished().folder;
  std::error_code failure;
  // Another thread may put a file into it meanwhile, but none once it is gone.
  for (int attempt = 0; attempt < 100 && !partial.empty() && fs::exists(partial, failure); ++attempt) {
    fs::remove_all(partial, failure);
  }
}

void writeFile(const fs::path& file, std::string_view bytes) {
  errno = 0;
  std::ofstream out(file, std::ios::binary | std::ios::trunc);
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  out.close();
  if (!out) throw MachineError(file.filename().string() + ": could not be written: " + lastError());
}

std::string readFile(const fs::path& file) {
  errno = 0;
  std::ifstream in(file, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(in), {}};
  if (!in || in.bad())
    throw MachineError(file.filename().string() + ": could not be read back: " + lastError());
  return bytes;
}

}  // namespace clerestory
