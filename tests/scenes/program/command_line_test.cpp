#include "tests/scenes/program/run_program.h"
#include "tests/support/catch.h"

namespace percale::program::test::command_line_test {

TEST_CASE("the program says its version and its commands") {
    const ProgramRun version = run_program({"--version"});
    CHECK(version.exit_code == 0);
    CHECK(version.out.rfind("percale ", 0) == 0);
    const ProgramRun help = run_program({"--help"});
    CHECK(help.exit_code == 0);
    for (const char* command : {"run", "plan", "check", "explain", "certify", "drape", "doctor", "replay", "stress", "study"})
        CHECK(help.out.find(command) != std::string::npos);
    CHECK(help.error.empty());
}

TEST_CASE("the help of every command shows an example of it") {
    for (const std::string command :
         {"run", "plan", "check", "explain", "certify", "drape", "doctor", "replay", "stress", "study"}) {
        const ProgramRun help = run_program({command, "--help"});
        INFO(command);
        CHECK(help.exit_code == 0);
        CHECK(help.out.find(": percale " + command + " ") != std::string::npos);
    }
}

TEST_CASE("help is an option by itself and before a command") {
    CHECK(run_program({"help"}).out == run_program({"--help"}).out);
    CHECK(run_program({"help", "drape"}).out == run_program({"drape", "--help"}).out);
    CHECK(run_program({"help", "drape"}).exit_code == 0);
    CHECK(run_program({"help", "help"}).out == run_program({"--help"}).out);
    CHECK(refused(run_program({"help", "drap"}), "no such command 'drap'; did you mean 'drape'?"));
}

TEST_CASE("an option that takes three numbers says so where it gets others") {
    const auto with = [](std::vector<std::string> more) {
        std::vector<std::string> arguments = {"drape", "no_such_garment.obj", "b.obj"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run_program(arguments);
    };
    CHECK(refused(with({"--move", "0", "1.53", "-o", "x.obj"}),
                  "--move takes three numbers, as in --move 0 1.5 0, but '-o' is no number"));
    CHECK(refused(with({"-o", "x.obj", "--rotate", "90", "0"}), "--rotate takes three numbers, as in"));
    CHECK(refused(with({"-o", "x.obj", "--rotate", "90", "0"}), "but 2 are given"));
    CHECK(refused(with({"-o", "x.obj", "--move", "0", "nan", "0"}), "'nan' is no number"));
    CHECK(refused(with({"--move", "1,2", "-o", "x.obj"}), "--move takes three numbers, as in --move 0 1.5 0, but 2 are given"));
    CHECK(refused(with({"--move", "0,", "1.5,", "0", "-o", "x.obj"}), "but 1 is given"));
    CHECK(refused(with({"--move=1,2", "-o", "x.obj"}), "--move takes three numbers, as in --move 0 1.5 0, but 2 are given"));
    CHECK(refused(with({"--move", "1,2,3,4", "-o", "x.obj"}), "but 4 are given"));
    CHECK(refused(with({"-o", "x.obj", "--rotate", "0,90deg,0"}), "'90deg' is no number"));
    // Correct options pass, and the next error is about the files.
    CHECK(refused(with({"-o", "x.obj", "--move", "-1", "-.5", "2e-3"}), "cannot be read"));
    CHECK(refused(with({"-o", "x.obj", "--move", "-1,-.5,2e-3"}), "cannot be read"));
}

TEST_CASE("a command that does not exist is refused with the nearest and all that there are") {
    CHECK(refused(run_program({"chek", "a.toml"}), "no such command 'chek'; did you mean 'check'? valid: run, plan, check, "));
    CHECK(refused(run_program({"simulate"}), "no such command 'simulate'; valid: run, plan, check, "));
}

TEST_CASE("a command line that cannot be read ends with exit code 2 and one message") {
    CHECK(refused(run_program({}), "subcommand"));
    CHECK(refused(run_program({"run"}), "SCENE"));
    CHECK(refused(run_program({"run", "a.toml", "--no-such-option"}), "percale: no such option '--no-such-option' (see --help)"));
    CHECK(refused(run_program({"run", "a.toml", "--frmes", "none"}), "no such option '--frmes'; did you mean '--frames'?"));
    CHECK(refused(run_program({"run", "a.toml", "--thread=2"}), "no such option '--thread'; did you mean '--threads'?"));
    CHECK(refused(run_program({"run", "a.toml", "b.toml", "c.toml"}), "unexpected argument 'b.toml'"));
    CHECK(refused(run_program({"check", "a.toml", "--jobs", "many"}), "many"));
    CHECK(refused(run_program({"drape", "a.obj", "-o", "b.obj"}), "BODY"));
}

TEST_CASE("output that cannot be written is an error") {
    if (!std::filesystem::is_character_file("/dev/full")) return;
    const TestFolder folder;
    const std::string error = folder.path("error");
    const std::string call = quoted(PERCALE_PROGRAM) + " explain >/dev/full 2>" + quoted(error);
    CHECK(WEXITSTATUS(std::system(call.c_str())) == 2);
    CHECK(folder.read("error") == "percale: the standard output cannot be written\n");
}

}  // namespace percale::program::test::command_line_test
