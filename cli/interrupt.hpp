// SPDX-License-Identifier: GPL-3.0-or-later
// What happens when somebody ends the program before it is done.
#pragma once

namespace clerestory {

/// From now on an interrupt (Ctrl-C) or a request to end removes what is half written, says so and ends the
/// program with the signal's own exit status (128 + its number in a shell). To be called before any other
/// thread begins. A signal that whoever started the program wants ignored stays ignored. Where the
/// standard library would abort, the same is removed, and the program ends as when the machine fails.
void endCleanlyWhenInterrupted();

}  // namespace clerestory
