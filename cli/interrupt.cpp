// SPDX-License-Identifier: GPL-3.0-or-later
// Waits for signals in a thread of its own, which may do what a signal handler must not. The only file that
// knows signals.
#include "interrupt.hpp"

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>
#include <system_error>
#include <thread>

#ifndef _WIN32
#include <pthread.h>
#include <unistd.h>
#endif

#include <report/report.hpp>

#include "exit_code.hpp"

namespace clerestory {
namespace {

void cleanUp() {
  abandonReport();
  std::fputs("\nclerestory: interrupted; an older report stays as it was\n", stderr);
}

/// Where a library cannot even throw: without memory or threads, as a rule.
[[noreturn]] void endInTrouble() {
  std::string what = "for no reason that it gives";
  try {
    if (const std::exception_ptr error = std::current_exception()) std::rethrow_exception(error);
  } catch (const std::exception& error) {
    what = error.what();
  } catch (...) {
  }
  abandonReport();
  std::fprintf(stderr, "clerestory: error: a fault of the program or the machine: %s\n", what.c_str());
  std::_Exit(exitMachineFailed);
}

}  // namespace

#ifdef _WIN32

void endCleanlyWhenInterrupted() {
  std::set_terminate(endInTrouble);
  // Windows calls it in a thread of its own.
  std::signal(SIGINT, [](int) {
    cleanUp();
    std::_Exit(128 + SIGINT);
  });
}

#else

namespace {

void waitAndEnd(sigset_t signals) {
  int signal = 0;
  if (sigwait(&signals, &signal) != 0) return;
  cleanUp();
  std::signal(signal, SIG_DFL);
  pthread_sigmask(SIG_UNBLOCK, &signals, nullptr);
  kill(getpid(), signal);
}

}  // namespace

void endCleanlyWhenInterrupted() {
  std::set_terminate(endInTrouble);
  // A file that grows beyond a limit is an error of writing, not the end.
  std::signal(SIGXFSZ, SIG_IGN);
  sigset_t signals;
  sigemptyset(&signals);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction action {};
    if (sigaction(signal, nullptr, &action) == 0 && action.sa_handler != SIG_IGN) sigaddset(&signals, signal);
  }
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  try {
    std::thread(waitAndEnd, signals).detach();
  } catch (const std::system_error&) {  // no thread to be had: signals end the program as they always do
    pthread_sigmask(SIG_UNBLOCK, &signals, nullptr);
  }
}

#endif

}  // namespace clerestory
