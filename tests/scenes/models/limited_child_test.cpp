#include "scenes/models/limited_child.h"

#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <string>
#include <thread>

#include "percale/error.h"
#include "tests/scenes/message_of.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::limited_child_test {
namespace {

constexpr ChildLimits limits{.memory = 256u << 20, .cpu_s = 1.0};

std::string fault_of(const std::function<std::vector<std::byte>()>& work) {
    return message_of([&] { run_in_child(limits, work); });
}

/// Longer than a pipe holds.
std::vector<std::byte> many_bytes() {
    std::vector<std::byte> bytes;
    for (int k = 0; k < 300000; ++k) bytes.push_back(static_cast<std::byte>(k % 251));
    return bytes;
}

}  // namespace

TEST_CASE("What a child returns comes back whole, and nothing where it returns nothing") {
    CHECK(run_in_child(limits, many_bytes) == many_bytes());
    CHECK(run_in_child(limits, [] { return std::vector<std::byte>(); }).empty());
}

TEST_CASE("An error in a child is the caller's, with its text") {
    CHECK(fault_of([]() -> std::vector<std::byte> { throw SceneError("a.fbx", "is torn"); }) == "a.fbx: is torn");
    CHECK(fault_of([]() -> std::vector<std::byte> { throw std::runtime_error("lost"); }) == "lost");
    CHECK(fault_of([]() -> std::vector<std::byte> { throw 7; }) == "ended without a result (exit code 1)");
}

TEST_CASE("A child that crashes, does not end or takes too much memory is reported, and this process goes on") {
    CHECK(fault_of([]() -> std::vector<std::byte> {
              std::raise(SIGSEGV);
              std::abort();
          }).starts_with("crashed (Segmentation fault"));
    CHECK(fault_of([]() -> std::vector<std::byte> { std::abort(); }).starts_with("crashed (Abort"));
    CHECK(fault_of([] {
              volatile bool on = true;
              while (on) {
              }
              return std::vector<std::byte>();
          }) == "took more than 1 s of CPU time");
    const auto fill = [] {
        std::vector<std::vector<std::byte>> all;
        while (true) all.emplace_back(std::size_t{16} << 20, std::byte{1});
        return std::vector<std::byte>();
    };
    // Where the machine has to find the memory first that takes CPU time, too.
    const std::string memory = message_of([&] { run_in_child({.memory = limits.memory, .cpu_s = 60.0}, fill); });
    // Sanitizers have an allocator that ends the program instead.
    CAPTURE(memory);
    CHECK((memory == "took more than 256 MB of memory" || memory.starts_with("ended without a result")));
    CHECK(run_in_child(limits, many_bytes) == many_bytes());
}

TEST_CASE("A child leaves signals that stop the program to it, and sends its result where the standard streams are closed") {
    CHECK(run_in_child(limits, [] {
              std::raise(SIGINT);
              std::raise(SIGTERM);
              return many_bytes();
          }) == many_bytes());
    CHECK(fault_of([]() -> std::vector<std::byte> {
              std::raise(SIGKILL);
              return {};
          }) == "was killed, perhaps for want of memory");
    const pid_t host = fork();
    if (host == 0) {
        for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) close(stream);
        _exit(run_in_child(limits, many_bytes) == many_bytes() ? 0 : 1);
    }
    int status = 0;
    waitpid(host, &status, 0);
    CHECK(status == 0);
}

TEST_CASE("Several threads may have children at once") {
    std::vector<std::thread> threads;
    std::vector<int> good(4, 0);
    for (int k = 0; k < 4; ++k)
        threads.emplace_back(
            [&good, k] { good[static_cast<std::size_t>(k)] = run_in_child(limits, many_bytes) == many_bytes(); });
    for (std::thread& thread : threads) thread.join();
    CHECK(good == std::vector<int>(4, 1));
}

}  // namespace percale::scenes::test::limited_child_test
