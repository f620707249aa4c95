#include "models/limited_child.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>
#include <fstream>
#include <new>
#include <span>
#include <string>

#include "percale/error.h"

namespace percale::scenes {

namespace {

/// The first byte that a child sends.
enum class Word : unsigned char { result, error, no_memory };

/// The allowed wall time over the allowed CPU time: a child that sleeps for ever ends, too.
constexpr double wall_over_cpu = 10.0;

std::string megabytes(std::uint64_t bytes) { return std::to_string(bytes >> 20) + " MB"; }

std::uint64_t mapped_bytes() {
    std::ifstream statm("/proc/self/statm");
    std::uint64_t pages = 0;
    statm >> pages;
    return pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

void set_limit(decltype(RLIMIT_AS) what, std::uint64_t value) {
    rlimit limit{};
    if (getrlimit(what, &limit) != 0) return;
    limit.rlim_cur = std::min<rlim_t>(value, limit.rlim_max);
    setrlimit(what, &limit);
}

void limit_child(const ChildLimits& limits, pid_t parent) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent) _exit(1);
    for (const int number : {SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL, SIGXCPU, SIGPIPE}) signal(number, SIG_DFL);
    // A terminal sends them to the child, too; what they mean is for the parent to say, and the child ends with it.
    for (const int number : {SIGINT, SIGTERM}) signal(number, SIG_IGN);
    sigset_t none;
    sigemptyset(&none);
    sigprocmask(SIG_SETMASK, &none, nullptr);
    const int silent = open("/dev/null", O_RDWR | O_CLOEXEC);
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) dup2(silent, stream);
    set_limit(RLIMIT_CORE, 0);
    set_limit(RLIMIT_CPU, static_cast<std::uint64_t>(std::ceil(limits.cpu_s)));
    set_limit(RLIMIT_AS, mapped_bytes() + limits.memory);
}

void send(int to, Word word, std::span<const std::byte> bytes) {
    const auto write_all = [&](const void* from, std::size_t count) {
        const char* next = static_cast<const char*>(from);
        while (count > 0) {
            const ssize_t written = write(to, next, count);
            if (written < 0 && errno == EINTR) continue;
            if (written <= 0) _exit(1);
            next += written;
            count -= static_cast<std::size_t>(written);
        }
    };
    write_all(&word, 1);
    write_all(bytes.data(), bytes.size());
    _exit(0);
}

[[noreturn]] void be_child(int to, const std::function<std::vector<std::byte>()>& work) {
    try {
        send(to, Word::result, work());
    } catch (const SceneError& error) {
        const std::string text = error.what();
        send(to, Word::error, std::as_bytes(std::span(text)));
    } catch (const std::bad_alloc&) {
        send(to, Word::no_memory, {});
    } catch (const std::exception& error) {
        const std::string text = error.what();
        send(to, Word::error, std::as_bytes(std::span(text)));
    } catch (...) {
    }
    _exit(1);  // never back into the program that this is a copy of
}

/// Receives bytes until the other side closes; false where that takes too long.
bool receive(int from, double seconds, std::vector<std::byte>& bytes) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    std::vector<std::byte> part(std::size_t{1} << 16);
    while (true) {
        const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - std::chrono::steady_clock::now()).count();
        if (left <= 0) return false;
        pollfd waited{.fd = from, .events = POLLIN, .revents = 0};
        if (poll(&waited, 1, static_cast<int>(std::min<long>(left, 1000))) <= 0) continue;
        const ssize_t count = read(from, part.data(), part.size());
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) return true;
        bytes.insert(bytes.end(), part.begin(), part.begin() + count);
    }
}

/// Why a child ended without a result.
std::string ending_text(int status, bool in_time, const ChildLimits& limits) {
    const std::string seconds = std::to_string(static_cast<long>(std::ceil(limits.cpu_s))) + " s";
    if (!in_time) return "took more than " + seconds + " of CPU time, or waited for ever";
    if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU) return "took more than " + seconds + " of CPU time";
    if (WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL) return "was killed, perhaps for want of memory";
    if (WIFSIGNALED(status)) return std::string("crashed (") + strsignal(WTERMSIG(status)) + ")";
    return "ended without a result (exit code " + std::to_string(WEXITSTATUS(status)) + ")";
}

}  // namespace

std::vector<std::byte> run_in_child(const ChildLimits& limits, const std::function<std::vector<std::byte>()>& work) {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) throw SceneError(std::string("no pipe: ") + std::strerror(errno));
    const pid_t parent = getpid(), child = fork();
    if (child < 0) {
        const int error = errno;
        for (const int end : ends) close(end);
        throw SceneError(std::string("no process: ") + std::strerror(error));
    }
    if (child == 0) {
        close(ends[0]);
        // Behind the standard streams, which are silenced: a host may have closed those, and the pipe got their numbers.
        if (ends[1] <= STDERR_FILENO) ends[1] = fcntl(ends[1], F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
        limit_child(limits, parent);
        be_child(ends[1], work);
    }
    close(ends[1]);
    std::vector<std::byte> bytes;
    const bool in_time = receive(ends[0], wall_over_cpu * limits.cpu_s, bytes);
    close(ends[0]);
    if (!in_time) kill(child, SIGKILL);
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    const bool whole = in_time && WIFEXITED(status) && WEXITSTATUS(status) == 0 && !bytes.empty();
    if (!whole) throw SceneError(ending_text(status, in_time, limits));
    const Word word = static_cast<Word>(bytes.front());
    bytes.erase(bytes.begin());
    if (word == Word::result) return bytes;
    if (word == Word::no_memory) throw SceneError("took more than " + megabytes(limits.memory) + " of memory");
    throw SceneError(std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}

}  // namespace percale::scenes
