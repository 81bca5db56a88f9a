// SPDX-License-Identifier: GPL-3.0-or-later
// What the program tells the shell when it ends.
#pragma once

namespace clerestory {

enum ExitCode : int {
  exitDone = 0,
  exitInputWrong = 1,
  exitCommandLineWrong = 2,
  exitMachineFailed = 3,
};

}  // namespace clerestory
