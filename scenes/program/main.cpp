#include <csignal>

#include "program/command_line.h"

int main(int argc, char** argv) {
    // A file that grows beyond its limit is then an error of the write, with a name and a reason, like a full disk.
    std::signal(SIGXFSZ, SIG_IGN);
    return percale::program::run_program(argc, argv);
}
