#include "collision/c/call.h"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <new>
#include <stdexcept>
#include <string>
#include <thread>

#include "percale/contact.h"
#include "tests/support/catch.h"
#include "tests/support/collision/c_objects.h"

// Sanitizers take more addresses than a limit leaves.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define PERCALE_TEST_UNDER_SANITIZER
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define PERCALE_TEST_UNDER_SANITIZER
#endif
#endif

namespace percale::test::call_test {
using namespace percale::c_interface;

TEST_CASE("Whatever is thrown becomes a status with a text, of the object and of the thread") {
    ErrorText own;
    const auto status_of = [&](auto thrown) {
        return call(
            "f", [&] { throw thrown; }, &own);
    };
    CHECK(own.text() == std::string());
    CHECK(status_of(SceneError("cloth", "is odd")) == PERCALE_INVALID_ARGUMENT);
    CHECK(own.text() == std::string("f: cloth: is odd"));
    CHECK(thread_error().text() == std::string("f: cloth: is odd"));
    CHECK(status_of(StartError("starts inside", {})) == PERCALE_START_REFUSED);
    CHECK(status_of(CallError(PERCALE_NOT_BUILT, "fcl")) == PERCALE_NOT_BUILT);
    CHECK(status_of(std::bad_alloc()) == PERCALE_OUT_OF_MEMORY);
    CHECK(own.text() == std::string("f: out of memory"));
    CHECK(status_of(std::length_error("too long")) == PERCALE_INTERNAL_ERROR);
    CHECK(own.text() == std::string("f: too long"));
    CHECK(status_of(42) == PERCALE_INTERNAL_ERROR);
    CHECK(own.text() == std::string("f: an exception of unknown type"));
}

#ifndef PERCALE_TEST_UNDER_SANITIZER
namespace {

/// In a process that may take a few more pages: a large mesh, then a small one. 0 where the first lacked memory and the second,
/// once there is some again, was made.
int lack_memory() {
    std::ifstream sizes("/proc/self/statm");
    rlim_t pages = 0;
    sizes >> pages;
    rlimit before{}, tight{};
    getrlimit(RLIMIT_AS, &before);
    tight = before;
    tight.rlim_cur = (pages + 1024) * static_cast<rlim_t>(sysconf(_SC_PAGESIZE));
    setrlimit(RLIMIT_AS, &tight);
    percale_mesh* mesh = nullptr;
    const percale_status lacking = percale_make_sphere(1.0, 8, &mesh);
    if (lacking != PERCALE_OUT_OF_MEMORY || mesh != nullptr) return 1;
    setrlimit(RLIMIT_AS, &before);
    if (std::string(percale_last_error(nullptr)).find("out of memory") == std::string::npos) return 2;
    if (percale_make_sphere(1.0, 1, &mesh) != PERCALE_OK) return 3;
    percale_destroy_mesh(mesh);
    return 0;
}

}  // namespace

TEST_CASE("Lack of memory is a status, and the library goes on when there is some again") {
    const pid_t child = fork();
    REQUIRE(child >= 0);
    if (child == 0) _exit(lack_memory());
    int status = -1;
    REQUIRE(waitpid(child, &status, 0) == child);
    REQUIRE(WIFEXITED(status));
    CHECK(WEXITSTATUS(status) == 0);
}
#endif

TEST_CASE("A call that goes well leaves the text of the last error") {
    ErrorText own;
    CHECK(call(
              "first", [] { throw SceneError("wrong"); }, &own) == PERCALE_INVALID_ARGUMENT);
    CHECK(call(
              "second", [] {}, &own) == PERCALE_OK);
    CHECK(own.text() == std::string("first: wrong"));
}

TEST_CASE("Every thread has an error text of its own") {
    fails(percale_pin(nullptr, 0, 0), PERCALE_INVALID_ARGUMENT, "percale_pin", "simulation: is NULL");
    std::string of_other = "unset", after;
    std::thread([&] {
        of_other = percale_last_error(nullptr);
        percale_unpin(nullptr, 0, 0);
        after = percale_last_error(nullptr);
    }).join();
    CHECK(of_other.empty());
    CHECK(after == "percale_unpin: simulation: is NULL");
    CHECK(percale_last_error(nullptr) == std::string("percale_pin: simulation: is NULL"));
}

TEST_CASE("Every simulation has an error text of its own") {
    const auto one = percale::test::c_simulation("none"), other = percale::test::c_simulation("none");
    fails(percale_pin(one.get(), 7, 0), PERCALE_INVALID_ARGUMENT, "percale_pin", "7");
    CHECK(percale_last_error(one.get()) == std::string(percale_last_error(nullptr)));
    CHECK(percale_last_error(other.get()) == std::string());
}

}  // namespace percale::test::call_test
