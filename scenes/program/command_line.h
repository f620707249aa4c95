#pragma once

namespace percale::program {

/// Does what a command line asks for. Gives the program's exit code (exit_codes.h); errors are printed on stderr.
int run_program(int argc, char** argv);

}  // namespace percale::program
