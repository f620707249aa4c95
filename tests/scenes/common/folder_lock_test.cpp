#include "common/folder_lock.h"

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <optional>

#include "percale/error.h"
#include "tests/scenes/message_of.h"
#include "tests/scenes/test_folder.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::folder_lock_test {

TEST_CASE("a folder has one lock at a time, which leaves nothing behind") {
    const TestFolder folder;
    std::optional<FolderLock> first(folder.path());
    CHECK(message_of([&] { FolderLock second(folder.path()); }) ==
          folder.path() + ": another run writes into it; wait for its end, or name another folder");
    CHECK_FALSE(message_of([&] { FolderLock second(folder.path("none/../")); }).empty());
    first.reset();
    folder.write("file", "");
    CHECK(message_of([&] { FolderLock of_file(folder.path("file")); }).starts_with(folder.path("file") + ": cannot be kept"));
    std::filesystem::remove(folder.path("file"));
    CHECK(message_of([&] { FolderLock second(folder.path()); }).empty());
    CHECK(folder.file_count() == 0);
    CHECK(message_of([&] { FolderLock none(folder.path("none")); }).empty());  // whoever makes the folder says why it cannot be
}

TEST_CASE("a process that is killed leaves no lock") {
    const TestFolder folder;
    int ready[2];
    REQUIRE(pipe(ready) == 0);
    const pid_t child = fork();
    if (child == 0) {
        const FolderLock lock(folder.path());
        const char byte = 1;
        if (write(ready[1], &byte, 1) == 1) pause();
        _exit(0);
    }
    char byte = 0;
    REQUIRE(read(ready[0], &byte, 1) == 1);
    CHECK_FALSE(message_of([&] { FolderLock second(folder.path()); }).empty());
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    CHECK(message_of([&] { FolderLock second(folder.path()); }).empty());
    for (const int end : ready) close(end);
}

}  // namespace percale::scenes::test::folder_lock_test
