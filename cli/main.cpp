// SPDX-License-Identifier: GPL-3.0-or-later
// The program: understands the command line, runs the command, and turns what went wrong into a message and
// an exit code.
#include <CLI/CLI.hpp>

#include <exception>
#include <functional>
#include <iostream>
#include <new>
#include <optional>
#include <string>

#include <import/error.hpp>

#include "chart.hpp"
#include "compare.hpp"
#include "exit_code.hpp"
#include "inspect.hpp"
#include "interrupt.hpp"
#include "progress.hpp"
#include "study.hpp"

namespace clerestory {

namespace {

ExitCode fail(ExitCode code, const std::string& message) {
  std::cerr << "clerestory: error: " << printable(message) << '\n';
  return code;
}

// The command line as a shell would take it again, where no argument holds a quote.
std::string commandLineOf(int argc, char** argv) {
  std::string text = "clerestory";
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    const bool quote = argument.empty() || argument.find_first_of(" \t*?$&;|<>()#") != std::string::npos;
    text += quote ? " '" + argument + "'" : " " + argument;
  }
  return text;
}

// Understands the command line: gives `run` its command, or the exit code where there is nothing to run.
std::optional<ExitCode> parse(int argc, char** argv, std::function<void()>& run) {
  CLI::App program(
      "Clerestory computes how much light reaches the surfaces and working planes of a building.\n"
      "It reads a model as it comes out of CAD, cleans it, solves the light and writes a report.",
      "clerestory");
  program.set_version_flag("--version", "clerestory " CLERESTORY_VERSION);
  program.get_formatter()->column_width(24);
  program.footer(
      "Examples:\n"
      "  clerestory study office.glb        a model alone: overcast sky, a grid above each floor\n"
      "  clerestory study study.toml        a study with its own sky, materials, grids and views\n"
      "  clerestory inspect office.glb      what is in the model and what had to be repaired\n"
      "  clerestory compare east west       how far one report or table lies from another\n"
      "  clerestory chart study.toml        error against time over methods and settings\n"
      "  clerestory study --help            every option of a command, with its default\n\n"
      "Exit codes: 0 done, 1 the input is wrong, 2 the command line is wrong, 3 the machine failed (disk, "
      "memory),\n128 + n ended by signal n.");
  program.require_subcommand(1);
  addStudyCommand(program, commandLineOf(argc, argv), run);
  addInspectCommand(program, run);
  addCompareCommand(program, run);
  addChartCommand(program, run);

  if (argc < 2) {
    std::cerr << program.help();
    return exitCommandLineWrong;
  }
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {  // --help, --version
      program.exit(error);
      return exitDone;
    }
    const auto commands = program.get_subcommands();
    const bool unknownCommand = commands.empty() && argv[1][0] != '-';
    return fail(exitCommandLineWrong,
                (unknownCommand ? "there is no command \"" + std::string(argv[1]) + "\"" : error.what()) +
                    " (see clerestory " + (commands.empty() ? "" : commands.front()->get_name() + " ") +
                    "--help)");
  }
  return {};
}

ExitCode runProgram(int argc, char** argv) {
  endCleanlyWhenInterrupted();
  try {
    std::function<void()> run;
    if (const auto code = parse(argc, argv, run)) {
      return *code;
    }
    run();
    return exitDone;
  } catch (const InputError& error) {
    return fail(exitInputWrong, error.what());
  } catch (const MachineError& error) {
    return fail(exitMachineFailed, error.what());
  } catch (const std::bad_alloc&) {
    return fail(exitMachineFailed,
                "the machine has not enough memory for this; a smaller --memory or a coarser "
                "--accuracy needs less");
  } catch (const std::exception& error) {
    return fail(exitMachineFailed, std::string("a fault of the program or the machine: ") + error.what());
  }
}

}  // namespace

}  // namespace clerestory

int main(int argc, char** argv) {
  return clerestory::runProgram(argc, argv);
}
