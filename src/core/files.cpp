// SPDX-License-Identifier: MIT
#include "core/files.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <system_error>
#include <tuple>
#include <utility>

#include "core/spawn.hpp"
#include "core/text/param_text.hpp"

namespace darkroom {
namespace {

namespace fs = std::filesystem;

// The temporary files that exist, for a signal handler: a table of fixed size, since a handler may neither allocate nor
// lock. A file that finds no room, or whose name is too long, is written all the same and left by a signal.
struct Watched {
    enum State : int { Free, Changing, Used };
    std::atomic<int> state{Free};
    std::array<char, 1024> path{};
};
std::array<Watched, 256> watched_files;
static_assert(std::atomic<int>::is_always_lock_free);

int watch(const fs::path& path) noexcept {
    const std::string& name = path.native();
    if (name.size() >= watched_files[0].path.size()) return -1;
    for (std::size_t i = 0; i < watched_files.size(); ++i) {
        int free = Watched::Free;
        if (!watched_files[i].state.compare_exchange_strong(free, Watched::Changing)) continue;
        std::copy_n(name.c_str(), name.size() + 1, watched_files[i].path.data());
        watched_files[i].state = Watched::Used;
        return static_cast<int>(i);
    }
    return -1;
}

void unwatch(int place) noexcept {
    if (place >= 0) watched_files[static_cast<std::size_t>(place)].state = Watched::Free;
}

std::atomic<int> creating{0};
std::atomic<bool> is_ending{false};

/// While one lives, a file may come to be. The handler waits for it on another thread, so no file appears behind it.
class Creation {
  public:
    Creation() {
        sigset_t all;
        ::sigfillset(&all);
        ::pthread_sigmask(SIG_BLOCK, &all, &before_);
        ++creating;
        if (!is_ending) return;
        --creating;
        for (;;) ::pause();
    }
    Creation(const Creation&) = delete;
    Creation& operator=(const Creation&) = delete;
    ~Creation() {
        --creating;
        ::pthread_sigmask(SIG_SETMASK, &before_, nullptr);
    }

  private:
    sigset_t before_{};
};

// Only what a handler may call (signal-safety(7)). A file system that hangs is waited for a second at most. The signal
// that is raised is blocked until the handler returns.
void remove_watched(int signal) {
    is_ending = true;
    for (int wait = 0; wait < 1000 && creating > 0; ++wait) ::poll(nullptr, 0, 1);
    for (const Watched& file : watched_files)
        if (file.state == Watched::Used) ::unlink(file.path.data());
    if (const int process = process_that_ends_with_us; process > 0) ::kill(process, signal);
    ::signal(signal, SIG_DFL);
    ::raise(signal);
}

struct Descriptor {
    int number = -1;

    explicit Descriptor(int opened) : number(opened) {}
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    ~Descriptor() {
        if (number >= 0) ::close(number);
    }
};

Failure io_error(const fs::path& path, const char* doing, int code) {
    return machine_error(fmt::format("{}: cannot {}: {}", printable(path.string()), doing, std::strerror(code)));
}

Failure read_failure(int code) { return machine_error(fmt::format("cannot read: {}", std::strerror(code))); }

// A wrong name is the user's to mend; a disk that fails is not.
Failure open_failure(int code) {
    if (code == ENOENT) return user_error("there is no such file");
    const std::string text = fmt::format("cannot open: {}", std::strerror(code));
    return code == ENOTDIR || code == ENAMETOOLONG ? user_error(text) : machine_error(text);
}

Failure placed(const fs::path& path, const Error& error) {
    return failure(Error{error.fault, fmt::format("{}: {}", printable(path.string()), error.text)});
}

Failure open_error(const fs::path& path, int code) { return placed(path, Result<>(open_failure(code)).error()); }

const char* kind_of(mode_t mode) {
    if (S_ISFIFO(mode)) return "a pipe";
    if (S_ISSOCK(mode)) return "a socket";
    return "a device";
}

Result<> check_regular(mode_t mode) {
    if (S_ISDIR(mode)) return user_error("is a folder, a file is needed");
    if (S_ISREG(mode)) return {};
    return user_error(fmt::format("is no regular file but {}", kind_of(mode)));
}

/// Asked before it is opened, since some devices act when they are, and behind it, since a name may have been given to
/// another file meanwhile. Without waiting: a pipe would be opened when somebody writes into it.
Result<int> open_regular(const fs::path& path, struct stat& status) {
    if (::stat(path.c_str(), &status) != 0) return open_failure(errno);
    if (auto checked = check_regular(status.st_mode); !checked) return failure(std::move(checked));
    const int number = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
    if (number < 0) return open_failure(errno);
    Result<> checked;
    if (::fstat(number, &status) != 0)
        checked = read_failure(errno);
    else
        checked = check_regular(status.st_mode);
    if (checked) return number;
    ::close(number);
    return failure(std::move(checked));
}

Result<std::vector<std::byte>> read_regular(const fs::path& path, const ReadFileOptions& options) {
    struct stat status {};
    const Result<int> opened = open_regular(path, status);
    if (!opened) return failure(opened.error());
    const Descriptor file(*opened);
    const auto most = static_cast<std::size_t>(std::min<std::uintmax_t>(options.max_size, PTRDIFF_MAX));
    const std::size_t room = options.takes_start ? std::max<std::size_t>(most, 16) : PTRDIFF_MAX;

    std::vector<std::byte> content(16);
    std::size_t size = 0;
    bool is_start_checked = !options.check_start;
    for (bool is_end = false; !is_end;) {
        const ssize_t count = ::read(file.number, content.data() + size, content.size() - size);
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) return read_failure(errno);
        is_end = count == 0;
        size += static_cast<std::size_t>(count);
        if (!is_end && size < content.size()) continue;
        if (!is_start_checked) {
            is_start_checked = true;
            if (Result<> checked = options.check_start({content.data(), size}); !checked)
                return failure(std::move(checked));
        }
        const auto known = std::max<std::uintmax_t>(size, static_cast<std::uintmax_t>(status.st_size));
        if (!options.takes_start && known > most)
            return user_error(fmt::format("{} bytes, at most {} are read", known, options.max_size));
        if (size >= room) break;
        // One byte more than the file says it has, so that the usual file ends without another round of growing.
        if (!is_end) content.resize(std::min(room, std::max(size * 2, static_cast<std::size_t>(status.st_size) + 1)));
    }
    content.resize(std::min(size, most));
    return content;
}

Result<> write_all(int descriptor, const fs::path& path, std::span<const std::byte> content) {
    while (!content.empty()) {
        const ssize_t count = ::write(descriptor, content.data(), content.size());
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) return io_error(path, "write", errno);
        content = content.subspan(static_cast<std::size_t>(count));
    }
    return {};
}

thread_local std::set<fs::path>* record = nullptr;  // of this thread's ReadRecord

Result<> write_and_close(Descriptor& file, const fs::path& path, std::span<const std::byte> content) {
    if (auto written = write_all(file.number, path, content); !written) return written;
    const int descriptor = std::exchange(file.number, -1);
    if (::close(descriptor) != 0) return io_error(path, "write", errno);
    return {};
}

}  // namespace

ReadRecord::ReadRecord() { record = &files_; }
ReadRecord::~ReadRecord() { record = nullptr; }

Result<std::vector<std::byte>> read_file(const fs::path& path, const ReadFileOptions& options) {
    if (record != nullptr) record->insert(path);
    Result<std::vector<std::byte>> content = read_regular(path, options);
    return content || !options.is_path_in_errors ? std::move(content) : placed(path, content.error());
}

FileStamp stamp_of(const std::filesystem::path& path) {
    struct stat is {};
    if (::stat(path.c_str(), &is) != 0) return {};
    return {static_cast<std::uint64_t>(is.st_size), is.st_mtim.tv_sec, is.st_mtim.tv_nsec, is.st_ino};
}

Result<> write_file(const fs::path& path, std::span<const std::byte> content, bool waits_for_disk) {
    std::error_code ignored;
    const fs::file_status status = fs::status(path, ignored);
    if (fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status)) {
        Descriptor file(::open(path.c_str(), O_WRONLY | O_CLOEXEC));
        if (file.number < 0) return open_error(path, errno);
        return write_and_close(file, path, content);
    }
    auto temporary = AtomicPath::beside(path);
    if (!temporary) return failure(std::move(temporary));
    Descriptor file(::open(temporary->path().c_str(), O_WRONLY | O_TRUNC | O_CLOEXEC));
    if (file.number < 0) return open_error(path, errno);
    if (auto written = write_all(file.number, path, content); !written) return written;
    // Renamed first, the name would stand for an empty file behind a power cut.
    if (waits_for_disk && ::fsync(file.number) != 0) return io_error(path, "write", errno);
    if (auto closed = write_and_close(file, path, {}); !closed) return closed;
    return temporary->commit();
}

void AtomicPath::remove_on_signals() {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        struct sigaction action {};
        if (::sigaction(signal, nullptr, &action) != 0 || action.sa_handler == SIG_IGN) continue;
        action = {};
        action.sa_handler = remove_watched;
        ::sigfillset(&action.sa_mask);
        std::ignore = ::sigaction(signal, &action, nullptr);
    }
}

AtomicPath::AtomicPath(fs::path target, fs::path temporary)
    : target_(std::move(target)), temporary_(std::move(temporary)), watched_(watch(temporary_)) {}

AtomicPath::AtomicPath(AtomicPath&& other) noexcept
    : target_(std::move(other.target_)),
      temporary_(std::move(other.temporary_)),
      watched_(std::exchange(other.watched_, -1)) {
    other.temporary_.clear();
}

AtomicPath& AtomicPath::operator=(AtomicPath&& other) noexcept {
    if (this == &other) return *this;
    discard();
    target_ = std::move(other.target_);
    temporary_ = std::move(other.temporary_);
    watched_ = std::exchange(other.watched_, -1);
    other.temporary_.clear();
    return *this;
}

AtomicPath::~AtomicPath() { discard(); }

void AtomicPath::discard() noexcept {
    if (!temporary_.empty()) ::unlink(temporary_.c_str());
    forget();
}

void AtomicPath::forget() noexcept {
    temporary_.clear();
    unwatch(std::exchange(watched_, -1));
}

Result<AtomicPath> AtomicPath::beside(const fs::path& target) {
    if (target.filename().empty()) return user_error(fmt::format("{}: is a folder, a file is needed", target.string()));
    std::error_code code;
    const fs::file_status status = fs::status(target, code);
    if (fs::is_directory(status)) return user_error(fmt::format("{}: is a folder, a file is needed", target.string()));
    if (fs::exists(status) && !fs::is_regular_file(status))
        return user_error(fmt::format("{}: is no regular file and cannot be replaced", target.string()));
    // Replacing a link would cut it; what it points to is what the user means, be it there or not.
    fs::path real = target;
    constexpr int most_links = 40;  // as the system follows
    for (int i = 0; i < most_links && fs::is_symlink(fs::symlink_status(real, code)); ++i) {
        const fs::path to = fs::read_symlink(real, code);
        if (code) break;
        real = real.parent_path() / to;
    }
    if (fs::is_symlink(fs::symlink_status(real, code))) return open_error(target, ELOOP);
    if (fs::exists(status)) {
        // A rename asks only the folder; a file that its owner protected must stay as well.
        if (::access(real.c_str(), W_OK) != 0) return open_error(target, errno);
    }

    static std::atomic<unsigned> counter{0};
    for (int attempt = 0; attempt < 100; ++attempt) {
        const std::string name = fmt::format(".{}.{}.{}.part{}", real.stem().string().substr(0, 100), ::getpid(),
                                             counter.fetch_add(1), real.extension().string());
        fs::path temporary = real.parent_path() / name;
        const Creation creation;
        const Descriptor file(::open(temporary.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666));
        if (file.number >= 0) {
            struct stat existing {};
            if (::stat(real.c_str(), &existing) == 0) std::ignore = ::fchmod(file.number, existing.st_mode & 07777);
            return AtomicPath(std::move(real), std::move(temporary));
        }
        if (errno != EEXIST) return io_error(target, "create", errno);
    }
    return machine_error(fmt::format("{}: cannot create: no free temporary name beside it", target.string()));
}

Result<> AtomicPath::commit() {
    if (::rename(temporary_.c_str(), target_.c_str()) != 0) return io_error(target_, "create", errno);
    forget();
    return {};
}

}  // namespace darkroom
