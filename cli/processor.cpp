// SPDX-License-Identifier: GPL-3.0-or-later
// Ends the program with a message, before any other code of it runs, on a processor that it is not built for.
#if defined(__GNUC__) && defined(__x86_64__) && !defined(_WIN32)

#include <unistd.h>

#include <string_view>

#include "exit_code.hpp"

namespace {

// Ahead of every static object: their constructors are built for x86-64-v3 like everything else.
[[gnu::constructor(101)]] void checkProcessor() {
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi") &&
      __builtin_cpu_supports("bmi2")) {
    return;
  }
  constexpr std::string_view message =
      "clerestory: error: this processor lacks AVX2, FMA or BMI, which the program is built for (x86-64-v3: "
      "Intel from 2013, AMD from 2015); use another machine\n";
  [[maybe_unused]] const auto written = write(STDERR_FILENO, message.data(), message.size());
  _exit(clerestory::exitMachineFailed);
}

}  // namespace

#endif
