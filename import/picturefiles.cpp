// SPDX-License-Identifier: GPL-3.0-or-later
// Loads the library of picture files, which lies beside the program or where it is installed.
#include <import/picturefiles.hpp>

#ifdef _WIN32
#include <windows.h>
#else
#include <dlfcn.h>
#endif

#include <new>

#include <import/error.hpp>

namespace clerestory {
namespace {

// What its two hundred libraries and their threads take of the address space. Where one of them gets no
// memory while it is loaded, it may end the program without a word.
constexpr std::size_t roomNeeded = std::size_t{448} << 20;

/// Whether so much could be had; nothing of it is touched.
bool hasRoom() {
  void* volatile room = ::operator new(roomNeeded, std::nothrow);
  const bool found = room != nullptr;
  ::operator delete(room);
  return found;
}

using Entry = const PictureFiles* (*)();
constexpr const char* kEntry = "clerestoryPictureFiles";

#ifdef _WIN32

Entry load() {
  const HMODULE library = LoadLibraryA(CLERESTORY_PICTURES);  // looks in the program's folder first
  return library == nullptr ? nullptr : reinterpret_cast<Entry>(GetProcAddress(library, kEntry));
}

std::string whyNot() {
  return "error " + std::to_string(GetLastError());
}

#else

Entry load() {
  void* const library =
      dlopen(CLERESTORY_PICTURES, RTLD_LAZY | RTLD_LOCAL);  // looks in the program's run path
  return library == nullptr ? nullptr : reinterpret_cast<Entry>(dlsym(library, kEntry));
}

std::string whyNot() {
  const char* const error = dlerror();
  return error == nullptr ? "" : error;
}

#endif

}  // namespace

const PictureFiles& pictureFiles() {
  static const bool isRoomy = hasRoom();
  if (!isRoomy) throw std::bad_alloc();
  static const Entry entry = load();  // never unloaded: OpenImageIO keeps threads and caches
  if (entry == nullptr) {
    throw MachineError("the library for pictures cannot be loaded: " + whyNot() +
                       "; install the program again, or leave pictures out");
  }
  return *entry();
}

}  // namespace clerestory
