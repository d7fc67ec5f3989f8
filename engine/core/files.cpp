// SPDX-License-Identifier: MIT
#include "core/files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <optional>
#include <system_error>
#include <utility>

#include "core/own_file.hpp"
#include "core/system/file.hpp"
#include "core/system/watched_files.hpp"
#include "core/text/param_text.hpp"

namespace darkroom {
namespace {

namespace fs = std::filesystem;

Failure io_error(const fs::path& path, const char* doing, const std::error_code& code) {
    return machine_error(fmt::format("{}: cannot {}: {}", printable(path.string()), doing, code.message()));
}

Failure read_failure(const std::error_code& code) {
    return machine_error(fmt::format("cannot read: {}", code.message()));
}

// A wrong name is the user's to mend; a disk that fails is not.
Failure open_failure(const std::error_code& code) {
    if (code == std::errc::no_such_file_or_directory) return user_error("there is no such file");
    const std::string text = fmt::format("cannot open: {}", code.message());
    const bool is_name_wrong = code == std::errc::not_a_directory || code == std::errc::filename_too_long;
    return is_name_wrong ? user_error(text) : machine_error(text);
}

Failure placed(const fs::path& path, const Error& error) {
    return failure(Error{error.fault, fmt::format("{}: {}", printable(path.string()), error.text)});
}

Failure open_error(const fs::path& path, const std::error_code& code) {
    return placed(path, Result<>(open_failure(code)).error());
}

Result<> check_regular(FileKind kind) {
    switch (kind) {
        case FileKind::Regular:
            return {};
        case FileKind::Folder:
            return user_error("is a folder, a file is needed");
        case FileKind::Pipe:
            return user_error("is a pipe, a regular file is needed");
        case FileKind::Socket:
            return user_error("is a socket, a regular file is needed");
        case FileKind::Device:
            break;
    }
    return user_error("is a device, a regular file is needed");
}

/// Asked before it is opened, since some devices act when they are, and behind it, since a name may have been given to
/// another file meanwhile.
Result<> open_regular(const fs::path& path, OpenFile& file, FileFacts& facts) {
    if (const auto failed = facts_of(path, facts)) return open_failure(failed);
    DARKROOM_TRY(check_regular(facts.kind));
    if (const auto failed = file.open(path, OpenFile::How::Read)) return open_failure(failed);
    if (const auto failed = file.facts(facts)) return read_failure(failed);
    return check_regular(facts.kind);
}

Result<std::vector<std::byte>> read_regular(const fs::path& path, const ReadFileOptions& options) {
    OpenFile file;
    FileFacts facts;
    DARKROOM_TRY(open_regular(path, file, facts));
    const auto most = static_cast<std::size_t>(std::min<std::uintmax_t>(options.max_size, PTRDIFF_MAX));
    const std::size_t room = options.takes_start ? std::max<std::size_t>(most, 16) : PTRDIFF_MAX;

    std::vector<std::byte> content(16);
    std::size_t size = 0;
    bool is_start_checked = !options.check_start;
    for (bool is_end = false; !is_end;) {
        std::size_t count = 0;
        if (const auto failed = file.read(std::span(content).subspan(size), count)) return read_failure(failed);
        is_end = count == 0;
        size += count;
        if (!is_end && size < content.size()) continue;
        if (!is_start_checked) {
            is_start_checked = true;
            DARKROOM_TRY(options.check_start({content.data(), size}));
        }
        const auto known = std::max<std::uintmax_t>(size, facts.size);
        if (!options.takes_start && known > most)
            return user_error(fmt::format("{} bytes, at most {} are read", known, options.max_size));
        if (size >= room) break;
        // One byte more than the file says it has, so that the usual file ends without another round of growing.
        if (!is_end) content.resize(std::min(room, std::max(size * 2, static_cast<std::size_t>(facts.size) + 1)));
    }
    content.resize(std::min(size, most));
    return content;
}

thread_local std::set<fs::path>* record = nullptr;  // of this thread's ReadRecord

Result<> write_and_close(OpenFile& file, const fs::path& path, std::span<const std::byte> content,
                         bool waits_for_disk = false) {
    std::error_code failed = file.write(content);
    // Renamed first, the name would stand for an empty file behind a power cut.
    if (!failed && waits_for_disk) failed = file.reach_disk();
    if (!failed) failed = file.close();
    if (failed) return io_error(path, "write", failed);
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
    FileFacts is;
    if (facts_of(path, is)) return {};
    return {is.size, is.seconds, is.nanoseconds, is.number};
}

Result<> write_file(const fs::path& path, std::span<const std::byte> content, bool waits_for_disk) {
    std::error_code ignored;
    const fs::file_status status = fs::status(path, ignored);
    OpenFile file;
    if (fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status)) {
        if (const auto failed = file.open(path, OpenFile::How::Write)) return open_error(path, failed);
        return write_and_close(file, path, content);
    }
    DARKROOM_TRY_VALUE(auto temporary, AtomicPath::beside(path));
    if (const auto failed = file.open(temporary.path(), OpenFile::How::Truncate)) return open_error(path, failed);
    DARKROOM_TRY(write_and_close(file, path, content, waits_for_disk));
    return temporary.commit();
}

bool is_place_of_system(const fs::path& path) {
    const fs::path folder = path.parent_path();
    return folder == "/dev" || folder == "/dev/fd" || folder == "/proc/self/fd";
}

Result<> check_own_file(const fs::path& path, FileOwner owner) {
    if (owner == FileOwner::Anyone && is_place_of_system(path)) return {};
    std::error_code error;
    const fs::file_status status = fs::symlink_status(path, error);
    if (!fs::exists(status)) return {};
    const auto refuse = [&](std::string_view what) {
        return user_error(fmt::format("{}: {}; a regular file{}, or none, is needed here", printable(path.string()),
                                      what, owner == FileOwner::ThisUser ? " of this user" : ""));
    };
    if (fs::is_symlink(status)) return refuse("is a link, which is not followed");
    if (!fs::is_regular_file(status)) return refuse(fs::is_directory(status) ? "is a folder" : "is no regular file");
    return owner == FileOwner::Anyone || is_of_this_user(path) ? Result<>() : refuse("belongs to another user");
}

namespace {

/// Beside what is to be replaced, with this in it.
Result<AtomicPath> written_beside(const fs::path& path, std::span<const std::byte> content, FileOwner owner) {
    DARKROOM_TRY(check_own_file(path, owner));
    DARKROOM_TRY_VALUE(auto temporary, AtomicPath::beside(path));
    // A link that was put there since leads to another folder or another name.
    const std::string own = fmt::format(".{}.", path.stem().string().substr(0, 100));
    if (temporary.path().parent_path() != path.parent_path() || !temporary.path().filename().string().starts_with(own))
        return user_error(fmt::format("{}: is a link, which is not followed", printable(path.string())));
    OpenFile file;
    if (const auto failed = file.open(temporary.path(), OpenFile::How::Truncate)) return open_error(path, failed);
    DARKROOM_TRY(write_and_close(file, path, content));
    return temporary;
}

}  // namespace

Result<> write_own_file(const fs::path& path, std::span<const std::byte> content, FileOwner owner) {
    if (owner == FileOwner::Anyone && is_place_of_system(path)) return write_file(path, content);
    DARKROOM_TRY_VALUE(AtomicPath temporary, written_beside(path, content, owner));
    return temporary.commit();
}

Result<> make_own_folder(const fs::path& path) {
    std::error_code error;
    if (fs::is_symlink(fs::symlink_status(path, error)))
        return user_error(fmt::format("{}: is a link, which is not followed", printable(path.string())));
    fs::create_directories(path, error);
    if (!error) return {};
    return machine_error(fmt::format("{}: cannot be made: {}", printable(path.string()), error.message()));
}

Result<FileLock> write_locked_file(const fs::path& path, std::span<const std::byte> content) {
    DARKROOM_TRY_VALUE(AtomicPath temporary, written_beside(path, content, FileOwner::ThisUser));
    auto lock = std::make_shared<OpenFile>();
    if (const auto failed = lock->open(temporary.path(), OpenFile::How::Read)) return open_error(path, failed);
    if (!lock->lock()) return machine_error(fmt::format("{}: cannot be locked", printable(path.string())));
    DARKROOM_TRY(temporary.commit());
    return FileLock(std::move(lock));
}

FileLock lock_own_file(const fs::path& path) {
    auto lock = std::make_shared<OpenFile>();
    FileFacts held, there;
    if (!check_own_file(path) || lock->open(path, OpenFile::How::Read) || !lock->lock() || lock->facts(held)) return {};
    // Who writes it replaces it, and a link may have been put there since.
    if (!check_own_file(path) || facts_of(path, there) || held.number != there.number) return {};
    return lock;
}

void AtomicPath::remove_on_signals() { remove_watched_files_on_signals(); }

AtomicPath::AtomicPath(fs::path target, fs::path temporary)
    : target_(std::move(target)), temporary_(std::move(temporary)), watched_(watch_file(temporary_)) {}

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
    std::error_code ignored;
    if (!temporary_.empty()) fs::remove(temporary_, ignored);
    forget();
}

void AtomicPath::forget() noexcept {
    temporary_.clear();
    unwatch_file(std::exchange(watched_, -1));
}

Result<AtomicPath> AtomicPath::beside(const fs::path& target) {
    if (target.filename().empty()) return user_error(fmt::format("{}: is a folder, a file is needed", target.string()));
    std::error_code code;
    const fs::file_status status = fs::status(target, code);
    if (fs::is_directory(status)) return user_error(fmt::format("{}: is a folder, a file is needed", target.string()));
    if (fs::exists(status) && !fs::is_regular_file(status))
        return user_error(fmt::format("{}: is not a regular file and cannot be replaced", target.string()));
    // Replacing a link would cut it; what it points to is what the user means, be it there or not.
    fs::path real = target;
    constexpr int max_links = 40;  // as the system follows
    for (int i = 0; i < max_links && fs::is_symlink(fs::symlink_status(real, code)); ++i) {
        const fs::path to = fs::read_symlink(real, code);
        if (code) break;
        real = real.parent_path() / to;
    }
    if (fs::is_symlink(fs::symlink_status(real, code)))
        return open_error(target, std::make_error_code(std::errc::too_many_symbolic_link_levels));
    if (fs::exists(status)) {
        // A rename asks only the folder; a file that its owner protected must stay as well.
        if (const auto failed = check_writable(real)) return open_error(target, failed);
    }

    static std::atomic<unsigned> counter{0};
    for (int attempt = 0; attempt < 100; ++attempt) {
        const std::string name = fmt::format(".{}.{}.{}.part{}", real.stem().string().substr(0, 100), process_number(),
                                             counter.fetch_add(1), real.extension().string());
        fs::path temporary = real.parent_path() / name;
        std::error_code failed;
        std::optional<AtomicPath> made;
        create_watched([&] {
            OpenFile file;
            failed = file.open(temporary, OpenFile::How::Create);
            if (!failed) made = AtomicPath(std::move(real), std::move(temporary));
        });
        if (made) {
            if (fs::exists(status)) fs::permissions(made->temporary_, status.permissions(), code);
            return std::move(*made);
        }
        if (failed != std::errc::file_exists) return io_error(target, "create", failed);
    }
    return machine_error(fmt::format("{}: cannot create: no free temporary name beside it", target.string()));
}

Result<> AtomicPath::commit() {
    // Of one folder, and over what is there: on Windows, too, where it fails while another process has it open.
    std::error_code failed;
    fs::rename(temporary_, target_, failed);
    if (failed) return io_error(target_, "create", failed);
    forget();
    return {};
}

}  // namespace darkroom
