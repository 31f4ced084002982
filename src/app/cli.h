#pragma once

namespace calot {

/// Reads the command line, runs the command and returns the process's exit code (see exit_code.h).
int run_program(int argc, char** argv);

}  // namespace calot
