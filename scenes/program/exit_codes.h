#pragma once

namespace percale::program {

/// What the program returns to the shell.
enum ExitCode {
    all_well = 0,
    not_as_expected = 1,  // an expectation failed, a step ended badly or unsolved, a certificate is not clean
    wrong_input = 2,      // also output that cannot be written
    internal_error = 3,
    stopped_by_signal = 130,
};

}  // namespace percale::program
